// SPDX-License-Identifier: Apache-2.0
#include "planner/painted/scene.hpp"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "tests/planner/painted/painted_show.hpp"

namespace footlight::planner {
namespace {

using test::kGrey;
using test::PaintedShow;

std::string refused(const PaintedShow& one) {
  const auto scene = one.read();
  EXPECT_FALSE(scene);
  return scene ? "" : scene.error().message;
}

TEST(PaintedScene, PeopleBeginInTheFirstShapeAndEndInTheLastOnCellsOfTheirOwn) {
  const PaintedShow one;
  const auto scene = one.read();
  ASSERT_TRUE(scene) << scene.error().message;
  ASSERT_EQ(scene->parties.size(), 1U);
  const auto& party = scene->parties[0];
  EXPECT_EQ(party.people, 40);
  EXPECT_EQ(std::set<CellIndex>(party.begin.begin(), party.begin.end()).size(), 40U);
  EXPECT_EQ(std::set<CellIndex>(party.end.begin(), party.end.end()).size(), 40U);
  const Grid& grid = one.show.stage.grid;
  for (const CellIndex cell : party.begin) EXPECT_LT(grid.centre(cell).x, -8) << grid.name(cell);
  for (const CellIndex cell : party.end) EXPECT_GT(grid.centre(cell).x, 8) << grid.name(cell);
  ASSERT_EQ(party.legs.size(), 1U);
  ASSERT_EQ(party.legs[0].strokes.size(), 1U);
  const Stroke& stroke = party.legs[0].strokes[0];
  EXPECT_LT(scene->floor.to_floor(stroke.line.front()).x, scene->floor.to_floor(stroke.line.back()).x);
  EXPECT_TRUE(scene->notes.empty());
}

TEST(PaintedScene, ThePaintingLiesOnTheFloorUpright) {
  const PaintedShow one;
  const auto scene = one.read();
  ASSERT_TRUE(scene);
  // 120 x 80 pixels on 30 m x 20 m: 4 pixels a metre, the top upstage.
  EXPECT_NEAR(scene->picture.pixel_m, 0.25, 1e-12);
  EXPECT_NEAR(scene->picture.to_floor({0, 0}).x, -15, 1e-9);
  EXPECT_NEAR(scene->picture.to_floor({0, 0}).y, 20, 1e-9);
}

TEST(PaintedScene, NeighboursStayNeighboursFromShapeToShape) {
  const PaintedShow one;
  const auto scene = one.read();
  ASSERT_TRUE(scene);
  const auto& party = scene->parties[0];
  int kept = 0;
  int all = 0;
  for (std::size_t a = 0; a < 40; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (distance(party.places[0][a], party.places[0][b]) > 1.1) continue;
      ++all;
      kept += distance(party.places[1][a], party.places[1][b]) < 3.2 ? 1 : 0;
    }
  }
  EXPECT_GT(kept, 0.85 * all) << all;
}

TEST(PaintedScene, GreyBlocksCellsForTheSection) {
  PaintedShow one;
  one.painter.box(56, 0, 64, 28, kGrey);
  const auto scene = one.read();
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_FALSE(scene->covered.empty());
  for (const CellIndex cell : scene->covered) {
    const Point at = one.show.stage.grid.centre(cell);
    EXPECT_LT(std::abs(at.x), 1.6);
    EXPECT_GT(at.y, 12.4);
    EXPECT_FALSE(scene->ways->can_stand(cell));
  }
  one.options.background = PaintedOptions::Background::attract;
  const auto gathered = one.read();
  ASSERT_TRUE(gathered);
  EXPECT_TRUE(gathered->covered.empty());
  EXPECT_TRUE(std::any_of(gathered->background_field.cells.begin(), gathered->background_field.cells.end(),
                          [](Point v) { return length(v) > 0.5; }));
}

TEST(PaintedScene, ColoursThatMeanNothingAreTold) {
  PaintedShow one;
  one.painter.box(50, 60, 70, 70, {20, 90, 220});
  const auto scene = one.read();
  ASSERT_TRUE(scene) << scene.error().message;
  ASSERT_EQ(scene->notes.size(), 1U);
  EXPECT_EQ(scene->notes[0], "2.1 % of the painting mean nothing and are taken for floor: no paint binds #145ADC");
}

TEST(PaintedScene, AnEmptyPaintingIsRefused) {
  PaintedShow one;
  one.painter = test::Painter(120, 80);
  EXPECT_EQ(refused(one),
            "show.yaml:7:5: error: sections[0]: 'painting.png' is empty: all of its pixels are white (paint shapes and "
            "strokes on it)");
}

TEST(PaintedScene, AColourThatIsNotInThePaintingIsRefused) {
  PaintedShow one;
  one.options.paint[2].colour = {40, 40, 240};
  EXPECT_EQ(refused(one),
            "show.yaml:12:7: error: sections[0].paint[2]: the colour #2828F0 is nowhere in 'painting.png' (the most "
            "frequent colour that is bound to nothing is #8F3131)");
}

TEST(PaintedScene, AShapeTooSmallForItsPeopleIsRefused) {
  PaintedShow one;
  one.painter.box(0, 0, 120, 80, {255, 255, 255});
  one.paint();
  one.painter.box(100, 20, 120, 52, {255, 255, 255});
  EXPECT_EQ(
      refused(one),
      "show.yaml:11:7: error: sections[0].paint[1]: the shape #00A000 has 10 free cells for 40 people of who is in "
      "no painted group (paint it larger, or take a finer grid)");
}

TEST(PaintedScene, AStrokeWithoutAGradientIsRefused) {
  PaintedShow one;
  one.stroke({220, 40, 40}, {220, 40, 40});
  EXPECT_EQ(refused(one),
            "show.yaml:12:7: error: sections[0].paint[2]: the stroke #DC2828 has no gradient: its brightness does not "
            "fall by 10 of 255 from one end to the other, so that its sense is open (paint it bright where people come "
            "from and dark where they go)");
}

TEST(PaintedScene, AStrokeThatLeadsBackwardsIsRefused) {
  PaintedShow one;
  one.stroke({110, 20, 20}, {255, 150, 150});
  EXPECT_EQ(
      refused(one),
      "show.yaml:12:7: error: sections[0].paint[2]: the stroke #DC2828 leads backwards between shape 1 and shape 2 "
      "of who is in no painted group: its bright end is at shape 2 (a stroke is bright where people come from)");
}

TEST(PaintedScene, AStrokeThatDoesNotConnectItsShapesIsRefused) {
  PaintedShow one;
  one.painter.box(24, 30, 96, 50, {255, 255, 255});
  one.painter.stroke({{50, 40}, {70, 40}}, 4, {255, 150, 150}, {110, 20, 20});
  const std::string message = refused(one);
  EXPECT_NE(
      message.find("sections[0].paint[2]: the stroke #DC2828 does not connect shape 1 and shape 2 of who is in no "
                   "painted group: its tail is "),
      std::string::npos)
      << message;
}

TEST(PaintedScene, AWallThatCutsTheWayIsRefused) {
  PaintedShow one;
  one.painter.box(56, 0, 64, 80, kGrey);
  one.options.paint.pop_back();
  const std::string message = refused(one);
  EXPECT_NE(
      message.find("show.yaml:7:5: error: sections[0]: who is in no painted group cannot come from shape 1 to shape "
                   "2: what is blocked cuts cell "),
      std::string::npos)
      << message;
}

TEST(PaintedScene, AWallAcrossAStrokeIsNamed) {
  PaintedShow one;
  one.painter.box(56, 20, 64, 60, kGrey);
  const auto scene = one.read();
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.error().message,
            "show.yaml:12:7: error: sections[0].paint[2]: the background cuts the stroke #DC2828 between shape 1 and "
            "shape 2 of who is in no painted group: a piece of it ends there (leave a gap in the background, or lead "
            "the stroke around it)");
}

