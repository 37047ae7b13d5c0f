// SPDX-License-Identifier: Apache-2.0
#include "app/freeze_watch.hpp"

#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "tests/support/plan_builder.hpp"

namespace footlight::app {
namespace {

using tests::mark_at;
using Phase = controller::Rehearsal::Phase;

Grid squares() { return Grid::make(GridKind::square, 8, 6, 1.0).value(); }

/// Two in a file, a metre apart, who walk for three seconds: until 2.4 s the one behind may run into who has stopped.
Plan file() {
  const Grid grid = squares();
  Plan plan = tests::plan_of(grid, {{mark_at(0, grid, 1, 1), mark_at(3, grid, 4, 1), mark_at(4, grid, 4, 1)},
                                    {mark_at(0, grid, 2, 1), mark_at(3, grid, 5, 1), mark_at(4, grid, 5, 1)}});
  plan.stage.clearance_m = 0.4;
  return plan;
}

Plan two_who_stand() {
  const Grid grid = squares();
  return tests::plan_of(
      grid, {{mark_at(0, grid, 1, 1), mark_at(9, grid, 1, 1)}, {mark_at(0, grid, 4, 1), mark_at(9, grid, 4, 1)}});
}

FreezeView known(FreezeWatch& watch, const DeskView& view) {
  for (int i = 0; i < 4000; ++i) {
    if (const FreezeView seen = watch.look(view); seen.known) return seen;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  ADD_FAILURE() << "never judged";
  return {};
}

TEST(FreezeWatch, InTheShowItIsTheShowThatIsJudged) {
  const Plan plan = file();
  FreezeWatch watch(plan, {});
  DeskView view;
  view.show.phase = Phase::runs;
  view.show.position = instant_at(1);
  const FreezeView seen = known(watch, view);
  EXPECT_EQ(seen.pairs, 1U);
  EXPECT_NEAR(to_seconds(seen.none_from), 2.4, 2e-6);
}

TEST(FreezeWatch, InAResetMoveItIsTheResetMoveThatIsJudged) {
  const Plan plan = two_who_stand();
  FreezeWatch watch(plan, {});
  DeskView view;
  view.show.phase = Phase::stands;
  view.way = std::make_shared<const Plan>(file());
  EXPECT_EQ(known(watch, view).pairs, 0U) << "nobody walks by it yet";
  view.show.phase = Phase::resets;
  view.show.target.show_time = milliseconds(1000);
  const FreezeView seen = known(watch, view);
  EXPECT_EQ(seen.pairs, 1U);
  EXPECT_EQ(seen.none_from, kNever) << "no count of the show is a moment of it";
  view.show.target.show_time = milliseconds(2500);
  EXPECT_EQ(known(watch, view).pairs, 0U);
  view.show.phase = Phase::reset_held;
  view.show.target.show_time = milliseconds(1000);
  EXPECT_EQ(known(watch, view).resume_pairs, 1U);
}

TEST(FreezeWatch, AnotherWayIsJudgedAnew) {
  const Plan plan = two_who_stand();
  FreezeWatch watch(plan, {});
  DeskView view;
  view.show.phase = Phase::resets;
  view.show.target.show_time = milliseconds(1000);
  view.way = std::make_shared<const Plan>(file());
  EXPECT_EQ(known(watch, view).pairs, 1U);
  view.way = std::make_shared<const Plan>(two_who_stand());
  EXPECT_FALSE(watch.look(view).known);
  EXPECT_EQ(known(watch, view).pairs, 0U);
}

TEST(FreezeWatch, APlanThatIsTakenIsJudgedAnew) {
  Plan plan = file();
  FreezeWatch watch(plan, {});
  DeskView view;
  view.show.phase = Phase::runs;
  view.show.position = instant_at(1);
  EXPECT_EQ(known(watch, view).pairs, 1U);
  plan = two_who_stand();
  watch.plan_taken({});
  EXPECT_FALSE(watch.look(view).known);
  EXPECT_EQ(known(watch, view).pairs, 0U);
}

}  // namespace
}  // namespace footlight::app
