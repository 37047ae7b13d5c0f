// SPDX-License-Identifier: Apache-2.0
// Time of the exact assignment, each timing with a check of the optimum: the duality gap, and the cost of the peer
// where there is one. `peer/...` rows are LEMON's NetworkSimplex in the same run.
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include "planner/assignment/assignment.hpp"
#include "tests/bench/instances.hpp"
#ifdef FOOTLIGHT_HAS_LEMON
#include "tests/bench/network_simplex.hpp"
#endif

namespace footlight::bench {
namespace {

using planner::WalkCost;

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

std::string name(const char* who, Scene scene, WalkCost cost, int people) {
  return std::string(who) + "/" + std::string(to_text(scene)) +
         (cost == WalkCost::squared ? "/squared/" : "/euclidean/") + std::to_string(people);
}

/// What the peer found in this run, by the name of the instance.
std::map<std::string, double>& peer_costs() {
  static std::map<std::string, double> costs;
  return costs;
}

void report(benchmark::State& state, const std::string& key, double cost, double gap) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  state.counters["cost"] = cost;
  state.counters["gap"] = gap;
  state.counters["peak_mb"] = static_cast<double>(usage.ru_maxrss) / 1024;
  if (std::abs(gap) > 1e-9 * cost) state.SkipWithError("the duality gap is not 0");
  const auto peer = peer_costs().find(key);
  state.counters["same_as_peer"] = peer == peer_costs().end() ? 0 : 1;
  if (peer != peer_costs().end() && std::abs(peer->second - cost) > 1e-8 * (1 + cost)) {
    state.SkipWithError("the peer's optimum is another one");
  }
}

void assign_all(benchmark::State& state, Scene scene, WalkCost cost, int people, const std::string& key) {
  const Instance instance = make_instance(scene, people);
  std::optional<planner::Assignment> found;
  for (auto _ : state) {
    found = planner::assign(instance.sources, instance.targets, cost, kNoLimit);
    benchmark::DoNotOptimize(found);
  }
  report(state, key, found->cost, found->gap);
}

/// What a transition of a show looks like: a formation and the same one a step on, nobody walks farther than five
/// cells.
void assign_short(benchmark::State& state, int people) {
  Instance instance = make_instance(Scene::flower_turned, people);
  instance.targets = instance.sources;
  for (Point& p : instance.targets) p = p + Point{p.y > 0 ? 2.0 : 3.0, p.y > 0 ? 1.0 : 0.0};
  std::optional<planner::Assignment> found;
  for (auto _ : state) {
    found = planner::assign(instance.sources, instance.targets, WalkCost::squared, 5.0);
    benchmark::DoNotOptimize(found);
  }
  if (!found) return state.SkipWithError("no assignment");
  report(state, {}, found->cost, found->gap);
}

#ifdef FOOTLIGHT_HAS_LEMON
void network_simplex(benchmark::State& state, Scene scene, WalkCost cost, int people, const std::string& key) {
  const Instance instance = make_instance(scene, people);
  for (auto _ : state) peer_costs()[key] = network_simplex_cost(instance, cost);
  state.counters["cost"] = peer_costs()[key];
}
#endif

void register_all() {
  for (const Scene scene : kScenes) {
    for (const WalkCost cost : {WalkCost::squared, WalkCost::euclidean}) {
      for (const int people : {100, 330, 1000, 3290, 10'000, 100'000}) {
        const std::string key = name("", scene, cost, people);
#ifdef FOOTLIGHT_HAS_LEMON
        if (people <= 3290) {
          benchmark::RegisterBenchmark(name("peer", scene, cost, people).c_str(), network_simplex, scene, cost, people,
                                       key)
              ->Unit(benchmark::kMillisecond)
              ->Iterations(1);
        }
#endif
        if (cost == WalkCost::euclidean && people > 10'000) continue;
        benchmark::RegisterBenchmark(name("assign", scene, cost, people).c_str(), assign_all, scene, cost, people, key)
            ->Unit(benchmark::kMillisecond);
      }
    }
  }
  for (const int people : {1000, 3290, 10'000}) {
    benchmark::RegisterBenchmark(("assign/short_walks/squared/" + std::to_string(people)).c_str(), assign_short, people)
        ->Unit(benchmark::kMillisecond);
  }
}

}  // namespace
}  // namespace footlight::bench

int main(int argc, char** argv) {
  footlight::bench::register_all();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
