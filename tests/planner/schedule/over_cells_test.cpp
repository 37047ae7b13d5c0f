// SPDX-License-Identifier: Apache-2.0
// Whole shows with `walk: cells`.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"
#include "planner/plan_show.hpp"
#include "planner/validate.hpp"
#include "tests/planner/small_show.hpp"

namespace footlight::planner {
namespace {

using test::Films;
using test::three_films;

Show over_cells(GridKind kind, int people) {
  Show show = test::three_sections(people, kind);
  show.stage.walk = WalkKind::cells;
  show.stage.max_speed_mps = 2;
  return show;
}

/// Everybody goes to a neighbouring cell or stays, from whole count to whole count.
void expect_steps(const Show& show, const Plan& plan) {
  const Grid& grid = show.stage.grid;
  for (const std::vector<Mark>& track : plan.tracks) {
    for (std::size_t m = 1; m < track.size(); ++m) {
      if (track[m].cell == track[m - 1].cell) continue;
      const auto near = grid.neighbours(track[m - 1].cell);
      ASSERT_TRUE(std::find(near.begin(), near.end(), track[m].cell) != near.end());
      for (const Mark& mark : {track[m - 1], track[m]}) {
        const double count = show.tempo.count_at(mark.time);
        ASSERT_NEAR(count, std::round(count), 1e-6);
      }
    }
  }
}

TEST(OverCells, EverybodyStepsOnWholeCountsAndThePlanIsValid) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    constexpr GridKind kKinds[] = {GridKind::square, GridKind::hexagonal, GridKind::triangular};
    Show show = over_cells(kKinds[rng.below(3)], 6 + static_cast<int>(rng.below(60)));
    if (rng.below(3) == 0 && show.stage.grid.kind() == GridKind::square) {
      show.stage.blocked = test::cells_in(show.stage.grid, "L7:M8");
    }
    if (rng.below(4) == 0) show.stage.max_speed_mps = 1.2;  // two counts a step
    const auto planned = plan_show(show, three_films());
    RC_ASSERT(planned.has_value());
    RC_ASSERT(planned->refusal.empty());
    RC_ASSERT(planned->plan.valid);
    expect_steps(show, planned->plan);
    // The images are exact: everybody stands where the picture is, each on a cell of her own.
    for (const std::size_t at : {std::size_t{0}, planned->plan.formations.size() - 1}) {
      std::vector<CellIndex> cells = planned->plan.formations[at].cells;
      std::sort(cells.begin(), cells.end());
      RC_ASSERT(std::adjacent_find(cells.begin(), cells.end()) == cells.end());
    }
  }));
}

TEST(OverCells, APlanMadeAgainFromItsStagesIsTheSame) {
  const Show show = over_cells(GridKind::square, 44);
  Stages stages;
  const Reuse reuse{&stages, {"a", "film", "b"}};
  const auto first = plan_show(show, three_films(), {}, reuse);
  ASSERT_TRUE(first) << first.error().message;
  const auto second = plan_show(show, Films(3), {}, reuse);
  ASSERT_TRUE(second) << second.error().message;
  EXPECT_EQ(second->plan, first->plan);
  EXPECT_EQ(second->walks.anew, 0U);
}

TEST(OverCells, ASectionThatLeavesTooFewCountsIsRefusedByHowManyAreMissing) {
  Show show = over_cells(GridKind::square, 30);
  show.sections.erase(show.sections.begin() + 1);
  show.sections[1].start_count = 13;  // eight counts after the hold of the first one
  Films two = three_films();
  two.erase(two.begin() + 1);
  const std::vector<PictureOptions> pictures{{Fit::contain, {}, {}}, {Fit::contain, {}, {}}};
  for (std::size_t s = 0; s < 2; ++s) std::get<ImageSource>(show.sections[s].from).picture = pictures[s];
  two[0] = tests::film_of(1, [](int) { return tests::disc(80, 60, 16, 30, 10); });
  two[1] = tests::film_of(1, [](int) { return tests::disc(80, 60, 66, 30, 10); });
  const auto planned = plan_show(show, two);
  ASSERT_TRUE(planned) << planned.error().message;
  EXPECT_FALSE(planned->plan.valid);
  ASSERT_EQ(planned->refusal.size(), 1U);
  EXPECT_EQ(
      planned->refusal[0],
      "show.yaml:13:5: error: sections[1]: the formation last/1 at count 13 cannot be reached over cells in time: "
      "it takes 14 steps of a count each at 2 m/s, and there are 8 counts from count 5 (6 counts more before it, or "
      "walk: straight)");
}

