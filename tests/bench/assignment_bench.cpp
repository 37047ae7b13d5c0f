// SPDX-License-Identifier: Apache-2.0
// Time of the exact assignment. The duality gap is checked here; the costs of the peers are compared by scripts/bench.
// `lemon/...` rows are LEMON's NetworkSimplex in the same process, `generic/...` rows ours without the instructions
// that not every processor has.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>

#include "planner/assignment/assignment.hpp"
#include "planner/assignment/kernels.hpp"
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
const std::string kListedJob = "assignment listed around_a_wall";

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

/// Until it goes, the instructions that every processor has.
class OnlyGeneric {
 public:
  OnlyGeneric() { use_instructions(Instructions::generic); }
  ~OnlyGeneric() {
    for (const Instructions wider : {Instructions::avx2, Instructions::avx512}) {
      if (has_instructions(wider)) use_instructions(wider);
    }
  }
  OnlyGeneric(const OnlyGeneric&) = delete;
  OnlyGeneric& operator=(const OnlyGeneric&) = delete;

 private:
  using Instructions = planner::assignment::Instructions;
};

struct SparseInstance {
  int people;
  std::vector<planner::Arc> arcs;
};

/// A disk that opens into a ring on a stage with a wall: who would cross it walks through its gap, and what is walked
/// outside of the ring costs extra. Everybody may take the targets of the neighbours, as somebody must.
SparseInstance around_a_wall(int people) {
  constexpr double kNeighbours = 3;
  constexpr double kExtra = 0.37;
  const Instance instance = make_instance(Scene::disk_to_ring, people);
  const auto nearest = planner::assign(instance.sources, instance.targets, WalkCost::squared, kNoLimit);
  const double radius = 0.5455 * std::sqrt(static_cast<double>(people));
  const Point gap{0.25, 0.5 * radius};
  SparseInstance out{people, {}};
  const auto count = static_cast<std::uint32_t>(people);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::size_t first = out.arcs.size();
    for (std::uint32_t k = 0; k < count; ++k) {
      const Point from = instance.sources[i];
      if (distance(from, instance.sources[k]) > kNeighbours) continue;
      const std::uint32_t j = nearest->target_of[k];
      const Point to = instance.targets[j];
      const bool crosses = (from.x < gap.x) != (to.x < gap.x);
      const double walk = crosses ? distance(from, gap) + distance(gap, to) : distance(from, to);
      out.arcs.push_back({i, j, walk * walk + kExtra * std::max(0.0, radius - length(0.5 * (from + to)))});
    }
    std::sort(out.arcs.begin() + static_cast<std::ptrdiff_t>(first), out.arcs.end(),
              [](const planner::Arc& a, const planner::Arc& b) { return a.target < b.target; });
  }
  return out;
}

void assign_listed(benchmark::State& state, const std::string& name, int people) {
  const SparseInstance instance = around_a_wall(people);
  std::optional<planner::Assignment> found;
  const auto work = [&] { found = planner::assign_sparse(static_cast<std::uint32_t>(people), instance.arcs); };
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

/// Nobody may walk farther than four fifths of the longest walk without a limit.
void assign_limited(benchmark::State& state, const std::string& name, int people) {
  const Instance instance = wandering_hole(people);
  const auto free = planner::assign(instance.sources, instance.targets, WalkCost::squared, kNoLimit);
  double longest_m = 0;
  for (std::size_t i = 0; i < instance.sources.size(); ++i) {
    longest_m = std::max(longest_m, distance(instance.sources[i], instance.targets[free->target_of[i]]));
  }
  assign_all(state, name, instance, WalkCost::squared, 0.8 * longest_m);
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

void network_simplex_of_listed(benchmark::State& state, int people) {
  const SparseInstance instance = around_a_wall(people);
  double found = 0;
  for (auto _ : state) {
    state.counters["mb"] = peak_memory_mb([&] { found = network_simplex_cost(people, instance.arcs); });
  }
  state.counters["cost"] = found;
}

void register_lemon_of_listed(const Effort& effort, int people) {
  benchmark::RegisterBenchmark(job_name("lemon", kListedJob, people).c_str(),
                               [=](benchmark::State& state) { network_simplex_of_listed(state, people); })
      ->Iterations(1)
      ->Repetitions(effort.repetitions());
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
void register_lemon_of_listed(const Effort&, int) {}
#endif

void register_scene(const Effort& effort, Scene scene, WalkCost cost) {
  for (const int people : {100, 330, 1000, 3290, 5000, 10'000, 100'000}) {
    if (people > 10'000 && cost == WalkCost::euclidean && (effort.quick || scene != Scene::disk_to_ring)) continue;
    const std::string name = job_name("ours", job_of(scene, cost), people);
    const std::string generic = job_name("generic", job_of(scene, cost), people);
    const auto work = [=](benchmark::State& state) {
      assign_all(state, name, make_instance(scene, people), cost, kNoLimit);
    };
    for (auto* job : {benchmark::RegisterBenchmark(name.c_str(), work),
                      benchmark::RegisterBenchmark(generic.c_str(), [=](benchmark::State& state) {
                        const OnlyGeneric only;
                        work(state);
                      })}) {
      job->Repetitions(people > 10'000 ? 3 : effort.repetitions());
      if (people > 10'000) job->Iterations(1);
    }
    register_lemon(effort, scene, cost, people);
  }
}

}  // namespace

void register_assignment(const Effort& effort) {
  for (const Scene scene : kScenes) {
    if (effort.quick && scene != Scene::disk_to_ring) continue;
    for (const WalkCost cost : {WalkCost::squared, WalkCost::euclidean}) register_scene(effort, scene, cost);
  }
  for (const int people : {330, 1000, 3290, 10'000}) {
    const std::string name = job_name("ours", kListedJob, people);
    benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
      assign_listed(state, name, people);
    })->Repetitions(effort.repetitions());
    if (!effort.quick || people <= 3290) register_lemon_of_listed(effort, people);
  }
  for (const int people : {1000, 3290, 10'000}) {
    const std::string name = job_name("ours", "assignment squared short_walks", people);
    benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
      assign_all(state, name, short_walks(people), WalkCost::squared, 5.0);
    })->Repetitions(effort.repetitions());
  }
  for (const int people : {3290, 10'000, 100'000}) {
    if (effort.quick && people > 10'000) continue;
    const std::string name = job_name("ours", "assignment squared under_a_limit", people);
    benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
      assign_limited(state, name, people);
    })->Repetitions(people > 10'000 ? 1 : effort.repetitions());
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
