// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

namespace footlight {

/// Crowds that keep their formation by short range destinations (SRD) on position based dynamics.
///
/// Source: J. H. Son, M. K. Sung, "Position-Based Formation Control Scheme for Crowds Using Short Range Distance
/// (SRD)", Appl. Sci. 14 (8) 3386, 2024; symbols and equation numbers are the paper's. It prints no values for them.
struct SrdOptions {
  /// How a formation lies along its path.
  enum class Orientation {
    fixed,  ///< it is carried without turning, Eq. 4
    path,   ///< it faces along the path; who is outrun in a turn catches up behind it
    wheel,  ///< it faces along the path and takes the time that everybody needs for a turn
  };
  Orientation orientation = Orientation::fixed;
  bool formation = true;  ///< false: no formation constraint, each for herself, the crowd of Weiss et al. 2017
  std::optional<double> group_speed_mps;  ///< omega of Eq. 3, (0, 20]; nothing: in time for `settle`
  double settle = 0.15;     ///< share of the section that is left when the group arrives at its goal, [0, 0.9]
  double corner_m = 3;      ///< turns of the path are made within so much before and after a corner, [0, 100]
  double step_s = 0.1;      ///< dt of Algorithm 1, [0.01, 0.5]
  int iterations = 4;       ///< N of Algorithm 1, [1, 50]
  double stiffness = 0.5;   ///< share of Eq. 8 that each iteration makes good, [0, 1]
  double blending = 0.5;    ///< share of the planned velocity in the blended one, line 5 of Algorithm 1, (0, 1]
  double steering = 0.3;    ///< share of v_s of Eq. 10 that is added each step, [0, 1]
  double room_m = 1;        ///< so far apart people are kept where their formations leave room for that, [0, 10]
  double congestion_m = 2;  ///< side of a grid space e_k of Eq. 9, [0.1, 100]
  double look_m = 5;        ///< collisions to come are looked for so far around, [0, 100]
  double horizon_s = 5;     ///< and so far ahead, tau_0 of Weiss et al., (0, 60]
  double avoidance = 0.24;  ///< how much of a collision to come is made good in an iteration, k of Weiss et al., [0, 1]
  double agility = 1;       ///< what avoidance is multiplied by for who has none of her own, [0, 4]
  double reaction_s = 0.3;  ///< before somebody leaves the formation, and before she returns, [0, 10]; less is quicker
  double variation = 0.2;   ///< these two are spread evenly by so much either way, [0, 1]; what is her own is not
};

}  // namespace footlight
