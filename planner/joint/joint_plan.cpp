// SPDX-License-Identifier: Apache-2.0
#include "planner/joint/joint_plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "planner/formation/best_single.hpp"
#include "planner/formation/cell_shares.hpp"
#include "planner/joint/frame_weight.hpp"
#include "planner/joint/time_flow.hpp"
#include "planner/parallel.hpp"

namespace footlight::planner {
namespace {

constexpr double kRounding_m = 1e-9;
/// Nobody goes further than this in one interval, whatever the limit is.
constexpr double kFarthestPitches = 6;
/// Frames of an interval that are looked at.
constexpr double kFramesPerInterval = 4;
/// What walking one pitch in an interval costs, squared for more, where being in the picture meanwhile is worth one.
constexpr double kWalkCost = 0.1;
/// Whole costs for what one person in the picture is worth in one interval.
constexpr double kScale = 1000;
/// What being on a cell of a formation that the director gave is worth.
constexpr double kKeyWorth = 200;
/// Share of all people who are thought to be on their way at first.
constexpr double kOnTheirWay = 0.5;
/// Rounds, each with the weights of the walks before; how exact the first ends, step by step, and the others are.
constexpr int kRounds = 3;
constexpr std::array kEpsilons{1000, 200, 50};
/// More cells times instants than this are not planned: 40 bytes each.
constexpr std::size_t kMostNodes = 5'000'000;
/// Walks to and from the reserve are kinds of their own.
enum Border : std::uint8_t { kWithin, kOut, kIn, kBorders };

/// One frame that is looked at.
struct Look {
  std::size_t frame = 0;
  double share = 0;   // of the interval
  double stands = 1;  // for so many frames
  double area = 0;    // of the picture, cells
  FrameWeight weight;
  std::vector<float> rho;  // picture in each cell, 0 in the reserve
};

class JointPlanner {
 public:
  JointPlanner(const JointTask& task, const Progress& progress)
      : task_(task),
        progress_(progress),
        grid_(task.ways->grid()),
        pitch_(grid_.pitch_m()),
        people_(static_cast<double>(task.people)),
        waits_(static_cast<std::size_t>(grid_.size()), 0),
        looks_(task.instants.size() - 1) {
    for (const CellIndex cell : task.reserve) waits_[cell.at()] = 1;
  }

  std::optional<JointPlan> run() {
    choose_looks();
    find_reach();
    if (!look()) return std::nullopt;
    return improve();
  }

 private:
  [[nodiscard]] double interval_s(std::size_t k) const {
    return to_seconds(task_.instants[k + 1].time - task_.instants[k].time);
  }

  void choose_looks() {
    const auto frames = task_.film->frames.size();
    const double per_interval = static_cast<double>(frames) / static_cast<double>(looks_.size());
    const auto step = std::max<std::size_t>(1, static_cast<std::size_t>(per_interval / kFramesPerInterval));
    std::size_t k = 0;
    for (std::size_t f = 0; f < frames; f += step) {
      const Instant now = task_.start + seconds(static_cast<double>(f) / task_.fps);
      while (k + 1 < looks_.size() && now >= task_.instants[k + 1].time) ++k;
      Look look;
      look.frame = f;
      look.share = std::clamp(to_seconds(now - task_.instants[k].time) / interval_s(k), 0.0, 1.0);
      look.stands = static_cast<double>(std::min(step, frames - f));
      looks_[k].push_back(std::move(look));
    }
    worth_ = kScale * people_ / per_interval;
  }

  void find_reach() {
    for (std::size_t k = 0; k < looks_.size(); ++k) {
      const double reach_m = std::min(task_.speed_mps * interval_s(k) - kRounding_m, kFarthestPitches * pitch_);
      const auto [known, is_new] = reach_.try_emplace(std::llround(reach_m * 1e6));
      if (is_new) known->second = reach_of(std::max(reach_m, 0.0));
      flow_.intervals.push_back({&known->second, {}});
    }
  }

  [[nodiscard]] Reach reach_of(double reach_m) {
    Reach reach;
    reach.first.push_back(0);
    for (std::size_t i = 0; i < waits_.size(); ++i) {
      const CellIndex from = CellIndex::of(i);
      if (task_.ways->can_stand(from)) {
        for (const CellIndex to : grid_.within(grid_.centre(from), reach_m)) {
          const double length_m = distance(grid_.centre(from), grid_.centre(to));
          if (!task_.ways->can_stand(to) || length_m > reach_m) continue;
          if (!task_.ways->straight(grid_.centre(from), grid_.centre(to))) continue;
          reach.to.push_back(to.value());
          const Border border = waits_[i] == waits_[to.at()] ? kWithin : waits_[i] != 0 ? kOut : kIn;
          reach.kind.push_back(kind_of(length_m, border));
        }
      }
      reach.first.push_back(static_cast<std::uint32_t>(reach.to.size()));
    }
    for (std::size_t kind = 0; kind < reach.mirror.size(); ++kind) {
      constexpr std::array<std::uint8_t, kBorders> kMirror{kWithin, kIn, kOut};
      reach.mirror[kind] = static_cast<std::uint8_t>(kind - kind % kBorders + kMirror[kind % kBorders]);
    }
    return reach;
  }

  /// Lengths are told apart to a thousandth of a pitch.
  [[nodiscard]] std::uint8_t kind_of(double length_m, Border border) {
    const long long key = std::llround(1000 * length_m / pitch_);
    const auto [known, is_new] = lengths_.try_emplace(key, lengths_.size());
    FL_CHECK(kBorders * known->second + border < 256);
    return static_cast<std::uint8_t>(kBorders * known->second + border);
  }

