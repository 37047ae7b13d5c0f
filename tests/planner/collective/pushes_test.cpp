// SPDX-License-Identifier: Apache-2.0
#include "planner/collective/pushes.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"

namespace footlight::planner::collective {
namespace {

constexpr Falloff kRepulsion{2, 0.3};
constexpr Falloff kSeparation{0.2, 0.5};

TEST(Pushes, AreTheForcesOfAllAroundAddedUp) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    const std::size_t others = rng.below(40);
    Around around;
    around.clear(others);
    Around::Sums wanted;
    for (std::size_t n = 0; n < others; ++n) {
      const Point away{4 * rng.uniform() - 2, 4 * rng.uniform() - 2};
      const double touch_m = 0.4 + 0.4 * rng.uniform();
      const bool stranger = rng.below(2) == 0;
      around.add(away, 2.25 * 2.25, touch_m, stranger);
      const double room_m = length(away) - touch_m;
      if (length(away) > 2.25) continue;
      Point& sum = stranger ? wanted.strangers : wanted.own;
      if (room_m < kCutOff * kRepulsion.range_m) sum = sum + repulse_force(away, {}, touch_m, kRepulsion);
      if (stranger && room_m < kCutOff * kSeparation.range_m) {
        sum = sum + repulse_force(away, {}, touch_m, kSeparation);
      }
    }
    const Around::Sums found = around.pushes(kRepulsion, kSeparation);
    RC_ASSERT(distance(found.own, wanted.own) <= 1e-13 * (1 + length(wanted.own)));
    RC_ASSERT(distance(found.strangers, wanted.strangers) <= 1e-13 * (1 + length(wanted.strangers)));
  }));
}

TEST(Pushes, OfNobodyAreNothing) {
  Around around;
  around.clear(0);
  EXPECT_EQ(around.pushes(kRepulsion, kSeparation).own, Point{});
  around.clear(2);
  around.add({}, 1, 0.5, false);
  around.add({0, 1.01}, 1, 0.5, true);
  EXPECT_EQ(around.people(), 0U) << "neither she herself nor who is out of reach";
  EXPECT_EQ(around.pushes(kRepulsion, kSeparation).strangers, Point{});
}

TEST(Pushes, OfTwoWhoTouchHerAreAlikeHoweverWideTheyAre) {
  // Both others touch her: A = 2 m/s^2 from each, whatever their width.
  Around around;
  around.clear(2);
  around.add({0.5, 0}, 4, 0.5, false);
  around.add({0, 0.9}, 4, 0.9, false);
  const Around::Sums sums = around.pushes(kRepulsion, kSeparation);
  EXPECT_NEAR(sums.own.x, 2, 1e-14);
  EXPECT_NEAR(sums.own.y, 2, 1e-14);
}

}  // namespace
}  // namespace footlight::planner::collective
