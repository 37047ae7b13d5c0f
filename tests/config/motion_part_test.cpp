// SPDX-License-Identifier: Apache-2.0
#include "config/motion_part.hpp"

#include <gtest/gtest.h>

#include "config/show_file.hpp"
#include "tests/config/show_folder.hpp"

namespace footlight::config {
namespace {

/// Lines 1 to 6; what is asked follows in line 7.
constexpr std::string_view kHead =
    "footlight: 1\n"
    "title: t\n"
    "stage: {grid: {columns: 6, rows: 4}}\n"
    "performers: {count: 4, groups: [{name: odd, members: [1, 3], colour: \"#FFFFFF\"}]}\n"
    "sections:\n"
    "  - {name: a, from: {cells: a.csv}, start: count 1}\n";

class MotionPart : public testing::Test {
 protected:
  void SetUp() override {
    folder_.write("a.csv", "cell\nA1\nA2\nA3\nB1\n");
    folder_.write("film.mp4", "x");
  }
  static std::string moved(const std::string& rest, const std::string& from = "cells: a.csv") {
    return "  - {name: b, from: {" + from + "}, start: count 9, " + rest + "}\n";
  }
  Result<LoadedShow, Diagnostics> load(const std::string& more) {
    folder_.write("show.yaml", std::string(kHead) + more);
    return load_show(folder_.path("show.yaml"));
  }
  Section section(const std::string& more) {
    const auto result = load(more);
    EXPECT_TRUE(result) << (result ? "" : result.error().to_text());
    return result ? result->show.sections.at(1) : Section();
  }
  std::string errors(const std::string& more) {
    const auto result = load(more);
    EXPECT_FALSE(result);
    return result ? "" : folder_.without_folder(result.error().to_text());
  }

