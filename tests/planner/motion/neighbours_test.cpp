// SPDX-License-Identifier: Apache-2.0
#include "planner/motion/neighbours.hpp"

#include <algorithm>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"

namespace footlight::planner {
namespace {

using Found = std::vector<std::pair<std::uint32_t, double>>;

Found visited(const Neighbours& neighbours, Point at, double radius_m) {
  Found out;
  neighbours.visit(at, radius_m, [&](std::uint32_t i, double squared) { out.emplace_back(i, squared); });
  return out;
}

Found by_looking_at_everybody(const std::vector<Point>& people, Point at, double radius_m) {
  Found out;
  for (std::uint32_t i = 0; i < people.size(); ++i) {
    const double squared = squared_length(people[i] - at);
    if (squared <= radius_m * radius_m) out.emplace_back(i, squared);
  }
  return out;
}

/// A crowd in a few clusters, some of it spread far, some of it on one place.
std::vector<Point> crowd(Rng& rng) {
  std::vector<Point> people(1 + rng.below(300));
  const double wide_m = rng.below(2) == 0 ? 20 : 2000;
  for (Point& at : people) {
    const Point middle = rng.below(3) == 0 ? Point{wide_m * rng.uniform(), wide_m * rng.uniform()} : Point{-3, 7};
    at = middle + Point{4 * rng.uniform(), 4 * rng.uniform()};
  }
  if (people.size() > 3) people[2] = people[1] = people[0];
  return people;
}

TEST(Neighbours, AreThoseWhoAreFoundByLookingAtEverybody) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    const std::vector<Point> people = crowd(rng);
    Neighbours neighbours;
    neighbours.sort(people, 0.1 + 5 * rng.uniform());
    for (int n = 0; n < 20; ++n) {
      Point at = people[rng.below(people.size())];
      if (n % 3 == 0) at = at + Point{40 * (rng.uniform() - 0.5), 40 * (rng.uniform() - 0.5)};
      const double radius_m = 8 * rng.uniform();
      Found found = visited(neighbours, at, radius_m);
      std::sort(found.begin(), found.end());
      RC_ASSERT(found == by_looking_at_everybody(people, at, radius_m));
    }
  }));
}

TEST(Neighbours, OfABinComeInTheOrderOfTheirNumbers) {
  Neighbours neighbours;
  const std::vector<Point> people{{0.2, 0.1}, {5, 5}, {0.1, 0.2}, {5, 0.1}, {0.3, 0.3}, {0.1, 5}};
  neighbours.sort(people, 2.5);
  std::vector<std::uint32_t> order;
  for (const auto& [i, squared] : visited(neighbours, {2, 2}, 100)) order.push_back(i);
  EXPECT_THAT(order, testing::ElementsAre(0, 2, 4, 3, 5, 1));
}

TEST(Neighbours, StretchesOfTheirOrderHaveEverybodyWhoIsNear) {
  Rng rng(5);
  const std::vector<Point> people = crowd(rng);
  Neighbours neighbours;
  neighbours.sort(people, 1.5);
  ASSERT_EQ(neighbours.order().size(), people.size());
  for (std::size_t k = 0; k < people.size(); ++k) EXPECT_EQ(neighbours.places()[k], people[neighbours.order()[k]]);
  Found found;
  std::uint32_t before = 0;
  neighbours.visit_rows(people[3], 3, [&](std::uint32_t begin, std::uint32_t end) {
    EXPECT_GE(begin, before);
    before = end;
    for (std::uint32_t k = begin; k < end; ++k) {
      const double squared = squared_length(neighbours.places()[k] - people[3]);
      if (squared <= 9) found.emplace_back(neighbours.order()[k], squared);
    }
  });
  EXPECT_EQ(found, visited(neighbours, people[3], 3));
}

TEST(Neighbours, OfNobodyAreNobody) {
  Neighbours neighbours;
  neighbours.sort({}, 1);
  EXPECT_TRUE(visited(neighbours, {}, 10).empty());
}

TEST(Neighbours, OnTheEdgeOfTheRadiusCount) {
  Neighbours neighbours;
  const std::vector<Point> people{{0, 0}, {2, 0}, {2.001, 0}};
  neighbours.sort(people, 1);
  EXPECT_EQ(visited(neighbours, {0, 0}, 2).size(), 2U);
}

}  // namespace
}  // namespace footlight::planner
