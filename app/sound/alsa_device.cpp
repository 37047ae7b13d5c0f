// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <alsa/asoundlib.h>
#include <fmt/format.h>

#include "app/sound/samples.hpp"
#include "app/sound/sound_device.hpp"

namespace footlight::app {
namespace {

constexpr unsigned kLatency_us = 40'000;

/// ALSA writes its complaints to stderr; they are told by their codes.
void say_nothing(const char* /*file*/, int /*line*/, const char* /*function*/, int /*error*/, const char* /*format*/,
                 ...) {}

}  // namespace

struct SoundDevice::Open {
  std::string name;
  snd_pcm_t* pcm = nullptr;
  ~Open() {
    if (pcm != nullptr) snd_pcm_close(pcm);
  }
};

SoundDevice::SoundDevice(std::unique_ptr<Open> open) : open_(std::move(open)) {}
SoundDevice::SoundDevice(SoundDevice&&) noexcept = default;
SoundDevice& SoundDevice::operator=(SoundDevice&&) noexcept = default;
SoundDevice::~SoundDevice() = default;

Result<SoundDevice> SoundDevice::open(const std::string& name) {
  snd_lib_error_set_handler(say_nothing);
  auto open = std::make_unique<Open>();
  open->name = name;
  int error = snd_pcm_open(&open->pcm, name.c_str(), SND_PCM_STREAM_PLAYBACK, 0);
  if (error >= 0) {
    error = snd_pcm_set_params(open->pcm, SND_PCM_FORMAT_FLOAT, SND_PCM_ACCESS_RW_INTERLEAVED, 1, kSampleRate, 1,
                               kLatency_us);
  }
  if (error >= 0) return SoundDevice(std::move(open));
  return device_error(fmt::format("sound device \"{}\": {}", name, snd_strerror(error)));
}

Status<> SoundDevice::play(std::span<const float> block) {
  while (!block.empty()) {
    snd_pcm_sframes_t taken = snd_pcm_writei(open_->pcm, block.data(), block.size());
    if (taken < 0) taken = snd_pcm_recover(open_->pcm, static_cast<int>(taken), 1);
    if (taken < 0) {
      return device_error(fmt::format("sound device \"{}\": {}", open_->name, snd_strerror(static_cast<int>(taken))));
    }
    block = block.subspan(static_cast<std::size_t>(taken));
  }
  return Done{};
}

long SoundDevice::delay() const {
  snd_pcm_sframes_t frames = 0;
  return snd_pcm_delay(open_->pcm, &frames) == 0 && frames > 0 ? frames : 0;
}

}  // namespace footlight::app
