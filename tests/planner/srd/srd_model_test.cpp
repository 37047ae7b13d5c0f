// SPDX-License-Identifier: Apache-2.0
#include "planner/srd/srd_model.hpp"

#include <atomic>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <tbb/global_control.h>

#include "core/rng.hpp"
#include "planner/motion/models.hpp"
#include "planner/srd/congestion.hpp"
#include "tests/planner/srd/srd_tasks.hpp"

namespace footlight::planner::srd {
namespace {

using test::add_group;
using test::block;
using test::crossing;
using test::task_on;
using test::TaskFloor;

constexpr double kRounding_m = 1e-9;

SrdModel model_of(const MotionTask& task, const SrdOptions& options = {}) {
  auto model = SrdModel::make(task, options);
  EXPECT_TRUE(model) << model.error();
  return std::move(*model);
}

/// Calls see(before, after) for each step until the task ends.
template <class See>
SrdModel::State run(const SrdModel& model, const MotionTask& task, See see) {
  SrdModel::State now = model.begin();
  while (static_cast<double>(now.tick) * model.step_s() < task.duration_s() - kRounding_m) {
    SrdModel::State next = now;
    ++next.tick;
    model.step(now, next);
    see(now, next);
    now = std::move(next);
  }
  return now;
}

double nearest_m(const std::vector<Point>& people) {
  double least = 1e9;
  for (std::size_t i = 0; i < people.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) least = std::min(least, distance(people[i], people[j]));
  }
  return least;
}

double mean_distance(const std::vector<Point>& a, const std::vector<Point>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += distance(a[i], b[i]);
  return sum / static_cast<double>(a.size());
}

TEST(SrdModel, FormationOnAFreeFloorIsKeptExactly) {
  const TaskFloor floor;
  MotionTask task = task_on(floor, 60);
  add_group(task, 0, block({-20, 5}, 6, 5), block({20, 20}, 6, 5));
  const SrdModel model = model_of(task);
  double most_m = 0;
  const auto end = run(model, task, [&](const auto&, const auto& next) {
    const auto places = model.destinations(static_cast<double>(next.tick) * model.step_s());
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (next.tick > 20) most_m = std::max(most_m, distance(next.position[i], places[i]));
    }
  });
  EXPECT_LT(most_m, 0.02);  // a fraction of a step, (1 - stiffness)^iterations of it
  EXPECT_LT(mean_distance(end.position, model.destinations(60)), 1e-3);
}

TEST(SrdModel, TwoFormationsCrossAndFindTheirFormationsAgain) {
  const TaskFloor floor;
  const MotionTask task = crossing(floor, 6, 6, 60, 1.4);
  const SrdModel model = model_of(task);
  double most_m = 0;
  std::size_t released = 0;
  const auto end = run(model, task, [&](const auto&, const auto& next) {
    EXPECT_GE(nearest_m(next.position), 0.5 - kRounding_m);
    const auto places = model.destinations(static_cast<double>(next.tick) * model.step_s());
    most_m = std::max(most_m, mean_distance(next.position, places));
    released += static_cast<std::size_t>(std::count(next.released.begin(), next.released.end(), 1));
  });
  EXPECT_GT(released, 500U);
  EXPECT_GT(most_m, 0.1);
  EXPECT_LT(mean_distance(end.position, model.destinations(60)), 0.01);
  EXPECT_EQ(std::count(end.released.begin(), end.released.end(), 1), 0);
}

/// Everybody comes to her place, and nobody nearer to anybody than the clearance on the way.
void expect_passed(const MotionTask& task) {
  const SrdModel model = model_of(task);
  std::size_t released = 0;
  const auto end = run(model, task, [&](const auto&, const auto& next) {
    EXPECT_GE(nearest_m(next.position), 0.5 - kRounding_m);
    released += static_cast<std::size_t>(std::count(next.released.begin(), next.released.end(), 1));
  });
  EXPECT_GT(released, 100U);
  const auto places = model.destinations(task.duration_s());
  for (std::size_t i = 0; i < places.size(); ++i) EXPECT_LT(distance(end.position[i], places[i]), 0.05) << i;
}

TEST(SrdModel, DenseBlocksPassThroughEachOtherHeadOn) {
  const TaskFloor floor(80, 30);
  for (const double aside_m : {0.0, 0.3, 0.5}) {
    MotionTask task = task_on(floor, 70);
    add_group(task, 0, block({-30, 10}, 8, 8), block({22, 10}, 8, 8));
    add_group(task, 1, block({22, 10 + aside_m}, 8, 8), block({-30, 10 + aside_m}, 8, 8));
    SCOPED_TRACE(aside_m);
    expect_passed(task);
  }
}

