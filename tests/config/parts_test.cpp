// SPDX-License-Identifier: Apache-2.0
//
// Formations that are put together of drawings.
#include "core/parts.hpp"

#include <numbers>

#include <gtest/gtest.h>

#include "config/show_file.hpp"
#include "tests/config/show_folder.hpp"

namespace footlight::config {
namespace {

/// Lines 1 to 4; what is asked follows from line 5 on.
constexpr std::string_view kHead =
    "footlight: 1\n"
    "title: t\n"
    "stage: {grid: {columns: 30, rows: 20}}\n"
    "performers: {count: 5, groups: [{name: odd, members: [1, 3, 5], colour: \"#FFFFFF\"}, "
    "{name: even, members: [2, 4], colour: \"#FF0000\"}]}\n";

class Parts : public testing::Test {
 protected:
  void SetUp() override {
    folder_.write("bird.png", "x");
    folder_.write("bird.obj", "# bird\nv 0 0 0\nv 1 0.5 -2\nvt 0 0\nv +3.5e0\t4 5 1.0\nf 1 2 3\n");
  }
  static std::string from(const std::string& text) {
    return "sections:\n  - {name: s, start: count 1, from: " + text + "}\n";
  }
  std::vector<Part> parts(const std::string& text) {
    folder_.write("show.yaml", std::string(kHead) + from(text));
    const auto result = load_show(folder_.path("show.yaml"));
    EXPECT_TRUE(result) << (result ? "" : result.error().to_text());
    if (!result) return {};
    const auto* source = std::get_if<PartsSource>(&result->show.sections.at(0).from);
    EXPECT_NE(source, nullptr);
    return source == nullptr ? std::vector<Part>() : *source->parts;
  }
  std::string errors(const std::string& text) {
    folder_.write("show.yaml", std::string(kHead) + from(text));
    const auto result = load_show(folder_.path("show.yaml"));
    EXPECT_FALSE(result);
    return result ? "" : folder_.without_folder(result.error().to_text());
  }

