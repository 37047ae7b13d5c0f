// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace footlight {

/// Parameters of the collective transform (Xu, Wu, Ye, Farkas, Jiang, Deng, "Collective Crowd Formation Transform with
/// Mutual Information Based Runtime Feedback", Computer Graphics Forum 2015; docs/algorithms/collective.md). The paper
/// prints no values; the defaults are of people who walk.
struct CollectiveOptions {
  enum class Pairing { least_effort, euclidean, manhattan };
  Pairing pairing = Pairing::least_effort;  ///< what is kept small over everybody, Eq. 3 and section 5.2
  double lambda = 0.5;                      ///< Eq. 3: 1 counts ways alone, 0 local density alone, [0, 1]
  double reaction_s = 0.5;                  ///< tau of Eq. 8, [0.1, 5] s
  double repulsion_mps2 = 2;                ///< A of Eq. 9 and 10, between two who touch, [0, 20] m/s^2
  double repulsion_range_m = 0.3;           ///< B of Eq. 9 and 10, [0.05, 5] m
  double fluctuation_mps2 = 0.02;           ///< largest xi of Eq. 7, [0, 5] m/s^2
  bool feedback = true;                     ///< Eq. 18 and 19
  double bin_m = 5;                         ///< R of Eq. 12 and 13, [0.5, 1000] m
  int sectors = 8;                          ///< K of Eq. 14, and classes of speed, [2, 64]
  bool subgroups = true;                    ///< Eq. 20 to 23
  double damping = 0.9;                     ///< of affinity propagation, [0.5, 0.99]
  int rounds = 1000;                        ///< of affinity propagation, at most, [10, 10000]
  double cohesion_mps2 = 1;                 ///< A' of Eq. 21, its bound, [0, 20] m/s^2
  double separation_mps2 = 0.2;             ///< A' of Eq. 22, between two who touch, [0, 20] m/s^2
  double group_range_m = 0.5;               ///< B' of Eq. 21 and 22, [0.05, 20] m
  /// Share of what strangers do to somebody that all of her sub-group take together, so that it keeps its shape while
  /// it passes through another, [0, 1]. Groups that meet step aside by so much that their files pass between each
  /// other's. 0: neither, as in the paper.
  double rigidity = 0.8;
};

}  // namespace footlight
