// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>

#include "drivers/transport.hpp"

namespace footlight::sim {

inline drivers::CanFrame frame(int id, std::initializer_list<int> bytes) {
  drivers::CanFrame made{static_cast<std::uint16_t>(id), static_cast<std::uint8_t>(bytes.size()), {}};
  std::size_t i = 0;
  for (const int byte : bytes) made.data[i++] = static_cast<std::uint8_t>(byte);
  return made;
}

}  // namespace footlight::sim
