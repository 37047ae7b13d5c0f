// SPDX-License-Identifier: Apache-2.0
// The orderings of Li 2020, section V, on one small film; docs/li2020.md has them on real ones.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "planner/measure.hpp"
#include "planner/plan_show.hpp"
#include "tests/support/films.hpp"

namespace footlight::planner {
namespace {

constexpr std::size_t kPeople = 160;

/// A hook of two arms that stands still, turns by 120 degrees and stands still again.
Film draw_hook() {
  return tests::film_of(121, [](int frame) {
    const double turn = std::clamp((frame - 40) / 40.0, 0.0, 1.0) * 2 * std::numbers::pi / 3;
    return tests::mask_where(90, 90, [turn](int x, int y) {
      const double u = std::cos(turn) * (2 * x - 90) + std::sin(turn) * (2 * y - 90);
      const double v = -std::sin(turn) * (2 * x - 90) + std::cos(turn) * (2 * y - 90);
      return (std::abs(u) < 80 && std::abs(v) < 10) || (u > 60 && u < 80 && v > 0 && v < 50);
    });
  });
}

Show hook_show(PlannerModel model, int layers, double speed_mps) {
  Show show;
  show.stage.grid = *Grid::make(GridKind::square, 36, 36, 1.0);
  show.stage.clearance_m = 0.5;
  show.stage.max_speed_mps = speed_mps;
  show.performers.resize(kPeople);
  for (std::size_t p = 0; p < show.performers.size(); ++p) show.performers[p].id = std::to_string(p + 1);
  Section section;
  section.name = "hook";
  section.from = VideoSource{"hook.mp4", 0, std::nullopt, {}};
  section.duration_counts = 180;  // 90 s: 2,250 frames of show
  section.sampling.snap_to_count = false;
  section.planner.model = model;
  section.planner.layers = layers;
  section.planner.cost = PairingCost::euclidean;
  show.sections.push_back(section);
  return show;
}

Measures measured(const Show& show) {
  static const std::vector<std::optional<Film>> films{draw_hook()};
  const auto planned = plan_show(show, films);
  EXPECT_TRUE(planned);
  EXPECT_TRUE(planned->plan.valid);
  return measure(planned->plan, films).show;
}

Measures sampled(int interval_frames, double hash) {
  Show show = hook_show(PlannerModel::hierarchical, 2, 20);
  show.sections[0].sampling.interval = seconds(interval_frames / 25.0);
  show.sections[0].sampling.hash = hash;
  return measured(show);
}

TEST(Li2020, TheHierarchyDeviatesFarLessThanFlatMatchingAndAThirdLayerNotMore) {
  const double flat = *measured(hook_show(PlannerModel::flat, 2, 1.4)).theta_dev;
  const double two = *measured(hook_show(PlannerModel::hierarchical, 2, 1.4)).theta_dev;
  const double three = *measured(hook_show(PlannerModel::hierarchical, 3, 1.4)).theta_dev;
  RecordProperty("thetas", testing::PrintToString(std::vector{flat, two, three}));
  EXPECT_LT(two, 0.75 * flat);
  EXPECT_LT(three, 1.02 * two);
}

TEST(Li2020, DynamicSamplingDeviatesLessThanFixedOfTheSameIntervalOrWithAsManyKeyFrames) {
  const Measures dynamic = sampled(160, 0.1);
  const Measures same_interval = sampled(160, 1);
  EXPECT_LT(*dynamic.theta_dev, *same_interval.theta_dev);
  Measures as_many = same_interval;
  for (int interval = 140; as_many.formations < dynamic.formations; interval -= 10) as_many = sampled(interval, 1);
  EXPECT_LT(*dynamic.theta_dev, *as_many.theta_dev) << as_many.formations << " and " << dynamic.formations;
}

TEST(Li2020, HalfTheIntervalMakesMoreKeyFramesAndHardlyABetterDrawing) {
  const Measures c80 = sampled(80, 0.1);
  const Measures c40 = sampled(40, 0.1);
  EXPECT_GT(c40.formations, c80.formations);
  EXPECT_NEAR(*c40.theta_dev, *c80.theta_dev, 0.1 * *c80.theta_dev);
}

TEST(Li2020, AFinerHashMakesMoreKeyFramesAndACoarserOneDeviatesMore) {
  const Measures fine = sampled(160, 0.05);
  const Measures usual = sampled(160, 0.1);
  const Measures coarse = sampled(160, 0.2);
  EXPECT_GT(fine.formations, usual.formations);
  EXPECT_GT(usual.formations, coarse.formations);
  EXPECT_GT(*coarse.theta_dev, *usual.theta_dev);
}

}  // namespace
}  // namespace footlight::planner
