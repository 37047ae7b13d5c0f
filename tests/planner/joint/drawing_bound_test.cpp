// SPDX-License-Identifier: Apache-2.0
#include "planner/joint/drawing_bound.hpp"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"
#include "planner/plan_show.hpp"
#include "tests/planner/small_show.hpp"

namespace footlight::planner {
namespace {

constexpr int kCells = 8;

/// One row of cells, a pixel each, people who go one cell a second, an instant each second. The picture of each frame
/// is given as its pixels.
Plan row_plan(const std::vector<std::vector<int>>& at) {
  Plan plan;
  plan.stage.grid = *Grid::make(GridKind::square, kCells, 1, 1.0);
  PlanSection section;
  section.name = "film";
  section.max_speed_mps = 1;
  FilmPlacement film;
  film.show_fps = 1;
  film.width = kCells;
  film.height = 1;
  film.stage_to_frame = {1, 0, kCells / 2.0, 0, -1, 1};
  section.film = film;
  plan.sections.push_back(section);
  for (std::size_t p = 0; p < at.front().size(); ++p) plan.performers.push_back(std::to_string(p + 1));
  for (std::size_t k = 0; k < at.size(); ++k) {
    Formation formation;
    formation.section = SectionIndex(0);
    formation.time = kStart + seconds(static_cast<double>(k));
    formation.frame = static_cast<int>(k);
    for (const int column : at[k]) formation.cells.push_back(plan.stage.grid.index({column, 0}));
    plan.formations.push_back(formation);
  }
  return plan;
}
Film row_film(const std::vector<std::vector<int>>& pictures) {
  return tests::film_of(static_cast<int>(pictures.size()), [&](int f) {
    Mask mask(kCells, 1);
    for (const int x : pictures[static_cast<std::size_t>(f)]) mask.set(x, 0);
    return mask;
  });
}

/// theta_iou of one frame by sets of cells.
double iou(const std::vector<int>& people, const std::vector<int>& picture) {
  double both = 0;
  for (const int cell : people) both += std::count(picture.begin(), picture.end(), cell) > 0 ? 1 : 0;
  const double either = static_cast<double>(people.size() + picture.size()) - both;
  return either > 0 ? 1 - both / either : 0;
}

/// The least sum over all ways that two people can go.
double best_of_two(const std::vector<std::vector<int>>& pictures) {
  std::vector<std::vector<double>> least(kCells, std::vector<double>(kCells, 1e9));
  for (std::size_t k = 0; k < pictures.size(); ++k) {
    std::vector<std::vector<double>> next(kCells, std::vector<double>(kCells, 1e9));
    for (int a = 0; a < kCells; ++a) {
      for (int b = a + 1; b < kCells; ++b) {
        double before = k == 0 ? 0 : 1e9;
        for (int c = std::max(0, a - 1); k > 0 && c <= std::min(kCells - 1, a + 1); ++c) {
          for (int d = std::max(0, b - 1); d <= std::min(kCells - 1, b + 1); ++d) {
            before = std::min(before, least[static_cast<std::size_t>(c)][static_cast<std::size_t>(d)]);
          }
        }
        next[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)] = before + iou({a, b}, pictures[k]);
      }
    }
    least = next;
  }
  double out = 1e9;
  for (const auto& row : least) out = std::min(out, *std::min_element(row.begin(), row.end()));
  return out;
}

TEST(DrawingBound, IsNeverAboveTheBestOfAllWaysToWalk) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    std::vector<std::vector<int>> pictures;
    std::vector<std::vector<int>> at;
    for (std::size_t k = 0; k < 2 + rng.below(5); ++k) {
      std::vector<int> picture;
      for (int x = 0; x < kCells; ++x) {
        if (rng.below(3) == 0) picture.push_back(x);
      }
      pictures.push_back(picture);
      at.push_back({3, 4});
    }
    const auto bound = bound_drawing(row_plan(at), SectionIndex(0), row_film(pictures), 12);
    RC_ASSERT(bound.has_value());
    RC_ASSERT(bound->instants == pictures.size());
    const double best = best_of_two(pictures) / static_cast<double>(pictures.size());
    RC_ASSERT(bound->least <= best + 1e-9);
    RC_ASSERT(bound->nobody_walks <= bound->least);
    RC_ASSERT(best <= bound->of_plan + 1e-9);
  }));
}

TEST(DrawingBound, APictureThatJumpsFartherThanPeopleWalkCannotBeDrawn) {
  // Two of eight cells, at one end and at the other: people are at one of them, or on the way.
  const std::vector<std::vector<int>> pictures{{0, 1}, {0, 1}, {6, 7}, {6, 7}, {0, 1}, {0, 1}};
  const auto bound =
      bound_drawing(row_plan(std::vector<std::vector<int>>(6, {0, 1})), SectionIndex(0), row_film(pictures), 16);
  ASSERT_TRUE(bound);
  EXPECT_EQ(bound->nobody_walks, 0);
  const double best = best_of_two(pictures) / 6;
  EXPECT_NEAR(best, 1.0 / 3, 1e-9);
  EXPECT_GT(bound->least, 0.95 * best);
  EXPECT_LE(bound->least, best);
}

TEST(DrawingBound, APictureThatPeopleCanFollowNeedNotBeWorseThanItsFrames) {
  std::vector<std::vector<int>> pictures;
  for (int k = 0; k < 5; ++k) pictures.push_back({k, k + 1});
  const auto bound = bound_drawing(row_plan(pictures), SectionIndex(0), row_film(pictures), 4);
  ASSERT_TRUE(bound);
  EXPECT_EQ(bound->of_plan, 0);
  EXPECT_EQ(bound->least, 0);
}

TEST(DrawingBound, HoldsForEveryModeOfPlanning) {
  Show show = test::three_sections(60);
  test::Films films = test::three_films();
  // Twice as fast as anybody walks, there and back.
  films[1] = tests::film_of(40, [](int f) { return tests::disc(80, 60, 20 + 2 * std::abs(20 - f), 30, 15); });
  for (const PlannerModel model : {PlannerModel::flat, PlannerModel::hierarchical, PlannerModel::joint}) {
    show.sections[1].planner.model = model;
    const auto planned = plan_show(show, films);
    ASSERT_TRUE(planned);
    const auto bound = bound_drawing(planned->plan, SectionIndex(1), *films[1], 6);
    ASSERT_TRUE(bound);
    EXPECT_LE(bound->nobody_walks, bound->least);
    EXPECT_LE(bound->least, bound->of_plan);
    EXPECT_GT(bound->instants, 2U);
  }
}

TEST(DrawingBound, ThereIsNoneWithoutAFilmAndNoneWhenStopped) {
  Plan plan = row_plan({{0}, {1}, {2}});
  const Film film = row_film({{0}, {1}, {2}});
  const std::atomic<bool> stop{true};
  EXPECT_FALSE(bound_drawing(plan, SectionIndex(0), film, 4, {{}, &stop}));
  plan.sections[0].film.reset();
  EXPECT_FALSE(bound_drawing(plan, SectionIndex(0), film, 4));
}

}  // namespace
}  // namespace footlight::planner
