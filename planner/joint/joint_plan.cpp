// SPDX-License-Identifier: Apache-2.0
#include "planner/joint/joint_plan.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "planner/formation/best_single.hpp"
#include "planner/formation/summed_area.hpp"
#include "planner/joint/picture_worth.hpp"
#include "planner/joint/time_flow.hpp"
#include "planner/parallel.hpp"

namespace footlight::planner {
namespace {

constexpr double kRounding_m = 1e-9;
/// Nobody goes further than this in one interval, whatever the limit is.
constexpr double kFarthestPitches = 6;
/// Frames of an interval that are looked at.
constexpr double kFramesPerInterval = 5;
/// What walking one pitch in an interval costs, squared for more: about a fifth of being in the picture meanwhile.
constexpr double kWalkCost = 0.2;
/// Whole costs for what one person in the picture is worth in one interval.
constexpr double kScale = 1000;
/// What it is worth to be where the guide has somebody, in intervals.
constexpr double kGuideWorth = 100;
/// The same at a key formation of the director's: more than everything else in a few intervals.
constexpr double kKeyWorth = 900;
/// Intervals that are looked ahead.
constexpr std::size_t kHorizon = 12;
/// What a place at the end of them is worth, in intervals.
constexpr double kEndWorth = 2;
/// More walks than this (all intervals together) are not weighed.
constexpr std::size_t kMostWalks = 60'000'000;

/// One frame that is looked at.
struct Look {
  std::size_t frame = 0;
  double share = 0;   // of the interval
  double stands = 1;  // for so many frames
  FrameWeight weight;
};

class JointPlanner {
 public:
  JointPlanner(const JointTask& task, const Progress& progress)
      : task_(task),
        progress_(progress),
        grid_(task.ways->grid()),
        pitch_(grid_.pitch_m()),
        people_(static_cast<double>(task.first.size())),
        waits_(static_cast<std::size_t>(grid_.size()), 0),
        looks_(task.instants.size() - 1) {
    for (const CellIndex cell : task.reserve) waits_[cell.at()] = 1;
  }

  std::optional<JointPlan> run() {
    choose_looks();
    if (!find_reach()) return std::nullopt;
    if (!weigh_best()) return std::nullopt;
    if (!weigh_walks()) return std::nullopt;
    return walk_on();
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
      looks_[k].push_back(look);
    }
    worth_ = people_ / per_interval;
  }

  bool find_reach() {
    std::size_t walks = 0;
    for (std::size_t k = 0; k < looks_.size(); ++k) {
      const double reach_m = std::min(task_.speed_mps * interval_s(k) - kRounding_m, kFarthestPitches * pitch_);
      const auto [known, is_new] = reach_.try_emplace(std::llround(reach_m * 1e6));
      if (is_new) known->second = reach_of(std::max(reach_m, 0.0));
      intervals_.push_back({&known->second, {}});
      walks += known->second.to.size();
    }
    return walks <= kMostWalks;
  }

  [[nodiscard]] Reach reach_of(double reach_m) const {
    Reach reach;
    reach.first.push_back(0);
    for (std::size_t i = 0; i < waits_.size(); ++i) {
      const CellIndex from = CellIndex::of(i);
      if (task_.ways->can_stand(from)) {
        for (const CellIndex to : grid_.within(grid_.centre(from), reach_m)) {
          if (!task_.ways->can_stand(to) || distance(grid_.centre(from), grid_.centre(to)) > reach_m) continue;
          if (task_.ways->straight(grid_.centre(from), grid_.centre(to))) reach.to.push_back(to.value());
        }
      }
      reach.first.push_back(static_cast<std::uint32_t>(reach.to.size()));
    }
    reach.find_back();
    return reach;
  }

  /// First weights: as if every frame were drawn by people who need not walk.
  bool weigh_best() {
    const double cell_px = grid_.cell_area_m2() * std::abs(task_.map[0] * task_.map[4] - task_.map[1] * task_.map[3]);
    const int most = static_cast<int>(people_);
    const int least = std::max(0, most - static_cast<int>(task_.reserve.size()));
    return for_each_index(looks_.size(), "joint", progress_, [&](std::size_t k) {
      for (Look& look : looks_[k]) {
        const SummedArea picture(task_.film->frames[look.frame]);
        const auto shares = cell_shares(picture, grid_, task_.map);
        const SingleBest best =
            best_single({&shares, task_.usable, static_cast<double>(picture.total()) / cell_px, least, most});
        set_weight(look, best.people, best.covered, best.area);
      }
    });
  }