TEST(SrdModel, DenseBlocksPassEachOtherAroundAWall) {
  std::vector<Cell> wall;
  for (int row = 12; row < 28; ++row) wall.push_back({40, row});
  const TaskFloor floor(80, 50, wall);
  MotionTask task = task_on(floor, 100);
  add_group(task, 0, block({-25.5, 16.5}, 6, 8), block({20.5, 16.5}, 6, 8));
  add_group(task, 1, block({20.5, 16.5}, 6, 8), block({-25.5, 16.5}, 6, 8));
  expect_passed(task);
}

TEST(SrdModel, DenseBlocksPassEachOtherInAGate) {
  std::vector<Cell> wall;
  for (int row = 0; row < 40; ++row) {
    if (row < 15 || row >= 25) wall.push_back({40, row});
  }
  const TaskFloor floor(80, 40, wall);
  MotionTask task = task_on(floor, 80);
  add_group(task, 0, block({-25.5, 16.5}, 6, 8), block({20.5, 16.5}, 6, 8));
  add_group(task, 1, block({20.5, 16.5}, 6, 8), block({-25.5, 16.5}, 6, 8));
  expect_passed(task);
}

TEST(SrdModel, OnSlowGroundTheGroupWaitsAndKeepsItsFormation) {
  std::vector<std::uint8_t> grey(60, 0);
  std::fill(grey.begin() + 25, grey.begin() + 35, 255);
  const TaskFloor hill(60, 40, {}, {}, test::ground_of(grey));
  MotionTask task = task_on(hill, 60);
  add_group(task, 0, block({-20, 5}, 6, 5), block({15, 20}, 6, 5));
  SrdOptions options;
  options.settle = 0;
  const SrdModel model = model_of(task, options);
  double slow_mps = 0;
  double most_m = 0;
  const auto end = run(model, task, [&](const auto& now, const auto& next) {
    const auto places = model.destinations(static_cast<double>(next.tick) * model.step_s());
    for (std::size_t i = 0; i < task.people(); ++i) {
      const double speed_mps = distance(now.position[i], next.position[i]) / model.step_s();
      EXPECT_LE(speed_mps, 1.4 * hill.floor->speed_factor(now.position[i]) + kRounding_m);
      if (hill.floor->speed_factor(now.position[i]) < 0.51) slow_mps = std::max(slow_mps, speed_mps);
      if (next.tick > 20) most_m = std::max(most_m, distance(next.position[i], places[i]));
    }
  });
  EXPECT_GT(slow_mps, 0.5);  // somebody was on it
  EXPECT_LT(most_m, 0.1);
  EXPECT_LT(mean_distance(end.position, model.destinations(60)), 0.01);
}

TEST(SrdModel, WithoutFormationEverybodyComesToHerPlaceAndNothingIsKeptOnTheWay) {
  const TaskFloor floor;
  const MotionTask task = crossing(floor, 6, 6, 60, 1.4);
  SrdOptions options;
  options.formation = false;
  const SrdModel loose = model_of(task, options);
  const SrdModel held = model_of(task);
  double loose_m = 0;
  double held_m = 0;
  const auto end = run(loose, task, [&](const auto&, const auto& next) {
    EXPECT_GE(nearest_m(next.position), 0.5 - kRounding_m);
    loose_m += mean_distance(next.position, loose.destinations(static_cast<double>(next.tick) * loose.step_s()));
  });
  run(held, task, [&](const auto&, const auto& next) {
    held_m += mean_distance(next.position, held.destinations(static_cast<double>(next.tick) * held.step_s()));
  });
  EXPECT_LT(mean_distance(end.position, loose.destinations(60)), 0.1);
  EXPECT_LT(held_m, loose_m);
}

TEST(SrdModel, NobodyIsReleasedButWhereGroupsMeet) {
  const TaskFloor floor;
  const MotionTask task = crossing(floor, 6, 4, 50);
  SrdOptions options;
  options.reaction_s = 0;
  const SrdModel model = model_of(task, options);
  std::size_t released = 0;
  run(model, task, [&](const auto& now, const auto& next) {
    for (std::size_t i = 0; i < next.released.size(); ++i) {
      if (next.released[i] == 0) continue;
      ++released;
      // Somebody of the other group is in one of the four nearest spaces, 2 m wide, or was when the step was predicted.
      const double near_m = 1.5 * 2 + 2 * 0.14;
      bool other = false;
      for (std::size_t j = 0; j < next.released.size(); ++j) {
        const Point apart = now.position[i] - now.position[j];
        other = other || (task.group[i] != task.group[j] && std::max(std::abs(apart.x), std::abs(apart.y)) < near_m);
      }
      EXPECT_TRUE(other) << i;
    }
  });
  EXPECT_GT(released, 100U);
}

