// SPDX-License-Identifier: Apache-2.0
#include "planner/collective/affinity.hpp"

#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "core/rng.hpp"

namespace footlight::planner::collective {
namespace {

/// A crowd of pieces that fly apart, each as one, with people off their places by `noise_m`.
struct Pieces {
  std::vector<Point> from, to;
  std::vector<std::uint32_t> piece;
};

Pieces pieces_of(int pieces, int across, double noise_m, std::uint64_t seed) {
  Rng rng(seed);
  Pieces out;
  for (int k = 0; k < pieces; ++k) {
    const double turn = 2 * 3.14159265358979 * k / pieces;
    const Point middle{15 * std::cos(turn), 15 * std::sin(turn)};
    const Point shift = 2.0 * middle;
    for (int i = 0; i < across * across; ++i) {
      const Point at = middle + Point{static_cast<double>(i % across), static_cast<double>(i / across)};
      out.from.push_back(at);
      out.to.push_back(at + shift + Point{noise_m * (rng.uniform() - 0.5), noise_m * (rng.uniform() - 0.5)});
      out.piece.push_back(static_cast<std::uint32_t>(k));
    }
  }
  return out;
}

/// Adjusted Rand index of two partitions (Hubert and Arabie 1985): 1 when they are the same, about 0 by chance.
double adjusted_rand(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
  std::map<std::uint32_t, double> rows, columns;
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> both;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ++rows[a[i]];
    ++columns[b[i]];
    ++both[{a[i], b[i]}];
  }
  const auto pairs = [](double n) { return n * (n - 1) / 2; };
  double together = 0, in_rows = 0, in_columns = 0;
  for (const auto& [key, n] : both) together += pairs(n);
  for (const auto& [key, n] : rows) in_rows += pairs(n);
  for (const auto& [key, n] : columns) in_columns += pairs(n);
  const double expected = in_rows * in_columns / pairs(static_cast<double>(a.size()));
  return (together - expected) / ((in_rows + in_columns) / 2 - expected);
}

SimilarityRows rows_of(const std::vector<std::vector<float>>& table) {
  SimilarityRows rows;
  for (const auto& row : table) {
    for (std::uint32_t k = 0; k < row.size(); ++k) rows.add(k, row[k]);
    rows.close_row();
  }
  return rows;
}

TEST(Similarity, IsMinusEquation20) {
  // Manhattan 3 + 4 = 7 m before, 1 + 1 = 2 m after.
  EXPECT_DOUBLE_EQ(similarity({0, 0}, {3, 4}, {5, 5}, {6, 6}), -25);
  EXPECT_DOUBLE_EQ(similarity({0, 0}, {3, 4}, {5, 5}, {9, 8}), 0) << "as far as before";
}

TEST(AffinityPropagation, FindsTwoPairsAndTheirNetSimilarity) {
  // 0 and 1 are alike, 2 and 3 are alike; a preference of -3. Two clusters: -1 - 1 - 3 - 3 = -8; one: -1 - 20 - 20 - 3.
  const Clusters found = affinity_propagation(
      rows_of({{-3, -1, -20, -20}, {-1, -3, -20, -20}, {-20, -20, -3, -1}, {-20, -20, -1, -3}}), {});
  EXPECT_TRUE(found.converged);
  EXPECT_EQ(found.count(), 2U);
  EXPECT_EQ(found.exemplar_of[0], found.exemplar_of[1]);
  EXPECT_EQ(found.exemplar_of[2], found.exemplar_of[3]);
  EXPECT_DOUBLE_EQ(found.net_similarity, -8);
}

TEST(AffinityPropagation, MakesAPointThatKnowsNobodyItsOwnExemplar) {
  SimilarityRows rows;
  rows.add(0, -3);
  rows.add(1, -1);
  rows.close_row();
  rows.add(0, -1);
  rows.add(1, -3);
  rows.close_row();
  rows.add(2, -3);
  rows.close_row();
  const Clusters found = affinity_propagation(rows, {});
  EXPECT_EQ(found.exemplar_of[2], 2U);
  EXPECT_EQ(found.exemplar_of[0], found.exemplar_of[1]);
}

TEST(AffinityPropagation, IsTheBestOfAllChoicesOfExemplarsOnSmallCrowds) {
  // Eight people: all 255 sets of exemplars are tried. Messages are a heuristic; on these crowds they find the best.
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    Rng rng(seed);
    std::vector<Point> from, to;
    for (int i = 0; i < 8; ++i) {
      from.push_back({10 * rng.uniform(), 10 * rng.uniform()});
      to.push_back({10 * rng.uniform(), 10 * rng.uniform()});
    }
    const SimilarityRows rows = all_similarities(from, to);
    double best = -1e30;
    for (unsigned set = 1; set < 256; ++set) {
      double sum = 0;
      for (std::uint32_t i = 0; i < 8; ++i) {
        double most = (set >> i & 1U) != 0 ? rows.similarity[i * 8 + i] : -1e30;
        for (std::uint32_t k = 0; k < 8 && (set >> i & 1U) == 0; ++k) {
          if ((set >> k & 1U) != 0) most = std::max<double>(most, rows.similarity[i * 8 + k]);
        }
        sum += most;
      }
      best = std::max(best, sum);
    }
    const Clusters found = affinity_propagation(rows, {});
    EXPECT_TRUE(found.converged);
    EXPECT_GE(found.net_similarity, best - 0.02 * std::abs(best)) << seed;
  }
}

