// SPDX-License-Identifier: Apache-2.0
// Painted sections from the show to a plan that is proved.
#include <algorithm>

#include <gtest/gtest.h>

#include "core/motion.hpp"
#include "planner/painted/walls.hpp"
#include "planner/plan_show.hpp"
#include "planner/validate.hpp"
#include "tests/planner/painted/painted_show.hpp"

namespace footlight::planner {
namespace {

using test::kGrey;
using test::PaintedShow;

Film film_of(const PaintedShow& one) {
  Film film;
  const RgbPicture picture = one.painter.picture();
  film.width = picture.width;
  film.height = picture.height;
  film.rgb = one.painter.rgb();
  return film;
}

void paint_into(PaintedShow& one, std::size_t section) {
  auto motion = std::make_shared<Motion>();
  motion->options = one.options;
  one.show.sections[section].motion = motion;
  one.show.sections[section].planner.model = PlannerModel::painted;
}

TEST(PaintedSection, BringsItsOwnBeginningAndIsProved) {
  PaintedShow one;
  one.show.sections[0].duration_counts = 100;
  paint_into(one, 0);
  const auto planned = plan_show(one.show, {film_of(one)});
  ASSERT_TRUE(planned) << planned.error().message;
  EXPECT_TRUE(planned->plan.valid);
  const auto scene = one.read();
  ASSERT_TRUE(scene);
  const auto same = [](std::vector<CellIndex> a, std::vector<CellIndex> b) {
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    return a == b;
  };
  EXPECT_TRUE(same(planned->plan.formations.front().cells, scene->begin_cells()));
  EXPECT_TRUE(same(planned->plan.formations.back().cells, scene->end_cells()));
}

TEST(PaintedSection, ItsWallsStandInThePlanAndNobodyComesNear) {
  PaintedShow one;
  one.show.sections[0].duration_counts = 160;
  one.painter.box(54, 0, 66, 32, kGrey);
  one.painter.box(54, 50, 66, 80, kGrey);
  paint_into(one, 0);
  const auto planned = plan_show(one.show, {film_of(one)});
  ASSERT_TRUE(planned) << planned.error().message;
  EXPECT_TRUE(planned->plan.valid) << (planned->refusal.empty() ? "" : planned->refusal.front());
  EXPECT_EQ(planned->plan.stage.blocked, covered_cells(one.show.stage, one.painter.picture(), one.options));
  EXPECT_FALSE(planned->plan.stage.blocked.empty());
}

TEST(PaintedSection, TakesPeopleFromTheSectionBefore) {
  PaintedShow one;
  Section lines = test::section_of(
      "lines", CellsSource{"lines.csv", test::cells_in(one.show.stage.grid, "A1:T2"), false, {}}, 1, 0, 4, 6);
  one.show.sections.insert(one.show.sections.begin(), lines);
  one.show.sections[1].start_count = 60;
  one.show.sections[1].duration_counts = 100;
  paint_into(one, 1);
  const auto planned = plan_show(one.show, {std::nullopt, film_of(one)});
  ASSERT_TRUE(planned) << planned.error().message;
  EXPECT_TRUE(planned->plan.valid);
}

TEST(PaintedSection, HasItsBeginningWhereTheSectionBeforeTouchesIt) {
  PaintedShow one;
  const auto scene = one.read();
  ASSERT_TRUE(scene);
  std::vector<CellIndex> begin = scene->begin_cells();
  std::reverse(begin.begin(), begin.end());
  const Section lines = test::section_of("lines", CellsSource{"lines.csv", begin, false, {}}, 1, 0, 59, 6);
  one.show.sections.insert(one.show.sections.begin(), lines);
  one.show.sections[1].start_count = 60;
  one.show.sections[1].duration_counts = 100;
  paint_into(one, 1);
  const auto planned = plan_show(one.show, {std::nullopt, film_of(one)});
  ASSERT_TRUE(planned) << planned.error().message;
  EXPECT_TRUE(planned->plan.valid);
  EXPECT_EQ(planned->plan.formations[1].count, 60);
  EXPECT_EQ(planned->plan.formations[1].cells, planned->plan.formations[0].cells);
}

TEST(PaintedSection, GroupsKeepTheirOwnShapes) {
  PaintedShow one;
  one.show.groups = {{"red", {255, 0, 0}, true}, {"blue", {0, 0, 255}, true}};
  for (std::size_t p = 0; p < 40; ++p) one.show.performers[p].group = GroupIndex::of(p < 20 ? 0 : 1);
  one.painter = test::Painter(120, 80);
  one.options.paint.clear();
  const std::array<Colour, 4> colours{{{0, 200, 0}, {0, 120, 0}, {200, 120, 0}, {120, 60, 0}}};
  for (int k = 0; k < 4; ++k) {
    Paint paint{colours.at(std::size_t(k)), Paint::Role::shape, GroupIndex::of(k / 2), 1 + k % 2, 10,
                {"show.yaml", 10, 7}};
    one.options.paint.push_back(paint);
    const int left = k % 2 == 0 ? 4 : 92;
    const int top = k / 2 == (k % 2) ? 6 : 46;
    one.painter.box(left, top, left + 24, top + 28, paint.colour);
  }
  one.show.sections[0].duration_counts = 120;
  paint_into(one, 0);
  const auto planned = plan_show(one.show, {film_of(one)});
  ASSERT_TRUE(planned) << planned.error().message;
  EXPECT_TRUE(planned->plan.valid) << (planned->refusal.empty() ? "" : planned->refusal.front());
  // The two groups cross: red begins upstage and ends downstage.
  const Grid& grid = one.show.stage.grid;
  double begin = 0;
  double end = 0;
  for (std::size_t p = 0; p < 20; ++p) {
    begin += grid.centre(planned->plan.formations.front().cells[p]).y / 20;
    end += grid.centre(planned->plan.formations.back().cells[p]).y / 20;
  }
  EXPECT_GT(begin, 13);
  EXPECT_LT(end, 7);
}

}  // namespace
}  // namespace footlight::planner