  ShowFolder folder_;
};

TEST_F(Parts, AreDrawingsOfGroupsWithPlaceAndSize) {
  const auto all = parts(
      "{parts: [{group: odd, people: 2, shape: circle, at: [-20 m, 10 m], radius: 6 m}, "
      "{shape: arc, angle: 90 deg, spacing: 80 cm, turn: -30 deg}, {shape: block, rows: 3, width: 4 m, height: 2 m}, "
      "{group: even, text: \"走\", font: Noto Sans CJK SC Bold, height: 5 m}, {mesh: bird.obj, view: front, width: 9 "
      "m}, "
      "{image: bird.png, invert: true, width: 3 m}]}");
  ASSERT_EQ(all.size(), 6U);
  EXPECT_EQ(std::get<Shape>(all[0].drawing).kind, Shape::Kind::circle);
  EXPECT_EQ(all[0].group, GroupIndex(0));
  EXPECT_EQ(all[0].people, 2);
  EXPECT_EQ(all[0].at, (Point{-20, 10}));
  EXPECT_EQ(all[0].radius_m, 6);
  EXPECT_EQ(all[0].position.line, 6);
  EXPECT_EQ(all[0].position.column, 46);
  EXPECT_NEAR(std::get<Shape>(all[1].drawing).angle_rad, std::numbers::pi / 2, 1e-12);
  EXPECT_EQ(all[1].group, std::nullopt);
  EXPECT_EQ(all[1].people, std::nullopt);
  EXPECT_EQ(all[1].at, std::nullopt);
  EXPECT_DOUBLE_EQ(all[1].spacing_m, 0.8);
  EXPECT_NEAR(all[1].turn_rad, -std::numbers::pi / 6, 1e-12);
  EXPECT_EQ(std::get<Shape>(all[2].drawing).rows, 3);
  EXPECT_EQ(all[2].height_m, 2);
  EXPECT_EQ(std::get<Lettering>(all[3].drawing).text, "走");
  EXPECT_EQ(std::get<Lettering>(all[3].drawing).font, "Noto Sans CJK SC Bold");
  const auto& mesh = std::get<Mesh>(all[4].drawing);
  EXPECT_EQ(mesh.view, Mesh::View::front);
  EXPECT_EQ(mesh.vertices, (std::vector<std::array<double, 3>>{{0, 0, 0}, {1, 0.5, -2}, {3.5, 4, 5}}));
  EXPECT_TRUE(std::get<Picture>(all[5].drawing).options.invert);
}

TEST_F(Parts, MayBeASingleDrawingWithoutAList) {
  const auto one = parts("{shape: spiral, turns: 3, radius: 8 m}");
  ASSERT_EQ(one.size(), 1U);
  EXPECT_EQ(std::get<Shape>(one[0].drawing).turns, 3);
  const auto placed = parts("{image: bird.png, height: 8 m, colour: {from: \"#101010\", to: \"#404040\"}}");
  ASSERT_EQ(placed.size(), 1U);
  EXPECT_EQ(std::get<Picture>(placed[0].drawing).options.colour, (ColourRange{{0x10, 0x10, 0x10}, {0x40, 0x40, 0x40}}));
}

TEST_F(Parts, WithoutADrawingOrWithTwoAreRefused) {
  EXPECT_EQ(errors("{parts: []}"),
            "show.yaml:6:45: error: sections[0].from.parts: the list is empty (at least one part is needed)\n");
  EXPECT_EQ(
      errors("{parts: [{group: odd}, {shape: line, text: A}]}"),
      "show.yaml:6:46: error: sections[0].from.parts[0]: one of the keys shape, text, mesh, image is missing (give "
      "exactly one of them)\n"
      "show.yaml:6:74: error: sections[0].from.parts[1].text: does not go with \"shape\" (give exactly one of "
      "shape, text, mesh, image)\n");
}

TEST_F(Parts, RefuseGroupsAndShapesThatAreNone) {
  EXPECT_EQ(
      errors("{parts: [{group: od, shape: circel}]}"),
      "show.yaml:6:54: error: sections[0].from.parts[0].group: no group has the name \"od\" (did you mean \"odd\"?)\n"
      "show.yaml:6:65: error: sections[0].from.parts[0].shape: \"circel\" is not one of the choices (did you mean "
      "\"circle\"?)\n");
}

TEST_F(Parts, RefuseKeysThatMeanNothingForTheDrawing) {
  EXPECT_EQ(
      errors("{parts: [{shape: line, radius: 3 m, rows: 2, view: top}]}"),
      "show.yaml:6:60: error: sections[0].from.parts[0].radius: the key has no meaning here (a circle, ring, arc or "
      "spiral has a radius)\n"
      "show.yaml:6:73: error: sections[0].from.parts[0].rows: the key has no meaning here (only a block has rows)\n"
      "show.yaml:6:82: error: sections[0].from.parts[0].view: the key has no meaning here (it goes with a mesh)\n");
  EXPECT_EQ(
      errors("{shape: ring, radius: 3 m, spacing: 1 m, invert: true}"),
      "show.yaml:6:64: error: sections[0].from.spacing: the key has no meaning here (its size says how far people "
      "are from each other)\n"
      "show.yaml:6:78: error: sections[0].from.invert: the key has no meaning here (it goes with an image)\n");
  EXPECT_EQ(errors("{parts: [{shape: line}], width: 3 m}"),
            "show.yaml:6:62: error: sections[0].from.width: the key has no meaning here (write it into a part)\n");
}

TEST_F(Parts, RefusePlacesThatAreNone) {
  EXPECT_EQ(errors("{shape: line, at: 3 m}"),
            "show.yaml:6:55: error: sections[0].from.at: a single value stands where a place [x, y] belongs (write for "
            "example [-20 m, 10 m]: to stage left of the centre line, upstage of the edge)\n");
  EXPECT_EQ(
      errors("{shape: line, at: [3 m, 2]}"),
      "show.yaml:6:61: error: sections[0].from.at[1]: \"2\" has no unit (write for example \"0.5 m\"; units: m, cm, "
      "mm, ft, in)\n");
  EXPECT_EQ(
      errors("{shape: line, turn: 30}"),
      "show.yaml:6:57: error: sections[0].from.turn: \"30\" has no unit (write for example \"30 deg\"; units: rad, "
      "deg)\n");
}

TEST_F(Parts, RefuseTextWithNothingInIt) {
  EXPECT_EQ(errors("{text: \"  \"}"),
            "show.yaml:6:44: error: sections[0].from.text: there is nothing to draw in it (write a word or a sign)\n");
}

TEST_F(Parts, RefuseAMeshWithoutCornersOrWithBrokenOnes) {
  folder_.write("empty.obj", "o nothing\nvn 0 0 1\n");
  EXPECT_EQ(errors("{mesh: empty.obj}"),
            "empty.obj: error: the mesh has no corners (an OBJ file has lines like v 1.0 0.5 -2)\n");
  folder_.write("broken.obj", "v 0 0 0\nv 1 nan 2\n");
  EXPECT_EQ(errors("{mesh: broken.obj}"),
            "broken.obj:2:1: error: the corner is not three numbers (write for example v 1.0 0.5 -2)\n");
  EXPECT_EQ(errors("{mesh: none.obj}"),
            "show.yaml:6:44: error: sections[0].from.mesh: the file \"none.obj\" is missing (looked for none.obj)\n");
}

TEST_F(Parts, RefuseColoursThatAreNoRange) {
  EXPECT_EQ(
      errors("{image: bird.png, colour: {from: \"#404040\", to: \"#10FFFF\"}}"),
      "show.yaml:6:85: error: sections[0].from.colour.to: no colour lies between #404040 and #10FFFF (each of red, "
      "green and blue goes up from the one to the other)\n");
  EXPECT_EQ(
      errors("{image: bird.png, threshold: 3, colour: {from: \"#404040\", to: \"#FFFFFF\"}}"),
      "show.yaml:6:55: error: sections[0].from.threshold: the key has no meaning here (the colours say what is the "
      "picture)\n");
}

}  // namespace
}  // namespace footlight::config