  /// Looks at the frames. The first weights are those of people who need not walk, but for frames with few people in
  /// the picture: half of all of them are thought to be on their way.
  bool look() {
    const double cell_px = grid_.cell_area_m2() * std::abs(task_.map[0] * task_.map[4] - task_.map[1] * task_.map[3]);
    const int most = static_cast<int>(people_);
    const int least = std::max(0, most - static_cast<int>(task_.reserve.size()));
    return for_each_index(looks_.size(), "joint", progress_, [&](std::size_t k) {
      for (Look& look : looks_[k]) {
        const Mask& picture = task_.film->frames[look.frame];
        const auto shares = cell_shares(picture, grid_, task_.map);
        look.area = static_cast<double>(picture_area(picture)) / cell_px;
        const SingleBest best = best_single({&shares, task_.usable, look.area, least, most});
        set_weight(look, std::max<double>(best.people, kOnTheirWay * people_), best.covered);
        look.rho.assign(shares.begin(), shares.end());
        for (const CellIndex cell : task_.reserve) look.rho[cell.at()] = 0;
      }
    });
  }

  /// Near nothing the figures are steep; a few people more or less must not decide about everything.
  void set_weight(Look& look, double people, double covered) const {
    const double least = 0.02 * people_;
    const double n = std::max(people, least);
    look.weight = frame_weight(n, std::clamp(covered, 0.0, n), std::max(look.area, least));
  }

  std::optional<JointPlan> improve() {
    flow_.cells = waits_.size();
    flow_.people = task_.people;
    flow_.start = task_.first;
    TimeFlowSolver solver(flow_);
    std::optional<JointPlan> best;
    double least = 0;
    for (int round = 0; round < kRounds; ++round) {
      weigh();
      for (const int epsilon : kEpsilons) {
        if (round > 0 && epsilon != kEpsilons.back()) continue;
        if (!solver.refine(epsilon, {{}, progress_.stop})) return std::nullopt;
      }
      TimeFlow found = solver.result();
      const double loss = judge(found);
      if (!best || loss < least) {
        least = loss;
        best = JointPlan{std::move(found.at), static_cast<double>(found.cost - found.bound) / kScale};
      }
      progress_.tell("joint", (round + 1.0) / kRounds);
    }
    return best;
  }

  /// What it costs to be on each cell at each instant, from the frames around it: a frame between two instants sees
  /// everybody partly where she was and partly where she will be.
  void weigh() {
    const std::size_t cells = waits_.size();
    flow_.stand.assign(cells * (looks_.size() + 1), 0);
    for_each_index(looks_.size() + 1, "joint", {{}, progress_.stop}, [&](std::size_t k) {
      std::vector<double> gain(cells, 0.0);
      const auto add = [&](const Look& look, double share) {
        const double alpha = worth_ * share * look.stands * look.weight.alpha;
        const double beta = worth_ * share * look.stands * look.weight.beta;
        for (std::size_t c = 0; c < cells; ++c) gain[c] += waits_[c] != 0 ? 0 : alpha * look.rho[c] - beta;
      };
      if (k < looks_.size()) {
        double out = 0;
        double in = 0;
        for (const Look& look : looks_[k]) {
          add(look, 1 - look.share);
          out += worth_ * (1 - look.share) * look.stands * look.weight.beta;
          in += worth_ * look.share * look.stands * look.weight.beta;
        }
        for (const auto& [length, index] : lengths_) {
          const double walk = kScale * kWalkCost * static_cast<double>(length * length) / 1e6;
          flow_.intervals[k].cost[kBorders * index + kWithin] = whole(walk);
          flow_.intervals[k].cost[kBorders * index + kOut] = whole(walk + out);
          flow_.intervals[k].cost[kBorders * index + kIn] = whole(walk + in);
        }
      }
      if (k > 0) {
        for (const Look& look : looks_[k - 1]) add(look, look.share);
      }
      if (!task_.given.empty()) {
        for (const CellIndex cell : task_.given[k]) gain[cell.at()] += kScale * kKeyWorth;
      }
      for (std::size_t c = 0; c < cells; ++c) flow_.stand[k * cells + c] = whole(-gain[c]);
    });
  }

  [[nodiscard]] static std::int32_t whole(double cost) {
    return static_cast<std::int32_t>(std::clamp(std::round(cost), -1e6, 1e6));
  }

  /// What the drawings lose by these walks, theta_dev + kIouWeight theta_iou, and the weights at that.
  double judge(const TimeFlow& flow) {
    double loss = 0;
    for (std::size_t k = 0; k < looks_.size(); ++k) {
      for (Look& look : looks_[k]) {
        double people = 0;
        double covered = 0;
        for (std::size_t i = 0; i < task_.people; ++i) {
          const std::size_t from = flow.at[k][i].at();
          const std::size_t to = flow.at[k + 1][i].at();
          if (waits_[from] != 0 && waits_[to] != 0) continue;
          people += 1;
          covered += (1 - look.share) * look.rho[from] + look.share * look.rho[to];
        }
        const double either = look.area + people - covered;
        if (people > 0) loss += look.stands * (1 - covered / people);
        if (either > 0) loss += look.stands * kIouWeight * (1 - covered / either);
        set_weight(look, people, covered);
      }
    }
    return loss;
  }

  const JointTask& task_;
  const Progress& progress_;
  const Grid& grid_;
  double pitch_;
  double people_;
  CellFlags waits_;
  std::vector<std::vector<Look>> looks_;
  std::map<long long, Reach> reach_;
  std::map<long long, std::size_t> lengths_;  // thousandths of a pitch, and their number
  FlowTask flow_;
  double worth_ = 1;
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
