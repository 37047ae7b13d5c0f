// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "core/grid.hpp"

/// The forces of Xu 2015, sections 3.3 and 3.5, as accelerations of a person of mass 1, m/s^2. Where the paper prints
/// only a magnitude the force points along the line between the two; where its print cannot be meant, the function says
/// what is taken instead (docs/algorithms/collective.md). Reentrant, O(1).
namespace footlight::planner::collective {

/// A unit vector along `a`; nothing of nothing.
[[nodiscard]] inline Point unit(Point a) {
  const double long_m = length(a);
  return long_m > 0 ? 1 / long_m * a : Point{};
}

/// Eq. 8: (v0 e - v) / tau.
[[nodiscard]] inline Point drive_force(Point velocity, Point heading, double wanted_mps, double reaction_s) {
  return 1 / reaction_s * (wanted_mps * heading - velocity);
}

/// Strength and range of a force that falls off exponentially.
struct Falloff {
  double strength_mps2 = 1;  ///< A where two touch
  double range_m = 1;        ///< B
};

/// Eq. 9: A exp(-d / B) away from an obstacle; d from the person's outline to it.
/// @param at the obstacle's nearest point  @param radius_m of the person
[[nodiscard]] inline Point obstacle_force(Point person, Point at, double radius_m, Falloff falloff) {
  const Point away = person - at;
  return falloff.strength_mps2 * std::exp((radius_m - length(away)) / falloff.range_m) * unit(away);
}

/// Eq. 10 and 22: A exp(-d / B) / d times the vector from the other, which the print leaves out: of strength
/// A exp(-d / B). d is the room between the two bodies: as in Helbing 2000, people of different width repel each other
/// alike when they touch.
/// @param touch_m sum of their radii
[[nodiscard]] inline Point repulse_force(Point person, Point other, double touch_m, Falloff falloff) {
  const Point away = person - other;
  return falloff.strength_mps2 * std::exp((touch_m - length(away)) / falloff.range_m) * unit(away);
}

/// In place of Eq. 21, A' exp(d), which grows without bound: A' (1 - exp(-x / B')) toward where the others of the
/// sub-group, on average, have their formation's place for her; x is how far that is. For small x this is the mean of
/// linear springs to all of them, and it is never more than A'.
/// @param missing from the person to that place
[[nodiscard]] inline Point cohesion_force(Point missing, Falloff falloff) {
  return falloff.strength_mps2 * (1 - std::exp(-length(missing) / falloff.range_m)) * unit(missing);
}

/// In place of Eq. 18, which adds a magnitude to a direction: the heading turned toward that of the others in her bin,
/// in proportion to the information: e + g (mean e' - e), of length 1, with the gain g = min(1, I_d).
/// @param others mean heading of the others in the bin
[[nodiscard]] inline Point fed_back_heading(Point heading, Point others, double direction_bits) {
  const Point turned = heading + std::clamp(direction_bits, 0.0, 1.0) * (others - heading);
  return squared_length(turned) > 1e-12 ? unit(turned) : heading;
}

/// In place of Eq. 19, which only ever adds speed: v0 + min(1, I_v) (mean v0' - v0).
[[nodiscard]] inline double fed_back_speed(double wanted_mps, double others_mps, double speed_bits) {
  return wanted_mps + std::clamp(speed_bits, 0.0, 1.0) * (others_mps - wanted_mps);
}

}  // namespace footlight::planner::collective
