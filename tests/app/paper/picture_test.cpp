// SPDX-License-Identifier: Apache-2.0
#include "app/paper/picture.hpp"

#include <cstring>
#include <string_view>

#include <cairo.h>
#include <gtest/gtest.h>

#include "app/paper/canvas.hpp"
#include "app/paper/drawn_floor.hpp"
#include "core/check.hpp"
#include "tests/support/plan_builder.hpp"

namespace footlight::app {
namespace {

struct Pixel {
  int red, green, blue;
  friend bool operator==(const Pixel&, const Pixel&) = default;
};

/// A PNG read back.
class Picture {
 public:
  explicit Picture(std::string_view png) : left_(png) {
    const auto read = [](void* self, unsigned char* data, unsigned size) {
      auto& left = static_cast<Picture*>(self)->left_;
      if (left.size() < size) return CAIRO_STATUS_READ_ERROR;
      std::memcpy(data, left.data(), size);
      left.remove_prefix(size);
      return CAIRO_STATUS_SUCCESS;
    };
    surface_ = cairo_image_surface_create_from_png_stream(read, this);
    FL_CHECK(cairo_surface_status(surface_) == CAIRO_STATUS_SUCCESS);
  }
  Picture(const Picture&) = delete;
  Picture& operator=(const Picture&) = delete;
  ~Picture() { cairo_surface_destroy(surface_); }

  int width() const { return cairo_image_surface_get_width(surface_); }
  int height() const { return cairo_image_surface_get_height(surface_); }
  Pixel at(int x, int y) const {
    std::uint32_t value = 0;
    std::memcpy(&value, cairo_image_surface_get_data(surface_) + y * cairo_image_surface_get_stride(surface_) + 4 * x,
                4);
    return {static_cast<int>(value >> 16U & 255U), static_cast<int>(value >> 8U & 255U),
            static_cast<int>(value & 255U)};
  }
  /// Pixels of about this colour.
  int count(Pixel colour) const {
    int out = 0;
    for (int y = 0; y < height(); ++y) {
      for (int x = 0; x < width(); ++x) {
        const Pixel p = at(x, y);
        if (std::abs(p.red - colour.red) + std::abs(p.green - colour.green) + std::abs(p.blue - colour.blue) < 6) ++out;
      }
    }
    return out;
  }