TEST(SrdModel, ReactionIsTheTimeBeforeSomebodyLeavesHerFormation) {
  const TaskFloor floor;
  const MotionTask task = crossing(floor, 3, 3, 50);
  const auto first_tick = [&](double reaction_s) {
    SrdOptions options;
    options.reaction_s = reaction_s;
    options.variation = 0;
    std::uint64_t tick = 0;
    run(model_of(task, options), task, [&](const auto&, const auto& next) {
      if (tick == 0 && std::count(next.released.begin(), next.released.end(), 1) > 0) tick = next.tick;
    });
    return tick;
  };
  const std::uint64_t quick = first_tick(0);
  EXPECT_GT(quick, 0U);
  EXPECT_EQ(first_tick(0.5), quick + 4);  // five steps of 0.1 s in all
}

TEST(SrdModel, EverybodyReactsInHerOwnTime) {
  const TaskFloor floor;
  MotionTask task = task_on(floor, 40);
  // Four pairs, far from each other, who walk straight at each other.
  for (const double y : {5.0, 15.0, 25.0, 35.0}) {
    add_group(task, 0, {{-15, y}}, {{15, y}});
    add_group(task, 1, {{15, y}}, {{-15, y}});
  }
  task.agility.assign(8, 0.0);  // nobody steps aside, so that all meet as if nobody reacted
  const auto released_at = [&](std::vector<std::optional<double>> reaction_s) {
    task.reaction_s = std::move(reaction_s);
    SrdOptions options;
    options.reaction_s = 0.35;
    options.variation = 0;
    std::vector<std::uint64_t> tick(8, 0);
    run(model_of(task, options), task, [&](const auto&, const auto& next) {
      for (std::size_t i = 0; i < tick.size(); ++i) {
        if (tick[i] == 0 && next.released[i] != 0) tick[i] = next.tick;
      }
    });
    return tick;
  };
  std::vector<std::uint64_t> expected = released_at(std::vector<std::optional<double>>(8, 0.0));
  EXPECT_GT(*std::min_element(expected.begin(), expected.end()), 0U);
  // A step is 0.1 s: who waits 0.5 s is released in the fifth step in which she sees the other.
  const std::vector<std::uint64_t> later{0, 4, 0, 0, 2, 3, 0, 1};
  for (std::size_t i = 0; i < later.size(); ++i) expected[i] += later[i];
  EXPECT_EQ(released_at({0.0, 0.5, 0.1, 0.05, 0.25, std::nullopt, 0.0, 0.2}), expected);
}

TEST(SrdModel, EverybodyStepsAsideByHerOwnAgility) {
  const TaskFloor floor;
  MotionTask task = task_on(floor, 40);
  add_group(task, 0, {{-15, 10}}, {{15, 10}});
  add_group(task, 1, {{15, 10}}, {{-15, 10}});
  SrdOptions options;
  options.agility = 0.5;
  options.variation = 0;
  options.room_m = 0;  // they do not touch yet in the step that is looked at
  const auto first_aside = [&](std::optional<double> own) {
    task.agility = {own, 0.0};
    task.reaction_s = {0.0, 0.0};
    double aside = 0;
    run(model_of(task, options), task, [&](const auto&, const auto& next) {
      if (aside > kRounding_m) return;
      aside = 10 - next.position[0].y;
      EXPECT_NEAR(next.position[1].y, 10, kRounding_m);
    });
    return aside;
  };
  const double half = first_aside(0.5);
  EXPECT_GT(half, 1e-4);
  EXPECT_NEAR(first_aside(1), 2 * half, 1e-9);
  EXPECT_NEAR(first_aside(std::nullopt), half, 1e-9);  // who has none of her own is as the options say
}