TEST(AllSimilarities, HaveTheMedianAsPreference) {
  // Changes of 0, 1 and 2 m between three people: similarities 0, -1, -4.
  const SimilarityRows rows =
      all_similarities(std::vector<Point>{{0, 0}, {1, 0}, {3, 0}}, std::vector<Point>{{0, 0}, {1, 0}, {4, 0}});
  EXPECT_EQ(rows.similarity[1], 0);   // 0 and 1: 1 m, 1 m
  EXPECT_EQ(rows.similarity[2], -1);  // 0 and 2: 3 m, 4 m
  EXPECT_EQ(rows.similarity[5], -1);  // 1 and 2: 2 m, 3 m
  EXPECT_EQ(rows.similarity[0], -1);
}

TEST(AffinityPropagation, OfAllPairsGoesThroughThemInBlocksWithTheSameResult) {
  // One more who knows nobody: not all pairs any more, so that messages go one by one.
  const Pieces crowd = pieces_of(6, 7, 2, 3);
  const SimilarityRows all = all_similarities(crowd.from, crowd.to);
  ASSERT_GT(all.size(), 256U) << "more than a block";
  SimilarityRows with_stranger = all;
  with_stranger.add(all.size(), all.similarity[0]);
  with_stranger.close_row();
  const Clusters blocks = affinity_propagation(all, {});
  Clusters one_by_one = affinity_propagation(with_stranger, {});
  EXPECT_EQ(one_by_one.exemplar_of.back(), all.size());
  one_by_one.exemplar_of.pop_back();
  EXPECT_EQ(blocks.exemplar_of, one_by_one.exemplar_of);
  EXPECT_EQ(blocks.rounds, one_by_one.rounds);
  EXPECT_GT(blocks.count(), 1U);
}

TEST(Subgroups, SparseIsAsGoodAsDenseWhereACrowdHasNoPieces) {
  // A block becomes a disc: nobody belongs together of herself, and the partitions differ. Both judged by all pairs.
  std::vector<Point> from, to;
  for (int p = 0; p < 400; ++p) {
    from.push_back({1.5 * (p % 20), 1.5 * static_cast<double>(p / 20)});
    const double radius_m = std::sqrt(p + 0.5);
    to.push_back({80 + radius_m * std::cos(2.399963229728653 * p), 15 + radius_m * std::sin(2.399963229728653 * p)});
  }
  const SimilarityRows all = all_similarities(from, to);
  const Clusters dense = affinity_propagation(all, {});
  const Clusters sparse = affinity_propagation(near_similarities(from, to, 48, 64), {});
  EXPECT_TRUE(dense.converged);
  EXPECT_TRUE(sparse.converged);
  double net = 0;
  for (std::uint32_t i = 0; i < 400; ++i) net += double{all.similarity[i * 400 + sparse.exemplar_of[i]]};
  EXPECT_GT(net, 1.1 * dense.net_similarity) << "both are below 0";
}

TEST(Subgroups, SparseAndDenseFindTheSamePieces) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Pieces crowd = pieces_of(6, 7, 0.2, seed);
    const SimilarityRows all = all_similarities(crowd.from, crowd.to);
    const SimilarityRows near = near_similarities(crowd.from, crowd.to, 40, 40);
    EXPECT_LT(near.to.size(), all.to.size() / 2) << "sparse it is";
    const Clusters dense = affinity_propagation(all, {});
    const Clusters sparse = affinity_propagation(near, {});
    EXPECT_TRUE(dense.converged);
    EXPECT_TRUE(sparse.converged);
    EXPECT_GT(adjusted_rand(dense.exemplar_of, crowd.piece), 0.9) << seed;
    EXPECT_GT(adjusted_rand(sparse.exemplar_of, crowd.piece), 0.9) << seed;
    EXPECT_GT(adjusted_rand(sparse.exemplar_of, dense.exemplar_of), 0.9) << seed;
    EXPECT_GT(sparse.net_similarity, 1.1 * dense.net_similarity) << "both are below 0; at most a tenth worse";
  }
}

TEST(Subgroups, OfPeopleWhoAllGoTheSameWayAreOne) {
  std::vector<Point> from, to;
  for (int i = 0; i < 40; ++i) {
    from.push_back({static_cast<double>(i % 8), static_cast<double>(i / 8)});
    to.push_back(from.back() + Point{30, -7});
  }
  EXPECT_EQ(find_subgroups(from, to, {}).count(), 1U);
}

TEST(Subgroups, AreTheSameForAnyNumberOfThreads) {
  const Pieces crowd = pieces_of(5, 8, 2, 9);
  std::vector<Clusters> found;
  for (const std::size_t threads : {1U, 2U, 8U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    found.push_back(find_subgroups(crowd.from, crowd.to, {}));
  }
  EXPECT_EQ(found[0].exemplar_of, found[1].exemplar_of);
  EXPECT_EQ(found[0].exemplar_of, found[2].exemplar_of);
  EXPECT_EQ(found[0].net_similarity, found[2].net_similarity);
}

}  // namespace
}  // namespace footlight::planner::collective
