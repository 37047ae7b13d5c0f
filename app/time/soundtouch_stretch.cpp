// SPDX-License-Identifier: Apache-2.0
#include <SoundTouch.h>

#include "app/time/time_stretch.hpp"

namespace footlight::app {
namespace {

class SoundTouchStretch final : public TimeStretch {
 public:
  SoundTouchStretch(int channels, int sample_rate) : channels_(static_cast<unsigned>(channels)) {
    touch_.setChannels(channels_);
    touch_.setSampleRate(static_cast<unsigned>(sample_rate));
  }
  void set_speed(double speed) override {
    speed_ = speed;
    touch_.setTempo(speed);
  }
  void put(std::span<const float> frames) override {
    touch_.putSamples(frames.data(), static_cast<unsigned>(frames.size() / channels_));
  }
  std::size_t take(std::span<float> frames) override {
    return touch_.receiveSamples(frames.data(), static_cast<unsigned>(frames.size() / channels_));
  }
  [[nodiscard]] double inside() const override { return touch_.numUnprocessedSamples() + touch_.numSamples() * speed_; }
  void clear() override { touch_.clear(); }

 private:
  soundtouch::SoundTouch touch_;
  unsigned channels_;
  double speed_ = 1;
};

}  // namespace

std::unique_ptr<TimeStretch> make_time_stretch(int channels, int sample_rate) {
  return std::make_unique<SoundTouchStretch>(channels, sample_rate);
}

}  // namespace footlight::app
