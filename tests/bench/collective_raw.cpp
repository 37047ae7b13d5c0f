// SPDX-License-Identifier: Apache-2.0
// footlight_collective_raw PLAN SHOW   what the model's own ways are like, beside the walked ones, of each section
// footlight_collective_raw --steps N   steps a second of the model with N people on one thread, and its pairing
// Prints one JSON object. For scripts/xu2015.
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <string>

#include <nlohmann/json.hpp>
#include <sys/resource.h>
#include <tbb/global_control.h>

#include "config/plan_file.hpp"
#include "config/show_file.hpp"
#include "core/motion.hpp"
#include "planner/collective/collective.hpp"
#include "planner/collective/social_crowd.hpp"
#include "planner/crowd_measure.hpp"
#include "planner/motion/models.hpp"
#include "tests/bench/raw_task.hpp"

namespace footlight {
namespace {

using Json = nlohmann::ordered_json;
using planner::CrowdInstant;

constexpr double kStep_s = 0.5;

double cpu_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

Json figures(const planner::CrowdSeries& series) {
  const auto found = planner::crowd_figures(series, -1, 1e9);
  if (!found) return {};
  return {{"I_d", found->direction_bits},
          {"I_d_shuffled", found->shuffled_direction_bits},
          {"I_v", found->speed_bits},
          {"I_v_shuffled", found->shuffled_speed_bits},
          {"sigma_min_dis", found->sigma_nearest_m},
          {"sigma_curr_eft", found->sigma_effort_m},
          {"N", found->moving}};
}

/// Positions at each instant; velocities to the next ones.
planner::CrowdSeries series_of(const std::vector<double>& at_s, const std::vector<std::vector<Point>>& at,
                               const planner::InformationClasses& classes) {
  planner::CrowdSeries out;
  out.classes = classes;
  for (std::size_t k = 0; k + 1 < at.size(); ++k) {
    std::vector<Point> velocity(at[k].size());
    for (std::size_t p = 0; p < velocity.size(); ++p) {
      velocity[p] = 1 / (at_s[k + 1] - at_s[k]) * (at[k + 1][p] - at[k][p]);
    }
    out.time_s.push_back(at_s[k]);
    out.at.push_back(planner::crowd_at(at[k], velocity, at.front(), classes, k));
  }
  return out;
}

Json compare(const Show& show, const Plan& plan, const Section& section) {
  const auto raw = bench::raw_task(show, plan, section, kStep_s);
  const planner::MotionTask& task = raw->task;
  const auto& options = std::get<CollectiveOptions>(section.motion->options);
  const double before = cpu_s();
  const auto prepared = planner::collective::prepare(task, options, {});
  const double prepared_s = cpu_s() - before;
  const auto led = planner::move_crowd(task, options, {});
  if (!prepared || !led) {
    std::cerr << (prepared ? led.error() : prepared.error()) << '\n';
    std::exit(2);
  }
  const auto classes = planner::classes_of(show.stage.grid, planner::fastest_walk_mps(plan));
  const auto walked = bench::walked_ways(show, plan, section, *raw);
  double sum_m = 0;
  double most_m = 0;
  for (std::size_t k = 0; k < walked.size(); ++k) {
    for (std::size_t p = 0; p < task.people(); ++p) {
      const double off_m = distance(walked[k][p], led->at[k][p]);
      sum_m += off_m;
      most_m = std::max(most_m, off_m);
    }
  }
  return {{"section", section.name},
          {"people", task.people()},
          {"subgroups", prepared->subgroups},
          {"prepare_cpu_s", prepared_s},
          {"cost", prepared->cost},
          {"raw", figures(series_of(task.at_s, led->at, classes))},
          {"walked", figures(series_of(task.at_s, walked, classes))},
          {"distance_mean_m", sum_m / static_cast<double>(task.people() * task.at_s.size())},
          {"distance_max_m", most_m}};
}

/// A block that becomes a ring-like disc beside it: as many people as asked for.
Json steps(std::size_t people) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  Stage stage;
  stage.grid = *Grid::make(GridKind::square, 200, 100, 1);
  const planner::Ways ways(stage, 0.25);
  const planner::MotionFloor floor(ways, {}, TempoMap(60), kStart);
  planner::MotionTask task;
  const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(people))));
  for (std::size_t p = 0; p < people; ++p) {
    task.from.push_back({-90 + 1.5 * static_cast<double>(p % side), 5 + 1.5 * static_cast<double>(p / side)});
    const double radius_m = std::sqrt(static_cast<double>(p) + 0.5);
    const double turn = 2.399963229728653 * static_cast<double>(p);  // the golden angle: a sunflower's disc
    task.to.push_back({40 + radius_m * std::cos(turn), 50 + radius_m * std::sin(turn)});
  }
  task.group.assign(people, planner::kNoGroup);
  task.radius_m.assign(people, 0.25);
  task.speed_mps.assign(people, 1.4);
  task.at_s = {0, 120};
  task.floor = &floor;
  const CollectiveOptions options;
  const double before = cpu_s();
  auto prepared = planner::collective::prepare(task, options, {});
  const double prepared_s = cpu_s() - before;
  if (!prepared) std::exit(2);
  const planner::collective::SocialCrowd crowd(task, options, prepared->ways, prepared->subgroup);
  auto now = crowd.begin();
  constexpr int kSteps = 200;
  const double begin = cpu_s();
  for (int k = 0; k < kSteps; ++k) {
    auto next = now;
    ++next.tick;
    crowd.step(now, next);
    std::swap(now, next);
  }
  const double spent_s = cpu_s() - begin;
  // People are on their way: the result of what was timed.
  double moved_m = 0;
  for (std::size_t p = 0; p < people; ++p) moved_m += distance(now.position[p], task.from[p]);
  rusage use{};
  getrusage(RUSAGE_SELF, &use);
  return {{"people", people},
          {"steps_per_s", kSteps / spent_s},
          {"step_s", crowd.step_s()},
          {"prepare_cpu_s", prepared_s},
          {"subgroups", prepared->subgroups},
          {"moved_m", moved_m / static_cast<double>(people)},
          {"memory_mb", static_cast<double>(use.ru_maxrss) / 1024}};
}

int run(const std::string& first, const std::string& second) {
  if (first == "--steps") {
    std::cout << steps(std::stoul(second)).dump(1) << '\n';
    return 0;
  }
  const auto plan = config::load_plan(first);
  const auto loaded = config::load_show(second);
  if (!plan || !loaded) {
    std::cerr << "cannot read " << first << " or " << second << '\n';
    return 2;
  }
  Json out = Json::array();
  for (const Section& section : loaded->show.sections) {
    if (section.motion && std::holds_alternative<CollectiveOptions>(section.motion->options)) {
      out.push_back(compare(loaded->show, *plan, section));
    }
  }
  std::cout << out.dump(1) << '\n';
  return 0;
}

}  // namespace
}  // namespace footlight

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "footlight_collective_raw PLAN SHOW | --steps N\n");
    return 2;
  }
  return footlight::run(argv[1], argv[2]);
}