TEST(PaintedScene, TwoStrokesOfOneColourThatCrossAreTold) {
  PaintedShow one;
  EXPECT_TRUE(one.read()->notes.empty());
  one.painter.stroke({{60, 20}, {60, 60}}, 4, {255, 150, 150}, {110, 20, 20});
  const auto scene = one.read();
  ASSERT_TRUE(scene) << scene.error().message;
  ASSERT_EQ(scene->notes.size(), 1U);
  EXPECT_NE(scene->notes[0].find("% of the stroke #DC2828 lie beside the line that is read from it: it forks, turns "
                                 "back within its own width, or two strokes of this colour cross"),
            std::string::npos)
      << scene->notes[0];
}

TEST(PaintedScene, AGroupWithOneShapeHasNowhereToGo) {
  PaintedShow one;
  one.options.paint.erase(one.options.paint.begin() + 1, one.options.paint.end());
  EXPECT_EQ(refused(one),
            "show.yaml:7:5: error: sections[0]: who is in no painted group has one shape only in the painting (paint "
            "where they stand at the beginning and where at the end, two colours with order 1 and 2)");
}

TEST(PaintedScene, TwoShapesOfOneOrderAreRefused) {
  PaintedShow one;
  one.options.paint[1].order = 1;
  EXPECT_EQ(refused(one),
            "show.yaml:11:7: error: sections[0].paint[1]: a second shape of who is in no painted group has the order 1 "
            "(give every shape a place of its own in the sequence)");
}