TEST(OverCells, NamedPeopleWhoStandInEachOthersWayStepAside) {
  Show show = test::show_with(24, GridKind::square, 24, 12);
  show.stage.walk = WalkKind::cells;
  show.stage.max_speed_mps = 2;
  const auto left = test::cells_in(show.stage.grid, "D4:F11");
  const auto right = test::cells_in(show.stage.grid, "R4:T11");
  std::vector<CellIndex> before(left.begin(), left.begin() + 12);
  before.insert(before.end(), right.begin(), right.begin() + 12);
  std::vector<CellIndex> after(right.begin(), right.begin() + 12);
  after.insert(after.end(), left.begin(), left.begin() + 12);
  show.sections = {test::section_of("before", CellsSource{"a.csv", before, true, {}}, 1, 0, 4, 11),
                   test::section_of("after", CellsSource{"b.csv", after, true, {}}, 90, 0, 4, 12)};
  const auto planned = plan_show(show, Films(2));
  ASSERT_TRUE(planned) << planned.error().message;
  EXPECT_EQ(planned->refusal, std::vector<std::string>());
  EXPECT_TRUE(planned->plan.valid);
  expect_steps(show, planned->plan);
  for (std::size_t p = 0; p < after.size(); ++p) {
    EXPECT_EQ(planned->plan.tracks[p].front().cell, before[p]);
    EXPECT_EQ(planned->plan.tracks[p].back().cell, after[p]);
  }
}

TEST(OverCells, NamedPeopleWhoCannotPassAreRefusedByNameAndNotByCounts) {
  Show show = test::show_with(2, GridKind::square, 6, 1);
  show.stage.walk = WalkKind::cells;
  show.stage.max_speed_mps = 2;
  const CellIndex left = show.stage.grid.index({0, 0});
  const CellIndex right = show.stage.grid.index({5, 0});
  CellsSource source;
  source.assigned = true;
  source.cells = {left, right};
  show.sections.push_back(test::section_of("one", source, 1, 0, 4, 31));
  source.cells = {right, left};
  show.sections.push_back(test::section_of("two", source, 65, 0, 4, 32));
  const auto planned = plan_show(show, Films(2));
  ASSERT_TRUE(planned);
  EXPECT_FALSE(planned->plan.valid);
  ASSERT_EQ(planned->refusal.size(), 1U);
  const std::string& text = planned->refusal[0];
  const std::string head =
      "show.yaml:32:5: error: sections[1]: performers 1 and 2 are in each other's way: no steps over cells were found "
      "on "
      "which they pass, and at count ";
  const std::string tail =
      " they would be 0.000 m apart (places that they may exchange, other places, a wider way, or walk: straight)";
  EXPECT_EQ(text.substr(0, head.size()), head);
  ASSERT_GT(text.size(), tail.size());
  EXPECT_EQ(text.substr(text.size() - tail.size()), tail);
}

TEST(OverCells, WhereACountIsTooShortAStepTakesTwoAndTheNotesSaySo) {
  Show show = over_cells(GridKind::square, 30);
  show.stage.max_speed_mps = 1.4;
  const auto planned = plan_show(show, three_films());
  ASSERT_TRUE(planned);
  const auto& notes = planned->plan.sections[1].notes;
  EXPECT_TRUE(
      std::find(notes.begin(), notes.end(),
                "a step from cell to cell takes 2 counts, since one of 0.5 s is too short for 1 m at 1.4 m/s") !=
      notes.end());
}

}  // namespace
}  // namespace footlight::planner
