// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "core/diagnostic.hpp"
#include "core/grid.hpp"
#include "core/index.hpp"
#include "core/motion/collective_options.hpp"
#include "core/motion/painted_options.hpp"
#include "core/motion/srd_options.hpp"
#include "core/motion/swarm_options.hpp"

namespace footlight {

/// The way of a group through a section, on the floor; straight from point to point.
struct GroupPath {
  std::optional<GroupIndex> group;  ///< nothing: of everybody who has no path of her own
  std::vector<Point> through;       ///< at least one
  Position position;
};

/// Something round that moves through a section and that nobody may come near: a car, a lift, a dancer of another show.
struct MovingObstacle {
  struct At {
    double count = 1;  ///< of the music
    Point centre;
  };
  double radius_m = 1;
  std::vector<At> at;  ///< ascending by count; straight and even between, at rest before and after
  Position position;
};

/// Parameters of the models of motion, each in its own header.
using MotionOptions = std::variant<std::monostate, CollectiveOptions, SrdOptions, SwarmOptions, PaintedOptions>;

/// How a section moves people that has a model of motion: from where the section before leaves them to the formation of
/// its own, over the whole duration.
struct Motion {
  MotionOptions options;
  std::vector<GroupPath> paths;
  std::vector<MovingObstacle> obstacles;  ///< beside the stage's blocked cells
  /// People have a mark every so many counts, (0, 64], more often where a way is not straight between; nothing: as
  /// often as people can walk from cell to cell in every direction.
  std::optional<double> mark_counts;
  std::uint64_t seed = 1;
};

}  // namespace footlight
