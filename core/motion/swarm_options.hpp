// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>
#include <optional>

namespace footlight {

/// Parameters of the particle swarm. Source: Y.-Y. Lin, "Crowd Control with Swarm Intelligence", master's thesis,
/// National Chiao Tung University, 2007; numbers of equations are the thesis's. Where it names no value the default is
/// ours (docs/algorithms/swarm.md).
struct SwarmOptions {
  enum class Method {
    proposed,  ///< Eq. 6-10: direction and speed apart, acceptance, local search; nobody touches anybody
    original,  ///< Eq. 2-3: a plain particle swarm, which minds what is in the way only in its cost
  };
  /// What P_BGS is. A swarm that has to find its target first stops somewhere on the way where a step is as short as a
  /// person's: `swarm` is for study.
  enum class Best {
    target,  ///< the place itself, which the director knows
    swarm,   ///< the best that anybody of the crowd has found so far, seen from the own place
  };
  Method method = Method::proposed;
  Best best = Best::target;        ///< P_BGS
  double inertia = 1;              ///< w of Eq. 2 and 6, [0, 2]
  double cognitive = 0.5;          ///< c1, [0, 4]
  double social = 0.5;             ///< c2, [0, 4]
  double avoid = 0.05;             ///< c_obj of Eq. 9: obstacles and people against the target, [0, 100]
  double hardness = 1;             ///< k of Eq. 10, [1, 4]: nobody comes nearer than sqrt(k) times both scopes
  std::optional<double> person_m;  ///< sigma of a person, m, (0, 10]; nothing: half of the room that she needs
  double pace_spread = 0.2;        ///< V_max is between (1 - this) and 1 times the limit, drawn once a person, [0, 0.9]
  int directions = 8;              ///< tries with a random angle below 90 degrees, 1..64
  double grid_angle_rad = std::numbers::pi / 12;  ///< step of the grid of angles around the best try, 1 to 45 degrees
  int grid_steps = 3;                             ///< steps to each side, 0..12
  double slow_m = 1;    ///< nearer to the target the speed falls with the distance, m, (0, 20]
  double follow = 0.8;  ///< share of the section in which a moving target goes its way, (0, 1]
  double step_s = 0.2;  ///< one iteration, s, [0.02, 2]
};

}  // namespace footlight
