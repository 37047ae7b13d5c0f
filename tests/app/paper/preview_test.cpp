// SPDX-License-Identifier: Apache-2.0
#include "app/paper/preview.hpp"

#include <cmath>
#include <span>

#include <gtest/gtest.h>

#include "tests/support/films.hpp"
#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

constexpr int kWidth = 640;
constexpr int kHeight = 480;

/// Blue, green and red of a pixel.
std::array<int, 3> pixel(Canvas& canvas, Point at) {
  const auto pixels = canvas.pixels();
  const std::size_t i =
      static_cast<std::size_t>(canvas.stride()) * static_cast<std::size_t>(at.y) + 4 * static_cast<std::size_t>(at.x);
  return {pixels[i], pixels[i + 1], pixels[i + 2]};
}

TEST(View, DownstageIsBelowAndStageLeftIsRightFromBothSeats) {
  const Grid grid = *Grid::make(GridKind::square, 20, 12, 1);
  for (const Seat seat : {Seat::above, Seat::audience}) {
    const View view(seat, grid, {10, 20}, 600, 400);
    const Point near = view.at({0, 0.5});
    const Point far = view.at({0, 11.5});
    EXPECT_GT(near.y, far.y);
    EXPECT_LT(view.at({-5, 3}).x, view.at({5, 3}).x);
    EXPECT_NEAR(near.x, 310, 1e-6) << "the centre line is in the middle";
    EXPECT_NEAR(far.x, 310, 1e-6);
    for (const double x : {-10.0, 10.0}) {
      for (const double y : {0.0, 12.0}) {
        for (const double z : {0.0, 2.0}) {
          const Point at = view.at({x, y}, z);
          EXPECT_GE(at.x, 10 - 1e-6);
          EXPECT_LE(at.x, 610 + 1e-6);
          EXPECT_GE(at.y, 20 - 1e-6);
          EXPECT_LE(at.y, 420 + 1e-6);
        }
      }
    }
  }
  const View seat(Seat::audience, grid, {0, 0}, 600, 400);
  EXPECT_GT(seat.scale_at({0, 0}), seat.scale_at({0, 12})) << "what is far is small";
  EXPECT_LT(seat.at({0, 6}, 1.7).y, seat.at({0, 6}).y) << "heads are above feet";
}

TEST(Preview, EverybodyIsADotWhereThePlanHasHer) {
  const tests::SmallShow cast = tests::random_show(24, 16, 30, 2, 4, 5);
  const Stamp stamp(cast.plan);
  const PreviewFrame frame(cast.plan, cast.show, stamp, {}, {}, kWidth, kHeight);
  for (const double time_s : {0.0, 1.3, 7.9, 12.0, 17.0}) {
    Canvas canvas = Canvas::png(kWidth, kHeight, kOnScreen.ground);
    frame.draw_still(canvas, frame.preview().section_of(instant_at(time_s)));
    frame.draw_moving(canvas, instant_at(time_s));
    for (std::size_t p = 0; p < 30; ++p) {
      const Point at =
          frame.preview().view().at(position_at(cast.plan.stage.grid, cast.plan.tracks[p], instant_at(time_s)));
      const auto [blue, green, red] = pixel(canvas, at);
      // Somebody else may be drawn over her here; some group's colour is there.
      EXPECT_TRUE((blue == 0 && green == 200 && red == 0) || (blue == 180 && green == 105 && red == 255))
          << p << " at " << time_s << " s: " << red << " " << green << " " << blue;
    }
  }
}

TEST(Preview, WhoIsOutsideOfTheFilmHasAColourOfItsOwn) {
  tests::SmallShow cast = tests::random_show(20, 10, 2, 1, 2, 5);
  const Grid& grid = cast.plan.stage.grid;
  cast.plan.tracks = {{tests::mark_at(0, grid, 4, 4), tests::mark_at(4, grid, 4, 4)},
                      {tests::mark_at(0, grid, 15, 4), tests::mark_at(4, grid, 15, 4)}};
  // The left half of the picture, one pixel a cell.
  const Film film = tests::film_of(1, [](int) { return tests::mask_where(20, 10, [](int x, int) { return x < 10; }); });
  FilmPlacement placement;
  placement.show_fps = 0;
  placement.stage_to_frame = {1, 0, 10, 0, -1, 10};
  cast.plan.sections[0].film = placement;
  const Stamp stamp(cast.plan);
  for (const Seat seat : {Seat::above, Seat::audience}) {
    const PreviewFrame frame(cast.plan, cast.show, stamp, {&film}, {seat, true}, kWidth, kHeight);
    Canvas canvas = Canvas::png(kWidth, kHeight, kOnScreen.ground);
    frame.draw_still(canvas, SectionIndex(0));
    frame.draw_moving(canvas, instant_at(1));
    const View& view = frame.preview().view();
    const double chest_m = seat == Seat::above ? 0 : 1;
    const auto inside = pixel(canvas, view.at(grid.centre(Cell{4, 4}), chest_m));
    EXPECT_GT(inside[0], 200) << "white";
    const auto outside = pixel(canvas, view.at(grid.centre(Cell{15, 4}), chest_m));
    EXPECT_EQ(outside, (std::array<int, 3>{0, 94, 213})) << "vermilion";
    // The film lies on the left half of the floor, up to its edges; the centre line is between.
    for (const double y : {0.3, 3.3, 6.6, 9.7}) {
      for (const double x : {0.3, 2.3, 9.7}) {
        const auto shown = pixel(canvas, view.at({-x, y}));
        const auto dark = pixel(canvas, view.at({x, y}));
        EXPECT_GT(shown[0], dark[0] + 20) << x << " " << y;
      }
    }
  }
}

TEST(Preview, AContactSheetShowsEveryKeyFormation) {
  const tests::SmallShow cast = tests::random_show(24, 16, 30, 2, 4, 5);
  const Stamp stamp(cast.plan);
  Canvas svg = Canvas::svg(800, 600);
  draw_contact_sheet(svg, cast.plan, cast.show, stamp, {}, {});
  const std::string text = svg.finish();
  std::size_t round = 0;
  for (std::size_t at = text.find("stroke-linecap"); at != std::string::npos;
       at = text.find("stroke-linecap", at + 1)) {
    if (text.compare(at, 20, "stroke-linecap:round") == 0 || text.compare(at, 22, "stroke-linecap=\"round\"") == 0)
      ++round;
  }
  EXPECT_EQ(round, 30 * cast.plan.formations.size());
}

TEST(Canvas, ACapsuleIsAsLargeAsItsRadiusSays) {
  Canvas canvas = Canvas::png(60, 40, {0, 0, 0});
  const Capsule capsule{{20, 20}, {40, 20}, 5, {1, 1, 1}};
  canvas.capsules(std::span(&capsule, 1));
  double area = 0;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 60; ++x) area += pixel(canvas, Point{x + 0.0, y + 0.0})[0] / 255.0;
  }
  EXPECT_NEAR(area, 20 * 10 + M_PI * 25, 3);
  const Capsule outside{{-3, 45}, {70, -9}, 5, {1, 1, 1}};
  canvas.capsules(std::span(&outside, 1));  // what is outside is cut off
}

}  // namespace
}  // namespace footlight::app
