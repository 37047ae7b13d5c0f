// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/plan.hpp"
#include "core/rig.hpp"

namespace footlight::controller {

/// Somebody is not shown where to go, and comes too close to somebody else for it.
struct UnsafeCue {
  PerformerIndex who;
  CellIndex place;  ///< that she is not shown
  Instant told;     ///< when she should set out for it
  PerformerIndex other;
  double distance_m = 0;  ///< least, of those two
  Instant at;
};

/// A node, or a power supply with all of its nodes, that is dark for the whole show.
struct DarkUnit {
  enum class Kind { node, supply };
  Kind kind = Kind::node;
  std::string name;
  int nodes = 1;
  std::uint64_t not_shown = 0;   ///< walks whose goal is not shown, of everybody
  std::uint64_t unsafe = 0;      ///< of them, those after which somebody comes too close
  std::vector<UnsafeCue> worst;  ///< one for each of them, the nearest first, then by time; at most `keep`
};

/// What happens when a node or a supply is dark ("N - 1"): every unit of the rig, the one with the most unsafe cues
/// first, then the one with the nearest pair, then in the order of the rig, nodes before supplies.
///
/// Whose goal is not lit stays where she is until she is next shown a place, and walks straight there in the time of
/// that walk; everybody else walks as planned, past her or to the cell she stands on. A goal is shown by its cell's
/// lamp; where the cell has none in the rig, by her wearable, which says when and leaves where to her dot sheet.
/// Too close is nearer than the plan's clearance, or the sum of two people's radii where that is more. Exact: closest
/// approaches in closed form on every stretch between neighbouring marks. Shares no code with planner or judge.
/// @param keep  how many cues of a unit are named
/// Complexity: O(marks + walks not shown x people nearby). Deterministic.
[[nodiscard]] std::vector<DarkUnit> find_dark_units(const Plan& plan, const Rig& rig, std::size_t keep);

}  // namespace footlight::controller
