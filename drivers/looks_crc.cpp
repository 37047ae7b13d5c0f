// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <span>

#include "drivers/driver.hpp"

namespace footlight::drivers {

std::uint16_t looks_crc(std::span<const LookIndex> looks) {
  unsigned crc = 0xFFFF;
  for (const LookIndex look : looks) {
    crc ^= static_cast<unsigned>(look) << 8U;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 0x8000U) != 0 ? (crc << 1U) ^ 0x1021U : crc << 1U;
    crc &= 0xFFFFU;
  }
  return static_cast<std::uint16_t>(crc);
}

}  // namespace footlight::drivers
