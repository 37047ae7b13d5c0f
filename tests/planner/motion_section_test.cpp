// SPDX-License-Identifier: Apache-2.0
#include "planner/motion_section.hpp"

#include <algorithm>
#include <map>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "core/motion.hpp"
#include "planner/plan_show.hpp"
#include "planner/validate.hpp"
#include "tests/planner/small_show.hpp"
#include "tests/support/outside_judge.hpp"
#include "tests/support/plan_builder.hpp"

namespace footlight::planner {
namespace {

using test::cells_in;
using test::section_of;
using test::show_with;
using testing::HasSubstr;

CellsSource listed(std::vector<CellIndex> cells, std::vector<std::optional<GroupIndex>> groups = {}) {
  return {"list.csv", std::move(cells), false, std::move(groups)};
}

void add_motion(Show& show, const char* name, Source to, double start, double duration, Motion motion = {}) {
  Section section = section_of(name, std::move(to), start, duration, 0, 40);
  section.planner.model = PlannerModel::swarm;
  if (std::holds_alternative<std::monostate>(motion.options)) motion.options = SwarmOptions{};
  section.motion = std::make_shared<Motion>(std::move(motion));
  show.sections.push_back(std::move(section));
}

/// Two groups of 12 in blocks at the sides, each with the other's block to go to.
Show crossing_show() {
  Show show = show_with(24, GridKind::square, 34, 16);
  show.groups = {{"left", {}, true}, {"right", {}, true}};
  for (std::size_t p = 0; p < 24; ++p) show.performers[p].group = GroupIndex::of(p % 2);
  const Grid& grid = show.stage.grid;
  std::vector<CellIndex> from = cells_in(grid, "C3:E6");
  std::vector<CellIndex> to = cells_in(grid, "AC10:AE13");
  const std::vector<CellIndex> right = cells_in(grid, "AC3:AE6");
  const std::vector<CellIndex> left = cells_in(grid, "C10:E13");
  from.insert(from.end(), right.begin(), right.end());
  to.insert(to.end(), left.begin(), left.end());
  std::vector<std::optional<GroupIndex>> groups(24, GroupIndex(0));
  std::fill(groups.begin() + 12, groups.end(), GroupIndex(1));
  show.sections.push_back(section_of("begin", listed(from, groups), 1, 0, 4, 30));
  add_motion(show, "cross", listed(to, groups), 5, 96);
  return show;
}

Planned planned_of(const Show& show) {
  auto planned = plan_show(show, std::vector<std::optional<Film>>(show.sections.size()));
  EXPECT_TRUE(planned) << (planned ? "" : planned.error().message);
  return planned ? std::move(planned).value() : Planned{};
}

std::string error_of(const Show& show) {
  const auto planned = plan_show(show, std::vector<std::optional<Film>>(show.sections.size()));
  EXPECT_FALSE(planned);
  return planned ? "" : planned.error().message;
}

std::vector<CellIndex> sorted(std::vector<CellIndex> cells) {
  std::sort(cells.begin(), cells.end());
  return cells;
}

TEST(MotionSection, EndsInItsOwnFormationWithEverybodyInHerGroup) {
  const Show show = crossing_show();
  const Planned planned = planned_of(show);
  EXPECT_TRUE(planned.plan.valid) << testing::PrintToString(planned.refusal);
  const Formation& last = planned.plan.formations.back();
  const auto& list = std::get<CellsSource>(show.sections[1].from);
  EXPECT_EQ(sorted(last.cells), sorted(list.cells));
  EXPECT_EQ(last.count, 101);
  EXPECT_TRUE(last.key);
  std::map<CellIndex, GroupIndex> place;
  for (std::size_t i = 0; i < 24; ++i) place[list.cells[i]] = *list.groups[i];
  for (std::size_t p = 0; p < 24; ++p) EXPECT_EQ(place[last.cells[p]], *show.performers[p].group) << p;
}

TEST(MotionSection, HasAMarkEveryFewCountsAndSaysHowFarMarksAreFromTheWay) {
  const Planned planned = planned_of(crossing_show());
  std::vector<double> counts;
  for (const Formation& one : planned.plan.formations) counts.push_back(one.count);
  // The one before ends when this begins: nobody needs a mark then.
  ASSERT_EQ(counts.size(), 1U + 24U);
  EXPECT_EQ(counts[0], 1);
  EXPECT_EQ(counts[1], 9);
  EXPECT_THAT(
      planned.plan.sections[1].notes,
      testing::Contains(testing::ContainsRegex(
          "25 marks, every 4 counts where that is enough, are 0\\.[0-9]+ m from the model's way, at most [0-9.]+ m")));
}

TEST(MotionSection, AfterAPauseEverybodyStandsUntilItBegins) {
  Show show = crossing_show();
  show.sections[1].start_count = 13;
  const Planned planned = planned_of(show);
  EXPECT_TRUE(planned.plan.valid) << testing::PrintToString(planned.refusal);
  EXPECT_EQ(planned.plan.formations[1].count, 13);
  EXPECT_EQ(planned.plan.formations[1].cells, planned.plan.formations[0].cells);
}

TEST(MotionSection, IsTheSameForAnyNumberOfThreads) {
  const Show show = crossing_show();
  std::vector<Plan> plans;
  for (const std::size_t threads : {1U, 2U, 8U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    plans.push_back(planned_of(show).plan);
  }
  EXPECT_EQ(plans[0], plans[1]);
  EXPECT_EQ(plans[0], plans[2]);
}

TEST(MotionSection, IsPlannedAgainAsTheFirstTime) {
  const Show show = crossing_show();
  Stages stages;
  const Reuse reuse{&stages, std::vector<std::string>(show.sections.size())};
  const std::vector<std::optional<Film>> films(show.sections.size());
  const auto first = plan_show(show, films, {}, reuse);
  const auto again = plan_show(show, films, {}, reuse);
  ASSERT_TRUE(first && again);
  EXPECT_EQ(first->plan, again->plan);
  EXPECT_EQ(again->walks.anew, 0U);
  EXPECT_EQ(first->plan, planned_of(show).plan);
}

TEST(MotionSection, WhoFollowsAModelKeepsHerTrackBetweenFormationsOfGroups) {
  // Nobody is led anywhere else than the model led whoever stood there: ways of a group's people do not jump.
  Show show = crossing_show();
  const Planned planned = planned_of(show);
  const Grid& grid = show.stage.grid;
  for (std::size_t f = 2; f < planned.plan.formations.size(); ++f) {
    for (std::size_t p = 0; p < 24; ++p) {
      const double walk_m = distance(grid.centre(planned.plan.formations[f - 1].cells[p]),
                                     grid.centre(planned.plan.formations[f].cells[p]));
      EXPECT_LE(walk_m, 2.8 + 1e-6);
    }
  }
}

/// The crossing by short range destinations, with nothing left to chance.
Show srd_show(double agility, double reaction_s) {
  Show show = crossing_show();
  Motion motion;
  SrdOptions options;
  options.agility = agility;
  options.reaction_s = reaction_s;
  options.variation = 0;
  motion.options = options;
  show.sections[1].planner.model = PlannerModel::srd;
  show.sections[1].motion = std::make_shared<Motion>(std::move(motion));
  return show;
}

TEST(MotionSection, AgilityAndReactionOfAGroupsPeopleReachTheModel) {
  Show own = srd_show(1, 0.3);
  for (Performer& performer : own.performers) {
    performer.agility = 3;
    performer.reaction_s = 2;
  }
  // As if the model had been told; so many decimals of everybody's way cannot be equal by chance.
  EXPECT_EQ(planned_of(own).plan.tracks, planned_of(srd_show(3, 2)).plan.tracks);
  EXPECT_NE(planned_of(own).plan.tracks, planned_of(srd_show(1, 0.3)).plan.tracks);
  // Of a group whose places are anybody's the slowest counts.
  for (std::size_t p = 2; p < own.performers.size(); ++p) own.performers[p].agility = 3.5;
  for (std::size_t p = 2; p < own.performers.size(); ++p) own.performers[p].reaction_s = 1;
  EXPECT_EQ(planned_of(own).plan.tracks, planned_of(srd_show(3, 2)).plan.tracks);
}

/// Two blocks of 6 x 6, a metre from neighbour to neighbour, that change sides on cells of half a metre.
Show dense_show(const std::vector<Cell>& blocked = {}) {
  Show show = show_with(72);
  show.stage.grid = *Grid::make(GridKind::square, 120, 60, 0.5);
  const Grid& grid = show.stage.grid;
  for (const Cell cell : blocked) show.stage.blocked.push_back(grid.index(cell));
  std::sort(show.stage.blocked.begin(), show.stage.blocked.end());
  show.tempo = TempoMap(120);
  show.groups = {{"left", {}, true}, {"right", {}, true}};
  std::vector<CellIndex> from;
  std::vector<CellIndex> to;
  std::vector<std::optional<GroupIndex>> groups;
  for (int p = 0; p < 72; ++p) {
    const int n = p / 2;
    const Cell left{10 + 2 * (n % 6), 24 + 2 * (n / 6)};
    const Cell right{100 + 2 * (n % 6), 24 + 2 * (n / 6)};
    from.push_back(grid.index(p % 2 == 0 ? left : right));
    to.push_back(grid.index(p % 2 == 0 ? right : left));
    groups.emplace_back(GroupIndex::of(p % 2));
    show.performers[static_cast<std::size_t>(p)].group = groups.back();
  }
  show.sections.push_back(section_of("begin", listed(from, groups), 1, 0, 4, 30));
  Motion motion;
  motion.options = SrdOptions{};
  add_motion(show, "cross", listed(to, groups), 6, 160, std::move(motion));
  show.sections[1].planner.model = PlannerModel::srd;
  return show;
}

TEST(MotionSection, DenseFormationsCrossHeadOnOnCells) {
  std::vector<Cell> wall;
  std::vector<Cell> gate;
  for (int row = 0; row < 60; ++row) {
    if (row >= 22 && row < 38) wall.push_back({60, row});
    if (row < 20 || row >= 40) gate.push_back({60, row});
  }
  for (const auto& blocked : {std::vector<Cell>{}, wall, gate}) {
    const Planned planned = planned_of(dense_show(blocked));
    EXPECT_TRUE(planned.plan.valid) << blocked.size() << testing::PrintToString(planned.refusal);
    if (blocked != gate || !tests::OutsideJudge::missing().empty()) continue;  // one of them: it takes its time
    const tests::OutsideJudge outside;
    outside.write(planned.plan);
    EXPECT_EQ(tests::number_in(outside.check_marks(), "wrong"), 0.0);
  }
}

TEST(MotionSection, PeopleWhoAreNamedBeforeKeepTheirNames) {
  Show show = crossing_show();
  auto& begin = std::get<CellsSource>(show.sections[0].from);
  // By name: performers 1, 3, 5 ... are in the left group.
  std::vector<CellIndex> cells(24);
  for (std::size_t i = 0; i < 12; ++i) cells[2 * i] = begin.cells[i];
  for (std::size_t i = 0; i < 12; ++i) cells[2 * i + 1] = begin.cells[12 + i];
  begin.cells = cells;
  begin.groups.clear();
  begin.assigned = true;
  const Planned planned = planned_of(show);
  EXPECT_TRUE(planned.plan.valid) << testing::PrintToString(planned.refusal);
  EXPECT_EQ(planned.plan.formations.front().cells, cells);
  const auto& list = std::get<CellsSource>(show.sections[1].from);
  for (std::size_t p = 0; p < 24; ++p) {
    const auto at = std::find(list.cells.begin(), list.cells.end(), planned.plan.formations.back().cells[p]);
    EXPECT_EQ(list.groups[std::size_t(at - list.cells.begin())], show.performers[p].group);
  }
}

TEST(MotionSection, NamesAtItsEndAreThoseFromTheBeginning) {
  Show show = crossing_show();
  auto& begin = std::get<CellsSource>(show.sections[0].from);
  auto& end = std::get<CellsSource>(show.sections[1].from);
  begin.groups.clear();
  end.groups.clear();
  end.assigned = true;
  const Planned planned = planned_of(show);
  EXPECT_TRUE(planned.plan.valid) << testing::PrintToString(planned.refusal);
  EXPECT_EQ(planned.plan.formations.back().cells, end.cells);
}

TEST(MotionSection, NeedsASectionBefore) {
  Show show = crossing_show();
  show.sections.erase(show.sections.begin());
  EXPECT_EQ(error_of(show),
            "show.yaml:40:5: error: sections[0]: its model leads people from where the section before leaves them, and "
            "there is none before it (put a section before it that says where they begin, from cells, an image or "
            "parts)");
}

TEST(MotionSection, NeedsToKnowWhoIsInWhichGroup) {
  Show show = crossing_show();
  std::get<CellsSource>(show.sections[0].from).groups.clear();
  EXPECT_EQ(error_of(show),
            "show.yaml:40:5: error: sections[1]: it has places of the group 'left', and nothing says who is in which "
            "group when it begins: section 'begin' gives its places to anybody (let section 'begin' say whose its "
            "places are: cells with a column of groups or performers, or parts with groups)");
}

TEST(MotionSection, CannotKeepNamesAtBothEnds) {
  Show show = crossing_show();
  for (Section& section : show.sections) {
    std::get<CellsSource>(section.from).groups.clear();
    std::get<CellsSource>(section.from).assigned = true;
  }
  EXPECT_EQ(error_of(show),
            "show.yaml:40:5: error: sections[1]: who stands where is given by name at its beginning and at its end, "
            "and its model chooses (list the cells at its end by groups, or without names)");
}

Motion with_path(std::vector<Point> through) {
  Motion motion;
  motion.paths.push_back({GroupIndex(0), std::move(through), {"show.yaml", 44, 9}});
  return motion;
}

TEST(MotionSection, APathThroughAWallIsAnErrorAtItsPlace) {
  Show show = crossing_show();
  show.stage.blocked = {show.stage.grid.index({17, 8})};
  auto motion = with_path({{-10, 8.5}, {10, 8.5}});
  motion.options = SwarmOptions{};
  show.sections[1].motion = std::make_shared<Motion>(motion);
  EXPECT_EQ(error_of(show),
            "show.yaml:44:9: error: sections[1].paths[0]: the straight way from [-10 m, 8.5 m] to [10 m, 8.5 m] goes "
            "through blocked cells, or comes nearer than 0.25 m to one (put points in between that lead around them)");
  motion.paths[0].through = {{0.5, 8.5}};
  show.sections[1].motion = std::make_shared<Motion>(motion);
  EXPECT_EQ(error_of(show),
            "show.yaml:44:9: error: sections[1].paths[0]: the point [0.5 m, 8.5 m] is on a blocked cell, or nearer "
            "than 0.25 m to one (choose a point that is free)");
  motion.paths[0].through = {{0, 40}};
  show.sections[1].motion = std::make_shared<Motion>(motion);
  EXPECT_EQ(error_of(show),
            "show.yaml:44:9: error: sections[1].paths[0]: the point [0 m, 40 m] is off the floor (the nearest cell is "
            "Q16 at [-0.5 m, 15.5 m])");
}

TEST(MotionSection, MarksTooNearInTimeAreAnError) {
  Show show = crossing_show();
  Motion motion;
  motion.options = SwarmOptions{};
  motion.mark_counts = 1;
  show.sections[1].motion = std::make_shared<Motion>(motion);
  EXPECT_EQ(error_of(show),
            "show.yaml:40:5: error: sections[1].marks: in 1 count nobody comes to the next cell, 1 m away at 1.4 m/s "
            "(marks: 1.43 counts or more, or leave it out)");
}

TEST(MotionSection, ADurationInWhichNobodyCanMoveIsAnError) {
  Show show = crossing_show();
  show.sections[1].duration_counts = 1;
  EXPECT_EQ(error_of(show),
            "show.yaml:40:5: error: sections[1]: in 1 count nobody comes to the next cell, 1 m away at 1.4 m/s (a "
            "longer duration)");
}

TEST(MotionSection, KeepsOffWhatMoves) {
  Show show = crossing_show();
  // Through the middle of the floor from one side to the other and back, while people cross.
  Motion motion;
  motion.options = SwarmOptions{};
  motion.obstacles = {{1, {{5, {0, -3}}, {53, {0, 8}}, {101, {0, -3}}}, {"show.yaml", 45, 9}}};
  show.sections[1].motion = std::make_shared<Motion>(motion);
  const Planned planned = planned_of(show);
  EXPECT_TRUE(planned.plan.valid) << testing::PrintToString(planned.refusal);
  ASSERT_EQ(planned.plan.sections[1].obstacles.size(), 1U);
  EXPECT_EQ(planned.plan.sections[1].obstacles[0].at[1].time, show.tempo.at(53));
  // The same plan without the care taken: the judge would have seen it.
  Plan through = planned_of(crossing_show()).plan;
  through.sections[1].obstacles = {{3, {{show.tempo.at(5), {0, 8}}}}};
  EXPECT_FALSE(validate(through).valid());
}

TEST(MotionSection, SomethingThatEndsOnItsPlacesIsAnError) {
  Show show = crossing_show();
  Motion motion;
  motion.options = SwarmOptions{};
  motion.obstacles = {{1, {{5, {0, 0}}, {53, {-13, 11}}}, {"show.yaml", 45, 9}}};
  show.sections[1].motion = std::make_shared<Motion>(motion);
  EXPECT_THAT(error_of(show), HasSubstr("show.yaml:45:9: error: sections[1].obstacles: somebody stands on "));
  EXPECT_THAT(error_of(show), HasSubstr(" when the section ends, where it is then, or nearer to it than 0.25 m "
                                        "(another way for the obstacle, or other places)"));
}

TEST(MotionSection, ModelsFollowOneAnotherInOneShow) {
  // A film, srd, collective, a list: one track for everybody, and other hands find nothing wrong.
  Show show = show_with(40, GridKind::square, 30, 20);
  Section film = section_of("film", test::video(), 1, 60, 0, 31);
  show.sections.push_back(film);
  Motion srd;
  srd.options = SrdOptions{};
  Motion collective;
  collective.options = CollectiveOptions{};
  add_motion(show, "there", listed(cells_in(show.stage.grid, "C3:L6")), 61, 80, srd);
  add_motion(show, "back", listed(cells_in(show.stage.grid, "R12:AA15")), 145, 80, collective);
  show.sections.push_back(section_of("list", listed(cells_in(show.stage.grid, "K8:T11")), 290, 0, 8, 34));
  std::vector<std::optional<Film>> films(4);
  films[0] = tests::film_of(30, [](int f) { return tests::disc(80, 60, 25 + f, 30, 18); });
  const auto planned = plan_show(show, films);
  ASSERT_TRUE(planned) << planned.error().message;
  EXPECT_TRUE(planned->plan.valid) << testing::PrintToString(planned->refusal);
  EXPECT_EQ(sorted(planned->plan.formations[planned->plan.formations.size() - 2].cells),
            sorted(cells_in(show.stage.grid, "R12:AA15")));
  for (const auto& track : planned->plan.tracks) EXPECT_EQ(track.back().time, show.tempo.at(298));
  if (!tests::OutsideJudge::missing().empty()) return;
  const tests::OutsideJudge outside;
  outside.write(planned->plan);
  EXPECT_EQ(tests::number_in(outside.check_marks(), "wrong"), 0.0);
}

TEST(MotionSection, StopsWhenTold) {
  const Show show = crossing_show();
  const std::atomic<bool> stop = true;
  const auto planned = plan_show(show, std::vector<std::optional<Film>>(2), {{}, &stop});
  ASSERT_FALSE(planned);
  EXPECT_EQ(planned.error().kind, ErrorKind::interrupted);
}

}  // namespace
}  // namespace footlight::planner
