// SPDX-License-Identifier: Apache-2.0
#include "app/measure_report.hpp"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace footlight::app {
namespace {

using Json = nlohmann::json;

planner::ShowMeasures measures() {
  planner::Measures film;
  film.frames = 25;
  film.theta_dev = 0.0512345;
  film.theta_dev_var = 0.001;
  film.theta_miss = 0.1;
  film.theta_iou = 0.2;
  film.min_clearance_m = 0.75;
  film.too_close = 3;
  film.max_speed_m_s = 1.25;
  film.total_distance_m = 1234.5;
  film.longest_distance_m = 12.5;
  film.formations = 4;
  film.closest_b = PerformerIndex(1);
  film.closest_at = instant_at(1.5);
  film.median_distance_m = 5;
  film.distance_gini = 0.25;
  film.direction_changes = 7;
  film.marks_per_minute = 6;
  film.crowd = planner::CrowdFigures{20, 12.25, 0.5, 0.125, 0.25, 0.0625, 0.75, 2.5};
  planner::Measures cells;
  cells.formations = 1;
  cells.min_clearance_m = std::numeric_limits<double>::infinity();
  return {{{}, 8.4, 8, 1.4}, film, {film, cells}};
}

MeasuredPlan measured() {
  MeasuredPlan out;
  out.file = "show.yaml";
  out.measures = measures();
  Plan& plan = out.plan;
  plan.title = "T";
  plan.performers = {"ann", "bob"};
  plan.tracks.resize(2);
  plan.sections.resize(2);
  plan.sections[0].name = "film";
  plan.sections[0].end = instant_at(10);
  plan.sections[1].name = "bow";
  plan.sections[1].end = instant_at(20);
  plan.transitions.resize(3);
  plan.transitions[0].end = instant_at(5);
  plan.transitions[1].end = instant_at(10);
  plan.transitions[2].end = instant_at(15);
  out.lag_s = {0.125, 0.25, 2};
  return out;
}

TEST(MeasureReport, IsFourTablesForPeople) {
  EXPECT_EQ(measure_text({measured()}),
            "section  formations  frames  theta_dev  variance  theta_miss  theta_iou\n"
            "film              4      25     5.12 %     0.001     10.00 %    20.00 %\n"
            "bow               1       0          -         -           -          -\n"
            "show              4      25     5.12 %     0.001     10.00 %    20.00 %\n"
            "\n"
            "section  clearance      between      at  too close   fastest  tolerate 0.2 s   least\n"
            "film       0.750 m  ann and bob  1.50 s          3  1.25 m/s          1 of 2  0.12 s\n"
            "bow              -            -       -          0  0.00 m/s          1 of 1  2.00 s\n"
            "show       0.750 m  ann and bob  1.50 s          3  1.25 m/s          2 of 3  0.12 s\n"
            "\n"
            "section  walked  longest  to median  Gini  turns each  marks a minute\n"
            "film     1234 m     12 m      2.5 x  0.25         3.5             6.0\n"
            "bow         0 m      0 m          -  0.00         0.0             0.0\n"
            "show     1234 m     12 m      2.5 x  0.25         3.5             6.0\n"
            "\n"
            "section  walking    I_d  by chance    I_v  by chance  sigma_min_dis  sigma_curr_eft\n"
            "film          12  0.500      0.250  0.125      0.062        0.750 m          2.50 m\n"
            "bow            -      -          -      -          -              -               -\n"
            "show          12  0.500      0.250  0.125      0.062        0.750 m          2.50 m\n"
            "The plan is not valid: it breaks its limits.\n");
}

TEST(MeasureReport, SaysWhatNobodyWhoKeepsTheLimitCanBeat) {
  MeasuredPlan one = measured();
  one.bounds = {planner::DrawingBound{4, 0.1875, 0.125, 0.0625}, std::nullopt};
  EXPECT_THAT(measure_text({one}),
              testing::HasSubstr("film                      4      25     5.12 %     0.001     10.00 %    20.00 %\n"
                                 "  at formations           4       4          -         -           -    18.75 %\n"
                                 "  at least                4       4          -         -           -    12.50 %\n"
                                 "bow "));
  const Json json = Json::parse(measure_json({one}));
  EXPECT_EQ(
      json["sections"][0]["bound"],
      Json({{"formations", 4}, {"theta_iou", 0.1875}, {"theta_iou_least", 0.125}, {"theta_iou_nobody_walks", 0.0625}}));
  EXPECT_FALSE(json["sections"][1].contains("bound"));
}

TEST(MeasureReport, PutsSeveralPlansSideBySideAndMarksTheInvalidOnes) {
  MeasuredPlan good = measured();
  good.file = "good.plan";
  good.plan.valid = true;
  MeasuredPlan planned = measured();
  planned.planning_s = 1.5;
  EXPECT_EQ(measure_text({good, planned}),
            "plan                   formations  frames  theta_dev  variance  theta_miss  theta_iou\n"
            "good.plan                       4      25     5.12 %     0.001     10.00 %    20.00 %\n"
            "show.yaml (not valid)           4      25     5.12 %     0.001     10.00 %    20.00 %\n"
            "\n"
            "plan                   clearance      between      at  too close   fastest  tolerate lag   least\n"
            "good.plan                0.750 m  ann and bob  1.50 s          3  1.25 m/s        2 of 3  0.12 s\n"
            "show.yaml (not valid)    0.750 m  ann and bob  1.50 s          3  1.25 m/s        2 of 3  0.12 s\n"
            "\n"
            "plan                   walked  longest  to median  Gini  turns each  marks a minute  planned in\n"
            "good.plan              1234 m     12 m      2.5 x  0.25         3.5             6.0           -\n"
            "show.yaml (not valid)  1234 m     12 m      2.5 x  0.25         3.5             6.0      1.50 s\n"
            "\n"
            "plan                   walking    I_d  by chance    I_v  by chance  sigma_min_dis  sigma_curr_eft\n"
            "good.plan                   12  0.500      0.250  0.125      0.062        0.750 m          2.50 m\n"
            "show.yaml (not valid)       12  0.500      0.250  0.125      0.062        0.750 m          2.50 m\n"
            "The plan of show.yaml is not valid: it breaks its limits.\n");
  const Json json = Json::parse(measure_json({good, planned}));
  EXPECT_EQ(json["plans"][0]["valid"], true);
  EXPECT_EQ(json["plans"][0]["planning_s"], Json());
  EXPECT_EQ(json["plans"][1]["file"], "show.yaml");
  EXPECT_EQ(json["plans"][1]["planning_s"], 1.5);
}

TEST(MeasureReport, IsJsonForPrograms) {
  const Json json = Json::parse(measure_json({measured()}));
  EXPECT_EQ(json["valid"], false);
  EXPECT_EQ(json["theta_dev"], 0.0512345);
  EXPECT_EQ(json["theta_dev_var"], 0.001);
  EXPECT_EQ(json["too_close"], 3);
  EXPECT_EQ(json["closest"]["performers"], Json({"ann", "bob"}));
  EXPECT_EQ(json["closest"]["at_s"], 1.5);
  EXPECT_EQ(json["longest_to_median"], 2.5);
  EXPECT_EQ(json["distance_gini"], 0.25);
  EXPECT_EQ(json["direction_changes"], 7);
  EXPECT_EQ(json["marks_per_minute"], 6.0);
  EXPECT_EQ(json["transitions"], 3);
  EXPECT_EQ(json["lag_tolerated_by"], 2);
  EXPECT_EQ(json["least_tolerated_lag_s"], 0.125);
  EXPECT_EQ(json["tolerated_lag"].size(), 3U);
  EXPECT_EQ(json["tolerated_lag"][1]["lag_s"], 0.25);
  EXPECT_EQ(json["sections"][0]["name"], "film");
  EXPECT_EQ(json["sections"][0]["total_distance_m"], 1234.5);
  EXPECT_EQ(json["sections"][0]["transitions"], 2);
  EXPECT_EQ(json["sections"][1]["theta_dev"], Json());
  EXPECT_EQ(json["sections"][1]["min_clearance_m"], Json());
  EXPECT_EQ(json["sections"][1]["closest"], Json());
  EXPECT_EQ(json["sections"][1]["longest_to_median"], Json());
  EXPECT_EQ(json["crowd"]["R_m"], 8.4);
  EXPECT_EQ(json["crowd"]["K"], 8);
  EXPECT_EQ(json["crowd"]["N"], 12.25);
  EXPECT_EQ(json["crowd"]["I_d_shuffled_bits"], 0.25);
  EXPECT_EQ(json["sections"][0]["crowd"]["sigma_curr_eft_m"], 2.5);
  EXPECT_EQ(json["sections"][1]["crowd"], Json());
}

}  // namespace
}  // namespace footlight::app
