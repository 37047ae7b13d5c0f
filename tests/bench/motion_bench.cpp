// SPDX-License-Identifier: Apache-2.0
// One step of each continuous model of motion, beside what no such step can do without.
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "planner/collective/social_crowd.hpp"
#include "planner/collective/timed_ways.hpp"
#include "planner/motion/crowd.hpp"
#include "planner/motion/model.hpp"
#include "planner/motion/neighbours.hpp"
#include "planner/painted/painted_model.hpp"
#include "planner/repair/closest_approach.hpp"
#include "planner/srd/srd_model.hpp"
#include "planner/swarm/original.hpp"
#include "planner/swarm/proposed.hpp"
#include "tests/bench/job.hpp"
#include "tests/support/painted_between.hpp"

namespace footlight::bench {
namespace {

using planner::MotionFloor;
using planner::MotionTask;

/// Two blocks of people in the midst of each other on an open floor, one to the left and one to the right, 1.3 people
/// on each square metre.
class Crossing {
 public:
  explicit Crossing(int people) {
    const int side = static_cast<int>(std::ceil(std::sqrt(people / 2.0)));
    constexpr double kSpacing_m = 1.25;
    const double wide_m = kSpacing_m * side;
    stage_.grid = *Grid::make(GridKind::square, static_cast<int>(3 * wide_m) + 12, static_cast<int>(wide_m) + 4, 1.0);
    ways_ = std::make_unique<planner::Ways>(stage_, stage_.clearance_m / 2);
    floor_ = std::make_unique<MotionFloor>(*ways_, std::vector<MovingObstacle>{}, TempoMap(), Instant{});
    for (int p = 0; p < people; ++p) {
      const int n = p / 2;
      const double half_m = 0.5 * kSpacing_m * (p % 2);
      const Point at{kSpacing_m * (n % side) - wide_m / 2 + half_m, 1.5 + kSpacing_m * (n / side) + half_m};
      task_.from.push_back(at);
      task_.to.push_back({at.x + (p % 2 == 0 ? wide_m : -wide_m), at.y});
      task_.group.push_back(static_cast<std::uint32_t>(p % 2));
      task_.to_group.push_back(static_cast<std::uint32_t>(p % 2));
      task_.radius_m.push_back(0.25);
      task_.speed_mps.push_back(1.4);
    }
    task_.at_s = {0, wide_m + 20};  // at about 1 m/s
    task_.floor = floor_.get();
  }
  [[nodiscard]] const MotionTask& task() const { return task_; }

 private:
  Stage stage_;
  std::unique_ptr<planner::Ways> ways_;
  std::unique_ptr<MotionFloor> floor_;
  MotionTask task_;
};

const Crossing& crossing(int people) {
  static std::map<int, std::unique_ptr<Crossing>> known;
  auto& one = known[people];
  if (!one) one = std::make_unique<Crossing>(people);
  return *one;
}

/// A model in the midst of its crowd, and what one more step of it makes.
template <class Model>
struct Midst {
  static constexpr int kSteps = 12;

