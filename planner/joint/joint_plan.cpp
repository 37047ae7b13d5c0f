// SPDX-License-Identifier: Apache-2.0
#include "planner/joint/joint_plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>

#include "planner/formation/best_single.hpp"
#include "planner/formation/cell_shares.hpp"
#include "planner/joint/level.hpp"
#include "planner/parallel.hpp"

namespace footlight::planner {
namespace {

/// Frames of an interval that are looked at.
constexpr double kFramesPerInterval = 4;
/// Share of all people who are thought to be on their way at first.
constexpr double kOnTheirWay = 0.5;

/// From coarse to fine: on each level the weights are those of the walks before, `rounds` times; how exact the first
/// round ends, step by step. A level on which fewer people than kLeastPeople would walk says nothing.
struct Scale {
  int factor = 1;          // pitches a block
  std::size_t stride = 1;  // instants a step
  int rounds = 1;
};
constexpr std::array kScales{Scale{4, 2, 3}, Scale{2, 1, 2}, Scale{1, 1, 1}};
constexpr std::size_t kLeastPeople = 16;
constexpr int kRoundsAlone = 3;
constexpr std::array kEpsilonsAtFirst{1000, 200, 50, 20};
constexpr std::array kEpsilons{200, 50, 20};
/// The last of them only on cells, and where cells x instants are no more than this: it takes half as long again.
constexpr std::size_t kMostExactNodes = 400'000;

class JointPlanner {
 public:
  JointPlanner(const JointTask& task, const Progress& progress)
      : task_(task),
        progress_(progress),
        grid_(task.ways->grid()),
        people_(static_cast<double>(task.people)),
        waits_(static_cast<std::size_t>(grid_.size()), 0) {
    for (const CellIndex cell : task.reserve) waits_[cell.at()] = 1;
  }

  std::optional<JointPlan> run() {
    progress_.tell("joint", 0);
    choose_looks();
    if (!look()) return std::nullopt;
    for (const Scale& scale : kScales) {
      if (says_something(scale)) all_work_ += work(scale) * static_cast<double>(refinements(scale, all_work_ == 0));
    }
    for (const Scale& scale : kScales) {
      if (says_something(scale) && !improve(scale)) return std::nullopt;
    }
    return std::move(best_);
  }

 private:
  [[nodiscard]] bool says_something(const Scale& scale) const {
    const auto factor = static_cast<std::size_t>(scale.factor);
    return factor == 1 || task_.people >= kLeastPeople * factor * factor;
  }
  static int rounds(const Scale& scale, bool first) { return first ? kRoundsAlone : scale.rounds; }
  [[nodiscard]] std::span<const int> epsilons(const Scale& scale, bool first) const {
    if (first) return kEpsilonsAtFirst;
    const std::size_t nodes = static_cast<std::size_t>(grid_.size()) * task_.instants.size();
    return std::span(kEpsilons).first(scale.factor == 1 && nodes <= kMostExactNodes ? 3 : 2);
  }
  [[nodiscard]] std::size_t refinements(const Scale& scale, bool first) const {
    return epsilons(scale, first).size() + static_cast<std::size_t>(rounds(scale, first)) - 1;
  }
  /// Of one refinement, as it grows with blocks and instants.
  static double work(const Scale& scale) {
    return 1.0 / (scale.factor * scale.factor * static_cast<double>(scale.stride));
  }

  void choose_looks() {
    const auto frames = task_.film->frames.size();
    const auto intervals = std::count_if(task_.instants.begin(), task_.instants.end(),
                                         [&](const KeyFrame& instant) { return instant.time > task_.start; });
    const double per_interval =
        static_cast<double>(frames) / static_cast<double>(std::max<std::ptrdiff_t>(intervals, 1));
    const auto step = std::max<std::size_t>(1, static_cast<std::size_t>(per_interval / kFramesPerInterval));
    for (std::size_t f = 0; f < frames; f += step) {
      Look look;
      look.frame = f;
      look.at = task_.start + seconds(static_cast<double>(f) / task_.fps);
      look.stands = static_cast<double>(std::min(step, frames - f));
      looks_.push_back(std::move(look));
    }
    worth_ = people_ / per_interval;
  }

