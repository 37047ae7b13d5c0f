// SPDX-License-Identifier: Apache-2.0
#include "planner/why/one_more_count.hpp"

#include <atomic>

#include <gtest/gtest.h>

#include "planner/validate.hpp"
#include "tests/planner/why/hurried_show.hpp"

namespace footlight::planner {
namespace {

using tests::HurriedShow;

TEST(OneMoreCount, TheSameWalkIsSlowerAndToleratesAsMuch) {
  const HurriedShow made = tests::two_lists();
  const auto found = one_more_count(made.show, made.plan, {}, PerformerIndex(0), FormationIndex(1), {});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->places, 3);
  EXPECT_EQ(found->planned.places_reached, 3);
  EXPECT_DOUBLE_EQ(found->planned.walk_m, 2);
  EXPECT_DOUBLE_EQ(found->planned.speed_mps, 1);
  EXPECT_DOUBLE_EQ(found->again.speed_mps, 1);
  EXPECT_NEAR(found->one_more.speed_mps, 0.8, 1e-9);
  EXPECT_EQ(found->one_more.to, found->planned.to);
  EXPECT_GE(found->one_more.tolerated_lag_s, found->planned.tolerated_lag_s);
  EXPECT_DOUBLE_EQ(found->planned.clearance_m,
                   closest_approach(made.plan, made.show.tempo.at(5), made.show.tempo.at(9)).distance_m);
}

/// The formation into which most places of the drawing are missing.
FormationIndex hurried(const HurriedShow& made) {
  FormationIndex worst(1);
  int most = 0;
  for (std::size_t k = 1; k < made.plan.formations.size(); ++k) {
    const auto found =
        one_more_count(made.show, made.plan, made.film, PerformerIndex(0), FormationIndex::of(k), {}).value();
    EXPECT_LE(found.planned.places_reached, found.places);
    if (found.places - found.planned.places_reached <= most) continue;
    most = found.places - found.planned.places_reached;
    worst = FormationIndex::of(k);
  }
  EXPECT_GT(most, 0);
  return worst;
}

TEST(OneMoreCount, ReachesMorePlacesOfADrawingThatHadToGiveWay) {
  const HurriedShow made = tests::jumping_film();
  const auto found = one_more_count(made.show, made.plan, made.film, PerformerIndex(0), hurried(made), {}).value();
  EXPECT_GT(found.one_more.places_reached, found.again.places_reached);
  EXPECT_EQ(found.one_more.too_fast, 0);
  EXPECT_GE(found.one_more.clearance_m, made.show.stage.clearance_m - 1e-6);
}

TEST(OneMoreCount, SolvedAgainWithoutTheCountIsAsPlanned) {
  const HurriedShow made = tests::jumping_film();
  const FormationIndex into = hurried(made);
  const auto found = one_more_count(made.show, made.plan, made.film, PerformerIndex(7), into, {}).value();
  EXPECT_EQ(found.again.places_reached, found.planned.places_reached);
  EXPECT_NEAR(found.again.total_walk_m, found.planned.total_walk_m, 0.1 * found.planned.total_walk_m);
}

TEST(OneMoreCount, TellsHowManyWalksOfARefusedPlanAreTooFast) {
  HurriedShow made = tests::two_lists();
  made.show.stage.max_speed_mps = 0.9;
  for (PlanSection& section : made.plan.sections) section.max_speed_mps = 0.9;
  const auto found = one_more_count(made.show, made.plan, {}, PerformerIndex(0), FormationIndex(1), {}).value();
  EXPECT_EQ(found.planned.too_fast, 1);
  EXPECT_EQ(found.one_more.too_fast, 0);
}

TEST(OneMoreCount, CanBeInterrupted) {
  const HurriedShow made = tests::jumping_film();
  const std::atomic<bool> stop{true};
  const auto found = one_more_count(made.show, made.plan, made.film, PerformerIndex(0), FormationIndex(1), {{}, &stop});
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().kind, ErrorKind::interrupted);
}

TEST(OneMoreCount, NamedPeopleGoToTheirOwnPlacesAgainThoughSomebodyIsAway) {
  // Three people by name; the second does not come and nobody stands in: without a reserve the place stays empty.
  HurriedShow made = tests::two_lists();
  made.show.performers[1].absent = true;
  made.plan = plan_show(made.show, {std::nullopt, std::nullopt}).value().plan;
  ASSERT_EQ(made.plan.performers, (std::vector<std::string>{"1", "3"}));
  const auto found = one_more_count(made.show, made.plan, {}, PerformerIndex(0), FormationIndex(1), {}).value();
  EXPECT_EQ(found.places, 2);
  EXPECT_EQ(found.again.to, made.show.stage.grid.index({2, 0}));
  EXPECT_EQ(found.again.places_reached, 2);
  EXPECT_DOUBLE_EQ(found.again.total_walk_m, 2);
}

}  // namespace
}  // namespace footlight::planner
