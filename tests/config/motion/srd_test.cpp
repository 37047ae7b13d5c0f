// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "config/show_file.hpp"
#include "core/motion.hpp"
#include "tests/config/show_folder.hpp"

namespace footlight::config {
namespace {

class SrdSection : public testing::Test {
 protected:
  Result<LoadedShow, Diagnostics> load(const std::string& planner) {
    folder_.write("a.csv", "col,row\n0,0\n1,0\n");
    folder_.write("show.yaml",
                  "footlight: 1\n"
                  "title: t\n"
                  "stage: {grid: {columns: 4, rows: 3}}\n"
                  "performers: {count: 2}\n"
                  "sections:\n"
                  "  - {name: a, from: {cells: a.csv}, start: count 1}\n"
                  "  - name: b\n"
                  "    from: {cells: a.csv}\n"
                  "    start: count 2\n"
                  "    duration: 20 counts\n"
                  "    planner: " +
                      planner + "\n");
    return load_show(folder_.path("show.yaml"));
  }
  SrdOptions options(const std::string& planner) {
    const auto show = load(planner);
    EXPECT_TRUE(show) << (show ? "" : show.error().to_text());
    return show ? std::get<SrdOptions>(show->show.sections[1].motion->options) : SrdOptions();
  }
  std::string errors(const std::string& planner) {
    const auto show = load(planner);
    EXPECT_FALSE(show);
    return show ? "" : folder_.without_folder(show.error().to_text());
  }

  ShowFolder folder_;
};

TEST_F(SrdSection, FillsWhatIsNotWrittenWithTheModelsOwnDefaults) {
  const SrdOptions out = options("{model: srd}");
  const SrdOptions own;
  EXPECT_EQ(out.orientation, own.orientation);
  EXPECT_EQ(out.formation, own.formation);
  EXPECT_EQ(out.group_speed_mps, own.group_speed_mps);
  EXPECT_EQ(out.settle, own.settle);
  EXPECT_EQ(out.corner_m, own.corner_m);
  EXPECT_EQ(out.step_s, own.step_s);
  EXPECT_EQ(out.iterations, own.iterations);
  EXPECT_EQ(out.stiffness, own.stiffness);
  EXPECT_EQ(out.blending, own.blending);
  EXPECT_EQ(out.steering, own.steering);
  EXPECT_EQ(out.room_m, own.room_m);
  EXPECT_EQ(out.congestion_m, own.congestion_m);
  EXPECT_EQ(out.look_m, own.look_m);
  EXPECT_EQ(out.horizon_s, own.horizon_s);
  EXPECT_EQ(out.avoidance, own.avoidance);
  EXPECT_EQ(out.agility, own.agility);
  EXPECT_EQ(out.reaction_s, own.reaction_s);
  EXPECT_EQ(out.variation, own.variation);
}

TEST_F(SrdSection, ReadsEveryKey) {
  const SrdOptions out = options(
      "{model: srd, srd: {orientation: wheel, formation: false, group_speed: 1.1 m/s, settle: 0.2, corner: 5 m, step: "
      "50 ms, iterations: 8, stiffness: 0.4, blending: 0.6, steering: 0.7, room: 0.8 m, congestion: 3 m, look: 6 m, "
      "horizon: 4 s, avoidance: 0.3, agility: 2, reaction: 200 ms, variation: 0}}");
  EXPECT_EQ(out.orientation, SrdOptions::Orientation::wheel);
  EXPECT_FALSE(out.formation);
  EXPECT_EQ(out.group_speed_mps, 1.1);
  EXPECT_EQ(out.settle, 0.2);
  EXPECT_EQ(out.corner_m, 5);
  EXPECT_EQ(out.step_s, 0.05);
  EXPECT_EQ(out.iterations, 8);
  EXPECT_EQ(out.stiffness, 0.4);
  EXPECT_EQ(out.blending, 0.6);
  EXPECT_EQ(out.steering, 0.7);
  EXPECT_EQ(out.room_m, 0.8);
  EXPECT_EQ(out.congestion_m, 3);
  EXPECT_EQ(out.look_m, 6);
  EXPECT_EQ(out.horizon_s, 4);
  EXPECT_EQ(out.avoidance, 0.3);
  EXPECT_EQ(out.agility, 2);
  EXPECT_EQ(out.reaction_s, 0.2);
  EXPECT_EQ(out.variation, 0);
}

TEST_F(SrdSection, SaysWhatIsWrong) {
  const std::string key = "error: sections[1].planner.srd";
  EXPECT_EQ(
      errors("{model: srd, srd: {reaction: 0.3}}"),
      "show.yaml:11:43: " + key + ".reaction: \"0.3\" has no unit (write for example \"3.2 s\"; units: s, ms, min)\n");
  EXPECT_EQ(
      errors("{model: srd, srd: {orientation: round}}"),
      "show.yaml:11:46: " + key + ".orientation: \"round\" is not one of the choices (choices: fixed, path, wheel)\n");
  EXPECT_EQ(errors("{model: srd, srd: {settle: 1}}"),
            "show.yaml:11:41: " + key + ".settle: \"1\" is out of range (0 to 0.9)\n");
  EXPECT_EQ(errors("{model: srd, srd: {iterations: 0}}"),
            "show.yaml:11:45: " + key + ".iterations: \"0\" is out of range (1 to 50)\n");
  EXPECT_EQ(errors("{model: srd, srd: {look: 5 s}}"),
            "show.yaml:11:39: " + key +
                ".look: \"s\" is not a unit of a length (write for example \"0.5 m\"; units: m, cm, mm, ft, in)\n");
  EXPECT_EQ(errors("{model: srd, srd: {agilty: 2}}"),
            "show.yaml:11:33: " + key + ".agilty: unknown key (did you mean \"agility\"?)\n");
}

}  // namespace
}  // namespace footlight::config
