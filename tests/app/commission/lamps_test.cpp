// SPDX-License-Identifier: Apache-2.0
#include "app/commission/lamps.hpp"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

Rig rig_of(const Grid& grid) { return tests::lamps_everywhere(grid, {BusKind::can, BusKind::serial}, 115'200, 5); }

TEST(Lamps, AreTheChannelsOfTheRigButNoWearables) {
  const Grid grid = Grid::make(GridKind::square, 5, 2, 1).value();
  Rig rig = rig_of(grid);
  rig.nodes[0].channels[1] = {Channel::Kind::wearable, {}, PerformerIndex(0)};
  rig.nodes[1].channels[0] = {};
  const auto lamps = lamps_of(rig);
  ASSERT_EQ(lamps.size(), 9U);
  EXPECT_EQ(lamps[1].place.channel, 2);
  EXPECT_EQ(lamps[4].cell, std::nullopt);
  EXPECT_EQ(lamp_name(rig, lamps[1].place), "bus1/1/2");
}

TEST(WalkingOrder, GoesThereAndBackRowByRow) {
  const Grid grid = Grid::make(GridKind::square, 4, 3, 1).value();
  const Rig rig = rig_of(grid);
  const auto lamps = lamps_of(rig);
  std::string cells;
  for (const std::size_t i : walking_order(lamps, grid, WalkOrder::floor)) cells += grid.name(*lamps[i].cell) + " ";
  EXPECT_EQ(cells, "A1 B1 C1 D1 D2 C2 B2 A2 A3 B3 C3 D3 ");
}

TEST(WalkingOrder, IsAPermutationWithShortWays) {
  EXPECT_TRUE(rc::check([] {
    const int columns = *rc::gen::inRange(1, 12);
    const int rows = *rc::gen::inRange(1, 12);
    const Grid grid = Grid::make(GridKind::square, columns, rows, 1).value();
    const Rig rig = rig_of(grid);
    const auto lamps = lamps_of(rig);
    for (const WalkOrder order : {WalkOrder::floor, WalkOrder::bus}) {
      auto walk = walking_order(lamps, grid, order);
      for (std::size_t i = 1; i < walk.size() && order == WalkOrder::floor; ++i) {
        RC_ASSERT(distance(grid.centre(*lamps[walk[i - 1]].cell), grid.centre(*lamps[walk[i]].cell)) < 1.01);
      }
      std::ranges::sort(walk);
      for (std::size_t i = 0; i < walk.size(); ++i) RC_ASSERT(walk[i] == i);
    }
  }));
}

TEST(Places, LampsThatWereSeenAreThereAndTheOthersWhereNobodyElseIs) {
  const Grid grid = Grid::make(GridKind::square, 5, 2, 1).value();
  const Rig rig = rig_of(grid);
  const auto lamps = lamps_of(rig);
  std::vector<std::optional<CellIndex>> seen(lamps.size());
  seen[0] = lamps[3].cell;  // lamp 3 was not seen: its cell is another's now
  const Rig out = with_places(rig, lamps, seen);
  const auto after = lamps_of(out);
  EXPECT_EQ(after[0].cell, lamps[3].cell);
  EXPECT_EQ(after[3].cell, std::nullopt);
  EXPECT_EQ(after[1].cell, lamps[1].cell);
  std::set<CellIndex> cells;
  for (const FloorLamp& lamp : after) EXPECT_TRUE(!lamp.cell || cells.insert(*lamp.cell).second);
}

TEST(Digests, TellPlacesAndWiringApart) {
  const Grid grid = Grid::make(GridKind::square, 5, 4, 1).value();
  const Rig rig = rig_of(grid);
  Rig moved = rig;
  std::swap(moved.nodes[0].channels[0], moved.nodes[1].channels[3]);
  EXPECT_NE(places_digest(rig), places_digest(moved));
  EXPECT_EQ(wiring_tag(rig), wiring_tag(moved));
  Rig renamed = rig;
  renamed.nodes[0].name = "first";
  renamed.buses[0].url = "can://can0";
  EXPECT_EQ(places_digest(rig), places_digest(renamed));
  Rig readdressed = rig;
  readdressed.nodes[0].address = 77;
  EXPECT_NE(places_digest(rig), places_digest(readdressed));
  EXPECT_NE(wiring_tag(rig), wiring_tag(readdressed));
}

}  // namespace
}  // namespace footlight::app
