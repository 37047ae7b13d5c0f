// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace footlight::drivers::footlight_serial {

/// Consistent Overhead Byte Stuffing (Cheshire, Baker, IEEE/ACM Transactions on Networking 7(2), 1999): the same bytes
/// without a zero among them, one byte longer for each 254 begun. The delimiter 0x00 is not part of the result.
[[nodiscard]] std::vector<std::uint8_t> cobs_encode(std::span<const std::uint8_t> bytes);

/// @return nothing for what no encoder makes: empty input, a zero byte, a code that points beyond the end
[[nodiscard]] std::optional<std::vector<std::uint8_t>> cobs_decode(std::span<const std::uint8_t> bytes);

}  // namespace footlight::drivers::footlight_serial
