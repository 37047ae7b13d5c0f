// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/grid.hpp"
#include "core/motion.hpp"
#include "core/tempo_map.hpp"
#include "core/terrain.hpp"
#include "planner/schedule/ways.hpp"

namespace footlight::planner {

/// The floor as models of motion see it: a rectangle around all cells, blocked cells as their outlines, and discs that
/// move.
class MotionFloor {
 public:
  /// @param tempo, start of the section: moving obstacles are written in counts, a model's time begins at 0 s
  /// @param terrain must live as long as this; nothing: level ground
  MotionFloor(const Ways& ways, std::vector<MovingObstacle> moving, const TempoMap& tempo, Instant start,
              const Terrain* terrain = nullptr);

  [[nodiscard]] const Ways& ways() const { return *ways_; }
  [[nodiscard]] Point low() const { return low_; }  ///< of the rectangle in which people's centres stay
  [[nodiscard]] Point high() const { return high_; }

  /// The nearest point of anything that is blocked.
  struct Nearest {
    Point at;
    double distance_m = 0;  ///< 0 inside
  };
  /// @return nothing when there is nothing blocked within `radius_m`. O(cells in the radius)
  [[nodiscard]] std::optional<Nearest> nearest(Point from, double radius_m) const;
  /// How far along the straight way from `from` to `to` a centre comes before it is nearer than Ways::keep_m to
  /// something blocked or leaves the floor, as share 0..1; 1 when all of it is free. Never 1 through anything: swept.
  [[nodiscard]] double free_share(Point from, Point to) const;

  /// A disc that moves, at one time.
  struct Disc {
    Point centre;
    Point velocity;  ///< m/s
    double radius_m = 0;
  };
  [[nodiscard]] std::vector<Disc> discs(double at_s) const;

  /// The ground slows nobody down.
  [[nodiscard]] bool level() const { return terrain_ == nullptr; }
  /// Share of everybody's speed that the ground leaves at a point, above 0 and at most 1. O(1)
  [[nodiscard]] double speed_factor(Point at) const {
    return terrain_ == nullptr ? 1 : terrain_->speed_factor(at, terrain_low_, terrain_high_);
  }

 private:
  const Ways* ways_;
  Point low_;
  Point high_;
  struct Moving {
    double radius_m = 0;
    std::vector<double> at_s;
    std::vector<Point> centre;
  };
  std::vector<Moving> moving_;
  std::vector<char> blocked_;  ///< one flag a cell
  const Terrain* terrain_;
  Point terrain_low_;  ///< of the rectangle around all cells' outlines
  Point terrain_high_;
};

}  // namespace footlight::planner
