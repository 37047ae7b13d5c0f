// SPDX-License-Identifier: Apache-2.0
#include "planner/formation/delaunay.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"

namespace footlight::planner {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr double kFar = std::numeric_limits<double>::infinity();

std::vector<Point> scattered(std::size_t count, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<Point> out;
  for (std::size_t i = 0; i < count; ++i) out.push_back({40 * rng.uniform() - 20, 25 * rng.uniform()});
  return out;
}

double cross(Point a, Point b) { return a.x * b.y - a.y * b.x; }

/// How long the middles of circles through a and b are that have nobody inside, from all points in turn.
double free_middles_m(const std::vector<Point>& points, std::size_t a, std::size_t b) {
  const Point along = points[b] - points[a];
  const double apart = length(along);
  const Point normal{-along.y / apart, along.x / apart};
  const Point middle = 0.5 * (points[a] + points[b]);
  double low = -kFar;
  double high = kFar;
  for (std::size_t c = 0; c < points.size(); ++c) {
    if (c == a || c == b) continue;
    const Point to = points[c] - middle;
    const double side = dot(to, normal);
    // |to - t normal|^2 >= t^2 + (apart / 2)^2
    const double rest = squared_length(to) - apart * apart / 4;
    if (side > 0) high = std::min(high, rest / (2 * side));
    if (side < 0) low = std::max(low, rest / (2 * side));
    if (side == 0 && rest < 0) return -1;
  }
  return high - low;
}

TEST(Delaunay, HasThePairsWithAnEmptyCircleAndNoOthers) {
  EXPECT_TRUE(rc::check([] {
    const auto points = scattered(*rc::gen::inRange<std::size_t>(2, 40), *rc::gen::arbitrary<std::uint64_t>());
    const auto edges = delaunay_edges(points);
    for (std::uint32_t a = 0; a < points.size(); ++a) {
      for (std::uint32_t b = a + 1; b < points.size(); ++b) {
        const double free_m = free_middles_m(points, a, b);
        const double unsure_m = 1e-4 * distance(points[a], points[b]) + 1e-6;
        const bool is_edge = std::binary_search(edges.begin(), edges.end(), DelaunayEdge{a, b});
        if (free_m > 2 * unsure_m) RC_ASSERT(is_edge);
        if (free_m < 0.5e-4 * distance(points[a], points[b]) - 1e-6) RC_ASSERT(!is_edge);
      }
    }
  }));
}

TEST(Delaunay, IsPlanar) {
  const auto points = scattered(150, 3);
  const auto edges = delaunay_edges(points);
  EXPECT_LE(edges.size(), 3 * points.size() - 6);
  for (const DelaunayEdge e : edges) {
    for (const DelaunayEdge f : edges) {
      if (e.a == f.a || e.a == f.b || e.b == f.a || e.b == f.b) continue;
      const Point p = points[e.a];
      const Point q = points[e.b];
      const Point r = points[f.a];
      const Point s = points[f.b];
      const bool cross_each_other =
          cross(q - p, r - p) * cross(q - p, s - p) < 0 && cross(s - r, p - r) * cross(s - r, q - r) < 0;
      ASSERT_FALSE(cross_each_other) << e.a << "-" << e.b << " and " << f.a << "-" << f.b;
    }
  }
}

bool is_connected(std::size_t points, const std::vector<DelaunayEdge>& edges) {
  std::vector<std::size_t> root(points);
  std::iota(root.begin(), root.end(), 0U);
  const auto find = [&](std::size_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  std::size_t parts = points;
  for (const DelaunayEdge e : edges) {
    const std::size_t a = find(e.a);
    const std::size_t b = find(e.b);
    if (a == b) continue;
    root[a] = b;
    --parts;
  }
  return parts <= 1;
}

TEST(Delaunay, IsConnectedOnGridsToo) {
  EXPECT_TRUE(rc::check([] {
    const auto kind = static_cast<GridKind>(*rc::gen::inRange(0, 3));
    const Grid grid = *Grid::make(kind, 30, 30, 0.7);
    Rng rng(*rc::gen::arbitrary<std::uint64_t>());
    std::vector<Point> points;
    const std::uint64_t one_of = 1 + rng.below(5);
    for (int i = 0; i < grid.size(); ++i) {
      if (rng.below(one_of) == 0) points.push_back(grid.centre(CellIndex::of(i)));
    }
    RC_ASSERT(is_connected(points.size(), delaunay_edges(points)));
  }));
}

TEST(Delaunay, OfAGridAreItsNeighbours) {
  for (const GridKind kind : {GridKind::square, GridKind::hexagonal, GridKind::triangular}) {
    const Grid grid = *Grid::make(kind, 9, 8, 0.7);
    std::vector<Point> points;
    std::vector<DelaunayEdge> wanted;
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(grid.size()); ++i) {
      points.push_back(grid.centre(CellIndex(i)));
      for (const CellIndex near : grid.neighbours(CellIndex(i))) {
        if (near.value() > i) wanted.push_back({i, near.value()});
      }
    }
    const auto edges = delaunay_edges(points);
    for (const DelaunayEdge edge : wanted) EXPECT_TRUE(std::binary_search(edges.begin(), edges.end(), edge));
    // Beyond them only around the edge of the floor, where it is not convex.
    const std::size_t more = edges.size() - wanted.size();
    EXPECT_LE(more, kind == GridKind::square ? 0U : 40U) << to_text(kind);
  }
}

TEST(Delaunay, DoesNotDependOnTheOrderOfThePoints) {
  EXPECT_TRUE(rc::check([] {
    const Grid grid = *Grid::make(GridKind::triangular, 12, 12, 1.1);
    Rng rng(*rc::gen::arbitrary<std::uint64_t>());
    std::vector<Point> points;
    for (int i = 0; i < grid.size(); ++i) {
      if (rng.below(3) != 0) points.push_back(grid.centre(CellIndex::of(i)));
    }
    std::vector<std::uint32_t> order(points.size());
    std::iota(order.begin(), order.end(), 0U);
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[rng.below(i)]);
    std::vector<Point> shuffled;
    for (const std::uint32_t i : order) shuffled.push_back(points[i]);
    std::vector<DelaunayEdge> back;
    for (const DelaunayEdge e : delaunay_edges(shuffled)) {
      back.push_back({std::min(order[e.a], order[e.b]), std::max(order[e.a], order[e.b])});
    }
    std::sort(back.begin(), back.end());
    RC_ASSERT(back == delaunay_edges(points));
  }));
}