TEST(SrdModel, MoreAgilePeopleStepAsideMore) {
  const TaskFloor floor;
  const auto first_aside = [&](double agility) {
    MotionTask task = task_on(floor, 40);
    add_group(task, 0, {{-15, 20}}, {{15, 20}});
    add_group(task, 1, {{15, 20}}, {{-15, 20}});
    SrdOptions options;
    options.agility = agility;
    double aside = 0;
    run(model_of(task, options), task, [&](const auto&, const auto& next) {
      if (aside == 0) aside = (20 - next.position[0].y) + (next.position[1].y - 20);  // to the right of their ways
    });
    return aside;
  };
  EXPECT_EQ(first_aside(0), 0);
  EXPECT_GT(first_aside(0.5), 1e-4);
  EXPECT_NEAR(first_aside(1), 2 * first_aside(0.5), 1e-9);  // more than that she cannot step in a tenth of a second
}

TEST(SrdModel, NobodyIsFasterThanShe) {
  const TaskFloor floor;
  MotionTask task = crossing(floor, 5, 5, 60);
  for (std::size_t i = 0; i < task.people(); ++i) task.speed_mps[i] = 1 + 0.1 * static_cast<double>(i % 5);
  const SrdModel model = model_of(task);
  run(model, task, [&](const auto& now, const auto& next) {
    for (std::size_t i = 0; i < task.people(); ++i) {
      EXPECT_LE(distance(now.position[i], next.position[i]), 0.1 * task.speed_mps[i] + kRounding_m);
      EXPECT_LE(length(next.velocity[i]), task.speed_mps[i] + kRounding_m);
    }
  });
}

TEST(SrdModel, NobodyEntersAnythingBlockedAndEverybodyComesAroundIt) {
  std::vector<Cell> wall;
  for (int row = 8; row < 26; ++row) wall.push_back({30, row});
  const TaskFloor floor(60, 40, wall);
  MotionTask task = task_on(floor, 90);
  add_group(task, 0, block({-20.5, 12.5}, 4, 8), block({16.5, 12.5}, 4, 8));
  const SrdModel model = model_of(task);
  const auto end = run(model, task, [&](const auto& now, const auto& next) {
    for (std::size_t i = 0; i < task.people(); ++i) {
      EXPECT_TRUE(floor.ways->straight(now.position[i], next.position[i])) << i << " at " << now.tick;
    }
  });
  EXPECT_LT(mean_distance(end.position, model.destinations(90)), 0.05);
  for (const double t : {20.0, 40.0, 60.0}) {
    for (const Point at : model.destinations(t)) EXPECT_TRUE(floor.ways->straight(at, at));
  }
}

TEST(SrdModel, PeopleMakeRoomForWhatMoves) {
  MovingObstacle car;
  car.radius_m = 1;
  car.at = {{1, {0, 0}}, {41, {0, 38}}};  // a count is a second: 0.95 m/s upstage
  const TaskFloor floor(60, 40, {}, {car});
  MotionTask task = task_on(floor, 60);
  add_group(task, 0, block({-20, 15}, 6, 6, 1.4), block({12, 15}, 6, 6, 1.4));
  const SrdModel model = model_of(task);
  const auto end = run(model, task, [&](const auto&, const auto& next) {
    const auto disc = floor.floor->discs(static_cast<double>(next.tick) * model.step_s()).front();
    for (const Point at : next.position) EXPECT_GE(distance(at, disc.centre), 1.25 - 0.01);
  });
  EXPECT_LT(mean_distance(end.position, model.destinations(60)), 0.01);
}

TEST(SrdModel, ChangesFormationOnTheWay) {
  const TaskFloor floor;
  MotionTask task = task_on(floor, 60);
  add_group(task, 0, block({-25, 10}, 12, 3), block({20, 8}, 3, 12));
  const SrdModel model = model_of(task);
  const auto end =
      run(model, task, [&](const auto&, const auto& next) { EXPECT_GE(nearest_m(next.position), 0.5 - kRounding_m); });
  for (std::size_t i = 0; i < task.people(); ++i) {
    EXPECT_NEAR(distance(end.position[i], task.to[model.place_of()[i]]), 0, 0.01);
  }
}

