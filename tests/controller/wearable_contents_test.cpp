// SPDX-License-Identifier: Apache-2.0
#include "controller/wearable_contents.hpp"

#include <gtest/gtest.h>

namespace footlight::controller {
namespace {

class WearableContentTest : public ::testing::Test {
 protected:
  [[nodiscard]] CellIndex cell(int column, int row) const { return grid_.index({column, row}); }
  /// Of somebody who stands on C3 and is announced to walk from second 4 to 6.
  [[nodiscard]] drivers::WearableContent announced(int column, int row) const {
    const std::vector<Mark> track{
        {instant_at(0), cell(2, 2)}, {instant_at(4), cell(2, 2)}, {instant_at(6), cell(column, row)}};
    Doing doing;
    doing.cell = cell(2, 2);
    doing.next = cell(column, row);
    doing.next_arrives = instant_at(6);
    return content_of(doing, track, grid_, tempo_);
  }

  Grid grid_ = Grid::make(GridKind::square, 5, 5, 1.5).value();
  TempoMap tempo_;
};

TEST_F(WearableContentTest, DirectionsTurnClockwiseFromDownstage) {
  EXPECT_EQ(announced(2, 1).direction, 0) << "downstage";
  EXPECT_EQ(announced(1, 1).direction, 32);
  EXPECT_EQ(announced(1, 2).direction, 64) << "stage right";
  EXPECT_EQ(announced(2, 3).direction, 128) << "upstage";
  EXPECT_EQ(announced(3, 2).direction, 192) << "stage left";
}

TEST_F(WearableContentTest, SaysHowFarWhenAndInWhichCounts) {
  const drivers::WearableContent content = announced(0, 2);
  EXPECT_TRUE(content.walks);
  EXPECT_EQ(content.distance_cm, 300);
  EXPECT_EQ(content.starts_ms, 4000U);
  const Instant start = instant_at(4);
  EXPECT_EQ(content.count_ms, std::lround(to_seconds(tempo_.at(tempo_.count_at(start) + 1) - start) * 1000));
}

TEST_F(WearableContentTest, WhoStandsIsToldNothingAndWhoWalksHerOwnWay) {
  const std::vector<Mark> track{{instant_at(0), cell(0, 0)}, {instant_at(2), cell(1, 0)}};
  Doing doing;
  doing.cell = cell(0, 0);
  EXPECT_EQ(content_of(doing, track, grid_, tempo_), drivers::WearableContent{});
  doing.goal = cell(1, 0);
  doing.arrives = instant_at(2);
  EXPECT_EQ(content_of(doing, track, grid_, tempo_).direction, 192);
  EXPECT_EQ(content_of(doing, track, grid_, tempo_).starts_ms, 0U);
}

}  // namespace
}  // namespace footlight::controller
