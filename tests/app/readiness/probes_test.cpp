// SPDX-License-Identifier: Apache-2.0
#include "app/readiness/probes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<std::string> cells_of(const std::vector<FloorLamp>& lamps, const Grid& grid) {
  std::vector<std::string> cells;
  for (const std::size_t lamp : probe_lamps(lamps, grid)) cells.push_back(grid.name(*lamps[lamp].cell));
  return cells;
}

class Probes : public ::testing::Test {
 protected:
  Probes()
      : small_(tests::random_show(6, 4, 4, 1, 2, 1)),
        grid_(small_.show.stage.grid),
        lamps_(lamps_of(tests::lamps_everywhere(grid_, {BusKind::serial}, 115'200))) {}

  tests::SmallShow small_;
  const Grid& grid_;
  std::vector<FloorLamp> lamps_;
};

TEST_F(Probes, AreThreeCornersThatNoTurnShiftOrMirrorKeeps) {
  EXPECT_THAT(cells_of(lamps_, grid_), ElementsAre("A1", "F1", "F4"));
}

TEST_F(Probes, AreTheNearestWhereTheCornersHaveNoLamp) {
  std::erase_if(lamps_, [&](const FloorLamp& lamp) { return grid_.name(*lamp.cell) == "F4"; });
  EXPECT_THAT(cells_of(lamps_, grid_), ElementsAre("A1", "F1", ::testing::AnyOf("E4", "F3")));
}

TEST_F(Probes, AreAsManyAsThereAreLampsWithACell) {
  lamps_.resize(2);
  lamps_[1].cell.reset();
  EXPECT_THAT(cells_of(lamps_, grid_), ElementsAre("A1"));
  EXPECT_THAT(probe_lamps({}, grid_), IsEmpty());
}

TEST(ProbeAnswers, NobodyConfirmsByAccident) {
  EXPECT_EQ(probe_answer("yes"), ProbeAnswer::yes);
  EXPECT_EQ(probe_answer("n"), ProbeAnswer::no);
  EXPECT_EQ(probe_answer("skip"), ProbeAnswer::skip);
  for (const char* line : {"", "ok", "yess", "go"}) EXPECT_EQ(probe_answer(line), ProbeAnswer::unclear) << line;
}

}  // namespace
}  // namespace footlight::app
