// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>

#include "core/result.hpp"

namespace footlight::app {

/// A loudspeaker by ALSA, one channel of floats at kSampleRate. Built without it every device is refused, with the
/// reason. One thread.
class SoundDevice {
 public:
  /// @param name of ALSA, as "default"
  [[nodiscard]] static Result<SoundDevice> open(const std::string& name);

  SoundDevice(SoundDevice&&) noexcept;
  SoundDevice& operator=(SoundDevice&&) noexcept;
  ~SoundDevice();

  /// Blocks until the device has taken it. What it recovers from by itself (an underrun, a suspend) is no error.
  Status<> play(std::span<const float> block);
  /// Frames that were played and are not heard yet: so many before the next block's first.
  [[nodiscard]] long delay() const;

 private:
  struct Open;
  explicit SoundDevice(std::unique_ptr<Open> open);
  std::unique_ptr<Open> open_;
};

}  // namespace footlight::app
