// SPDX-License-Identifier: Apache-2.0
#include "app/plan_summary.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/plan_builder.hpp"

namespace footlight::app {
namespace {

/// Two people walk one metre in a second and stand for another one.
planner::Planned two_people() {
  const Grid grid = *Grid::make(GridKind::square, 4, 2, 1);
  planner::Planned out;
  out.plan = tests::plan_of(
      grid, {{tests::mark_at(0, grid, 0, 0), tests::mark_at(1, grid, 1, 0), tests::mark_at(2, grid, 1, 0)},
             {tests::mark_at(0, grid, 2, 0), tests::mark_at(1, grid, 3, 0), tests::mark_at(2, grid, 3, 0)}});
  out.plan.title = "Two";
  out.plan.valid = true;
  out.plan.sections.push_back({"walk", kStart, instant_at(2), 1.4, {}, {}, {"scaled to 0.8"}});
  out.plan.formations.push_back({"walk/1", SectionIndex(0), 1, kStart, {}, {CellIndex(0), CellIndex(2)}, 2});
  out.plan.formations.push_back({"walk/2", SectionIndex(0), 3, instant_at(1), {}, {CellIndex(1), CellIndex(3)}, 2});
  TransitionFacts facts;
  facts.start = kStart;
  facts.end = instant_at(1);
  facts.clearance_m = 2;
  facts.longest_walk_m = 1;
  facts.longest_walker = PerformerIndex(1);
  facts.tolerated_lag_s = 0.2;
  out.plan.transitions = {facts};
  out.shortest = {planner::Planned::Shortest{2.2, "performer 2 from C1 to D1"}};
  return out;
}

Show show() {
  Show out;
  out.tempo = TempoMap(120, 4);
  out.sections.resize(1);
  out.sections[0].name = "walk";
  out.sections[0].duration_counts = 4;
  return out;
}

TEST(PlanSummary, TellsWalksClearanceSpeedLagAndNotes) {
  EXPECT_EQ(plan_text(show(), two_people()),
            "Two: 2 performers on 4 x 2 cells, 2.0 s\n"
            "\n"
            "section  counts  formations  longest walk (who)  walked  clearance     speed  tolerate 0.2 s\n"
            "walk        1-5           2           1.0 m (2)     2 m    2.000 m  1.00 m/s          1 of 1\n"
            "show                      2           1.0 m (2)     2 m    2.000 m  1.00 m/s          1 of 1\n"
            "\n"
            "section walk: scaled to 0.8\n"
            "section walk: could be as short as 3 counts (it has 4); the hardest walk: performer 2 from C1 to D1\n");
}

TEST(PlanSummary, AFilmThatIsFasterThanPeopleIsNoReproach) {
  planner::Planned planned = two_people();
  planned.shortest[0]->counts = 1125.4;
  EXPECT_EQ(shortest_text(show(), planned),
            "section walk: the film is faster than people walk in 4 counts, so they stand as near to it as they come; "
            "a longer duration or a higher max_speed brings them nearer (every place would be reached with 1126 "
            "counts); the hardest walk: performer 2 from C1 to D1\n");
}

TEST(PlanSummary, ALagThatIsNotToleratedIsCounted) {
  planner::Planned planned = two_people();
  planned.plan.transitions[0].tolerated_lag_s = 0.15;
  const auto json = nlohmann::json::parse(plan_json(show(), planned));
  EXPECT_EQ(json["transitions"], 1);
  EXPECT_EQ(json["lag_tolerated_by"], 0);
}

TEST(PlanSummary, IsJsonForPrograms) {
  const auto json = nlohmann::json::parse(plan_json(show(), two_people()));
  EXPECT_EQ(json["valid"], true);
  EXPECT_EQ(json["total_distance_m"], 2.0);
  EXPECT_EQ(json["longest_walker"], "2");
  EXPECT_EQ(json["refusal"], nlohmann::json::array());
  const auto section = json["sections"][0];
  EXPECT_EQ(section["end_count"], 5.0);
  EXPECT_EQ(section["shortest_counts"], 2.2);
  EXPECT_EQ(section["limited_by"], "performer 2 from C1 to D1");
  EXPECT_EQ(section["notes"], nlohmann::json({"scaled to 0.8"}));
}

}  // namespace
}  // namespace footlight::app
