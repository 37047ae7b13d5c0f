// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>

#include "core/result.hpp"
#include "core/time.hpp"

namespace footlight::app {

/// Where music goes: frames of some channels, a few tenths of a second ahead. Nothing blocks.
class SoundOutput {
 public:
  virtual ~SoundOutput() = default;
  /// Frames that it takes now.
  virtual std::size_t room(Instant now) = 0;
  /// @param frames interleaved, at most `room` of them
  virtual void write(std::span<const float> frames, Instant now) = 0;
  /// Frames that have been written and not been heard.
  virtual std::size_t waiting(Instant now) = 0;
  /// What waits will not be heard.
  virtual void drop(Instant now) = 0;
};

/// No device: what is written is heard by the clock alone.
[[nodiscard]] std::unique_ptr<SoundOutput> clocked_output(int channels, int sample_rate);
/// An output of the machine ("default", "hw:1,0"). Errors: ErrorKind::device, as open_alsa_input.
[[nodiscard]] Result<std::unique_ptr<SoundOutput>> open_alsa_output(const std::string& device, int channels,
                                                                    int sample_rate);

}  // namespace footlight::app
