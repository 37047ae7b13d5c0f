// SPDX-License-Identifier: Apache-2.0
//
// Pictures as they come: whatever a film shows, the plan is sound and the drawing gives way before the limits do.
#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planner/formation/cell_shares.hpp"
#include "planner/plan_show.hpp"
#include "planner/validate.hpp"
#include "tests/support/films.hpp"

namespace footlight::planner {
namespace {

constexpr PlannerModel kModels[] = {PlannerModel::flat, PlannerModel::hierarchical, PlannerModel::joint};

/// People on 40 x 24 cells of a metre, the outer columns in reserve.
Show floor_of(int people, PlannerModel model) {
  Show show;
  show.file = "show.yaml";
  show.title = "Pictures";
  show.stage.grid = *Grid::make(GridKind::square, 40, 24, 1.0);
  for (int row = 0; row < 24; ++row) {
    for (const int column : {0, 1, 2, 3, 36, 37, 38, 39}) {
      show.stage.reserve.push_back(show.stage.grid.index({column, row}));
    }
  }
  std::sort(show.stage.reserve.begin(), show.stage.reserve.end());
  for (int p = 0; p < people; ++p) {
    Performer performer;
    performer.id = performer.name = std::to_string(p + 1);
    show.performers.push_back(performer);
  }
  Section section;
  section.name = "film";
  section.from = VideoSource{"film.mp4", 0, std::nullopt, {}};
  section.duration_counts = 80;
  section.planner.model = model;
  section.position = {"show.yaml", 31, 5};
  show.sections.push_back(section);
  return show;
}

Planned sound_plan(const Show& show, const Film& film) {
  auto planned = plan_show(show, {film});
  if (!planned) {
    ADD_FAILURE() << planned.error().message;
    return {};
  }
  EXPECT_TRUE(planned->plan.valid) << testing::PrintToString(planned->refusal);
  EXPECT_TRUE(validate(planned->plan).valid());
  for (const Formation& formation : planned->plan.formations) {
    EXPECT_EQ(std::set<CellIndex>(formation.cells.begin(), formation.cells.end()).size(), show.performers.size());
  }
  return std::move(planned).value();
}

/// Share of the people in the picture's formation who stand on picture.
double on_picture(const Show& show, const Plan& plan, const Film& film, const Formation& formation) {
  const auto frame = static_cast<std::size_t>(*formation.frame - film.first_frame);
  const auto shares = cell_shares(film.frames[frame], show.stage.grid, plan.sections[0].film->stage_to_frame);
  double covered = 0;
  double people = 0;
  for (const CellIndex cell : formation.cells) {
    if (std::binary_search(show.stage.reserve.begin(), show.stage.reserve.end(), cell)) continue;
    covered += shares[cell.at()];
    people += 1;
  }
  return covered / people;
}

TEST(Pictures, AreaMayGrowTenfoldAndShrinkAgain) {
  const Film film = tests::film_of(101, [](int f) {
    return tests::disc(160, 96, 80, 48,
                       12 + 26 * std::sin(3.14159265 * f / 100));  // 12 to 38 pixels: ten times as much
  });
  for (const PlannerModel model : kModels) {
    const Show show = floor_of(180, model);
    const Plan plan = sound_plan(show, film).plan;
    const auto most = std::max_element(plan.formations.begin(), plan.formations.end(),
                                       [](const auto& a, const auto& b) { return a.in_picture < b.in_picture; });
    // Joint leaves out who would be outside of the picture on the way for longer than inside of it.
    EXPECT_GT(most->in_picture, model == PlannerModel::joint ? 90 : 130);
    EXPECT_GT(on_picture(show, plan, film, *most), 0.8);
    EXPECT_LT(plan.formations.back().in_picture, 40);
  }
}

TEST(Pictures, AHardCutTakesTheTimeThatTheWalkNeedsAndThenDrawsThePicture) {
  const Film film =
      tests::film_of(101, [](int f) { return tests::disc(160, 96, f < 30 ? 45 : 115, f < 30 ? 60 : 36, 25); });
  for (const PlannerModel model : kModels) {
    const Show show = floor_of(110, model);
    const Planned planned = sound_plan(show, film);
    EXPECT_GT(on_picture(show, planned.plan, film, planned.plan.formations.front()), 0.85);
    EXPECT_GT(on_picture(show, planned.plan, film, planned.plan.formations.back()), 0.85);
  }
}

TEST(Pictures, SeveralPartsHolesAndThinLinesAreDrawnByExactlyEverybody) {
  const Film film = tests::film_of(50, [](int f) {
    return tests::mask_where(160, 96, [f](int x, int y) {
      const auto from = [&](double x0, double y0) { return std::hypot(x - x0, y - y0); };
      const bool ring = from(50 + 0.3 * f, 48) < 26 && from(50 + 0.3 * f, 48) > 14;
      const bool dots = from(115, 20) < 9 || from(130, 70) < 7;
      return ring || dots || (y / 2 == 24 && x > 20 && x < 140);
    });
  });
  for (const PlannerModel model : kModels) {
    const Show show = floor_of(120, model);
    const Plan plan = sound_plan(show, film).plan;
    EXPECT_GE(plan.formations.front().in_picture, 100);
    EXPECT_GT(on_picture(show, plan, film, plan.formations.front()), 0.6);
  }
}

TEST(Pictures, TwoHalvesThatNoWalkCanJoinInTimeGiveWayAndSayBy) {
  // One half of the floor, then the other, ten times a minute at 0.3 m/s.
  const Film film = tests::film_of(80, [](int f) {
    return tests::mask_where(160, 96, [f](int x, int) { return f / 10 % 2 == 0 ? x < 40 : x >= 120; });
  });
  Show show = floor_of(150, PlannerModel::hierarchical);
  show.stage.max_speed_mps = 0.3;
  const Planned planned = sound_plan(show, film);
  EXPECT_THAT(planned.plan.sections[0].notes,
              testing::Contains(testing::MatchesRegex(
                  "the drawing gives way: [0-9]+ of [0-9]+ places \\([0-9]+ %\\) in [0-9]+ formations are not reached "
                  "in time, most in film/[0-9]+ \\([0-9]+ %\\), since nobody walks faster than 0.3 m/s")));
  show.sections[0].planner.model = PlannerModel::joint;
  sound_plan(show, film);
}

TEST(Pictures, TwoImagesThatNoWalkCanJoinInTimeAreRefusedByNameAndByWhatWouldDo) {
  Show show = floor_of(60, PlannerModel::hierarchical);
  show.stage.reserve.clear();
  Section left = show.sections[0];
  left.from = ImageSource{"left.png", {}};
  left.duration_counts = 0;
  left.hold_counts = 8;
  left.name = "left";
  Section right = left;
  right.from = ImageSource{"right.png", {}};
  right.name = "right";
  right.start_count = 13;
  right.position.line = 32;
  show.sections = {left, right};
  const auto half = [](bool first) {
    return tests::film_of(1, [first](int) {
      return tests::mask_where(160, 96, [first](int x, int) { return first ? x < 10 : x >= 150; });
    });
  };
  show.sections[0].from = ImageSource{"left.png", {Fit::contain, {}, {}}};
  show.sections[1].from = ImageSource{"right.png", {Fit::contain, {}, {}}};
  const auto planned = plan_show(show, {half(true), half(false)});
  ASSERT_TRUE(planned) << planned.error().message;
  EXPECT_FALSE(planned->plan.valid);
  // Which of the people on the far edges is named is the pairing's choice.
  EXPECT_THAT(planned->refusal,
              testing::ElementsAre(testing::MatchesRegex(
                  "show.yaml:32:5: error: sections\\[1\\]: performer [0-9]+ would walk 38.0 m from A[0-9]+ to AM[0-9]+ "
                  "between count 9 and count 13 at 19.0 m/s, 13.6 times the limit of 1.4 m/s \\(start the section 51 "
                  "counts later, hold the one before shorter, or slow the music to 8 counts a minute\\)")));
}

TEST(Pictures, EveryFitLaysFramesOfEveryShapeOnTheFloor) {
  for (const auto& [width, height] : {std::pair{300, 30}, std::pair{30, 300}, std::pair{64, 64}}) {
    const Film film = tests::film_of(20, [w = width, h = height](int f) {
      return tests::mask_where(w, h,
                               [=](int x, int y) { return (x + f) * 4 / w % 2 == 0 && (y + f) * 5 / h % 2 == 0; });
    });
    for (const Fit fit : {Fit::area, Fit::contain, Fit::cover}) {
      Show show = floor_of(90, PlannerModel::hierarchical);
      std::get<VideoSource>(show.sections[0].from).picture.fit = fit;
      const Plan plan = sound_plan(show, film).plan;
      EXPECT_GT(plan.formations.front().in_picture, 0);
    }
  }
}

TEST(Pictures, StopAtEveryStageAndNothingComesOut) {
  const Film film = tests::film_of(40, [](int f) { return tests::disc(160, 96, 60 + f, 48, 20); });
  for (const PlannerModel model : kModels) {
    const Show show = floor_of(70, model);
    std::vector<std::string> stages;
    Progress watch;
    watch.report = [&](std::string_view stage, double) {
      if (stages.empty() || stages.back() != stage) stages.emplace_back(stage);
    };
    ASSERT_TRUE(plan_show(show, {film}, watch));
    ASSERT_GE(stages.size(), 4U);
    for (std::size_t until = 0; until < stages.size(); ++until) {
      std::atomic<bool> stop = false;
      std::size_t seen = 0;
      std::string last;
      Progress progress;
      progress.stop = &stop;
      progress.report = [&](std::string_view stage, double) {
        if (last != stage && seen++ == until) stop = true;
        last = stage;
      };
      const auto planned = plan_show(show, {film}, progress);
      ASSERT_FALSE(planned) << "stopped in " << stages[until];
      EXPECT_EQ(planned.error().kind, ErrorKind::interrupted) << stages[until];
    }
  }
}

}  // namespace
}  // namespace footlight::planner
