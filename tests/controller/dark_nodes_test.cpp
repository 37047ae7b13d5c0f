// SPDX-License-Identifier: Apache-2.0
#include "controller/dark_nodes.hpp"

#include <algorithm>
#include <utility>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "tests/support/small_show.hpp"

namespace footlight::controller {
namespace {

using tests::mark_at;
using tests::plan_of;

Grid floor6() { return Grid::make(GridKind::square, 6, 6, 1.0).value(); }

/// A node of its own for each listed cell; the other cells have no lamp.
Rig lamps_on(const Grid& grid, const std::vector<Cell>& cells) {
  Rig rig;
  rig.buses.push_back({"bus", BusKind::serial, "sim://serial", 115'200, std::nullopt, {}});
  for (const Cell cell : cells) {
    Node node;
    node.name = cell_name(cell);
    node.address = static_cast<int>(rig.nodes.size()) + 1;
    node.channels.push_back({Channel::Kind::cell, grid.index(cell), {}});
    rig.nodes.push_back(node);
  }
  return rig;
}

/// The first goes from A1 to B1 and on to C1; the second comes to A1 meanwhile, from A5.
Plan two_in_a_row() {
  const Grid grid = floor6();
  return plan_of(grid, {{mark_at(0, grid, 0, 0), mark_at(2, grid, 1, 0), mark_at(4, grid, 2, 0)},
                        {mark_at(0, grid, 0, 4), mark_at(2, grid, 0, 2), mark_at(4, grid, 0, 0)}});
}

TEST(DarkNodes, WhoIsNotShownHerPlaceIsWalkedIntoByWhoComesToHers) {
  const Plan plan = two_in_a_row();
  const auto units = find_dark_units(plan, lamps_on(floor6(), {{2, 0}, {1, 0}, {0, 0}}), 10);
  ASSERT_EQ(units.size(), 3U);
  // Dark B1: she waits on A1 until C1 is shown, and walks to it in the two seconds in which the second comes: who
  // begins two metres behind her and walks away at a right angle. Dark C1: she stays on B1, a metre from A1.
  for (const DarkUnit& unit : units) {
    EXPECT_EQ(unit.not_shown, 1U) << unit.name;
    EXPECT_EQ(unit.unsafe, 0U) << unit.name;
  }
  // Without C1's lamp either she stays on A1 for good.
  Rig rig = lamps_on(floor6(), {{2, 0}});
  rig.nodes[0].channels.push_back({Channel::Kind::cell, floor6().index({1, 0}), {}});
  const auto both = find_dark_units(plan, rig, 10);
  ASSERT_EQ(both.size(), 1U);
  EXPECT_EQ(both[0].not_shown, 2U);
  EXPECT_EQ(both[0].unsafe, 1U);
  ASSERT_EQ(both[0].worst.size(), 1U);
  const UnsafeCue& cue = both[0].worst[0];
  EXPECT_EQ(cue.who, PerformerIndex(0));
  EXPECT_EQ(cue.place, floor6().index({2, 0})) << "the walk she was last not shown";
  EXPECT_EQ(cue.told, instant_at(2));
  EXPECT_EQ(cue.other, PerformerIndex(1));
  EXPECT_EQ(cue.distance_m, 0.0);
  EXPECT_EQ(cue.at, instant_at(4));
}

TEST(DarkNodes, WhoWalksPastHerComesTooClose) {
  const Grid grid = floor6();
  // The first leaves B1 at once; the second walks along row 1 from A1 to F1 behind her.
  const Plan plan = plan_of(grid, {{mark_at(0, grid, 1, 0), mark_at(2, grid, 1, 3), mark_at(10, grid, 1, 3)},
                                   {mark_at(0, grid, 0, 0), mark_at(10, grid, 5, 0)}});
  const auto units = find_dark_units(plan, lamps_on(grid, {{1, 3}, {5, 0}}), 10);
  ASSERT_EQ(units.size(), 2U);
  EXPECT_EQ(units[0].name, "B4");
  EXPECT_EQ(units[0].unsafe, 1U);
  EXPECT_EQ(units[0].worst[0].distance_m, 0.0);
  EXPECT_EQ(units[0].worst[0].at, instant_at(2));
  EXPECT_EQ(units[1].name, "F1");
  EXPECT_EQ(units[1].unsafe, 0U) << "she stays in the corner";
}

TEST(DarkNodes, StandingOnTheWrongCellLastsUntilAPlaceIsShown) {
  const Grid grid = floor6();
  const Plan plan =
      plan_of(grid, {{mark_at(0, grid, 0, 0), mark_at(2, grid, 5, 0), mark_at(8, grid, 5, 0), mark_at(9, grid, 5, 1)},
                     {mark_at(0, grid, 0, 5), mark_at(4, grid, 0, 5), mark_at(7, grid, 0, 0), mark_at(9, grid, 0, 0)}});
  const auto units = find_dark_units(plan, lamps_on(grid, {{5, 0}, {5, 1}}), 10);
  EXPECT_EQ(units[0].name, "F1");
  EXPECT_EQ(units[0].unsafe, 1U) << "she waits on A1 for as long as she should wait on F1";
  EXPECT_EQ(units[0].worst[0].at, instant_at(7));
}

TEST(DarkNodes, ASupplyTakesAllOfItsNodesWithIt) {
  const Plan plan = two_in_a_row();
  Rig rig = lamps_on(floor6(), {{2, 0}, {1, 0}, {5, 5}});
  rig.nodes[0].supply = rig.nodes[1].supply = "left";
  rig.nodes[2].supply = "right";
  const auto units = find_dark_units(plan, rig, 10);
  ASSERT_EQ(units.size(), 5U);
  EXPECT_EQ(units[0].name, "left");
  EXPECT_EQ(units[0].kind, DarkUnit::Kind::supply);
  EXPECT_EQ(units[0].nodes, 2);
  EXPECT_EQ(units[0].not_shown, 2U);
  EXPECT_EQ(units[0].unsafe, 1U);
  EXPECT_EQ(units[4].name, "right");
  EXPECT_EQ(units[4].not_shown, 0U);
}

TEST(DarkNodes, TwoWhoAreNotShownTheirPlacesAreMeasuredWhereTheyAre) {
  const Grid grid = floor6();
  // Both should leave; neither does: nobody comes near anybody.
  const Plan plan = plan_of(
      grid, {{mark_at(0, grid, 0, 0), mark_at(2, grid, 0, 3)}, {mark_at(0, grid, 1, 0), mark_at(2, grid, 0, 0)}});
  Rig rig = lamps_on(grid, {{0, 3}});
  EXPECT_EQ(find_dark_units(plan, rig, 10)[0].unsafe, 1U) << "the second walks onto the first";
  rig.nodes[0].channels.push_back({Channel::Kind::cell, grid.index({0, 0}), {}});
  EXPECT_EQ(find_dark_units(plan, rig, 10)[0].not_shown, 2U);
  EXPECT_EQ(find_dark_units(plan, rig, 10)[0].unsafe, 0U);
}

TEST(DarkNodes, AWearableTellsWhereTheFloorHasNoLamp) {
  const Plan plan = two_in_a_row();
  Rig rig = lamps_on(floor6(), {{5, 5}});
  EXPECT_EQ(find_dark_units(plan, rig, 10)[0].not_shown, 0U) << "dot sheets go on";
  rig.nodes[0].channels.push_back({Channel::Kind::wearable, {}, PerformerIndex(0)});
  EXPECT_EQ(find_dark_units(plan, rig, 10)[0].not_shown, 2U);
  EXPECT_EQ(find_dark_units(plan, rig, 10)[0].unsafe, 1U);
}

TEST(DarkNodes, RadiiCount) {
  const Grid grid = floor6();
  Plan plan = plan_of(
      grid, {{mark_at(0, grid, 1, 1), mark_at(2, grid, 1, 4)}, {mark_at(0, grid, 0, 0), mark_at(2, grid, 3, 0)}});
  const Rig rig = lamps_on(grid, {{1, 4}});
  EXPECT_EQ(find_dark_units(plan, rig, 10)[0].unsafe, 0U) << "a metre";
  plan.radius_m = {0.6, 0.6};
  EXPECT_EQ(find_dark_units(plan, rig, 10)[0].unsafe, 1U);
}

/// The same by brute force: everybody's way under one dark node, sampled at every mark and between.
std::uint64_t pairs_too_close(const Plan& plan, const Rig& rig, std::size_t dark) {
  std::vector<std::vector<Mark>> tracks = plan.tracks;
  std::vector<std::vector<char>> astray(tracks.size());
  for (std::size_t p = 0; p < tracks.size(); ++p) {
    CellIndex here = tracks[p].front().cell;
    astray[p].assign(tracks[p].size(), 0);
    for (std::size_t k = 1; k < tracks[p].size(); ++k) {
      const CellIndex goal = plan.tracks[p][k].cell;
      const bool waits = goal == plan.tracks[p][k - 1].cell;
      bool shown = true;
      for (const Channel& channel : rig.nodes[dark].channels) shown = shown && (waits || channel.cell != goal);
      if (shown && !waits) here = goal;
      tracks[p][k].cell = here;
      astray[p][k] = here != goal ? 1 : 0;
    }
  }
  std::uint64_t people = 0;
  for (std::size_t a = 0; a < tracks.size(); ++a) {
    bool close = false;
    for (std::size_t k = 1; k < tracks[a].size(); ++k) {
      if (astray[a][k] == 0 && astray[a][k - 1] == 0) continue;
      for (std::size_t b = 0; b < tracks.size(); ++b) {
        if (a == b) continue;
        for (int n = 0; n <= 400; ++n) {
          const Instant at = tracks[a][k - 1].time + (tracks[a][k].time - tracks[a][k - 1].time) / 400 * n;
          close = close || distance(position_at(plan.stage.grid, tracks[a], at),
                                    position_at(plan.stage.grid, tracks[b], at)) < plan.stage.clearance_m - 0.02;
        }
      }
    }
    people += close ? 1 : 0;
  }
  return people;
}

TEST(DarkNodes, AgreesWithWalkingTheShowUnderEachDarkNode) {
  EXPECT_TRUE(rc::check([] {
    const auto small = tests::random_show(8, 6, 12, 1, 3, *rc::gen::inRange<std::uint64_t>(1, 1'000'000));
    const Rig rig = tests::lamps_everywhere(small.plan.stage.grid, {BusKind::serial}, 115'200, 8);
    const auto units = find_dark_units(small.plan, rig, 100);
    RC_ASSERT(units.size() == rig.nodes.size());
    for (std::size_t n = 0; n < rig.nodes.size(); ++n) {
      const auto unit =
          std::find_if(units.begin(), units.end(), [&](const DarkUnit& u) { return u.name == rig.nodes[n].name; });
      std::vector<char> who(small.plan.tracks.size(), 0);
      std::uint64_t people = 0;
      for (const UnsafeCue& cue : unit->worst) people += std::exchange(who[cue.who.at()], char{1}) == 0 ? 1 : 0;
      RC_ASSERT(people >= pairs_too_close(small.plan, rig, n));
    }
  }));
}

TEST(DarkNodes, KeepsNoMoreCuesThanAskedForAndPutsTheWorstUnitFirst) {
  const auto small = tests::random_show(12, 12, 60, 2, 4, 5);
  const Rig rig = tests::lamps_everywhere(small.plan.stage.grid, {BusKind::can}, 500'000, 16);
  const auto units = find_dark_units(small.plan, rig, 3);
  for (std::size_t n = 0; n < units.size(); ++n) {
    EXPECT_LE(units[n].worst.size(), 3U);
    EXPECT_LE(units[n].unsafe, units[n].not_shown);
    EXPECT_LE(units[n].unsafe, units[n == 0 ? 0 : n - 1].unsafe);
  }
  EXPECT_GT(units.front().unsafe, 0U);
}

}  // namespace
}  // namespace footlight::controller
