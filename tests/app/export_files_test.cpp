// SPDX-License-Identifier: Apache-2.0
#include "app/export_files.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/plan_builder.hpp"

namespace footlight::app {
namespace {

using Json = nlohmann::json;

/// Two people on four cells in a row at 120 counts a minute: "1" walks right in steps, "a,b" follows into its place and
/// comes from the reserve.
Plan small_plan() {
  const Grid grid = *Grid::make(GridKind::square, 4, 1, 0.5);
  Plan plan = tests::plan_of(
      grid, {{tests::mark_at(0, grid, 1, 0), tests::mark_at(2, grid, 2, 0), tests::mark_at(3.7, grid, 3, 0),
              tests::mark_at(5, grid, 3, 0)},
             {tests::mark_at(0, grid, 0, 0), tests::mark_at(2, grid, 1, 0), tests::mark_at(5, grid, 2, 0)}});
  plan.performers[1] = "a,\"b";
  plan.show_hash = "abc";
  plan.stage.blocked = {};
  plan.valid = true;
  PlanSection first{"one", kStart, instant_at(2), 1.4, {}, {CellIndex(0)}, {}};
  PlanSection film{"film", instant_at(3), instant_at(6), 2.0, {}, {}, {}};
  film.film = FilmPlacement{"/show/media/v.mp4", 10, 20, 5, 640, 480, 99, true, {1, 0, 2, 0, -1, 3}};
  plan.sections = {first, film};
  plan.formations.push_back({"one/1", SectionIndex(0), 1, kStart, {}, {CellIndex(1), CellIndex(0)}, 1});
  plan.formations.push_back({"film/1", SectionIndex(1), 11, instant_at(5), 12, {CellIndex(3), CellIndex(2)}, 2});
  return plan;
}

Show small_show() {
  Show show;
  show.file = "/show/show.yaml";
  show.tempo = TempoMap(120, 4);
  return show;
}

TEST(MarksCsv, HasARowForEachPerformerAndMark) {
  EXPECT_EQ(marks_csv(small_plan(), small_show()),
            "performer,count,time_s,col,row,x_m,y_m,look,section\n"
            "1,1,0,1,0,-0.25,0.25,handover,one\n"
            "1,5,2,2,0,0.25,0.25,arrive,one\n"
            "1,8.4,3.7,3,0,0.75,0.25,here,film\n"
            "1,11,5,3,0,0.75,0.25,here,film\n"
            "\"a,\"\"b\",1,0,0,0,-0.75,0.25,dark,one\n"
            "\"a,\"\"b\",5,2,1,0,-0.25,0.25,arrive,one\n"
            "\"a,\"\"b\",11,5,2,0,0.25,0.25,here,film\n");
}

TEST(FormationsCsv, HasARowForEachFormationAndPerformer) {
  Plan plan = small_plan();
  plan.formations.back().key = false;
  EXPECT_EQ(formations_csv(plan),
            "formation,count,time_s,frame,performer,col,row,key\n"
            "one/1,1,0,,1,1,0,1\n"
            "one/1,1,0,,\"a,\"\"b\",0,0,1\n"
            "film/1,11,5,12,1,3,0,0\n"
            "film/1,11,5,12,\"a,\"\"b\",2,0,0\n");
}

TEST(StageJson, SaysWhatTheContractAsksFor) {
  const Json stage = Json::parse(stage_json(small_plan(), small_show()));
  EXPECT_EQ(stage["valid"], true);
  EXPECT_EQ(stage["grid"], Json::parse(R"({"kind":"square","cols":4,"rows":1,"pitch_m":0.5,"cell_area_m2":0.25})"));
  EXPECT_EQ(stage["clearance_m"], 0.5);
  EXPECT_EQ(stage["blocked"], Json::array());
  EXPECT_FALSE(stage.contains("cells"));
  EXPECT_EQ(stage["sections"][0],
            Json::parse(R"({"name":"one","start_s":0.0,"end_s":2.0,"max_speed_m_s":1.4,"reserve":[[0,0]]})"));
  EXPECT_EQ(stage["sections"][1],
            Json::parse(R"({"name":"film","start_s":3.0,"end_s":5.0,"hold_until_s":6.0,"max_speed_m_s":2.0,"reserve":[],
              "video":"media/v.mp4","frame0":10,"last_frame":20,"fps":5.0,"threshold":99,"invert":true,
              "stage_to_frame":[[1.0,0.0,2.0],[0.0,-1.0,3.0]]})"));
}

TEST(StageJson, TheLargestSpeedThatAnybodyMayHaveIsTheLimit) {
  Plan plan = small_plan();
  EXPECT_EQ(Json::parse(stage_json(plan, small_show()))["max_speed_m_s"], 2.0);
  plan.max_speed_mps[1] = 2.5;
  EXPECT_EQ(Json::parse(stage_json(plan, small_show()))["max_speed_m_s"], 2.5);
}

TEST(StageJson, AnImageIsNoVideo) {
  Plan plan = small_plan();
  plan.sections[1].film->show_fps = 0;
  const Json section = Json::parse(stage_json(plan, small_show()))["sections"][1];
  EXPECT_FALSE(section.contains("video"));
  EXPECT_EQ(section["image"], "media/v.mp4");
  EXPECT_EQ(section["end_s"], 6.0);
}

TEST(StageJson, OtherGridsAddEveryCellsCentre) {
  Plan plan = small_plan();
  plan.stage.grid = *Grid::make(GridKind::hexagonal, 4, 2, 1);
  const Json stage = Json::parse(stage_json(plan, small_show()));
  ASSERT_EQ(stage["cells"].size(), 8U);
  const Point centre = plan.stage.grid.centre(Cell{1, 1});
  EXPECT_EQ(stage["cells"][5], (Json{1, 1, centre.x, centre.y}));
  EXPECT_EQ(stage["grid"]["cell_area_m2"], plan.stage.grid.cell_area_m2());
}

TEST(StageJson, ARefusedPlanSaysSo) {
  Plan plan = small_plan();
  plan.valid = false;
  EXPECT_EQ(Json::parse(stage_json(plan, small_show()))["valid"], false);
}

}  // namespace
}  // namespace footlight::app