TEST(PaintedScene, WhoIsInNoPaintedGroupIsMissed) {
  PaintedShow one;
  one.show.groups.push_back({"red", {}, true});
  for (std::size_t p = 0; p < 30; ++p) one.show.performers[p].group = GroupIndex(0);
  for (Paint& paint : one.options.paint) paint.group = GroupIndex(0);
  EXPECT_EQ(refused(one),
            "show.yaml:7:5: error: sections[0]: 10 performers are in no group of the painting (bind a shape for "
            "everybody else, without a group, or put them into a painted group)");
  for (Performer& performer : one.show.performers) performer.group.reset();
  one.options.paint.push_back(one.options.paint[0]);
  one.options.paint.back().group.reset();
  EXPECT_EQ(refused(one),
            "show.yaml:10:7: error: sections[0].paint[0]: nobody is in group 'red' (leave the paint out, or give it a "
            "group that has people)");
}

TEST(Marks, AStrokeHasItsHueWhateverItsBrightness) {
  const PaintedShow one;
  const auto marks = read_marks(one.painter.picture(), one.options);
  for (int x = 30; x < 90; ++x) EXPECT_EQ(marks.at(x, 40), 2) << x;
  EXPECT_EQ(marks.at(10, 40), 0);
  EXPECT_EQ(marks.at(110, 40), 1);
  EXPECT_EQ(marks.at(60, 5), kFloorMark);
}

TEST(Marks, GreyIsBackgroundWithinItsTolerance) {
  test::Painter painter(8, 8);
  painter.box(0, 0, 2, 8, {100, 100, 100});
  painter.box(2, 0, 4, 8, {100, 108, 100});
  painter.box(4, 0, 8, 8, {100, 130, 100});
  const auto marks = read_marks(painter.picture(), {});
  EXPECT_EQ(marks.at(0, 0), kBackgroundMark);
  EXPECT_EQ(marks.at(3, 0), kBackgroundMark);
  EXPECT_EQ(marks.at(7, 0), kUnknownMark);
  // Two pixels beside a mark are the soft edge of a brush.
  EXPECT_EQ(marks.at(5, 0), kFloorMark);
}

TEST(Marks, ThinWallsStayOnACoarserFloor) {
  test::Painter painter(60, 60);
  painter.box(0, 30, 60, 32, kGrey);
  const auto picture = painter.picture();
  const auto marks = read_marks(picture, {});
  const PictureFloor fine{{0, 60}, 1};
  const auto coarse = marks_on_floor(picture, marks, fine, fine.coarser(5), 12, 12);
  for (int x = 0; x < 12; ++x) EXPECT_EQ(coarse.marks.at(x, 6), kBackgroundMark);
}

TEST(Marks, BrightnessIsPerceived) {
  EXPECT_NEAR(brightness({255, 255, 255}), 255, 1e-3);
  EXPECT_NEAR(brightness({100, 0, 0}), 29.9, 1e-3);
}

}  // namespace
}  // namespace footlight::planner
