// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/grid.hpp"
#include "planner/motion/lanes.hpp"

namespace footlight::planner::srd {

// The constraints of position based dynamics as functions of places alone: what each asks of person i, in metres.

/// Shortens a vector to `most`.
[[nodiscard]] inline Point within(Point v, double most) {
  const double squared = squared_length(v);
  return squared > most * most ? most / std::sqrt(squared) * v : v;
}

/// Distance constraint between two people of equal mass where they come nearer than `apart_m`, and nothing otherwise:
///
///   C = |p_i - p_j| - d < 0,   dp_i = -1/2 C (p_i - p_j) / |p_i - p_j|                             (5)-(7)
/// The scaling factor of Eq. 7 is C / sum |grad C|^2 = C / 2. Collision and penetration are this constraint.
/// @param share of the correction that is i's: 1/2 of a person's, 1 where only i can move
/// @return nothing when they are apart. Two on one place are not moved: they have no direction.
[[nodiscard]] inline std::optional<Point> separation(Point i, Point j, double apart_m, double share = 0.5) {
  const Point away = i - j;
  const double squared = squared_length(away);
  if (squared >= apart_m * apart_m || squared <= 0) return std::nullopt;
  const double far_m = std::sqrt(squared);
  return share * (apart_m - far_m) / far_m * away;
}

/// Formation constraint, only the person moves: C = |p_i - s_i| - d with d = 0 (8).
[[nodiscard]] inline Point formation(Point person, Point destination, double stiffness) {
  return stiffness * (destination - person);
}

/// One of two people who may collide.
struct Moving {
  Point at;        ///< now
  Point velocity;  ///< m/s, as predicted
};

/// Time until two discs touch when they go on as they do, 0 when they do already; nothing when they do not or are going
/// apart.
///
///   |x + tau v| = apart_m with x, v relative; the earlier solution
[[nodiscard]] inline std::optional<double> touch_s(Moving i, Moving j, double apart_m) {
  const Point x = i.at - j.at;
  const Point v = i.velocity - j.velocity;
  const double a = squared_length(v);
  const double b = -dot(x, v);
  const double c = squared_length(x) - apart_m * apart_m;
  const double root = b * b - a * c;
  if (b <= 0 || a < 1e-12 || root <= 0) return std::nullopt;
  return std::max(0.0, (b - std::sqrt(root)) / a);
}

/// What a collision to come asks of person i in this step: to the side alone, so that nobody is pushed back.
///
/// Source: the long range collision constraint of Weiss, Litteneker, Jiang, Terzopoulos, "Position-Based Multi-Agent
/// Dynamics for Real-Time Crowd Simulation", MIG 2017: C = |x(t + dt)| - d < 0 a step after they touch at t, stiffness
/// k exp(-t^2 / tau_0), half of it each, and of the correction only what is tangential to the contact. Deviations: t is
/// not rounded down to whole steps, by which C of the same meeting would be anything from nothing to a step's way; all
/// of |C| goes to the tangential direction (as a projection it would vanish for two who walk straight at each other);
/// and who has no side to choose passes on her right.
/// @param side share that is i's, as in `separation`
[[nodiscard]] inline std::optional<Point> avoidance(Moving i, Moving j, double apart_m, double step_s, double horizon_s,
                                                    double k, double side = 0.5) {
  const auto touch = touch_s(i, j, apart_m);
  if (!touch || *touch > horizon_s) return std::nullopt;
  const Point x = i.at - j.at;
  const Point v = i.velocity - j.velocity;
  const double depth_m = apart_m - std::sqrt(squared_length(x + (*touch + step_s) * v));
  if (depth_m <= 0) return std::nullopt;
  const Point contact = x + *touch * v;
  // To the side on which i passes: across the contact, where the relative velocity leads.
  const Point across{-contact.y, contact.x};
  const double sideways = dot(across, v);
  constexpr double kStraightAt = 1e-6;  // of the relative speed
  const bool straight = sideways * sideways <= kStraightAt * kStraightAt * apart_m * apart_m * squared_length(v);
  const Point to = straight ? Point{v.y, -v.x} : sideways > 0 ? across : Point{-across.x, -across.y};
  const double share = side * k * lanes::exp(-*touch * *touch / horizon_s);
  return share * depth_m / std::sqrt(squared_length(to)) * to;
}

/// Desired velocity toward a destination that moves itself: where it will be in `arrive_s`, no faster than kappa.
///
///   v_d = (s_c - p_c) / |s_c - p_c| kappa,  v_s = v_d - v_c                                          (10)
/// Deviations: the paper prints p_c - s_c, which leads away; kappa is a limit and not constant, so that who has arrived
/// does not run to and fro over her place (Reynolds, "Steering behaviors for autonomous characters", GDC 1999:
/// arrival).
[[nodiscard]] inline Point seek(Point person, Point destination, Point destination_velocity, double arrive_s,
                                double kappa_mps) {
  return within(destination_velocity + 1 / arrive_s * (destination - person), kappa_mps);
}

}  // namespace footlight::planner::srd
