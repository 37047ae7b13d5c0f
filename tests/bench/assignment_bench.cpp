// SPDX-License-Identifier: Apache-2.0
// Time of the exact assignment. The duality gap is checked here; the costs of the peers are compared by scripts/bench.
// `lemon/...` rows are LEMON's NetworkSimplex in the same process.
#include <cmath>
#include <fstream>
#include <limits>
#include <string>

#include "planner/assignment/assignment.hpp"
#include "tests/bench/instances.hpp"
#include "tests/bench/job.hpp"
#ifdef FOOTLIGHT_HAS_LEMON
#include "tests/bench/network_simplex.hpp"
#endif

namespace footlight::bench {
namespace {

using planner::WalkCost;

constexpr double kNoLimit = std::numeric_limits<double>::infinity();
/// Dense arcs of the peers beyond these sizes need gigabytes and minutes.
constexpr int kLargestForLemon = 3290;
constexpr int kLargestForFiles = 10'000;

std::string job_of(Scene scene, WalkCost cost) {
  return std::string("assignment ") + (cost == WalkCost::squared ? "squared " : "euclidean ") +
         std::string(to_text(scene));
}

void assign_all(benchmark::State& state, const std::string& name, const Instance& instance, WalkCost cost,
                double longest_m) {
  std::optional<planner::Assignment> found;
  const auto work = [&] { found = planner::assign(instance.sources, instance.targets, cost, longest_m); };
  state.counters["mb"] = peak_memory_once_mb(name, work);
  for (auto _ : state) work();
  if (!found) return state.SkipWithError("no assignment");
  state.counters["cost"] = found->cost;
  state.counters["gap"] = found->gap;
  if (std::abs(found->gap) > 1e-9 * found->cost) state.SkipWithError("the duality gap is not 0");
}

/// What a transition of a show looks like: a formation and the same one a step on, nobody walks farther than five
/// cells.
Instance short_walks(int people) {
  Instance instance = make_instance(Scene::flower_turned, people);
  instance.targets = instance.sources;
  for (Point& p : instance.targets) p = p + Point{p.y > 0 ? 2.0 : 3.0, p.y > 0 ? 1.0 : 0.0};
  return instance;
}

#ifdef FOOTLIGHT_HAS_LEMON
void network_simplex(benchmark::State& state, Scene scene, WalkCost cost, int people) {
  const Instance instance = make_instance(scene, people);
  double found = 0;
  // A second run only for its memory would take as long as the timing.
  for (auto _ : state) {
    state.counters["mb"] = peak_memory_mb([&] { found = network_simplex_cost(instance, cost); });
  }
  state.counters["cost"] = found;
}

void register_lemon(const Effort& effort, Scene scene, WalkCost cost, int people) {
  if (people > kLargestForLemon) return;
  const std::string name = job_name("lemon", job_of(scene, cost), people);
  benchmark::RegisterBenchmark(name.c_str(),
                               [=](benchmark::State& state) { network_simplex(state, scene, cost, people); })
      ->Iterations(1)
      ->Repetitions(people > 1000 ? 1 : effort.repetitions());
}
#else
void register_lemon(const Effort&, Scene, WalkCost, int) {}
#endif

void register_scene(const Effort& effort, Scene scene, WalkCost cost) {
  for (const int people : {100, 330, 1000, 3290, 5000, 10'000, 100'000}) {
    if (people > 10'000 && (cost == WalkCost::euclidean || (effort.quick && scene != Scene::disk_to_ring))) continue;
    const std::string name = job_name("ours", job_of(scene, cost), people);
    auto* job = benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
      assign_all(state, name, make_instance(scene, people), cost, kNoLimit);
    });
    job->Repetitions(people > 10'000 ? 3 : effort.repetitions());
    if (people > 10'000) job->Iterations(1);
    register_lemon(effort, scene, cost, people);
  }
}

}  // namespace

void register_assignment(const Effort& effort) {
  for (const Scene scene : kScenes) {
    if (effort.quick && scene != Scene::disk_to_ring) continue;
    for (const WalkCost cost : {WalkCost::squared, WalkCost::euclidean}) register_scene(effort, scene, cost);
  }
  for (const int people : {1000, 3290, 10'000}) {
    const std::string name = job_name("ours", "assignment squared short_walks", people);
    benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
      assign_all(state, name, short_walks(people), WalkCost::squared, 5.0);
    })->Repetitions(effort.repetitions());
  }
}

void write_assignment_instances(const std::string& folder) {
  for (const Scene scene : kScenes) {
    for (const int people : {100, 330, 1000, 3290, 5000, 10'000, 100'000}) {
      if (people > kLargestForFiles && scene != Scene::disk_to_ring) continue;
      std::ofstream out(folder + "/" + std::string(to_text(scene)) + "_" + std::to_string(people) + ".txt");
      const Instance instance = make_instance(scene, people);
      out << people << "\n";
      for (std::size_t i = 0; i < instance.sources.size(); ++i) {
        const Point a = instance.sources[i];
        const Point b = instance.targets[i];
        out << a.x << " " << a.y << " " << b.x << " " << b.y << "\n";
      }
    }
  }
}

}  // namespace footlight::bench
