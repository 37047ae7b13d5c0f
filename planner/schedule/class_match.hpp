// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/grid.hpp"

namespace footlight::planner {

/// People who stand somewhere by one division into classes and shall stand elsewhere by another.
struct ClassMatchTask {
  const Grid* grid = nullptr;
  std::span<const CellIndex> from;             ///< distinct; empty: nobody comes from anywhere
  std::span<const std::uint32_t> from_class;   ///< of each of `from`
  std::span<const CellIndex> to;               ///< distinct
  std::span<const std::uint32_t> person_from;  ///< class of each performer by the first division
  std::span<const std::uint32_t> person_to;    ///< and by the second
};

/// Gives the places of `to_class` that are kOpenPlace to the classes that have fewer places than people: who stands
/// there already stays, of too many those farthest from the other places of their class; then the nearest.
/// O(open places x classes, sorted)
void settle_open_places(const ClassMatchTask& task, std::vector<std::uint32_t>& to_class);

/// Positions in `from` and in `to`, as many, that may be matched in any way.
struct ClassLot {
  std::vector<std::uint32_t> from;
  std::vector<std::uint32_t> to;
};

/// Matches so that as many people go from each class to each class as there are such performers. Classes that no other
/// combination ties to each other are one lot; where two classes are cut up among each other each combination takes
/// the places nearest to the middle of the other side, small ones first.
/// @param pair_lot position in lot.to for each of lot.from
/// @return position in `to` for each of `from`, a bijection. O(places x classes), and what pair_lot takes
[[nodiscard]] std::vector<std::uint32_t> match_classes(
    const ClassMatchTask& task, const std::vector<std::uint32_t>& to_class,
    const std::function<std::vector<std::uint32_t>(const ClassLot&)>& pair_lot);

}  // namespace footlight::planner