  explicit Midst(const Model& model) : now(model.begin()), next(now) {
    for (int n = 0; n < kSteps; ++n) {
      step(model);
      std::swap(now, next);
    }
  }
  void step(const Model& model) {
    next = now;
    ++next.tick;
    model.step(now, next);
  }
  typename Model::State now;
  typename Model::State next;
};

/// What speaks against a step, or nothing. @param touching whether the model lets people touch each other
const char* mistake(const MotionTask& task, const planner::Crowd& now, const planner::Crowd& next, double step_s,
                    bool touching) {
  std::vector<planner::Walk> walks;
  double walked_m = 0;
  for (std::size_t p = 0; p < now.position.size(); ++p) {
    walks.push_back({now.position[p], next.position[p]});
    const double step_m = distance(now.position[p], next.position[p]);
    if (!(step_m <= task.speed_mps[p] * step_s + 1e-9)) return "somebody is faster than the limit";
    walked_m += step_m;
  }
  if (walked_m < 0.05 * task.speed_mps[0] * step_s * static_cast<double>(walks.size())) return "hardly anybody moves";
  if (!touching && !planner::near_pairs(walks, 0.5 - 1e-6).empty()) return "people touch each other";
  return nullptr;
}

void limit_to(benchmark::State& state, int threads, const std::function<void()>& work) {
  tbb::task_arena arena(threads);
  arena.execute([&] {
    for (auto _ : state) work();
  });
}

/// A model, its step beside the bound: the same state copied once, everybody sorted into bins, and everybody within
/// `reach_m` looked at once with the least that can be done with them, a squared distance added up.
template <class Model>
void add_model(const Effort& effort, const std::string& name, double reach_m, bool touching,
               std::function<std::shared_ptr<const Model>(const MotionTask&)> make) {
  for (const int people : {1'000, 10'000, 100'000}) {
    if (effort.quick && people > 10'000) continue;
    using Both = std::pair<std::shared_ptr<const Model>, std::unique_ptr<Midst<Model>>>;
    const auto midst = std::make_shared<Both>();  // made by who runs first: most runs ask for a few
    const auto ready = [=]() -> Midst<Model>& {
      if (!midst->first) midst->first = make(crossing(people).task());
      if (!midst->second) midst->second = std::make_unique<Midst<Model>>(*midst->first);
      return *midst->second;
    };
    for (const int threads : {1, 2}) {
      const std::string job = "step " + name + (threads == 1 ? ", 1 thread" : ", 2 threads");
      const auto add = [&](const char* who, auto work) {
        benchmark::RegisterBenchmark(job_name(who, job, people).c_str(), work)
            ->Repetitions(effort.repetitions())
            ->UseRealTime();
      };
      add("ours", [=](benchmark::State& state) {
        Midst<Model>& one = ready();
        limit_to(state, threads, [&] { one.step(*midst->first); });
        const char* wrong = mistake(crossing(people).task(), one.now, one.next, midst->first->step_s(), touching);
        if (wrong != nullptr) state.SkipWithError(wrong);
      });
      add("stream", [=](benchmark::State& state) {
        Midst<Model>& one = ready();
        limit_to(state, threads, [&] {
          one.next = one.now;
          benchmark::ClobberMemory();
        });
      });
      add("bound", [=](benchmark::State& state) {
        Midst<Model>& one = ready();
        planner::Neighbours neighbours;
        std::vector<double> sums(one.now.position.size());
        limit_to(state, threads, [&] {
          one.next = one.now;
          const auto& at = one.now.position;
          neighbours.sort(at, reach_m / 2);
          tbb::parallel_for(
              tbb::blocked_range<std::size_t>(0, at.size(), 256),
              [&](const auto& r) {
                for (std::size_t p = r.begin(); p < r.end(); ++p) {
                  double sum = 0;
                  neighbours.visit(at[p], reach_m, [&](std::uint32_t, double squared) { sum += squared; });
                  sums[p] = sum;
                }
              },
              tbb::simple_partitioner());
          benchmark::ClobberMemory();
        });
      });
    }
  }
}

/// A swarm with its landscape.
template <class Swarm>
std::shared_ptr<const Swarm> make_swarm(const MotionTask& task) {
  struct Both {
    planner::swarm::Landscape landscape;
    Swarm swarm;
    explicit Both(planner::swarm::Landscape made) : landscape(std::move(made)), swarm(landscape) {}
  };
  auto landscape = planner::swarm::Landscape::make(task, {});
  const auto both = std::make_shared<const Both>(std::move(landscape).value());
  return {both, &both->swarm};
}

std::shared_ptr<const planner::srd::SrdModel> make_srd(const MotionTask& task) {
  auto model = planner::srd::SrdModel::make(task, {});
  return std::make_shared<const planner::srd::SrdModel>(std::move(model).value());
}

/// Without sub-groups: everybody on her own timed way.
std::shared_ptr<const planner::collective::SocialCrowd> make_collective(const MotionTask& task) {
  using planner::collective::SocialCrowd;
  using planner::collective::TimedWays;
  struct Both {
    TimedWays ways;
    SocialCrowd crowd;
    Both(const MotionTask& of, TimedWays made) : ways(std::move(made)), crowd(of, {}, ways, {}) {}
  };
  auto ways = TimedWays::make(task, task.to, nullptr, task.duration_s());
  const auto both = std::make_shared<const Both>(task, std::move(ways).value());
  return {both, &both->crowd};
}

/// A stroke for each block, through the other one. People stand nearer to each other than cells of the floor.
std::shared_ptr<const planner::PaintedModel> make_painted(const MotionTask& task) {
  struct Both {
    planner::PaintedScene scene;
    planner::PaintedModel model;
    Both(const MotionTask& of, const planner::Ways& cells)
        : scene(planner::test::painted_between(of, true, &cells)), model(of, {}, scene) {}
  };
  const Grid& floor = task.floor->ways().grid();
  Stage fine;
  fine.grid = *Grid::make(GridKind::square, 2 * floor.columns(), 2 * floor.rows(), floor.pitch_m() / 2);
  const auto both = std::make_shared<const Both>(task, planner::Ways(fine, fine.clearance_m / 2));
  return {both, &both->model};
}

}  // namespace

void register_motion(const Effort& effort) {
  using planner::swarm::OriginalSwarm;
  using planner::swarm::ProposedSwarm;
  add_model<ProposedSwarm>(effort, "swarm", 1.8, false, make_swarm<ProposedSwarm>);
  add_model<OriginalSwarm>(effort, "swarm, original", 0.01, true, make_swarm<OriginalSwarm>);
  add_model<planner::srd::SrdModel>(effort, "srd", 1.0, false, make_srd);
  add_model<planner::collective::SocialCrowd>(effort, "collective", 1.5, true, make_collective);
  add_model<planner::PaintedModel>(effort, "painted", 1.2, true, make_painted);
}

}  // namespace footlight::bench
