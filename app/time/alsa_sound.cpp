// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cerrno>
#include <utility>

#include <alsa/asoundlib.h>
#include <fmt/format.h>

#include "app/time/sound_input.hpp"
#include "app/time/sound_output.hpp"

namespace footlight::app {
namespace {

constexpr unsigned kRate_hz = 48'000;
constexpr unsigned kLatency_us = 500'000;  // of the buffer: whoever reads may be late by so much
constexpr std::size_t kFrames = 1024;
constexpr unsigned kChannels = 2;

struct ClosePcm {
  void operator()(snd_pcm_t* pcm) const { snd_pcm_close(pcm); }
};

void no_words(const char* /*file*/, int /*line*/, const char* /*function*/, int /*error*/, const char* /*format*/,
              ...) {}

class AlsaInput final : public SoundInput {
 public:
  AlsaInput(std::unique_ptr<snd_pcm_t, ClosePcm> pcm, unsigned channels) : pcm_(std::move(pcm)), channels_(channels) {
    (void)snd_pcm_start(pcm_.get());
  }
  [[nodiscard]] int sample_rate() const override { return static_cast<int>(kRate_hz); }

  Piece read(Instant now) override {
    Piece piece;
    piece.over = over_;
    while (!over_) {
      std::array<float, kFrames * kChannels> frames{};
      const snd_pcm_sframes_t count = snd_pcm_readi(pcm_.get(), frames.data(), kFrames);
      if (count == -EAGAIN || count == 0) break;
      if (count < 0) {
        piece.gap = true;
        if (snd_pcm_recover(pcm_.get(), static_cast<int>(count), 1) < 0 || snd_pcm_start(pcm_.get()) < 0) {
          over_ = piece.over = true;
          piece.trouble = snd_strerror(static_cast<int>(count));
        }
        continue;
      }
      for (snd_pcm_sframes_t i = 0; i < count; ++i) {
        piece.samples.push_back(frames[static_cast<std::size_t>(i) * channels_]);
      }
    }
    snd_pcm_sframes_t delay = 0;  // what has sounded and waits to be read
    if (over_ || snd_pcm_delay(pcm_.get(), &delay) < 0) delay = 0;
    piece.ends = now - seconds(static_cast<double>(delay) / kRate_hz);
    return piece;
  }

 private:
  std::unique_ptr<snd_pcm_t, ClosePcm> pcm_;
  unsigned channels_;
  bool over_ = false;
};

class AlsaOutput final : public SoundOutput {
 public:
  AlsaOutput(std::unique_ptr<snd_pcm_t, ClosePcm> pcm, int channels)
      : pcm_(std::move(pcm)), channels_(static_cast<std::size_t>(channels)) {}

  std::size_t room(Instant /*now*/) override {
    const snd_pcm_sframes_t room = snd_pcm_avail_update(pcm_.get());
    if (room < 0) (void)snd_pcm_recover(pcm_.get(), static_cast<int>(room), 1);
    return room < 0 ? 0 : static_cast<std::size_t>(room);
  }
  void write(std::span<const float> frames, Instant /*now*/) override {
    const auto count = static_cast<snd_pcm_uframes_t>(frames.size() / channels_);
    const snd_pcm_sframes_t written = snd_pcm_writei(pcm_.get(), frames.data(), count);
    if (written < 0) (void)snd_pcm_recover(pcm_.get(), static_cast<int>(written), 1);
  }
  std::size_t waiting(Instant /*now*/) override {
    snd_pcm_sframes_t delay = 0;
    return snd_pcm_delay(pcm_.get(), &delay) < 0 || delay < 0 ? 0 : static_cast<std::size_t>(delay);
  }
  void drop(Instant /*now*/) override {
    (void)snd_pcm_drop(pcm_.get());
    (void)snd_pcm_prepare(pcm_.get());
  }

 private:
  std::unique_ptr<snd_pcm_t, ClosePcm> pcm_;
  std::size_t channels_;
};

}  // namespace

Result<std::unique_ptr<SoundOutput>> open_alsa_output(const std::string& device, int channels, int sample_rate) {
  snd_lib_error_set_handler(&no_words);
  snd_pcm_t* raw = nullptr;
  int error = snd_pcm_open(&raw, device.c_str(), SND_PCM_STREAM_PLAYBACK, SND_PCM_NONBLOCK);
  std::unique_ptr<snd_pcm_t, ClosePcm> pcm(error < 0 ? nullptr : raw);
  if (error >= 0) {
    error = snd_pcm_set_params(pcm.get(), SND_PCM_FORMAT_FLOAT, SND_PCM_ACCESS_RW_INTERLEAVED,
                               static_cast<unsigned>(channels), static_cast<unsigned>(sample_rate), 1, kLatency_us);
  }
  if (error < 0) {
    return device_error(fmt::format("no sound output \"{}\": {} (`aplay -L` lists those of this machine)", device,
                                    snd_strerror(error)));
  }
  return std::unique_ptr<SoundOutput>(std::make_unique<AlsaOutput>(std::move(pcm), channels));
}

Result<std::unique_ptr<SoundInput>> open_alsa_input(const std::string& device) {
  snd_lib_error_set_handler(&no_words);  // errors are told once, by us
  snd_pcm_t* raw = nullptr;
  int error = snd_pcm_open(&raw, device.c_str(), SND_PCM_STREAM_CAPTURE, SND_PCM_NONBLOCK);
  std::unique_ptr<snd_pcm_t, ClosePcm> pcm(error < 0 ? nullptr : raw);
  unsigned channels = 1;
  if (error >= 0) {
    // One channel, or the first of two where the device has no single one.
    for (channels = 1; channels <= kChannels; ++channels) {
      error = snd_pcm_set_params(pcm.get(), SND_PCM_FORMAT_FLOAT, SND_PCM_ACCESS_RW_INTERLEAVED, channels, kRate_hz, 1,
                                 kLatency_us);
      if (error >= 0) break;
    }
  }
  if (error < 0) {
    return device_error(fmt::format("no sound input \"{}\": {} (`arecord -L` lists those of this machine)", device,
                                    snd_strerror(error)));
  }
  return std::unique_ptr<SoundInput>(std::make_unique<AlsaInput>(std::move(pcm), channels));
}

}  // namespace footlight::app
