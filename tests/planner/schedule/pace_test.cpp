// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/pace.hpp"

#include <gtest/gtest.h>

namespace footlight::planner {
namespace {

class LeaveEarly : public testing::Test {
 protected:
  LeaveEarly() {
    stage.grid = *Grid::make(GridKind::square, 40, 1, 1.0);
    reserve.assign(40, 0);
    reserve[0] = 1;
  }
  /// One person: in the reserve at first, in the picture at column 20 at the last of six instants, 5 m apart in time.
  [[nodiscard]] std::vector<std::vector<Wanted>> wanted(int picture_before = -1) const {
    std::vector<PaceInstant> instants(6);
    for (std::size_t k = 0; k < 6; ++k) {
      instants[k] = {{CellIndex::of(k == 5 ? 20 : 0)}, k == 0, 5.0};
      if (static_cast<int>(k) == picture_before) instants[k].own = {CellIndex(3)};
    }
    return leave_early(Ways(stage, 0.25), instants, reserve);
  }
  Stage stage;
  CellFlags reserve;
};

TEST_F(LeaveEarly, WhoHasFarToGoGoesInTime) {
  const auto where = wanted();
  EXPECT_TRUE(where[0][0].own);
  const double home_x = stage.grid.centre(Cell{0, 0}).x;
  // 4.25 m an interval, counted back from 20 m: 15.75, 11.5, 7.25, then 5 m can be walked at once from 3.
  EXPECT_NEAR(where[4][0].at.x - home_x, 15.75, 1e-9);
  EXPECT_NEAR(where[3][0].at.x - home_x, 11.5, 1e-9);
  EXPECT_NEAR(where[2][0].at.x - home_x, 7.25, 1e-9);
  EXPECT_NEAR(where[1][0].at.x - home_x, 3.0, 1e-9);
  EXPECT_FALSE(where[1][0].own);
  EXPECT_TRUE(where[5][0].own);
}

TEST_F(LeaveEarly, NobodyLeavesThePictureEarly) {
  const auto where = wanted(3);
  EXPECT_TRUE(where[3][0].own);
  EXPECT_EQ(where[3][0].at, stage.grid.centre(CellIndex(3)));
  EXPECT_FALSE(where[4][0].own);  // from there the reserve is skipped
}

TEST(PacedLength, LeavesRoomForTheSnapToCells) {
  EXPECT_DOUBLE_EQ(paced_m(4.5, 1.0), 3.75);
  EXPECT_DOUBLE_EQ(paced_m(1.0, 1.0), 0.5);
}

}  // namespace
}  // namespace footlight::planner
