// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/planner/painted/painter.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace footlight {
namespace {

using planner::test::Painter;
using test::footlight;
using test::Ran;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* kHead = R"(footlight: 1
title: Painted
stage: {grid: {kind: square, columns: 30, rows: 20, pitch: 1 m}, clearance: 0.5 m, max_speed: 1.4 m/s}
performers: {count: 40}
music: {tempo: 120, meter: 4/4}
sections:
)";
constexpr const char* kPainted = R"(  - name: across
    from: {painting: painting.bmp}
    start: count 1
    duration: 80 counts
    planner: {model: painted}
    paint:
      - {colour: "#00C800", role: shape, order: 1}
      - {colour: "#00A000", role: shape, order: 2, tolerance: 18}
      - {colour: "#DC2828", role: stroke, tolerance: 15}
)";

class PaintingCommand : public ::testing::Test {
 protected:
  PaintingCommand() {
    painter_.box(2, 24, 22, 56, {0, 200, 0});
    painter_.box(98, 20, 118, 60, {0, 160, 0});
    painter_.stroke({{26, 40}, {94, 40}}, 5, {255, 150, 150}, {110, 20, 20});
    write_show(kPainted);
    write_painting();
  }
  void write_show(const std::string& sections) { folder_.write("show.yaml", kHead + sections); }
  void write_painting() {
    // BMP: a header of 54 bytes, then rows from the bottom, blue, green, red.
    constexpr int kWidth = 120;
    constexpr int kHeight = 80;
    constexpr int kBytes = 3 * kWidth * kHeight;
    std::string bmp = "BM";
    const auto number = [&](int value, int bytes) {
      for (int i = 0; i < bytes; ++i) bmp += static_cast<char>(value >> (8 * i) & 255);
    };
    for (const int value : {54 + kBytes, 0, 54, 40, kWidth, kHeight}) number(value, 4);
    number(1, 2);
    number(24, 2);
    for (const int value : {0, kBytes, 2835, 2835, 0, 0}) number(value, 4);
    for (int y = kHeight - 1; y >= 0; --y) {
      for (int x = 0; x < kWidth; ++x) {
        const Colour colour = painter_.picture().at(x, y);
        for (const int value : {colour.blue, colour.green, colour.red}) number(value, 1);
      }
    }
    folder_.write("painting.bmp", bmp);
  }
  /// The whole of stderr of a run that must fail.
  std::string refused(const std::vector<std::string>& words) {
    std::vector<std::string> all{"painting"};
    all.insert(all.end(), words.begin(), words.end());
    const Ran ran = footlight(all);
    EXPECT_EQ(ran.status, 2);
    EXPECT_EQ(ran.out, "");
    return ran.err;
  }

  Painter painter_{120, 80};
  test::TemporaryFolder folder_;
  std::string show_ = folder_ / "show.yaml";
};

TEST_F(PaintingCommand, DrawsAndTellsWithoutPlanning) {
  for (const char* name : {"out.svg", "out.png"}) {
    const Ran ran = footlight({"painting", show_, "-o", folder_ / name});
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(ran.err, "");
    EXPECT_THAT(ran.out, StartsWith("across: '"));
    EXPECT_THAT(ran.out,
                HasSubstr("painting.bmp', 120 x 80 pixels, 0.25 m each\neverybody else: 40 people\n  shape 1"));
    EXPECT_THAT(ran.out, HasSubstr("0 cells are blocked\n" + (folder_ / name) + "\n"));
  }
  EXPECT_THAT(folder_.read("out.svg"), StartsWith("<?xml"));
  EXPECT_THAT(folder_.read("out.png"), StartsWith("\x89PNG"));
}