  /// Looks at the frames. The first weights are those of people who need not walk, but for frames with few people in
  /// the picture: half of all of them are thought to be on their way.
  bool look() {
    const double cell_px = grid_.cell_area_m2() * std::abs(task_.map[0] * task_.map[4] - task_.map[1] * task_.map[3]);
    const int most = static_cast<int>(people_);
    const int least = std::max(0, most - static_cast<int>(task_.reserve.size()));
    return for_each_index(looks_.size(), "joint", {{}, progress_.stop}, [&](std::size_t n) {
      Look& look = looks_[n];
      const Mask& picture = task_.film->frames[look.frame];
      const auto shares = cell_shares(picture, grid_, task_.map);
      look.area = static_cast<double>(picture_area(picture)) / cell_px;
      const SingleBest best = best_single({&shares, task_.usable, look.area, least, most});
      set_weight(look, std::max<double>(best.people, kOnTheirWay * people_), best.covered);
      look.rho.assign(shares.begin(), shares.end());
      for (const CellIndex cell : task_.reserve) look.rho[cell.at()] = 0;
    });
  }

  /// Near nothing the figures are steep; a few people more or less must not decide about everything.
  void set_weight(Look& look, double people, double covered) const {
    const double least = 0.02 * people_;
    const double n = std::max(people, least);
    look.weight = frame_weight(n, std::clamp(covered, 0.0, n), std::max(look.area, least));
  }

  /// Walks on one level, from the prices of the level before. @return false when stopped
  bool improve(const Scale& scale) {
    auto level = std::make_unique<Level>(task_, looks_, waits_, scale.factor, scale.stride, worth_);
    const bool first = coarser_ == nullptr;
    double least = 0;
    for (int round = 0; round < rounds(scale, first); ++round) {
      level->weigh();
      if (round == 0 && !first) level->start_like(*coarser_);
      if (!refine(*level, round, epsilons(scale, first), work(scale))) return false;
      TimeFlow found = level->result();
      const double loss = level->judge(
          found, [&](std::size_t n, double people, double covered) { set_weight(looks_[n], people, covered); });
      if (scale.factor == 1 && (!best_ || loss < least)) {
        least = loss;
        best_ = JointPlan{std::move(found.at), static_cast<double>(found.cost - found.bound) / kWorth};
      }
    }
    coarser_ = std::move(level);
    return true;
  }

  bool refine(Level& level, int round, std::span<const int> all, double work) {
    for (const int epsilon : round == 0 ? all : all.last(1)) {
      if (!level.refine(epsilon, {{}, progress_.stop})) return false;
      done_work_ += work;
      progress_.tell("joint", std::min(1.0, done_work_ / all_work_));
    }
    return true;
  }

  const JointTask& task_;
  const Progress& progress_;
  const Grid& grid_;
  double people_;
  CellFlags waits_;
  std::vector<Look> looks_;
  double worth_ = 1;
  double all_work_ = 0;
  double done_work_ = 0;
  std::unique_ptr<Level> coarser_;
  std::optional<JointPlan> best_;
};

}  // namespace

std::vector<KeyFrame> walking_instants(const Film& film, const FilmTime& time, bool snap_to_count, double shortest_s) {
  FL_CHECK(film.frames.size() >= 2 && time.duration_counts > 0);
  const double end_count = time.start_count + time.duration_counts;
  const Instant start = time.tempo->at(time.start_count);
  const Instant end = time.tempo->at(end_count);
  const double fps = show_fps(film, time);
  const auto key = [&](double count, Instant instant) {
    const double frame = std::round(to_seconds(instant - start) * fps);
    return KeyFrame{static_cast<int>(std::clamp(frame, 0.0, static_cast<double>(film.frames.size() - 1))), count,
                    instant};
  };
  std::vector<KeyFrame> keys{key(time.start_count, start)};
  const Duration shortest = std::max(seconds(shortest_s), milliseconds(1));
  for (;;) {
    Instant next = keys.back().time + shortest;
    double count = time.tempo->count_at(next);
    if (snap_to_count) {
      count = std::ceil(count - 1e-6);
      next = time.tempo->at(count);
    }
    if (next + shortest > end + milliseconds(1)) break;
    keys.push_back(key(count, next));
  }
  keys.push_back(key(end_count, end));
  return keys;
}

bool can_plan_jointly(const Grid& grid, std::size_t instants) {
  return static_cast<std::size_t>(grid.size()) * instants <= kMostNodes;
}

std::optional<JointPlan> plan_jointly(const JointTask& task, const Progress& progress) {
  return JointPlanner(task, progress).run();
}

}  // namespace footlight::planner
