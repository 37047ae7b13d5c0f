// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/rng.hpp"

namespace footlight::test {

/// One to four bytes changed, removed, doubled or moved. @param telling bytes that mean something in the format
inline std::string mutated(std::string bytes, Rng rng,
                           std::string_view telling = std::string_view("\0\x01\x7F\x80\xFF", 5)) {
  const auto times = 1 + rng.below(4);
  for (std::uint64_t k = 0; k < times && !bytes.empty(); ++k) {
    const auto at = static_cast<std::size_t>(rng.below(bytes.size()));
    switch (rng.below(5)) {
      case 0:
        bytes[at] = static_cast<char>(rng.below(256));
        break;
      case 1:
        bytes.erase(at, 1 + static_cast<std::size_t>(rng.below(8)));
        break;
      case 2:
        bytes.insert(at, bytes.substr(static_cast<std::size_t>(rng.below(bytes.size())),
                                      1 + static_cast<std::size_t>(rng.below(40))));
        break;
      default:
        bytes[at] = telling[static_cast<std::size_t>(rng.below(telling.size()))];
        break;
    }
  }
  return bytes;
}

}  // namespace footlight::test
