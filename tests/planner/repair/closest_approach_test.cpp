// SPDX-License-Identifier: Apache-2.0
#include "planner/repair/closest_approach.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"

namespace footlight::planner {
namespace {

std::vector<Walk> random_walks(Rng& rng, std::size_t people, double floor_m, double longest_m) {
  std::vector<Walk> walks;
  for (std::size_t i = 0; i < people; ++i) {
    const Point from{floor_m * rng.uniform(), floor_m * rng.uniform()};
    walks.push_back({from, from + Point{longest_m * (rng.uniform() - 0.5), longest_m * (rng.uniform() - 0.5)}});
  }
  return walks;
}

TEST(ClosestApproach, PeopleWhoCrossAreNearestWhereTheyCross) {
  const Approach approach = closest_approach({{0, 0}, {4, 0}}, {{2, 3}, {2, -3}});
  EXPECT_NEAR(approach.distance_m, 0, 1e-12);
  EXPECT_NEAR(approach.share, 0.5, 1e-12);
}

TEST(ClosestApproach, PeopleWhoWalkAlikeKeepTheirDistance) {
  EXPECT_DOUBLE_EQ(closest_approach({{0, 0}, {9, 4}}, {{0, 2}, {9, 6}}).distance_m, 2);
}

TEST(ClosestApproach, LooksOnlyAtTheGivenPartOfTheTime) {
  EXPECT_DOUBLE_EQ(closest_approach({{0, 0}, {4, 0}}, {{2, 4}, {2, -4}}, 0, 0.25).distance_m, std::hypot(1, 2));
}

TEST(NearPairs, AreTheSameAsByLookingAtAll) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    const auto walks = random_walks(rng, 2 + rng.below(60), 15, 1 + 30 * rng.uniform());
    const double reach = 0.2 + 2 * rng.uniform();
    std::vector<std::pair<std::uint32_t, std::uint32_t>> expected;
    for (std::uint32_t a = 0; a < walks.size(); ++a) {
      for (std::uint32_t b = a + 1; b < walks.size(); ++b) {
        if (closest_approach(walks[a], walks[b]).distance_m < reach - 1e-9) expected.emplace_back(a, b);
      }
    }
    std::vector<std::pair<std::uint32_t, std::uint32_t>> found;
    for (const NearPair& pair : near_pairs(walks, reach)) {
      const Approach approach = closest_approach(walks[pair.a], walks[pair.b]);
      RC_ASSERT(std::abs(pair.approach.distance_m - approach.distance_m) < 1e-9);
      if (approach.distance_m < reach - 1e-9) found.emplace_back(pair.a, pair.b);
    }
    RC_ASSERT(found == expected);
  }));
}

TEST(NearPairs, CanBeLimitedToThoseOfSomePeople) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    const auto walks = random_walks(rng, 2 + rng.below(40), 8, 6);
    std::vector<char> among;
    for (std::size_t i = 0; i < walks.size(); ++i) among.push_back(rng.below(3) == 0 ? 1 : 0);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> expected;
    for (const NearPair& pair : near_pairs(walks, 1.0)) {
      if (among[pair.a] != 0 || among[pair.b] != 0) expected.emplace_back(pair.a, pair.b);
    }
    std::vector<std::pair<std::uint32_t, std::uint32_t>> found;
    for (const NearPair& pair : near_pairs(walks, 1.0, among)) found.emplace_back(pair.a, pair.b);
    RC_ASSERT(found == expected);
  }));
}

TEST(NearestPair, FindsTheNearestHoweverFarApart) {
  const std::vector<Walk> walks{{{0, 0}, {0, 0}}, {{30, 0}, {20, 0}}, {{90, 0}, {90, 1}}};
  const NearPair pair = nearest_pair(walks);
  EXPECT_EQ(pair.a, 0U);
  EXPECT_EQ(pair.b, 1U);
  EXPECT_DOUBLE_EQ(pair.approach.distance_m, 20);
  EXPECT_DOUBLE_EQ(pair.approach.share, 1);
  EXPECT_TRUE(std::isinf(nearest_pair(std::span(walks).first(1)).approach.distance_m));
}

}  // namespace
}  // namespace footlight::planner
