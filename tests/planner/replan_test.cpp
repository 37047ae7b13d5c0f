// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"
#include "planner/measure.hpp"
#include "planner/plan_show.hpp"
#include "planner/validate.hpp"
#include "tests/planner/small_show.hpp"

namespace footlight::planner {
namespace {

using test::Films;
using test::three_films;
using test::three_sections;

std::vector<std::string> ids() { return {"a", "film", "b"}; }

/// Moves one person of a formation to the nearest free cell.
std::optional<Override> a_move(const Plan& plan, const Show& show, std::size_t formation, std::size_t who) {
  const Formation& before = plan.formations[formation];
  const CellIndex from = before.cells[who % before.cells.size()];
  if (std::binary_search(show.stage.reserve.begin(), show.stage.reserve.end(), from)) return std::nullopt;
  for (const CellIndex to : show.stage.grid.within(show.stage.grid.centre(from), 4)) {
    const bool taken = std::find(before.cells.begin(), before.cells.end(), to) != before.cells.end();
    if (taken || std::binary_search(show.stage.reserve.begin(), show.stage.reserve.end(), to)) continue;
    Override asked;
    asked.count = before.count;
    asked.move = {{from, to, {}}};
    return asked;
  }
  return std::nullopt;
}

TEST(Replan, GivesThePlanThatPlanningFromNothingGivesByteForByte) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    Show show = three_sections(6 + static_cast<int>(rng.below(20)));
    if (rng.below(3) == 0) show.stage.blocked = test::cells_in(show.stage.grid, "L7:M8");
    if (rng.below(3) == 0) show.performers[2].radius_m = 0.3;
    constexpr PlannerModel kModels[] = {PlannerModel::flat, PlannerModel::hierarchical, PlannerModel::joint};
    show.sections[1].planner.model = kModels[rng.below(8) == 0 ? 2 : rng.below(2)];
    show.sections[1].planner.region_size = 8;
    const Films films = three_films();
    Stages stages;
    const Reuse reuse{&stages, ids()};
    auto plan = plan_show(show, films, {}, reuse);
    RC_ASSERT(plan.has_value());
    RC_ASSERT(plan->plan == plan_show(show, films)->plan);
    for (int edit = 0; edit < 2; ++edit) {
      const std::size_t formation = rng.below(plan->plan.formations.size());
      const auto asked = a_move(plan->plan, show, formation, rng.below(100));
      auto& overrides = show.sections[plan->plan.formations[formation].section.at()].overrides;
      if (!overrides.empty() && rng.below(3) == 0) {
        overrides.pop_back();
      } else if (asked) {
        overrides.push_back(*asked);
      }
      plan = plan_show(show, films, {}, reuse);
      const auto anew = plan_show(show, films);
      RC_ASSERT(plan.has_value() == anew.has_value());
      if (!plan) break;
      RC_ASSERT(plan->plan == anew->plan);
      RC_ASSERT(plan->refusal == anew->refusal);
    }
  }));
}

TEST(Replan, NothingIsPlannedTwiceAndNoFilmIsNeededWhenNothingChanged) {
  const Show show = three_sections();
  Stages stages;
  const Reuse reuse{&stages, ids()};
  EXPECT_EQ(formations_known(show, reuse), (std::vector<bool>{false, false, false}));
  const auto first = plan_show(show, three_films(), {}, reuse);
  ASSERT_TRUE(first) << first.error().message;
  EXPECT_EQ(first->facts.anew, first->facts.all);
  EXPECT_EQ(formations_known(show, reuse), (std::vector<bool>{true, true, true}));
  const std::size_t size = stages.size();
  const auto second = plan_show(show, Films(3), {}, reuse);
  ASSERT_TRUE(second) << second.error().message;
  EXPECT_EQ(second->plan, first->plan);
  EXPECT_EQ(second->formations.anew + second->pairings.anew + second->walks.anew + second->facts.anew, 0U);
  EXPECT_EQ(stages.size(), size);
}

TEST(Replan, AChangedFormationReplansItsTwoTransitionsAndNotTheShow) {
  Show show = three_sections();
  Stages stages;
  const Reuse reuse{&stages, ids()};
  const auto before = plan_show(show, three_films(), {}, reuse);
  ASSERT_TRUE(before);
  const auto& formations = before->plan.formations;
  const auto in_film = [](const Formation& formation) { return formation.section == SectionIndex(1); };
  ASSERT_GT(std::count_if(formations.begin(), formations.end(), in_film), 5);
  show.sections[1].overrides = {*a_move(before->plan, show, 4, 7)};
  const auto after = plan_show(show, Films(3), {}, reuse);
  ASSERT_TRUE(after) << after.error().message;
  EXPECT_EQ(after->formations.anew, 0U);
  EXPECT_EQ(after->pairings.anew, 2U);
  // The step before it looks ahead to it.
  EXPECT_LE(after->walks.anew, 4U);
  // Lateness looks into the next transition, so that the one before counts, too.
  EXPECT_LE(after->facts.anew, 4U);
  EXPECT_GT(after->facts.all, 8U);
}

