// SPDX-License-Identifier: Apache-2.0
#include "core/plan.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"

namespace footlight {
namespace {

Grid floor5() { return *Grid::make(GridKind::square, 5, 5, 1.0); }

Mark mark(double time_s, int column, int row) { return {instant_at(time_s), floor5().index({column, row})}; }

void expect_at(const std::vector<Mark>& track, double time_s, Point expected) {
  const Point found = position_at(floor5(), track, instant_at(time_s));
  EXPECT_NEAR(found.x, expected.x, 1e-12) << time_s;
  EXPECT_NEAR(found.y, expected.y, 1e-12) << time_s;
}

TEST(PositionAt, WalksStraightAtConstantSpeedBetweenMarks) {
  const std::vector<Mark> track{mark(1, 0, 0), mark(3, 4, 2), mark(5, 4, 2), mark(6, 4, 3)};
  expect_at(track, 1, {-2, 0.5});
  expect_at(track, 1.5, {-1, 1});
  expect_at(track, 2, {0, 1.5});
  expect_at(track, 3, {2, 2.5});
  expect_at(track, 4, {2, 2.5});
  expect_at(track, 5.25, {2, 2.75});
}

TEST(PositionAt, StandsBeforeTheFirstAndAfterTheLastMark) {
  const std::vector<Mark> track{mark(1, 0, 0), mark(3, 4, 2)};
  expect_at(track, -9, {-2, 0.5});
  expect_at(track, 0.999, {-2, 0.5});
  expect_at(track, 99, {2, 2.5});
  expect_at({mark(1, 2, 2)}, 5, {0, 2.5});
}

TEST(PositionAtProperty, IsExactlyTheCentreAtAMark) {
  const bool held = rc::check([](std::uint64_t seed) {
    Rng rng(seed);
    std::vector<Mark> track;
    double time_s = 0;
    for (int k = 0; k < 6; ++k) {
      track.push_back(mark(time_s, static_cast<int>(rng.below(5)), static_cast<int>(rng.below(5))));
      time_s += 0.01 + rng.uniform();
    }
    for (const Mark& m : track) RC_ASSERT(position_at(floor5(), track, m.time) == floor5().centre(m.cell));
  });
  EXPECT_TRUE(held);
}

TEST(PositionAtDeathTest, ATrackWithoutMarksIsAProgrammerError) {
  EXPECT_DEATH(static_cast<void>(position_at(floor5(), {}, kStart)), "track.empty");
}

}  // namespace
}  // namespace footlight
