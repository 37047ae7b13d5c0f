// SPDX-License-Identifier: Apache-2.0
#include "core/patch.hpp"

#include <algorithm>

#include "core/sha256.hpp"

namespace footlight {

std::uint32_t patch_check(const Node& node) {
  Sha256 sum;
  sum.integer(node.address);
  for (const Channel& channel : node.channels) {
    const bool cell = channel.kind == Channel::Kind::cell;
    const bool worn = channel.kind == Channel::Kind::wearable;
    sum.integer(static_cast<int>(channel.kind));
    sum.integer(cell ? channel.cell.value() : worn ? channel.performer.value() : 0);
  }
  std::uint32_t check = 0;
  const auto digest = sum.digest();
  for (std::size_t i = 0; i < 4; ++i) check = (check << 8U) | digest.at(i);
  return std::max<std::uint32_t>(1, check);
}

}  // namespace footlight
