// SPDX-License-Identifier: Apache-2.0
//
// What every model of motion owes (planner/motion/model.hpp), over the table of models.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <optional>
#include <ostream>
#include <set>
#include <string>
#include <variant>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "core/rng.hpp"
#include "planner/motion/models.hpp"
#include "tests/support/painted_between.hpp"
#include "tests/support/plan_builder.hpp"

namespace footlight::planner {
namespace {

struct Model {
  std::string name;
  MotionOptions options;
};

void PrintTo(const Model& model, std::ostream* out) { *out << model.name; }

/// Every model that leads a crowd. A painting brings its own places: here one is made of the task's.
std::vector<Model> models() {
  std::vector<Model> out;
  out.push_back({"srd", SrdOptions{}});
  out.push_back({"collective", CollectiveOptions{}});
  out.push_back({"swarm", SwarmOptions{}});
  out.push_back({"painted", PaintedOptions{}});
  return out;
}

/// A block of people at one side of a floor with a wall that has a gate, and their places at the other.
struct Scene {
  Stage stage;
  std::vector<CellIndex> from;
  std::vector<CellIndex> to;
  std::optional<Ways> ways;
  std::optional<MotionFloor> floor;
  MotionTask task;
  PaintedScene painting;
};

constexpr double kSpeed_mps = 1.2;
constexpr double kDuration_s = 40;
/// Dense enough that nothing is stepped over: nobody gets farther than 6 cm.
constexpr double kEvery_s = 0.05;

void lay_out(Scene& scene, std::size_t people, bool wall, double every_s) {
  scene.stage.grid = *Grid::make(GridKind::square, 30, 16, 1.0);
  for (int row = 0; wall && row < 16; ++row) {
    if (row < 5 || row > 10) scene.stage.blocked.push_back(scene.stage.grid.index({15, row}));
  }
  scene.ways.emplace(scene.stage, 0.25);
  scene.floor.emplace(*scene.ways, std::vector<MovingObstacle>{}, TempoMap(120), kStart);
  MotionTask& task = scene.task;
  for (std::size_t p = 0; p < people; ++p) {
    const int n = static_cast<int>(p);
    scene.from.push_back(scene.stage.grid.index({1 + n % 10, 2 + n / 10}));
    scene.to.push_back(scene.stage.grid.index({28 - n / 8, 3 + n % 8}));
    task.from.push_back(scene.stage.grid.centre(scene.from.back()));
    task.to.push_back(scene.stage.grid.centre(scene.to.back()));
  }
  task.group.assign(people, kNoGroup);
  for (std::size_t p = 0; p < people; ++p) task.group[p] = p % 2 == 0 ? 0 : 1;
  for (std::size_t p = 0; p < people; ++p) task.to_group.push_back(p % 2 == 0 ? 0 : 1);
  task.radius_m.assign(people, 0.25);
  task.speed_mps.assign(people, kSpeed_mps);
  for (double at_s = 0; at_s < kDuration_s + every_s / 2; at_s += every_s) task.at_s.push_back(at_s);
  task.floor = &*scene.floor;
  task.seed = 7;
  scene.painting = test::painted_between(task, !wall);
  task.painting = &scene.painting;
}

class MotionContract : public testing::TestWithParam<Model> {
 protected:
  static Trajectory led(const MotionTask& task, const MotionOptions& options) {
    auto out = move_crowd(task, options, {});
    EXPECT_TRUE(out) << (out ? "" : out.error().message);
    return out ? std::move(out).value() : Trajectory{};
  }
};

bool same(const Trajectory& a, const Trajectory& b) { return a.at == b.at && a.place_of == b.place_of; }

TEST_P(MotionContract, BeginsWherePeopleStandAndHasEveryInstant) {
  Scene scene;
  lay_out(scene, 40, true, 1);
  const Trajectory out = led(scene.task, GetParam().options);
  ASSERT_EQ(out.at.size(), scene.task.at_s.size());
  EXPECT_EQ(out.at.front(), scene.task.from);
  for (const auto& at : out.at) EXPECT_EQ(at.size(), 40U);
}

TEST_P(MotionContract, GivesEverybodyAPlaceOfHerGroup) {
  Scene scene;
  lay_out(scene, 40, true, 1);
  const Trajectory out = led(scene.task, GetParam().options);
  ASSERT_EQ(out.place_of.size(), 40U);
  EXPECT_EQ(std::set<std::uint32_t>(out.place_of.begin(), out.place_of.end()).size(), 40U);
  for (std::size_t p = 0; p < 40; ++p) {
    ASSERT_LT(out.place_of[p], 40U);
    EXPECT_EQ(scene.task.to_group[out.place_of[p]], scene.task.group[p]);
  }
}

TEST_P(MotionContract, LeadsPeopleToTheirPlaces) {
  Scene scene;
  lay_out(scene, 40, false, 1);
  const Trajectory out = led(scene.task, GetParam().options);
  std::size_t there = 0;
  for (std::size_t p = 0; p < 40; ++p) {
    there += distance(out.at.back()[p], scene.task.to[out.place_of[p]]) < 1.5 ? 1 : 0;
  }
  EXPECT_GE(there, 36U);  // the others are put on their places by the marks at the end
}

TEST_P(MotionContract, LetsNobodyIntoAnythingBlocked) {
  Scene scene;
  lay_out(scene, 60, true, kEvery_s);
  const Trajectory out = led(scene.task, GetParam().options);
  for (std::size_t k = 1; k < out.at.size(); ++k) {
    for (std::size_t p = 0; p < 60; ++p) {
      const auto near = scene.floor->nearest(out.at[k][p], 1);
      ASSERT_FALSE(near && near->distance_m < scene.ways->keep_m() - 1e-3)
          << "person " << p << " at " << scene.task.at_s[k] << " s, " << near->distance_m << " m from it";
    }
  }
}

TEST_P(MotionContract, LetsNobodyWalkFasterThanSheCan) {
  Scene scene;
  lay_out(scene, 60, true, kEvery_s);
  for (std::size_t p = 0; p < 60; p += 3) scene.task.speed_mps[p] = 0.9;
  const Trajectory out = led(scene.task, GetParam().options);
  for (std::size_t k = 1; k < out.at.size(); ++k) {
    for (std::size_t p = 0; p < 60; ++p) {
      const double speed_mps = distance(out.at[k][p], out.at[k - 1][p]) / (scene.task.at_s[k] - scene.task.at_s[k - 1]);
      ASSERT_LE(speed_mps, scene.task.speed_mps[p] * (1 + 1e-6)) << "person " << p << " at " << scene.task.at_s[k];
    }
  }
}

TEST_P(MotionContract, IsTheSameForAnyNumberOfThreads) {
  Scene scene;
  lay_out(scene, 120, false, 1);
  std::vector<Trajectory> all;
  for (const std::size_t threads : {1U, 2U, 8U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    all.push_back(led(scene.task, GetParam().options));
  }
  EXPECT_TRUE(same(all[0], all[1]));
  EXPECT_TRUE(same(all[0], all[2]));
}

TEST_P(MotionContract, IsTheSameTwiceForASeed) {
  Scene scene;
  lay_out(scene, 40, true, 1);
  EXPECT_TRUE(same(led(scene.task, GetParam().options), led(scene.task, GetParam().options)));
}

TEST_P(MotionContract, DoesNotDependOnWhichInstantsAreAskedFor) {
  Scene scene;
  lay_out(scene, 30, true, 1);
  const Trajectory often = led(scene.task, GetParam().options);
  MotionTask seldom = scene.task;
  seldom.at_s.clear();
  for (std::size_t k = 0; k < scene.task.at_s.size(); k += 4) seldom.at_s.push_back(scene.task.at_s[k]);
  const Trajectory out = led(seldom, GetParam().options);
  for (std::size_t k = 0; k < out.at.size(); ++k) {
    for (std::size_t p = 0; p < 30; ++p) EXPECT_LT(distance(out.at[k][p], often.at[4 * k][p]), 1e-6) << k << " " << p;
  }
}

std::vector<std::size_t> shuffled(std::size_t size, std::uint64_t seed) {
  std::vector<std::size_t> out(size);
  std::iota(out.begin(), out.end(), std::size_t{0});
  Rng rng(seed);
  for (std::size_t i = size; i-- > 1;) std::swap(out[i], out[rng.below(i + 1)]);
  return out;
}

TEST_P(MotionContract, IsTheSameHoweverPeopleAndPlacesAreNumbered) {
  Scene scene;
  lay_out(scene, 40, true, 1);
  for (std::size_t p = 0; p < 40; p += 3) {
    scene.task.speed_mps[p] = 1.1;
    scene.task.radius_m[p] = 0.3;
  }
  const MotionTask& task = scene.task;
  const Trajectory out = led(task, GetParam().options);
  const auto person = shuffled(40, 11);
  const auto place = shuffled(40, 12);
  MotionTask other = task;
  for (std::size_t i = 0; i < 40; ++i) {
    other.from[i] = task.from[person[i]];
    other.group[i] = task.group[person[i]];
    other.radius_m[i] = task.radius_m[person[i]];
    other.speed_mps[i] = task.speed_mps[person[i]];
    other.to[i] = task.to[place[i]];
    other.to_group[i] = task.to_group[place[i]];
  }
  const Trajectory renumbered = led(other, GetParam().options);
  ASSERT_EQ(renumbered.at.size(), out.at.size());
  for (std::size_t i = 0; i < 40; ++i) {
    ASSERT_EQ(place[renumbered.place_of[i]], out.place_of[person[i]]) << i;
    for (std::size_t k = 0; k < out.at.size(); ++k)
      ASSERT_EQ(renumbered.at[k][i], out.at[k][person[i]]) << k << " " << i;
  }
}

TEST_P(MotionContract, StopsWhenTold) {
  Scene scene;
  lay_out(scene, 40, true, 1);
  const std::atomic<bool> stop = true;
  const auto out = move_crowd(scene.task, GetParam().options, {{}, &stop});
  ASSERT_FALSE(out);
  EXPECT_EQ(out.error().kind, ErrorKind::interrupted);
}

TEST_P(MotionContract, OnePersonAndNobodyElseIsACrowd) {
  Scene scene;
  lay_out(scene, 1, false, 1);
  const Trajectory out = led(scene.task, GetParam().options);
  ASSERT_EQ(out.place_of, std::vector<std::uint32_t>{0});
  EXPECT_LT(distance(out.at.back()[0], scene.task.to[0]), 1.0);
}

INSTANTIATE_TEST_SUITE_P(Models, MotionContract, testing::ValuesIn(models()),
                         [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace footlight::planner