  void set_weight(Look& look, double people, double covered, double area) const {
    // Near nothing the figures are steep; a few people more or less must not decide about everything.
    const double n = std::max(people, 0.05 * people_);
    look.weight = frame_weight(n, std::clamp(covered, 0.5 * n, n), std::max(area, 0.5 * n));
  }

  /// Looks kHorizon intervals ahead, walks half of them, looks again from there.
  std::optional<JointPlan> walk_on() {
    const std::size_t all = intervals_.size();
    JointPlan plan{{task_.first}};
    for (std::size_t k = 0; k < all;) {
      FlowTask flow;
      std::size_t end = k + 1;
      while (end < std::min(all, k + kHorizon) && !task_.instants[end].given) ++end;
      // At the director's key formations everybody is where the guide has somebody; nobody looks beyond them.
      const bool to_key = task_.instants[end].given;
      const std::size_t go = end == all || to_key ? end : k + kHorizon / 2;
      flow.cells = waits_.size();
      flow.start = plan.at.back();
      for (std::size_t n = k; n < end; ++n)
        flow.intervals.push_back({intervals_[n].reach, std::move(intervals_[n].cost)});
      flow.end_cost = weigh_end(end);
      auto found = cheapest_flow(flow, {{}, progress_.stop});
      if (!found) return std::nullopt;
      for (std::size_t n = k; n < end; ++n) intervals_[n].cost = std::move(flow.intervals[n - k].cost);
      for (std::size_t n = k; n < go; ++n) plan.at.push_back(std::move(found->at[n - k + 1]));
      k = go;
      progress_.tell("joint", static_cast<double>(k) / static_cast<double>(all));
    }
    return plan;
  }

  bool weigh_walks() {
    const bool done = for_each_index(looks_.size(), "joint", progress_, [&](std::size_t k) {
      std::vector<PictureField> fields;
      for (const Look& look : looks_[k]) fields.emplace_back(task_.film->frames[look.frame], grid_, task_.map);
      FlowInterval& interval = intervals_[k];
      interval.cost.resize(interval.reach->to.size());
      for (std::uint32_t c = 0; c < waits_.size(); ++c) {
        const Point from = grid_.centre(CellIndex(c));
        for (std::uint32_t a = interval.reach->first[c]; a < interval.reach->first[c + 1]; ++a) {
          const CellIndex cell(interval.reach->to[a]);
          const Point to = grid_.centre(cell);
          double gain = 0;
          if (waits_[c] == 0 || waits_[cell.at()] == 0) {
            for (std::size_t n = 0; n < fields.size(); ++n) {
              const Look& look = looks_[k][n];
              const Point at = from + look.share * (to - from);
              gain += look.stands * (look.weight.alpha * fields[n].at(at.x, at.y) - look.weight.beta);
            }
          }
          interval.cost[a] = whole(kWalkCost * squared_length(to - from) / (pitch_ * pitch_) - worth_ * gain);
        }
      }
    });
    return done;
  }

  [[nodiscard]] static std::int32_t whole(double cost) {
    return static_cast<std::int32_t>(std::clamp(std::round(kScale * cost), -1e6, 1e6));
  }

  /// Where people end is worth kEndWorth intervals.
  [[nodiscard]] std::vector<std::int32_t> weigh_end(std::size_t instant) const {
    const std::vector<Look>* looks = &looks_[instant - 1];
    for (std::size_t k = instant - 1; looks->empty(); --k) looks = &looks_[k];
    const Look& last = looks->back();
    const auto frame = static_cast<std::size_t>(task_.instants[instant].frame);
    const PictureField field(task_.film->frames[frame], grid_, task_.map);
    std::vector<std::int32_t> cost(waits_.size());
    for (std::size_t c = 0; c < waits_.size(); ++c) {
      const Point at = grid_.centre(CellIndex::of(c));
      const double gain = waits_[c] != 0 ? 0 : last.weight.alpha * field.at(at.x, at.y) - last.weight.beta;
      cost[c] = whole(-kEndWorth * people_ * gain);
    }
    if (!task_.guide.empty()) {
      const double worth = task_.instants[instant].given ? kKeyWorth : kGuideWorth;
      for (const CellIndex cell : task_.guide[instant]) cost[cell.at()] -= whole(worth);
    }
    return cost;
  }

  const JointTask& task_;
  const Progress& progress_;
  const Grid& grid_;
  double pitch_;
  double people_;
  CellFlags waits_;
  std::vector<std::vector<Look>> looks_;
  std::map<long long, Reach> reach_;
  std::vector<FlowInterval> intervals_;
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

std::optional<JointPlan> plan_jointly(const JointTask& task, const Progress& progress) {
  return JointPlanner(task, progress).run();
}

}  // namespace footlight::planner
