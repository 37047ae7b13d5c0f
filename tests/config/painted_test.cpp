// SPDX-License-Identifier: Apache-2.0
//
// Painted sections in a show file.
#include <gtest/gtest.h>

#include "config/show_file.hpp"
#include "core/motion.hpp"
#include "core/motion/painted_options.hpp"
#include "tests/config/show_folder.hpp"

namespace footlight::config {
namespace {

class PaintedKeys : public testing::Test {
 protected:
  void SetUp() override { folder_.write("art.png", "x"); }
  /// The section is in line 6.
  static std::string text(const std::string& section) {
    return "footlight: 1\ntitle: t\nstage: {grid: {columns: 30, rows: 20}}\n"
           "performers: {count: 5, groups: [{name: red, members: [1, 2], colour: \"#FF0000\"}]}\nsections:\n" +
           ("  - {name: p, start: count 1, " + section + "}\n");
  }
  PaintedOptions options(const std::string& section) {
    folder_.write("show.yaml", text(section));
    const auto result = load_show(folder_.path("show.yaml"));
    EXPECT_TRUE(result) << (result ? "" : result.error().to_text());
    if (!result || result->show.sections.at(0).motion == nullptr) return {};
    return std::get<PaintedOptions>(result->show.sections.at(0).motion->options);
  }
  std::string errors(const std::string& section) {
    folder_.write("show.yaml", text(section));
    const auto result = load_show(folder_.path("show.yaml"));
    EXPECT_FALSE(result);
    return result ? "" : folder_.without_folder(result.error().to_text());
  }
  static constexpr const char* kStart = "from: {painting: art.png}, duration: 40 counts, ";

  ShowFolder folder_;
};

TEST_F(PaintedKeys, BindColoursToRolesGroupsAndOrder) {
  const auto out = options(std::string(kStart) +
                           "planner: {model: painted}, paint: [{colour: \"#00C800\", role: shape}, {colour: "
                           "\"#00A000\", role: shape, order: 2, tolerance: 9}, {colour: \"#DC2828\", role: stroke, "
                           "group: red}]");
  ASSERT_EQ(out.paint.size(), 3U);
  EXPECT_EQ(out.paint[0].colour, (Colour{0, 200, 0}));
  EXPECT_EQ(out.paint[0].role, Paint::Role::shape);
  EXPECT_EQ(out.paint[0].order, 1);
  EXPECT_EQ(out.paint[0].tolerance, 20);
  EXPECT_FALSE(out.paint[0].group);
  EXPECT_EQ(out.paint[1].order, 2);
  EXPECT_EQ(out.paint[1].tolerance, 9);
  EXPECT_EQ(out.paint[2].role, Paint::Role::stroke);
  EXPECT_EQ(out.paint[2].group, GroupIndex(0));
  EXPECT_EQ(out.paint[2].position.line, 6);
}

TEST_F(PaintedKeys, DefaultsAreThoseOfTheOptions) {
  const auto out =
      options(std::string(kStart) + "planner: {model: painted}, paint: [{colour: \"#00C800\", role: shape}]");
  const PaintedOptions own;
  EXPECT_EQ(out.background, own.background);
  EXPECT_EQ(out.resolution, own.resolution);
  EXPECT_EQ(out.iterations, own.iterations);
  EXPECT_EQ(out.grey_tolerance, own.grey_tolerance);
  EXPECT_EQ(out.stroke_force, own.stroke_force);
  EXPECT_EQ(out.background_force, own.background_force);
  EXPECT_EQ(out.flow_force, own.flow_force);
  EXPECT_EQ(out.people_force, own.people_force);
  EXPECT_EQ(out.viscosity, own.viscosity);
  EXPECT_EQ(out.reaction_s, own.reaction_s);
  EXPECT_EQ(out.step_s, own.step_s);
}

TEST_F(PaintedKeys, AreReadWithTheirUnits) {
  const auto out = options(std::string(kStart) +
                           "planner: {model: painted, painted: {background: attract, resolution: 64, iterations: 1000, "
                           "grey: 5, stroke: 2, walls: 0, flow: 0.25, people: 3, viscosity: 1, reaction: 250 ms, step: "
                           "0.05 s}}, paint: [{colour: \"#00C800\", role: shape}]");
  EXPECT_EQ(out.background, PaintedOptions::Background::attract);
  EXPECT_EQ(out.resolution, 64);
  EXPECT_EQ(out.iterations, 1000);
  EXPECT_EQ(out.grey_tolerance, 5);
  EXPECT_EQ(out.stroke_force, 2);
  EXPECT_EQ(out.background_force, 0);
  EXPECT_EQ(out.flow_force, 0.25);
  EXPECT_EQ(out.people_force, 3);
  EXPECT_EQ(out.viscosity, 1);
  EXPECT_EQ(out.reaction_s, 0.25);
  EXPECT_EQ(out.step_s, 0.05);
}

TEST_F(PaintedKeys, WithWrongValuesAreRefused) {
  EXPECT_EQ(errors(std::string(kStart) +
                   "planner: {model: painted, painted: {resolution: 8}}, paint: [{colour: green, role: shape}]"),
            "show.yaml:6:127: error: sections[0].planner.painted.resolution: \"8\" is out of range (32 to 512)\n"
            "show.yaml:6:149: error: sections[0].paint[0].colour: \"green\" is not a colour (write \"#RRGGBB\", in "
            "quotes)\n");
  EXPECT_EQ(errors(std::string(kStart) +
                   "planner: {model: painted}, paint: [{colour: \"#00C800\", role: shape, order: 0}, {colour: "
                   "\"#00C800\", role: stroke}]"),
            "show.yaml:6:154: error: sections[0].paint[0].order: \"0\" is out of range (1 to 100)\n"
            "show.yaml:6:167: error: sections[0].paint[1].colour: the colour #00C800 is bound a second time (a colour "
            "means one thing)\n");
}

TEST_F(PaintedKeys, GoWithAPainting) {
  EXPECT_EQ(
      errors("from: {shape: line}, duration: 40 counts, planner: {model: painted}, paint: [{colour: \"#00C800\", "
             "role: shape}]"),
      "show.yaml:6:31: error: sections[0].from: `model: painted` follows a painting (from: {painting: FILE.png})\n");
  EXPECT_EQ(errors(std::string(kStart) + "planner: {model: painted}"),
            "show.yaml:6:5: error: sections[0].paint: the key is missing (it says which colour of the painting means "
            "what)\n");
}

}  // namespace
}  // namespace footlight::config
