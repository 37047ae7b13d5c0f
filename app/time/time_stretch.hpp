// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace footlight::app {

/// Music faster or slower at the same pitch.
class TimeStretch {
 public:
  virtual ~TimeStretch() = default;
  /// @param speed 0.25 to 2
  virtual void set_speed(double speed) = 0;
  virtual void put(std::span<const float> frames) = 0;
  /// @param frames interleaved, to be filled @return how many it has filled
  virtual std::size_t take(std::span<float> frames) = 0;
  /// Frames that were put and have not come out again.
  [[nodiscard]] virtual double inside() const = 0;
  /// As new.
  virtual void clear() = 0;
};

/// By SoundTouch; null: this program was built without it.
[[nodiscard]] std::unique_ptr<TimeStretch> make_time_stretch(int channels, int sample_rate);

}  // namespace footlight::app
