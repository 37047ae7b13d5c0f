// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/time.hpp"

namespace footlight::sim {

/// Finds the frames in the bytes of an RTU line. On a wire a frame ends with 3.5 characters of silence; a machine hands
/// bytes on in pieces of its own, so a frame also ends where its length says so and its check sum is right.
class RtuFraming {
 public:
  /// Longer than any silence within a frame, as the machine hands it on.
  static constexpr Duration kSilence = milliseconds(10);

  void take(std::span<const std::uint8_t> bytes, Instant now);
  /// The next whole frame, or what has been left lying by silence.
  [[nodiscard]] std::optional<std::vector<std::uint8_t>> next(Instant now);
  /// When silence ends what has come; kNever when nothing has.
  [[nodiscard]] Instant silence_at() const { return bytes_.empty() ? kNever : last_ + kSilence; }

 private:
  std::vector<std::uint8_t> bytes_;
  Instant last_ = kStart;
};

/// Bytes of the request that begins with these; 0 while that is not known or when the function has no known length
/// (Modbus Application Protocol V1.1b3, section 6).
[[nodiscard]] std::size_t rtu_request_size(std::span<const std::uint8_t> bytes);

}  // namespace footlight::sim