  ShowFolder folder_;
};

TEST_F(MotionPart, AModelHasItsOptionsAndTheSectionWhatGoesWithIt) {
  const Section b =
      section(moved("duration: 32 counts, planner: {model: srd}, marks: 2 counts, seed: 7, "
                    "paths: [{group: odd, through: [[-2 m, 50 cm], [2 m, 1.5 m]]}, {through: [[0 m, 1 m]]}], "
                    "obstacles: [{radius: 80 cm, at: [{count: 9, x: -2 m, y: 1 m}, {count: 17.5, x: 2 m, y: 1 m}]}]"));
  EXPECT_EQ(b.planner.model, PlannerModel::srd);
  EXPECT_EQ(b.duration_counts, 32);
  ASSERT_NE(b.motion, nullptr);
  EXPECT_TRUE(std::holds_alternative<SrdOptions>(b.motion->options));
  EXPECT_EQ(b.motion->mark_counts, 2);
  EXPECT_EQ(b.motion->seed, 7U);
  ASSERT_EQ(b.motion->paths.size(), 2U);
  EXPECT_EQ(b.motion->paths[0].group, GroupIndex(0));
  EXPECT_EQ(b.motion->paths[0].through, (std::vector<Point>{{-2, 0.5}, {2, 1.5}}));
  EXPECT_EQ(b.motion->paths[1].group, std::nullopt);
  ASSERT_EQ(b.motion->obstacles.size(), 1U);
  EXPECT_EQ(b.motion->obstacles[0].radius_m, 0.8);
  EXPECT_EQ(b.motion->obstacles[0].at[1].count, 17.5);
  EXPECT_EQ(b.motion->obstacles[0].at[1].centre, (Point{2, 1}));
}

TEST_F(MotionPart, WithoutThemDefaultsHold) {
  const Section b = section(moved("duration: 32 counts, planner: {model: srd}"));
  ASSERT_NE(b.motion, nullptr);
  EXPECT_EQ(b.motion->mark_counts, std::nullopt);
  EXPECT_EQ(b.motion->seed, 1U);
  EXPECT_TRUE(b.motion->paths.empty());
  EXPECT_EQ(section(moved("hold: 8 counts")).motion, nullptr);
}

TEST_F(MotionPart, EveryModelCanBeChosenByItsName) {
  for (const MotionModel& one : motion_models()) {
    if (one.name == "painted") continue;  // needs a painting
    const Section b = section(moved("duration: 32 counts, planner: {model: " + std::string(one.name) + "}"));
    EXPECT_EQ(b.planner.model, one.model) << one.name;
    ASSERT_NE(b.motion, nullptr);
    EXPECT_FALSE(std::holds_alternative<std::monostate>(b.motion->options)) << one.name;
  }
}

TEST_F(MotionPart, AnUnknownOptionOfAModelIsAnError) {
  const std::string text = errors(moved("duration: 32 counts, planner: {model: srd, srd: {iterationz: 1}}"));
  EXPECT_EQ(text.substr(0, text.find(" (")), "show.yaml:7:102: error: sections[1].planner.srd.iterationz: unknown key");
}

TEST_F(MotionPart, AModelNeedsADurationAndOneFormation) {
  EXPECT_EQ(errors(moved("planner: {model: srd}")),
            "show.yaml:7:5: error: sections[1].duration: the key is missing (`model: srd` moves people so long to the "
            "section's formation)\n");
  EXPECT_EQ(errors(moved("duration: 9 counts, planner: {model: srd}", "video: film.mp4")),
            "show.yaml:7:15: error: sections[1].from: `model: srd` leads people to one formation, and a video has "
            "many (an image, cells or parts; or model: joint, hierarchical or flat)\n");
}

TEST_F(MotionPart, WhatGoesWithAModelAloneIsRefusedWithoutOne) {
  std::string names;
  for (const MotionModel& one : motion_models()) names += (names.empty() ? "" : ", ") + std::string(one.name);
  EXPECT_EQ(
      errors(moved("marks: 2 counts, seed: 3")),
      "show.yaml:7:53: error: sections[1].marks: the key has no meaning here (it goes with a model of motion: " +
          names +
          ")\n"
          "show.yaml:7:70: error: sections[1].seed: the key has no meaning here (it goes with a model of motion: " +
          names + ")\n");
  EXPECT_EQ(errors(moved("planner: {srd: {iterations: 1}}")),
            "show.yaml:7:63: error: sections[1].planner.srd: the key has no meaning here (it goes with model: "
            "srd)\n");
}

TEST_F(MotionPart, WhatAModelDoesNotUseIsRefused) {
  EXPECT_EQ(errors(moved("duration: 9 counts, planner: {model: srd, layers: 3}, overrides: [{formation: 1}]")),
            "show.yaml:7:95: error: sections[1].planner.layers: the key has no meaning here (`model: srd` is given "
            "by the mapping `srd`)\n"
            "show.yaml:7:107: error: sections[1].overrides: the key has no meaning here (`model: srd` has marks of "
            "its own)\n");
}

TEST_F(MotionPart, PathsAreOnesOfGroupsThatThereAre) {
  const std::string head = "duration: 9 counts, planner: {model: srd}, paths: [";
  EXPECT_EQ(errors(moved(head + "{group: even, through: [[0 m, 1 m]]}]")),
            "show.yaml:7:112: error: sections[1].paths[0].group: no group has the name \"even\" ("
            "groups: odd)\n");
  EXPECT_EQ(errors(moved(head + "{through: [[0 m, 1 m]]}, {through: [[0 m, 2 m]]}]")),
            "show.yaml:7:129: error: sections[1].paths[1]: there is a path without a group already (one path leads "
            "through all of its places)\n");
  EXPECT_EQ(errors(moved(head + "{group: odd}]")),
            "show.yaml:7:104: error: sections[1].paths[0].through: the key is missing (Places on the floor, in their "
            "order.)\n");
}

TEST_F(MotionPart, AnObstacleMovesForwardInTime) {
  const std::string head = "duration: 9 counts, planner: {model: srd}, obstacles: [";
  EXPECT_EQ(errors(moved(head + "{radius: 1 m, at: [{count: 9, x: 0 m, y: 0 m}, {count: 9, x: 1 m, y: 0 m}]}]")),
            "show.yaml:7:163: error: sections[1].obstacles[0].at[1].count: count 9 is not after count 9 (write the "
            "places in the order of time)\n");
  EXPECT_EQ(errors(moved(head + "{radius: 0 m, at: []}]")),
            "show.yaml:7:117: error: sections[1].obstacles[0].radius: \"0 m\" is out of range (above 0, at most 1000 "
            "m)\n"
            "show.yaml:7:126: error: sections[1].obstacles[0].at: the list is empty (at least one is needed)\n");
}

TEST_F(MotionPart, MarksHaveARange) {
  EXPECT_EQ(errors(moved("duration: 9 counts, planner: {model: srd}, marks: 0 counts")),
            "show.yaml:7:103: error: sections[1].marks: \"0 counts\" is out of range (above 0, at most 64 counts)\n");
}

}  // namespace
}  // namespace footlight::config