TEST(Replan, AFilmThatBeginsWhereItIsBestIsKeptWhenTheFormationBeforeItChanges) {
  Show show = three_sections();
  Stages stages;
  const Reuse reuse{&stages, ids()};
  const auto before = plan_show(show, three_films(), {}, reuse);
  ASSERT_TRUE(before);
  show.sections[0].overrides = {*a_move(before->plan, show, 0, 3)};
  EXPECT_EQ(formations_known(show, reuse), (std::vector<bool>{true, true, true}));
  const auto after = plan_show(show, Films(3), {}, reuse);
  ASSERT_TRUE(after) << after.error().message;
  EXPECT_EQ(after->formations.anew, 0U);
  EXPECT_EQ(after->plan, plan_show(show, three_films())->plan);
}

TEST(Replan, AChangeEndsAtTheNextExactFormation) {
  Show show = three_sections();
  for (Section& section : show.sections) section.planner.model = PlannerModel::hierarchical;
  // Too slow to follow: the film yields, and what is late goes on being late until somebody is exact again.
  show.stage.max_speed_mps = 0.5;
  Stages stages;
  const Reuse reuse{&stages, ids()};
  const auto before = plan_show(show, three_films(), {}, reuse);
  ASSERT_TRUE(before);
  show.sections[0].overrides = {*a_move(before->plan, show, 0, 3)};
  const auto after = plan_show(show, Films(3), {}, reuse);
  ASSERT_TRUE(after) << after.error().message;
  EXPECT_EQ(after->pairings.anew, 1U);
  EXPECT_EQ(after->walks.anew, 1U);
  EXPECT_EQ(after->plan, plan_show(show, three_films())->plan);
}

TEST(Replan, WhatTheFactsOfAPlanSayIsWhatIsMeasured) {
  for (const WalkKind walk : {WalkKind::straight, WalkKind::cells}) {
    Show show = three_sections();
    show.stage.walk = walk;
    show.stage.max_speed_mps = 2;
    // Held before anybody walks: a section without a transition.
    show.sections[0].hold_counts = 12;
    const auto planned = plan_show(show, three_films());
    ASSERT_TRUE(planned);
    ASSERT_TRUE(planned->plan.valid);
    const ShowMeasures told = measure_walks(planned->plan);
    const ShowMeasures found = measure(planned->plan, Films(3));
    ASSERT_EQ(told.sections.size(), found.sections.size());
    const auto expect_alike = [&](const Measures& a, const Measures& b) {
      EXPECT_NEAR(a.min_clearance_m, b.min_clearance_m, 1e-9);
      EXPECT_EQ(a.too_close, b.too_close);
      EXPECT_EQ(a.total_distance_m, b.total_distance_m);
      EXPECT_EQ(a.longest_distance_m, b.longest_distance_m);
      EXPECT_EQ(a.max_speed_m_s, b.max_speed_m_s);
      EXPECT_EQ(a.direction_changes, b.direction_changes);
      EXPECT_EQ(a.arrivals, b.arrivals);
      EXPECT_EQ(a.formations, b.formations);
    };
    expect_alike(told.show, found.show);
    for (std::size_t s = 0; s < told.sections.size(); ++s) expect_alike(told.sections[s], found.sections[s]);
  }
}

TEST(Replan, WhatIsHarmedIsPlannedAnew) {
  const Show show = three_sections();
  Stages stages;
  const auto first = plan_show(show, three_films(), {}, {&stages, ids()});
  ASSERT_TRUE(first);
  Stages harmed;
  for (const auto& [key, value] : stages.all()) harmed.load(key, value.substr(0, value.size() - 1));
  const auto second = plan_show(show, three_films(), {}, {&harmed, ids()});
  ASSERT_TRUE(second);
  EXPECT_EQ(second->plan, first->plan);
  EXPECT_EQ(second->walks.anew, second->walks.all);
}

TEST(Replan, FactsAndProofsOfPiecesAreThoseOfTheWholePlan) {
  Show show = three_sections();
  show.performers[5].radius_m = 0.45;
  show.performers[6].radius_m = 0.4;
  const auto planned = plan_show(show, three_films());
  ASSERT_TRUE(planned);
  EXPECT_EQ(planned->plan.valid, validate(planned->plan).valid());
  for (const TransitionFacts& facts : planned->plan.transitions) {
    EXPECT_EQ(facts.tolerated_lag_s, tolerated_lag_s(planned->plan, facts.start, facts.end));
    EXPECT_NEAR(facts.clearance_m, closest_approach(planned->plan, facts.start, facts.end).distance_m, 1e-9);
  }
}

}  // namespace
}  // namespace footlight::planner
