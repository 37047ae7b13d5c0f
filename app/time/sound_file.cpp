// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <sndfile.h>

#include "app/time/sound_input.hpp"

namespace footlight::app {
namespace {

constexpr int kLowest_hz = 8'000;
constexpr int kHighest_hz = 192'000;
constexpr int kMostChannels = 64;

struct CloseSound {
  void operator()(SNDFILE* file) const { sf_close(file); }
};

class SoundFile final : public SoundInput {
 public:
  SoundFile(std::unique_ptr<SNDFILE, CloseSound> file, const SF_INFO& info) : file_(std::move(file)), info_(info) {}
  [[nodiscard]] int sample_rate() const override { return info_.samplerate; }

  Piece read(Instant now) override {
    if (!began_) began_ = now;
    const auto wanted = static_cast<sf_count_t>(to_seconds(now - *began_) * info_.samplerate) - taken_;
    Piece piece;
    piece.over = over_;
    if (wanted <= 0 || over_) return piece;
    const auto channels = static_cast<std::size_t>(info_.channels);
    interleaved_.resize(static_cast<std::size_t>(std::min<sf_count_t>(wanted, info_.samplerate)) * channels);
    const auto frames = static_cast<sf_count_t>(interleaved_.size() / channels);
    const sf_count_t count = std::max<sf_count_t>(0, sf_readf_float(file_.get(), interleaved_.data(), frames));
    for (sf_count_t i = 0; i < count; ++i)
      piece.samples.push_back(interleaved_[static_cast<std::size_t>(i) * channels]);
    taken_ += count;
    piece.ends = *began_ + seconds(static_cast<double>(taken_) / info_.samplerate);
    over_ = count < frames;
    if (over_) piece.trouble = "the file is over";
    return piece;
  }

 private:
  std::unique_ptr<SNDFILE, CloseSound> file_;
  SF_INFO info_;
  std::optional<Instant> began_;
  sf_count_t taken_ = 0;
  std::vector<float> interleaved_;
  bool over_ = false;
};

}  // namespace

Result<std::unique_ptr<SoundInput>> open_sound_file(const std::filesystem::path& file) {
  SF_INFO info{};
  std::unique_ptr<SNDFILE, CloseSound> opened(sf_open(file.c_str(), SFM_READ, &info));
  if (!opened) {
    std::string why = sf_strerror(nullptr);
    while (!why.empty() && (why.back() == '.' || why.back() == '\n')) why.pop_back();
    return input_error(fmt::format("{}: {} (a sound file is wanted: WAV, FLAC, MP3 ...)", file.string(), why));
  }
  if (info.samplerate < kLowest_hz || info.samplerate > kHighest_hz || info.channels < 1 ||
      info.channels > kMostChannels) {
    return input_error(fmt::format("{}: {} Hz on {} channels (8,000 to 192,000 Hz, 1 to 64 channels)", file.string(),
                                   info.samplerate, info.channels));
  }
  return std::unique_ptr<SoundInput>(std::make_unique<SoundFile>(std::move(opened), info));
}

}  // namespace footlight::app
