// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/grid.hpp"
#include "core/motion.hpp"
#include "planner/motion/floor.hpp"

namespace footlight::planner {

struct PaintedScene;  // planner/painted/scene.hpp

/// Group of who is in none.
inline constexpr std::uint32_t kNoGroup = std::numeric_limits<std::uint32_t>::max();

/// What every model of motion is asked: to lead people who stand somewhere to places somewhere else, seen at given
/// instants. Lists of people have one length and one order; which person is which number must not matter to a model.
struct MotionTask {
  std::vector<Point> from;  ///< where each person stands at 0 s
  std::vector<Point> to;    ///< places at the end, in any order, as many as people; empty: wherever the model ends
  std::vector<std::uint32_t> group;     ///< of each person, as Show::groups, or kNoGroup
  std::vector<std::uint32_t> to_group;  ///< of each place: only who is in this group may end there; empty: anybody
  std::vector<double> radius_m;         ///< half of the room of each person, > 0
  std::vector<double> speed_mps;        ///< fastest walk of each person, > 0
  std::vector<std::optional<double>> agility;     ///< of each person; empty, or nothing: as the model's options say
  std::vector<std::optional<double>> reaction_s;  ///< the same
  std::vector<double> at_s;                       ///< instants that are wanted, ascending, the first 0
  std::vector<GroupPath> paths;                   ///< of the section
  const MotionFloor* floor = nullptr;             ///< what is in the way
  const PaintedScene* painting = nullptr;         ///< of a painted section; people begin on its begin cells
  std::uint64_t seed = 1;

  [[nodiscard]] std::size_t people() const { return from.size(); }
  [[nodiscard]] double duration_s() const { return at_s.back(); }
};

/// Where a model led people: neither on cells nor proved; `snap_crowd` makes marks of it.
struct Trajectory {
  std::vector<std::vector<Point>> at;  ///< for each instant of the task, of each person
  /// Place of each person at the end, a permutation of 0..people-1; empty where the task has no places.
  std::vector<std::uint32_t> place_of;
  std::vector<std::string> notes;  ///< for people, in words of the show
};

}  // namespace footlight::planner
