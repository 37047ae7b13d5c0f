// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "core/grid.hpp"

namespace footlight::planner::collective {

/// Which points belong together, each to one of them, its exemplar.
struct Clusters {
  std::vector<std::uint32_t> exemplar_of;  ///< of each point; an exemplar's is itself
  double net_similarity = 0;  ///< of all points to their exemplars, and preferences of the exemplars: what is maximised
  int rounds = 0;
  bool converged = false;

  [[nodiscard]] std::size_t count() const;
};

struct AffinityOptions {
  double damping = 0.9;  ///< share of the old message in the new one, [0.5, 1)
  int most_rounds = 1000;
  int stable_rounds = 100;  ///< converged when the exemplars have not changed for so long
};

/// Similarities between some points, row by row; each row ascending, the point itself in it (its preference).
struct SimilarityRows {
  std::vector<std::uint32_t> first{0};  ///< points + 1
  std::vector<std::uint32_t> to;
  std::vector<float> similarity;

  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(first.size()) - 1; }
  void add(std::uint32_t other, float value) {
    to.push_back(other);
    similarity.push_back(value);
  }
  void close_row() { first.push_back(static_cast<std::uint32_t>(to.size())); }
};

/// Affinity propagation (Frey and Dueck, "Clustering by Passing Messages Between Data Points", Science 2007):
/// responsibilities r and availabilities a, damped, until the exemplars k with r(k, k) + a(k, k) > 0 stay the same;
///
///   r(i, k) = s(i, k) - max over k' != k of (a(i, k') + s(i, k'))
///   a(i, k) = min(0, r(k, k) + sum over i' not i, k of max(0, r(i', k))),   a(k, k) = sum over i' != k of max(0, r(i',
///   k))
/// Pairs that are not in the rows have similarity minus infinity. At the end each cluster takes the member that the
/// others are most similar to for its exemplar, and everybody the most similar exemplar, as the authors' own program
/// does. Equal similarities would swing for ever: each is lowered by up to a millionth of their range, by a hash of the
/// two numbers. A point that knows no exemplar is one itself.
/// O(rounds x similarities), in parallel; deterministic for any number of threads. Without convergence the last round.
[[nodiscard]] Clusters affinity_propagation(const SimilarityRows& rows, const AffinityOptions& options,
                                            const std::atomic<bool>* stop = nullptr);

/// Minus Eq. 20 of Xu 2015: -|w(s_i, s_j) - w(t_i, t_j)|^2 with Manhattan distances w, m^2.
[[nodiscard]] double similarity(Point from_i, Point from_j, Point to_i, Point to_j);

/// All pairs; the preference of each point is the median of all similarities of different points. O(people^2)
[[nodiscard]] SimilarityRows all_similarities(std::span<const Point> from, std::span<const Point> to);

/// Of each point those to its nearest `neighbours` in the formation that is left and to `landmarks` points spread
/// evenly over it, both ways; the preference is the median over as many pairs drawn at random. O(people x neighbours)
[[nodiscard]] SimilarityRows near_similarities(std::span<const Point> from, std::span<const Point> to,
                                               std::uint32_t neighbours, std::uint32_t landmarks);

/// Largest group whose similarities are all looked at; of larger ones only the near ones.
inline constexpr std::size_t kMostDense = 2000;

/// Sub-groups of people who can keep together on their way, section 3.4 of Xu 2015.
/// @param from, to  of each person
[[nodiscard]] Clusters find_subgroups(std::span<const Point> from, std::span<const Point> to,
                                      const AffinityOptions& options, const std::atomic<bool>* stop = nullptr);

}  // namespace footlight::planner::collective