 private:
  std::string_view left_;
  cairo_surface_t* surface_ = nullptr;
};

constexpr Pixel kGreen{0, 255, 0};

/// One person on a floor of 10 x 4 cells, at A1 (downstage, stage right), then at J4.
struct Scene {
  Scene() {
    const Grid grid = *Grid::make(GridKind::square, 10, 4, 1);
    plan = tests::plan_of(grid, {{tests::mark_at(0, grid, 0, 0), tests::mark_at(10, grid, 9, 3)}});
    plan.show_hash = "0123456789abcdef";
    plan.valid = true;
    plan.sections.push_back({"a b", kStart, instant_at(10), 1.4, {}, {}, {}});
    plan.formations.push_back({"a b/1", SectionIndex(0), 1, kStart, {}, {CellIndex(0)}, 1});
    plan.formations.push_back({"a b/2", SectionIndex(0), 21, instant_at(10), {}, {CellIndex(39)}, 1});
    show.groups = {{"g", {0, 255, 0}}};
    show.performers = {{"1", "Ann", GroupIndex(0), 0, 0, ""}};
  }
  Plan plan;
  Show show;
};

TEST(Picture, DownstageIsBelowAndStageRightIsLeft) {
  const Scene scene;
  const Picture first(formation_png(scene.plan, scene.show, FormationIndex(0), nullptr));
  ASSERT_EQ(first.width(), 56 + 1600 + 24);  // 160 pixels a cell
  EXPECT_EQ(first.at(56 + 80, 84 + 3 * 160 + 80), kGreen);
  const Picture last(formation_png(scene.plan, scene.show, FormationIndex(1), nullptr));
  EXPECT_EQ(last.at(56 + 9 * 160 + 80, 84 + 80), kGreen);
  EXPECT_NE(last.at(56 + 80, 84 + 3 * 160 + 80), kGreen);
}

TEST(Picture, WhoWaitsInTheReserveIsDim) {
  Scene scene;
  scene.plan.sections[0].reserve = {CellIndex(0)};
  const Picture picture(formation_png(scene.plan, scene.show, FormationIndex(0), nullptr));
  EXPECT_EQ(picture.count(kGreen), 0);
  EXPECT_GT(picture.at(56 + 80, 84 + 3 * 160 + 80).green, 100);
}

TEST(Picture, TheFilmLiesWhereItsPlacementSays) {
  Scene scene;
  Film film;
  film.width = 20;
  film.height = 8;
  film.frames.emplace_back(20, 8);
  for (int y = 0; y < 2; ++y) {
    for (int x = 18; x < 20; ++x) film.frames[0].set(x, y);  // image right and top: stage left and upstage
  }
  // Two pixels a metre, from x = -5 m and y = 4 m.
  scene.plan.sections[0].film = FilmPlacement{"f", 0, 0, 0, 20, 8, 128, false, {2, 0, 10, 0, -2, 8}};
  const auto plain = formation_png(scene.plan, scene.show, FormationIndex(0), nullptr);
  const auto with_film = formation_png(scene.plan, scene.show, FormationIndex(0), &film);
  const Picture before(plain);
  const Picture after(with_film);
  // Beside the walk's end in the middle of J4, and in the next cell.
  EXPECT_NE(after.at(56 + 9 * 160 + 40, 84 + 30), before.at(56 + 9 * 160 + 40, 84 + 30));
  EXPECT_EQ(after.at(56 + 8 * 160 + 40, 84 + 30), before.at(56 + 8 * 160 + 40, 84 + 30));
  EXPECT_EQ(after.at(56 + 9 * 160 + 40, 84 + 160 + 60), before.at(56 + 9 * 160 + 40, 84 + 160 + 60));
}

TEST(Picture, TheSamePlanGivesTheSameBytes) {
  const Scene scene;
  EXPECT_EQ(formation_png(scene.plan, scene.show, FormationIndex(0), nullptr),
            formation_png(scene.plan, scene.show, FormationIndex(0), nullptr));
}

TEST(Picture, ARefusedPlanSaysSo) {
  Scene scene;
  const auto good = formation_png(scene.plan, scene.show, FormationIndex(0), nullptr);
  scene.plan.valid = false;
  const auto bad = formation_png(scene.plan, scene.show, FormationIndex(0), nullptr);
  EXPECT_EQ(Picture(good).count({255, 89, 77}), 0);
  EXPECT_GT(Picture(bad).count({255, 89, 77}), 100);
}

TEST(Picture, OtherGridsAreDrawn) {
  for (const GridKind kind : {GridKind::hexagonal, GridKind::triangular}) {
    Scene scene;
    scene.plan.stage.grid = *Grid::make(kind, 10, 4, 1);
    scene.plan.stage.blocked = {CellIndex(20)};
    const Picture picture(formation_png(scene.plan, scene.show, FormationIndex(0), nullptr));
    EXPECT_GT(picture.count(kGreen), 200);
  }
}

TEST(PictureName, SortsAndHasNoSpecialLetters) {
  const Scene scene;
  EXPECT_EQ(picture_name(scene.plan, FormationIndex(0)), "001-a-b-1.png");
  EXPECT_EQ(picture_name(scene.plan, FormationIndex(1)), "002-a-b-2.png");
}

/// A film of one pixel a cell that shows the left half of the floor.
Film left_half() {
  Film film;
  film.width = 10;
  film.height = 4;
  Mask mask(10, 4);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 5; ++x) mask.set(x, y);
  }
  film.frames = {mask, mask};
  return film;
}

TEST(Picture, WhoStandsOutsideOfThePictureIsARing) {
  Scene scene;
  const Film film = left_half();
  const Frame frame(scene.plan.stage.grid, {}, 1, 1);
  FilmPlacement placement;
  placement.stage_to_frame = {1, 0, -frame.low.x, 0, -1, frame.high.y};
  scene.plan.sections[0].film = placement;
  for (Formation& formation : scene.plan.formations) formation.frame = 0;
  const Picture inside(formation_png(scene.plan, scene.show, FormationIndex(0), &film));
  EXPECT_EQ(inside.at(56 + 80, 84 + 3 * 160 + 80), kGreen);
  const Picture outside(formation_png(scene.plan, scene.show, FormationIndex(1), &film));
  EXPECT_NE(outside.at(56 + 9 * 160 + 80, 84 + 80), kGreen) << "hollow";
  EXPECT_EQ(outside.at(56 + 9 * 160 + 80 - 17, 84 + 80), kGreen) << "with an edge";
}

TEST(Picture, SaysWhatItsMarksMean) {
  const Scene scene;
  const Picture picture(formation_png(scene.plan, scene.show, FormationIndex(0), nullptr));
  bool marked = false;
  for (int y = 84 + 640 + 56; y < 84 + 640 + 70; ++y) marked = marked || picture.at(56 + 8, y) == kGreen;
  EXPECT_TRUE(marked) << "a dot as those of the picture, below it";
}

TEST(Canvas, WordsAreShortenedToTheRoomThatTheyHave) {
  const Canvas paper = Canvas::png(10, 10, {0, 0, 0});
  const std::string name = "Amelia Pond";
  EXPECT_EQ(paper.shortened(name, 13, paper.width_of(name, 13)), name);
  EXPECT_EQ(paper.shortened(name, 13, paper.width_of(name, 13) - 1), "Amelia");
  const std::string part = paper.shortened("\u00c4\u00e4\u00e4\u00e4\u00e4\u00e4\u00e4", 13, 40);
  EXPECT_LE(paper.width_of(part, 13), 40);
  EXPECT_TRUE(part.ends_with("\u00e4\u2026")) << part;
  EXPECT_EQ(paper.shortened(name, 13, 3), "");
}

}  // namespace
}  // namespace footlight::app
