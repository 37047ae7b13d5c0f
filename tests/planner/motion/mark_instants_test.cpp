// SPDX-License-Identifier: Apache-2.0
#include "planner/motion/mark_instants.hpp"

#include <cmath>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planner/motion/snap_crowd.hpp"

namespace footlight::planner {
namespace {

using testing::ElementsAre;

class MarkInstantsTest : public testing::Test {
 protected:
  /// 120 counts a minute: 0.7 m a count.
  [[nodiscard]] MarkTask task(double duration, std::optional<double> spacing = std::nullopt) const {
    return {&tempo_, &grid_, WalkKind::straight, 9, duration, 1.4, spacing};
  }
  TempoMap tempo_{120};
  Grid grid_ = *Grid::make(GridKind::square, 20, 20, 1.0);
};

TEST_F(MarkInstantsTest, AreAsFrequentAsPeopleCanFollowInEveryDirection) {
  const MarkInstants marks = mark_instants(task(16));
  EXPECT_EQ(marks.spacing_counts, 4);  // 2.8 m; in 3 counts 2.1 m, of which 1.41 m diagonally
  EXPECT_THAT(marks.count, ElementsAre(9, 13, 17, 21, 25));
  EXPECT_THAT(marks.at_s, ElementsAre(0, 2, 4, 6, 8));
  ASSERT_EQ(marks.longest_m.size(), 4U);
  EXPECT_NEAR(marks.longest_m[0], 2.8, 1e-6);
  EXPECT_GE(followed_share(grid_, 2.8), 0.7);
  EXPECT_LT(followed_share(grid_, 2.1), 0.7);
  EXPECT_LE(marks.followed_mps, 1.4 * followed_share(grid_, 2.8) + 1e-6);
  EXPECT_GT(marks.followed_mps, 0.9);
}

TEST_F(MarkInstantsTest, TheLastIntervalTakesWhatIsLeftOver) {
  EXPECT_THAT(mark_instants(task(18)).count, ElementsAre(9, 13, 17, 21, 27));
  EXPECT_THAT(mark_instants(task(3)).count, ElementsAre(9, 12));
}

TEST_F(MarkInstantsTest, AGivenSpacingHasSpareMarksInBetween) {
  const MarkInstants marks = mark_instants(task(24, 12));
  EXPECT_THAT(marks.count, ElementsAre(9, 12, 15, 18, 21, 24, 27, 30, 33));
  EXPECT_THAT(marks.spare, ElementsAre(0, 1, 1, 1, 0, 1, 1, 1, 0));
}

TEST_F(MarkInstantsTest, SpareMarksStayWhereAWayIsCurved) {
  MarkInstants marks = mark_instants(task(24, 12));
  Stage stage;
  stage.grid = grid_;
  // One person goes straight; the other turns in the second half.
  std::vector<std::vector<Point>> at;
  for (int k = 0; k < 9; ++k) at.push_back({{-5.0 + k, 3}, {-5.0 + std::min(k, 6), 8.0 + 2 * std::max(0, k - 6)}});
  marks.thin(at, Ways(stage, 0.25));
  EXPECT_THAT(marks.count, ElementsAre(9, 21, 27, 33));
  EXPECT_THAT(marks.at_s, ElementsAre(0, 6, 9, 12));
  ASSERT_EQ(at.size(), 4U);
  EXPECT_EQ(at[2][0], (Point{1, 3}));
  ASSERT_EQ(marks.longest_m.size(), 3U);
  EXPECT_NEAR(marks.longest_m[0], 8.4, 1e-6);
  EXPECT_NEAR(marks.longest_m[1], 4.2, 1e-6);
}

TEST_F(MarkInstantsTest, SpareMarksStayWhereTheStraightWayIsBlocked) {
  MarkInstants marks = mark_instants(task(12, 12));
  Stage stage;
  stage.grid = grid_;
  stage.blocked = {grid_.index({10, 5})};
  std::vector<std::vector<Point>> at;
  const Point middle = grid_.centre(Cell{10, 5});
  for (int k = 0; k < 5; ++k) at.push_back({middle + Point{k - 2.0, 0.9 - 0.05 * std::abs(k - 2)}});
  EXPECT_EQ(marks.count.size(), 5U);
  marks.thin(at, Ways(stage, 0.35));
  EXPECT_EQ(marks.count.size(), 3U);
}

TEST_F(MarkInstantsTest, OfAChangingTempoTheFastestCounts) {
  tempo_ = *TempoMap::from({{1, 120}, {17, 240}}, 4);
  EXPECT_EQ(mark_instants(task(16)).spacing_counts, 7);  // 2.45 m, which has steps of (2, 1)
  EXPECT_NEAR(least_mark_counts(task(16)), 1 / 1.4 * 4, 1e-9);
}

TEST_F(MarkInstantsTest, OverCellsPeopleStepOnCounts) {
  MarkTask over = task(16);
  over.walk = WalkKind::cells;
  over.speed_mps = 2;  // a cell a count
  const MarkInstants marks = mark_instants(over);
  ASSERT_FALSE(marks.longest_m.empty());
  EXPECT_NEAR(marks.longest_m[0], marks.spacing_counts * std::sqrt(0.5), 1e-9);
  EXPECT_GT(marks.followed_mps, 0.5);
}

}  // namespace
}  // namespace footlight::planner
