// SPDX-License-Identifier: Apache-2.0
#include "app/measure_report.hpp"

#include <limits>

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
  planner::Measures cells;
  cells.formations = 1;
  cells.min_clearance_m = std::numeric_limits<double>::infinity();
  return {film, {film, cells}};
}

Plan plan() {
  Plan out;
  out.title = "T";
  out.performers = {"1"};
  out.sections.resize(2);
  out.sections[0].name = "film";
  out.sections[1].name = "bow";
  return out;
}

TEST(MeasureReport, IsATableForPeople) {
  EXPECT_EQ(
      measure_text(plan(), measures()),
      "section  formations  frames  theta_dev  theta_miss  theta_iou  clearance  too close     speed  walked  longest\n"
      "film              4      25     5.12 %     10.00 %    20.00 %    0.750 m          3  1.25 m/s  1234 m     12 m\n"
      "bow               1       0          -           -          -          -          0  0.00 m/s     0 m      0 m\n"
      "show              4      25     5.12 %     10.00 %    20.00 %    0.750 m          3  1.25 m/s  1234 m     12 m\n"
      "The plan is not valid: it breaks its limits.\n");
}

TEST(MeasureReport, IsJsonForPrograms) {
  const Json json = Json::parse(measure_json(plan(), measures()));
  EXPECT_EQ(json["valid"], false);
  EXPECT_EQ(json["theta_dev"], 0.0512345);
  EXPECT_EQ(json["too_close"], 3);
  EXPECT_EQ(json["sections"][0]["name"], "film");
  EXPECT_EQ(json["sections"][0]["total_distance_m"], 1234.5);
  EXPECT_EQ(json["sections"][1]["theta_dev"], Json());
  EXPECT_EQ(json["sections"][1]["min_clearance_m"], Json());
}

}  // namespace
}  // namespace footlight::app