TEST_F(PaintingCommand, TellsFiguresAsJson) {
  painter_.box(56, 0, 64, 24, {120, 120, 120});
  write_painting();
  const Ran ran = footlight({"painting", show_, "across", "--json"});
  ASSERT_EQ(ran.status, 0) << ran.err;
  const auto json = nlohmann::json::parse(ran.out);
  EXPECT_EQ(json["section"], "across");
  EXPECT_EQ(json["painting"]["width"], 120);
  EXPECT_EQ(json["painting"]["pixel_m"], 0.25);
  EXPECT_EQ(json["blocked_cells"], 2 * 6);
  EXPECT_EQ(json["files"], nlohmann::json::array());
  ASSERT_EQ(json["parties"].size(), 1U);
  const auto& party = json["parties"][0];
  EXPECT_TRUE(party["group"].is_null());
  EXPECT_EQ(party["people"], 40);
  EXPECT_EQ(party["shapes"][1]["order"], 2);
  const auto& stroke = party["legs"][0]["strokes"][0];
  EXPECT_NEAR(stroke["tail"][0].get<double>(), -8.5, 1.5);
  EXPECT_NEAR(stroke["head"][0].get<double>(), 8.5, 1.5);
  ASSERT_GT(stroke["line"].size(), 10U);
  EXPECT_EQ(stroke["line"].front()[0], stroke["tail"][0]);
  EXPECT_EQ(stroke["line"].back()[1], stroke["head"][1]);
  EXPECT_NEAR(stroke["line"][stroke["line"].size() / 2][2].get<double>(), 2.5, 0.5);
  EXPECT_NEAR(stroke["width_m"].get<double>(), 2.5, 0.5);
}

TEST_F(PaintingCommand, TellsOfColoursThatMeanNothing) {
  painter_.box(40, 66, 60, 78, {20, 20, 220});
  write_painting();
  const Ran ran = footlight({"painting", show_});
  EXPECT_EQ(ran.status, 0);
  EXPECT_EQ(ran.err, "note: 2.5 % of the painting mean nothing and are taken for floor: no paint binds #1414DC\n");
}

TEST_F(PaintingCommand, RefusesASectionThatIsNotThere) {
  EXPECT_EQ(refused({show_, "acros"}), "error: there is no section \"acros\" (did you mean \"across\"?)\n");
}

TEST_F(PaintingCommand, RefusesASectionThatFollowsNoPainting) {
  write_show(std::string(kPainted) + "  - {name: round, from: {shape: circle, radius: 8 m}, start: count 200}\n");
  EXPECT_EQ(refused({show_, "round"}), "error: section \"round\" follows no painting (these do: across)\n");
}

TEST_F(PaintingCommand, RefusesAShowWithoutAPainting) {
  write_show("  - {name: round, from: {shape: circle, radius: 8 m}, start: count 1}\n");
  EXPECT_EQ(refused({show_}),
            "error: no section of '" + show_ +
                "' follows a painting (one with model: painted and from: {painting: FILE.png} does)\n");
}

TEST_F(PaintingCommand, AsksWhichOfSeveralPaintings) {
  std::string back = kPainted;
  back.replace(back.find("across"), 6, "back");
  back.replace(back.find("count 1"), 7, "count 200");
  write_show(kPainted + back);
  EXPECT_EQ(refused({show_}), "error: name one of the show's paintings: across, back\n");
  EXPECT_EQ(footlight({"painting", show_, "back"}).status, 0);
}

TEST_F(PaintingCommand, RefusesAFileThatIsNoPicture) {
  EXPECT_EQ(refused({show_, "-o", "out.pdf"}),
            "error: 'out.pdf': a painting is drawn into a file that ends with .svg or .png\n");
}

TEST_F(PaintingCommand, SparesThePaintingItself) {
  std::string text = kPainted;
  text.replace(text.find("painting.bmp"), 12, "painting.png");
  ASSERT_EQ(footlight({"painting", show_, "-o", folder_ / "painting.png"}).status, 0);
  write_show(text);
  const std::string before = folder_.read("painting.png");
  EXPECT_EQ(
      refused({show_, "-o", folder_ / "painting.png"}),
      "error: '" + (folder_ / "painting.png") + "' is a file that the show reads (give the output another name)\n");
  EXPECT_EQ(folder_.read("painting.png"), before);
}

TEST_F(PaintingCommand, DrawsNothingOfAStrokeWithoutASense) {
  painter_.stroke({{26, 40}, {94, 40}}, 5, {220, 40, 40}, {220, 40, 40});
  write_painting();
  EXPECT_EQ(
      refused({show_, "-o", folder_ / "out.svg"}),
      show_ +
          ":15:9: error: sections[0].paint[2]: the stroke #DC2828 has no gradient: its brightness does not fall by "
          "10 of 255 from one end to the other, so that its sense is open (paint it bright where people come from "
          "and dark where they go)\n");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out.svg"));
}

}  // namespace
}  // namespace footlight
