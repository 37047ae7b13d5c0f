// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "app/time/sound_output.hpp"

namespace footlight::app {
namespace {

constexpr Duration kBuffer = milliseconds(300);

class ClockedOutput final : public SoundOutput {
 public:
  ClockedOutput(int channels, int sample_rate)
      : channels_(static_cast<std::size_t>(channels)),
        sample_rate_(sample_rate),
        buffer_(static_cast<std::size_t>(to_seconds(kBuffer) * sample_rate)) {}

  std::size_t room(Instant now) override { return buffer_ - std::min(buffer_, waiting(now)); }
  void write(std::span<const float> frames, Instant now) override {
    if (waiting(now) == 0) {
      begins_ = now;  // after silence it begins anew
      written_ = 0;
    }
    written_ += frames.size() / channels_;
  }
  std::size_t waiting(Instant now) override {
    const auto heard = static_cast<std::size_t>(std::max(0.0, to_seconds(now - begins_)) * sample_rate_);
    return written_ - std::min(written_, heard);
  }
  void drop(Instant now) override {
    begins_ = now;
    written_ = 0;
  }

 private:
  std::size_t channels_;
  double sample_rate_;
  std::size_t buffer_;
  Instant begins_{};
  std::size_t written_ = 0;  ///< since then
};

}  // namespace

std::unique_ptr<SoundOutput> clocked_output(int channels, int sample_rate) {
  return std::make_unique<ClockedOutput>(channels, sample_rate);
}

}  // namespace footlight::app
