// SPDX-License-Identifier: Apache-2.0
// footlight_srd_raw SHOW                 plans it, without films, and says how far people are from their short range
//                                        destinations in each section with a model of motion: as the model leads them
//                                        and as they walk
// footlight_srd_raw --steps N srd|weiss  steps a second of the model with N people on one thread
// Prints one JSON object. For scripts/son2024.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <string>

#include <nlohmann/json.hpp>
#include <tbb/global_control.h>

#include "config/show_file.hpp"
#include "core/motion.hpp"
#include "planner/motion/models.hpp"
#include "planner/plan_show.hpp"
#include "planner/srd/srd_model.hpp"
#include "planner/validate.hpp"
#include "tests/bench/raw_task.hpp"

namespace footlight {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kStep_s = 0.5;  // at most a count

[[noreturn]] void fail(const std::string& message) {
  std::cerr << message << '\n';
  std::exit(2);
}

Json follow(const Show& show, const Plan& plan, SectionIndex index) {
  const Section& section = show.sections[index.at()];
  const Instant start = show.tempo.at(section.start_count);
  const auto raw = bench::raw_task(show, plan, section, kStep_s);
  const planner::MotionTask& task = raw->task;
  const auto walked_at = bench::walked_ways(show, plan, section, *raw);
  const auto* own = std::get_if<SrdOptions>(&section.motion->options);
  const auto model = planner::srd::SrdModel::make(task, own != nullptr ? *own : SrdOptions{});
  if (!model) fail(model.error().message);
  const auto led = planner::move_crowd(task, section.motion->options, planner::Progress{});
  if (!led) fail(led.error().message);
  Json out = {{"section", section.name}, {"people", task.people()}};
  for (std::size_t k = 0; k < task.at_s.size(); ++k) {
    const auto destinations = model.value().destinations(task.at_s[k]);
    double raw_m = 0;
    double walked_m = 0;
    double off_m = 0;
    double most_m = 0;
    for (std::size_t i = 0; i < task.people(); ++i) {
      const Point walked = walked_at[k][i];
      raw_m += distance(led->at[k][i], destinations[i]);
      walked_m += distance(walked, destinations[i]);
      const double one_m = distance(walked, led->at[k][i]);
      off_m += one_m;
      most_m = std::max(most_m, one_m);
    }
    const auto people = static_cast<double>(task.people());
    out["at_s"].push_back(task.at_s[k]);
    out["raw_m"].push_back(raw_m / people);
    out["walked_m"].push_back(walked_m / people);
    out["off_m"].push_back(off_m / people);
    out["off_most_m"].push_back(most_m);
  }
  // Where people of each group walk, at four instants of the crossing.
  for (const double share : {0.0, 0.45, 0.6, 1.0}) {
    const double at_s = share * task.duration_s();
    Json groups;
    for (const std::size_t p : raw->performer) {
      const Point at = position_at(show.stage.grid, plan.tracks[p], start + seconds(at_s));
      const auto group = show.performers[p].group;
      groups[group ? to_text(show.groups[group->at()].colour) : "#888888"].push_back({at.x, at.y});
    }
    out["pictures"].push_back({{"at_s", at_s}, {"people", groups}});
  }
  return out;
}

/// Two blocks of half of the people each that walk through each other, 1.5 m from neighbour to neighbour.
Json steps(std::size_t people, bool formation) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(people) / 2)));
  const double wide_m = 1.5 * static_cast<double>(side);
  Stage stage;
  const int cells = static_cast<int>(3 * wide_m) + 20;
  stage.grid = *Grid::make(GridKind::square, std::min(cells, 4000), std::min(cells / 2, 2000), 1);
  const planner::Ways ways(stage, 0.25);
  const planner::MotionFloor floor(ways, {}, TempoMap(60), kStart);
  planner::MotionTask task;
  for (std::size_t p = 0; p < people; ++p) {
    const std::size_t n = p / 2;
    const Point place{1.5 * static_cast<double>(n % side), 2 + 1.5 * static_cast<double>(n / side)};
    const Point left = place - Point{wide_m + 2, 0};
    const Point right = place + Point{2, 0};
    task.from.push_back(p % 2 == 0 ? left : right);
    task.to.push_back(p % 2 == 0 ? right : left);
    task.group.push_back(static_cast<std::uint32_t>(p % 2));
  }
  task.to_group = task.group;
  task.radius_m.assign(people, 0.25);
  task.speed_mps.assign(people, 1.4);
  const double duration_s = (wide_m + 4) / 0.9;
  task.at_s = {0, duration_s};
  task.floor = &floor;
  SrdOptions options;
  options.formation = formation;
  const auto model = planner::srd::SrdModel::make(task, options);
  if (!model) fail(model.error().message);
  auto now = model.value().begin();
  auto next = now;
  const auto wanted = std::min<std::uint64_t>(static_cast<std::uint64_t>(duration_s / model.value().step_s()),
                                              std::max<std::uint64_t>(40, 1'000'000 / people));
  // As many steps as are wanted, about the middle of the crossing where most is to be done, or as near to it as that
  // comes within some seconds.
  const auto all = static_cast<std::uint64_t>(duration_s / model.value().step_s());
  const auto skipped = std::min<std::uint64_t>((all - wanted) / 2, 12'000'000 / people);
  std::clock_t begin = std::clock();
  for (std::uint64_t k = 0; k < skipped + wanted; ++k) {
    if (k == skipped) begin = std::clock();
    next = now;
    ++next.tick;
    model.value().step(now, next);
    std::swap(now, next);
  }
  const double cpu_s = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  return {
      {"people", people}, {"steps", wanted}, {"cpu_s", cpu_s}, {"steps_a_second", static_cast<double>(wanted) / cpu_s}};
}

}  // namespace
}  // namespace footlight

int main(int argc, char** argv) {
  using namespace footlight;
  if (argc == 4 && std::string(argv[1]) == "--steps") {
    std::cout << steps(std::strtoul(argv[2], nullptr, 10), std::string(argv[3]) == "srd") << '\n';
    return 0;
  }
  if (argc != 2) fail("footlight_srd_raw SHOW | --steps N srd|weiss");
  const auto loaded = config::load_show(argv[1]);
  if (!loaded) fail(loaded.error().to_text());
  const Show& show = loaded->show;
  const auto planned = planner::plan_show(show, std::vector<std::optional<Film>>(show.sections.size()));
  if (!planned) fail(planned.error().message);
  if (!planned->refusal.empty()) fail(planned->refusal.front());
  const planner::Verdict verdict = planner::validate(planned->plan);
  Json out = Json::array();
  for (std::size_t s = 1; s < show.sections.size(); ++s) {
    if (!show.sections[s].motion) continue;
    Json one = follow(show, planned->plan, SectionIndex::of(s));
    one["violations"] = verdict.violations;
    one["min_clearance_m"] = verdict.min_clearance_m;
    one["max_speed_mps"] = verdict.max_speed_mps;
    out.push_back(std::move(one));
  }
  std::cout << out << '\n';
}
