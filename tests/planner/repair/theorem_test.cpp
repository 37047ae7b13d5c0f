// SPDX-License-Identifier: Apache-2.0
//
// The theorem on which plans rest, as a property of random formations that shrink to a smallest example: between
// formations whose people stand at least a pitch apart, two people with (s_a - s_b) . (g_a - g_b) >= 0 who start and
// arrive together keep p / sqrt(2) on squares and p sqrt(3)/2 on hexagons and triangles; the cheapest pairing by
// squared distance has this for every pair, and exchanges reach it from any pairing. The distances are sampled, so that
// the closed forms of the planner are not their own judges.
#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "planner/assignment/assignment.hpp"
#include "planner/repair/exchange.hpp"

namespace footlight::planner {
namespace {

/// As many distinct cells before as after, in the order in which they were drawn: a pairing without any order.
struct Formations {
  Grid grid;
  std::vector<Point> from;
  std::vector<Point> to;
};

Formations some_formations(GridKind kind) {
  Formations out;
  const double pitch_m = *rc::gen::element(0.6, 1.0, 1.7);
  out.grid = *Grid::make(kind, 9, 8, pitch_m);
  const auto cells = [&] { return *rc::gen::unique<std::vector<int>>(rc::gen::inRange(0, out.grid.size())); };
  const std::vector<int> from = cells();
  const std::vector<int> to = cells();
  for (std::size_t i = 0; i < std::min(from.size(), to.size()); ++i) {
    out.from.push_back(out.grid.centre(CellIndex::of(from[i])));
    out.to.push_back(out.grid.centre(CellIndex::of(to[i])));
  }
  return out;
}

double product(const Formations& all, const std::vector<std::uint32_t>& target_of, std::size_t a, std::size_t b) {
  return dot(all.from[a] - all.from[b], all.to[target_of[a]] - all.to[target_of[b]]);
}

/// Least distance at a hundred instants of the walk.
double sampled_distance(const Formations& all, const std::vector<std::uint32_t>& target_of, std::size_t a,
                        std::size_t b) {
  double least_m = distance(all.from[a], all.from[b]);
  for (int n = 0; n <= 100; ++n) {
    const double t = n / 100.0;
    const Point one = (1 - t) * all.from[a] + t * all.to[target_of[a]];
    const Point two = (1 - t) * all.from[b] + t * all.to[target_of[b]];
    least_m = std::min(least_m, distance(one, two));
  }
  return least_m;
}

/// Calls check(a, b, product) for every pair.
template <class Check>
void for_each_pair(const Formations& all, const std::vector<std::uint32_t>& target_of, Check check) {
  for (std::size_t a = 0; a < all.from.size(); ++a) {
    for (std::size_t b = a + 1; b < all.from.size(); ++b) check(a, b, product(all, target_of, a, b));
  }
}

class Theorem : public testing::TestWithParam<GridKind> {};

TEST_P(Theorem, PairsWhoDoNotTurnAroundEachOtherKeepTheBound) {
  EXPECT_TRUE(rc::check([] {
    const Formations all = some_formations(GetParam());
    std::vector<std::uint32_t> as_drawn(all.from.size());
    std::iota(as_drawn.begin(), as_drawn.end(), 0U);
    for_each_pair(all, as_drawn, [&](std::size_t a, std::size_t b, double sign) {
      if (sign < 0) return;
      RC_ASSERT(sampled_distance(all, as_drawn, a, b) >= all.grid.clearance_bound_m() - 1e-9);
    });
  }));
}

TEST_P(Theorem, TheCheapestPairingBySquaredDistanceKeepsTheBoundForEverybody) {
  EXPECT_TRUE(rc::check([] {
    const Formations all = some_formations(GetParam());
    if (all.from.empty()) return;
    const auto best = assign(all.from, all.to, WalkCost::squared, std::numeric_limits<double>::infinity());
    RC_ASSERT(best.has_value());
    for_each_pair(all, best->target_of, [&](std::size_t a, std::size_t b, double sign) {
      RC_ASSERT(sign >= -1e-9);
      RC_ASSERT(sampled_distance(all, best->target_of, a, b) >= all.grid.clearance_bound_m() - 1e-9);
    });
  }));
}

TEST_P(Theorem, ExchangesReachTheBoundFromAnyPairing) {
  EXPECT_TRUE(rc::check([] {
    const Formations all = some_formations(GetParam());
    std::vector<std::uint32_t> target_of(all.from.size());
    std::iota(target_of.begin(), target_of.end(), 0U);
    exchange(all.from, all.to, target_of, all.grid.clearance_bound_m(), [](Point, Point) { return true; });
    for_each_pair(all, target_of, [&](std::size_t a, std::size_t b, double) {
      RC_ASSERT(sampled_distance(all, target_of, a, b) >= all.grid.clearance_bound_m() - 1e-9);
    });
  }));
}

TEST_P(Theorem, TheBoundIsReachedAndNotBelow) {
  // Two neighbours of whom one walks around the other by the sharpest turn that the theorem allows.
  const Grid grid = *Grid::make(GetParam(), 9, 8, 1.0);
  double least_m = 10;
  for (int i = 0; i < grid.size(); ++i) {
    for (const CellIndex j : grid.neighbours(CellIndex::of(i))) {
      for (const CellIndex k : grid.neighbours(j)) {
        const Formations all{grid, {grid.centre(CellIndex::of(i)), grid.centre(j)}, {grid.centre(j), grid.centre(k)}};
        if (k == CellIndex::of(i) || product(all, {0, 1}, 0, 1) < 0) continue;
        least_m = std::min(least_m, sampled_distance(all, {0, 1}, 0, 1));
      }
    }
  }
  EXPECT_NEAR(least_m, grid.clearance_bound_m(), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Grids, Theorem, testing::Values(GridKind::square, GridKind::hexagonal, GridKind::triangular));

}  // namespace
}  // namespace footlight::planner