TEST(Delaunay, OfPointsOnALineIsTheLine) {
  EXPECT_THAT(delaunay_edges(std::vector<Point>{{3, 3}, {1, 1}, {2, 2}, {7, 7}}),
              ElementsAre(DelaunayEdge{0, 2}, DelaunayEdge{0, 3}, DelaunayEdge{1, 2}));
}

TEST(Delaunay, OfASquareHasNoDiagonal) {
  EXPECT_THAT(delaunay_edges(std::vector<Point>{{0, 0}, {1, 0}, {1, 1}, {0, 1}}),
              ElementsAre(DelaunayEdge{0, 1}, DelaunayEdge{0, 3}, DelaunayEdge{1, 2}, DelaunayEdge{2, 3}));
}

TEST(Delaunay, LinksPointsOnOnePlaceWithTheFirst) {
  EXPECT_THAT(delaunay_edges(std::vector<Point>{{0, 0}, {5, 5}, {0, 0}}),
              ElementsAre(DelaunayEdge{0, 1}, DelaunayEdge{0, 2}));
  EXPECT_THAT(delaunay_edges(std::vector<Point>{{2, 2}, {2, 2}}), ElementsAre(DelaunayEdge{0, 1}));
}

TEST(Delaunay, OfFewerThanTwoPointsIsEmpty) {
  EXPECT_THAT(delaunay_edges(std::vector<Point>{}), IsEmpty());
  EXPECT_THAT(delaunay_edges(std::vector<Point>{{1, 1}}), IsEmpty());
}

}  // namespace
}  // namespace footlight::planner
