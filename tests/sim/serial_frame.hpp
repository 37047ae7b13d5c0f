// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sim/markers/check_sums.hpp"

namespace footlight::sim {

using Octets = std::vector<std::uint8_t>;

/// A frame of Footlight serial around a payload without its check sum, block by block as the COBS paper has it.
inline Octets serial_frame(Octets payload) {
  const std::uint32_t check = crc32_ieee(payload);
  for (unsigned i = 0; i < 4; ++i) payload.push_back(static_cast<std::uint8_t>(check >> (8 * i)));
  Octets frame{0};
  Octets block;
  const auto close = [&] {
    frame.push_back(static_cast<std::uint8_t>(block.size() + 1));
    frame.insert(frame.end(), block.begin(), block.end());
    block.clear();
  };
  for (const std::uint8_t byte : payload) {
    if (byte == 0) {
      close();
    } else {
      block.push_back(byte);
    }
  }
  close();
  frame.push_back(0);
  return frame;
}

/// The payload of one frame with its check sum taken off; nothing when the check sum is wrong.
inline std::optional<Octets> serial_payload(std::span<const std::uint8_t> frame) {
  Octets payload;
  for (std::size_t i = 1; i + 1 < frame.size();) {
    const std::size_t code = frame[i];
    if (code == 0 || i + code >= frame.size()) return std::nullopt;
    payload.insert(payload.end(), frame.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                   frame.begin() + static_cast<std::ptrdiff_t>(i + code));
    i += code;
    if (i + 1 < frame.size()) payload.push_back(0);
  }
  if (payload.size() < 9) return std::nullopt;
  std::uint32_t check = 0;
  for (unsigned i = 0; i < 4; ++i) check |= std::uint32_t{payload[payload.size() - 4 + i]} << (8 * i);
  payload.resize(payload.size() - 4);
  if (check != crc32_ieee(payload)) return std::nullopt;
  return payload;
}

}  // namespace footlight::sim
