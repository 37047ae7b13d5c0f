// SPDX-License-Identifier: Apache-2.0
#include "planner/parts_section.hpp"

#include <algorithm>
#include <numbers>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/parts.hpp"
#include "planner/plan_show.hpp"
#include "planner/validate.hpp"
#include "tests/planner/small_show.hpp"

namespace footlight::planner {
namespace {

using test::show_with;
using Kind = Shape::Kind;

Part part_of(Kind kind, Point at, double size_m, int line = 20) {
  Part out;
  Shape shape;
  shape.kind = kind;
  out.drawing = shape;
  out.at = at;
  const bool round = kind == Kind::circle || kind == Kind::ring || kind == Kind::arc || kind == Kind::spiral;
  (round ? out.radius_m : out.width_m) = size_m;
  out.position = {"show.yaml", line, 9};
  return out;
}

/// People in two groups, who draw the parts.
Show two_groups(int left, int right, std::vector<Part> parts) {
  Show show = show_with(left + right);
  show.groups = {{"left", {}, true}, {"right", {}, true}};
  for (int p = 0; p < left + right; ++p) {
    show.performers[static_cast<std::size_t>(p)].group = GroupIndex::of(p < left ? 0 : 1);
  }
  PartsSource source{std::make_shared<const std::vector<Part>>(std::move(parts))};
  show.sections = {test::section_of("first", source, 1, 0, 4, 11)};
  return show;
}

Result<SectionPlan> planned(const Show& show) {
  return plan_section(show, SectionIndex(0), std::nullopt, Ways(show.stage, show.stage.clearance_m / 2), nullptr, {});
}

std::string refused(const Show& show) {
  const auto plan = planned(show);
  return plan ? "planned" : plan.error().message;
}

std::vector<std::string> names(const Show& show, const std::vector<CellIndex>& cells) {
  std::vector<std::string> out;
  for (const CellIndex cell : cells) out.push_back(show.stage.grid.name(cell));
  return out;
}

TEST(Parts, PutTheirPeopleOnTheNearestCells) {
  Show show = two_groups(0, 5, {part_of(Kind::line, {0.5, 4.5}, 4)});
  const auto plan = planned(show);
  ASSERT_TRUE(plan) << plan.error();
  const Station& station = plan->stations.at(0);
  EXPECT_THAT(names(show, station.cells), testing::ElementsAre("N5", "O5", "P5", "Q5", "R5"));
  EXPECT_TRUE(station.groups.empty()) << "they are nobody's in particular";
  EXPECT_EQ(station.in_picture, 5);
  EXPECT_TRUE(station.exact);
  EXPECT_EQ(station.depart, show.tempo.at(5));
}

TEST(Parts, AreTurnedCounterClockwiseAroundTheirMiddle) {
  Part line = part_of(Kind::line, {0.5, 4.5}, 4);
  line.turn_rad = std::numbers::pi / 2;
  Show show = two_groups(0, 5, {line});
  const auto plan = planned(show);
  ASSERT_TRUE(plan) << plan.error();
  EXPECT_THAT(names(show, plan->stations.at(0).cells), testing::ElementsAre("P3", "P4", "P5", "P6", "P7"));
}

TEST(Parts, OfGroupsAreTheirPlaces) {
  Part left = part_of(Kind::circle, {-8, 8}, 4);
  left.group = GroupIndex(0);
  Show show = two_groups(20, 30, {left, part_of(Kind::ring, {7, 8}, 6)});
  const auto plan = planned(show);
  ASSERT_TRUE(plan) << plan.error();
  const Station& station = plan->stations.at(0);
  ASSERT_EQ(station.groups.size(), 50U);
  for (std::size_t i = 0; i < 50; ++i) {
    EXPECT_EQ(station.groups[i], i < 20 ? std::optional(GroupIndex(0)) : std::nullopt) << i;
    EXPECT_EQ(show.stage.grid.centre(station.cells[i]).x < 0, i < 20) << i;
  }
}

TEST(Parts, OfOneGroupShareItEvenlyBesideThoseWithANumber) {
  Part given = part_of(Kind::line, {0, 2}, 12);
  given.people = 7;
  Show show = two_groups(0, 20, {part_of(Kind::line, {-6, 9}, 9), given, part_of(Kind::line, {6, 16}, 9)});
  const auto plan = planned(show);
  ASSERT_TRUE(plan) << plan.error();
  std::map<int, int> rows;
  for (const CellIndex cell : plan->stations.at(0).cells) ++rows[show.stage.grid.cell(cell).row / 4];
  EXPECT_EQ(rows, (std::map<int, int>{{0, 7}, {2, 7}, {3, 6}}));
}

TEST(Parts, LeaveWhoIsInNoneToTheReserve) {
  Part part = part_of(Kind::line, {0, 9}, 9);
  part.group = GroupIndex(0);
  part.people = 6;
  Show show = two_groups(8, 3, {part});
  show.stage.reserve = test::cells_in(show.stage.grid, "A1:A6");
  const auto plan = planned(show);
  ASSERT_TRUE(plan) << plan.error();
  const Station& station = plan->stations.at(0);
  EXPECT_EQ(station.cells.size(), 11U);
  EXPECT_EQ(station.in_picture, 6);
  EXPECT_EQ(std::count(station.groups.begin(), station.groups.end(), std::optional(GroupIndex(0))), 8);
  for (std::size_t i = 6; i < 11; ++i) EXPECT_EQ(show.stage.grid.cell(station.cells[i]).column, 0) << i;
}

TEST(Parts, OfAWholeShowAreWalkedAndJudged) {
  Part left = part_of(Kind::circle, {-8, 9}, 5);
  left.group = GroupIndex(0);
  Part right = part_of(Kind::wedge, {8, 9}, 12);
  right.group = GroupIndex(1);
  Show show = two_groups(24, 21, {left, right});
  Part across = left;
  across.at = Point{8, 9};
  Part back = right;
  back.at = Point{-8, 9};
  PartsSource second{std::make_shared<const std::vector<Part>>(std::vector<Part>{across, back})};
  show.sections.push_back(test::section_of("second", second, 60, 0, 4, 12));
  const auto made = plan_show(show, {std::nullopt, std::nullopt});
  ASSERT_TRUE(made) << made.error();
  EXPECT_TRUE(made->plan.valid) << testing::PrintToString(made->refusal);
  ASSERT_EQ(made->plan.formations.size(), 2U);
  for (std::size_t p = 0; p < 45; ++p) {
    EXPECT_EQ(show.stage.grid.centre(made->plan.formations[0].cells[p]).x < 0, p < 24) << p;
    EXPECT_EQ(show.stage.grid.centre(made->plan.formations[1].cells[p]).x < 0, p >= 24) << p;
  }
}

TEST(Parts, OfAnyKindAndTurnHaveDistinctCellsThatCanBeStoodOn) {
  EXPECT_TRUE(rc::check([] {
    Show show = show_with(*rc::gen::inRange(1, 60), static_cast<GridKind>(*rc::gen::inRange(0, 3)), 40, 40);
    show.stage.blocked = test::cells_in(show.stage.grid, "T20:U21");
    Part part = part_of(static_cast<Kind>(*rc::gen::inRange(0, 8)), {0, 0}, 0);
    part.at.reset();
    part.turn_rad = 0.01 * *rc::gen::inRange(0, 628);
    part.spacing_m = show.performers.size() > 20 ? 1.0 : 1.7;
    PartsSource source{std::make_shared<const std::vector<Part>>(std::vector<Part>{part})};
    show.sections = {test::section_of("first", source, 1, 0, 4, 11)};
    const Ways ways(show.stage, show.stage.clearance_m / 2);
    const auto plan = plan_section(show, SectionIndex(0), std::nullopt, ways, nullptr, {});
    if (!plan) RC_DISCARD(plan.error().message.c_str());
    const auto& cells = plan->stations.at(0).cells;
    RC_ASSERT(cells.size() == show.performers.size());
    RC_ASSERT(std::set<CellIndex>(cells.begin(), cells.end()).size() == cells.size());
    for (const CellIndex cell : cells) RC_ASSERT(ways.can_stand(cell));
  }));
}

TEST(Parts, ThatAreTooSmallSayHowMuch) {
  EXPECT_EQ(refused(two_groups(0, 21, {part_of(Kind::line, {0, 9}, 10)})),
            "show.yaml:20:9: error: sections[0].from: the line is too small for its 21 people: they would stand 0.5 m "
            "apart (1 m are needed: 2 times as large, or fewer people)");
  EXPECT_EQ(
      refused(two_groups(0, 375, {part_of(Kind::circle, {0, 9}, 6)})),
      "show.yaml:20:9: error: sections[0].from: the circle is too small for its 375 people: they would stand 0.58 "
      "m apart (1 m are needed: 1.7 times as large, or fewer people)");
}

TEST(Parts, OffTheStageSayWhereItEnds) {
  EXPECT_EQ(
      refused(two_groups(0, 11, {part_of(Kind::line, {12, 9}, 10)})),
      "show.yaml:20:9: error: sections[0].from: 2 of the 11 people of the line would stand off the stage, up to 2 m "
      "(the floor is -15 m to 15 m from side to side and 0 m to 20 m deep)");
}

TEST(Parts, ThatAskForMorePeopleThanThereAreSayHowMany) {
  Part one = part_of(Kind::line, {0, 9}, 8);
  one.group = GroupIndex(0);
  one.people = 7;
  Part two = part_of(Kind::line, {0, 5}, 8, 21);
  two.group = GroupIndex(0);
  two.people = 4;
  EXPECT_EQ(
      refused(two_groups(10, 3, {one, two})),
      "show.yaml:21:9: error: sections[0].from.parts[1]: 4 people, but the group 'left' has 10 (at most 3 are left "
      "for this part)");
  two.people.reset();
  one.people = 10;
  EXPECT_EQ(refused(two_groups(10, 3, {one, two})),
            "show.yaml:21:9: error: sections[0].from.parts[1]: nobody is left for it: the group 'left' has 10 people "
            "(fewer people in other parts, or one part less)");
}

TEST(Parts, WithoutRoomForWhoIsInNoneSayHowManyTheyAre) {
  Part part = part_of(Kind::line, {0, 9}, 9);
  part.group = GroupIndex(0);
  EXPECT_EQ(
      refused(two_groups(8, 3, {part})),
      "show.yaml:20:9: error: sections[0].from: 3 performers are in no part, and the reserve has room for 0 (more "
      "people in parts, or more reserve cells)");
}

TEST(Parts, WithoutFreeCellsSayWhatIsInTheWay) {
  Show show = two_groups(0, 9, {part_of(Kind::line, {0.5, 9.5}, 8)});
  show.stage.blocked = test::cells_in(show.stage.grid, "A1:AD20");
  EXPECT_EQ(refused(show),
            "show.yaml:20:9: error: sections[0].from: not all of the 9 people of the line find a cell of their own "
            "(blocked cells, the reserve or parts before it are in the way)");
}

TEST(Parts, AreRefusedWhereTheirCellsAreNearerThanTheClearance) {
  Part line = part_of(Kind::line, {0.3, 9.2}, 9.2);
  line.turn_rad = 0.35;
  Show show = two_groups(0, 8, {line});
  show.stage.clearance_m = 1.3;
  const std::string text = refused(show);
  EXPECT_THAT(text, testing::StartsWith("show.yaml:20:9: error: sections[0].from: the nearest cells for it bring two "
                                        "people to "));
}

}  // namespace
}  // namespace footlight::planner