TEST(SrdModel, OrderOfPeopleHasNoInfluence) {
  const TaskFloor floor;
  const MotionTask task = crossing(floor, 4, 4, 30);
  const std::size_t people = task.people();
  std::vector<std::size_t> order(people);
  std::iota(order.begin(), order.end(), 0);
  Rng rng(7);
  for (std::size_t i = people; i > 1; --i) std::swap(order[i - 1], order[rng.below(i)]);
  MotionTask mixed = task;
  for (std::size_t i = 0; i < people; ++i) {
    mixed.from[i] = task.from[order[i]];
    mixed.group[i] = task.group[order[i]];
  }
  SrdOptions options;
  options.variation = 0;
  const auto one = move_crowd(task, options, {});
  const auto other = move_crowd(mixed, options, {});
  ASSERT_TRUE(one && other);
  // Sums over neighbours round differently; until people meet that is all.
  for (std::size_t k = 0; k < task.at_s.size() && task.at_s[k] <= 15; ++k) {
    for (std::size_t i = 0; i < people; ++i) {
      EXPECT_NEAR(distance(one->at[k][order[i]], other->at[k][i]), 0, 1e-6) << task.at_s[k];
    }
  }
}

TEST(SrdModel, IsTheSameForAnyNumberOfThreads) {
  const TaskFloor floor;
  const MotionTask task = crossing(floor, 16, 14, 30);
  std::vector<Trajectory> all;
  for (const std::size_t threads : {1, 2, 8}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    all.push_back(*move_crowd(task, SrdOptions{}, {}));
  }
  EXPECT_EQ(all[0].at, all[1].at);
  EXPECT_EQ(all[0].at, all[2].at);
}

TEST(SrdModel, AnotherSeedIsAnotherChance) {
  const TaskFloor floor;
  MotionTask task = crossing(floor, 5, 5, 50);
  const auto one = move_crowd(task, SrdOptions{}, {});
  task.seed = 2;
  const auto other = move_crowd(task, SrdOptions{}, {});
  EXPECT_NE(one->at, other->at);
}

TEST(SrdModel, NeverComesNearerThanTheRadiiWhateverMeets) {
  EXPECT_TRUE(rc::check("nobody nearer than the sum of radii", [] {
    const TaskFloor floor(40, 30);
    MotionTask task = task_on(floor, 12);
    const int groups = *rc::gen::inRange(1, 4);
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    std::vector<std::uint32_t> cells(1200);
    std::iota(cells.begin(), cells.end(), 0);
    for (std::size_t i = cells.size(); i > 1; --i) std::swap(cells[i - 1], cells[rng.below(i)]);
    const auto centre = [&](std::size_t n) { return floor.stage.grid.centre(CellIndex(cells[n])); };
    const std::size_t people = *rc::gen::inRange<std::size_t>(2, 120);
    for (std::size_t i = 0; i < people; ++i) {
      // Near each other, so that they are in each other's way.
      const Point from = centre(i);
      task.from.push_back({from.x / 1.6, 5 + from.y / 1.6});
      task.group.push_back(static_cast<std::uint32_t>(rng.below(static_cast<std::uint64_t>(groups))));
      task.radius_m.push_back(0.2 + 0.1 * rng.uniform());
      task.speed_mps.push_back(3);
    }
    task.paths.push_back({std::nullopt, {{0, 15}}, {}});
    SrdOptions options;
    options.formation = *rc::gen::arbitrary<bool>();
    options.iterations = *rc::gen::inRange(1, 8);
    const SrdModel model = model_of(task, options);
    run(model, task, [&](const auto&, const auto& next) {
      for (std::size_t i = 0; i < people; ++i) {
        for (std::size_t j = 0; j < i; ++j) {
          RC_ASSERT(distance(next.position[i], next.position[j]) >= task.radius_m[i] + task.radius_m[j] - kRounding_m);
        }
      }
    });
  }));
}

TEST(SrdModel, TellsOfWhoIsNotAtHerPlace) {
  const TaskFloor floor;
  MotionTask task = task_on(floor, 40);
  add_group(task, 0, {{-20, 10}, {-20, 12}}, {{10, 10}, {10, 12}});
  SrdOptions options;
  options.settle = 0;
  EXPECT_TRUE(move_crowd(task, options, {})->notes.empty());
  // Nothing moves anybody.
  options.stiffness = 0;
  options.steering = 0;
  options.blending = 0.001;
  EXPECT_EQ(move_crowd(task, options, {})->notes,
            std::vector<std::string>{"2 of 2 people are more than 1 m from their places when the section ends"});
}

TEST(SrdModel, StopsWhenTold) {
  const TaskFloor floor;
  const MotionTask task = crossing(floor, 3, 3, 50);
  const std::atomic<bool> stop = true;
  const auto led = move_crowd(task, SrdOptions{}, {{}, &stop});
  ASSERT_FALSE(led);
  EXPECT_EQ(led.error().kind, ErrorKind::interrupted);
}

}  // namespace
}  // namespace footlight::planner::srd
