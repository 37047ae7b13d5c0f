// SPDX-License-Identifier: Apache-2.0
#include "planner/motion/snap_crowd.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/check.hpp"
#include "planner/motion/way_home.hpp"
#include "planner/repair/closest_approach.hpp"
#include "planner/schedule/pace.hpp"
#include "planner/schedule/places.hpp"

namespace footlight::planner {
namespace {

/// How far around the point that is wanted cells are looked at, pitches; farther where these are not enough.
constexpr std::array kRadii{1.6, 3.2, 6.4};
/// What it costs to stand where the place at the end cannot be reached from, before it is weighed by how much.
constexpr double kTooFar = 1000;
/// Staying where one is, when it is not among the cells near.
constexpr double kStay = 100;
/// Who could as well stay does not step to and fro between two cells; in squared pitches.
constexpr double kStep = 0.02;
/// How many walks ahead one gives way to what moves, and what each costs.
constexpr std::size_t kAhead = 3;
constexpr double kSoon = 0.5;
/// How often cells are chosen again where ways conflict, and what a conflict costs each time, in squared pitches.
constexpr int kRounds = 24;
constexpr double kToll = 0.7;
constexpr double kShorter = 0.85;
/// No way home is counted as longer.
constexpr double kFarHome_m = 1e6;

class CrowdSnapper {
 public:
  CrowdSnapper(const SnapCrowdTask& task, const Progress& progress)
      : task_(task),
        progress_(progress),
        ways_(*task.ways),
        grid_(ways_.grid()),
        pitch_(grid_.pitch_m()),
        order_(task.from.size()),
        home_(ways_, task.to) {
    FL_CHECK(task.at->size() == task.at_s.size() && task.longest_m.size() + 1 == task.at_s.size());
    FL_CHECK(task.leg_ways.empty() || task.leg_ways.size() == task.longest_m.size());
    FL_CHECK(task.to.empty() || task.to.size() == task.from.size());
    std::iota(order_.begin(), order_.end(), 0U);
    std::sort(order_.begin(), order_.end(), [&](auto a, auto b) { return task.from[a] < task.from[b]; });
    // From each instant on, less what is lost to the rounding to cells on the way.
    reach_m_.assign(task.at_s.size(), 0.0);
    for (std::size_t k = task.longest_m.size(); k-- > 0;) {
      const bool last = k + 1 == task.longest_m.size();
      reach_m_[k] = last ? task.longest_m[k] : reach_m_[k + 1] + paced_m(task.longest_m[k], pitch_);
    }
    if (!task.to.empty() && !ways_.open()) measure_rest();
  }

  std::optional<SnappedCrowd> run() {
    out_.cells.emplace_back(task_.from.begin(), task_.from.end());
    const std::size_t instants = task_.at_s.size();
    for (std::size_t k = 1; k < instants; ++k) {
      if (progress_.stopped()) return std::nullopt;
      progress_.tell("marks", static_cast<double>(k) / static_cast<double>(instants));
      if (k + 1 == instants && !task_.to.empty()) {
        out_.cells.emplace_back(task_.to.begin(), task_.to.end());
      } else if (!step(k)) {
        break;
      }
      compare(k);
    }
    if (instants > 1) out_.mean_m /= static_cast<double>((instants - 1) * std::max<std::size_t>(1, order_.size()));
    return std::move(out_);
  }

 private:
  /// What is left of everybody's trajectory from each instant on: a way to the end that is known to be free.
  void measure_rest() {
    rest_m_.assign(task_.at_s.size(), std::vector<double>(order_.size(), 0.0));
    for (std::size_t k = task_.longest_m.size(); k-- > 0;) {
      for (std::size_t p = 0; p < order_.size(); ++p) {
        rest_m_[k][p] = rest_m_[k + 1][p] + distance((*task_.at)[k][p], (*task_.at)[k + 1][p]);
      }
    }
  }

  /// How much too far a place is from where somebody must be at the end.
  [[nodiscard]] double beyond_m(std::size_t k, std::uint32_t person, CellIndex cell) {
    if (task_.to.empty()) return 0;
    const Point here = grid_.centre(cell);
    const Point there = grid_.centre(task_.to[person]);
    const double straight = distance(here, there);
    if (straight > reach_m_[k]) return straight - reach_m_[k];
    if (ways_.open() || rest_m_[k][person] + distance(here, (*task_.at)[k][person]) <= reach_m_[k]) return 0;
    if (ways_.straight(here, there)) return 0;
    return std::max(0.0, std::min(kFarHome_m, home_.length_m(person, cell)) - reach_m_[k]);
  }

  /// The floor on the way to instant k.
  [[nodiscard]] const Ways& ways_to(std::size_t k) const {
    return task_.leg_ways.empty() ? ways_ : task_.leg_ways[k - 1];
  }

  /// What it costs to stand where something comes soon.
  [[nodiscard]] double soon(std::size_t k, CellIndex cell) const {
    double sum = 0;
    for (std::size_t next = k; next < std::min(k + kAhead, task_.leg_ways.size()); ++next) {
      sum += task_.leg_ways[next].can_stand(cell) ? 0 : kSoon;
    }
    return sum;
  }

  [[nodiscard]] bool free(std::size_t k, CellIndex from, CellIndex to) const {
    if (from == to) return true;
    const Point a = grid_.centre(from);
    const Point b = grid_.centre(to);
    return distance(a, b) <= task_.longest_m[k - 1] && ways_to(k).straight(a, b);
  }

  /// Where somebody wants to be at instant k, as far as she can come.
  [[nodiscard]] Point aim(std::size_t k, std::uint32_t person) {
    const CellIndex now = out_.cells[k - 1][person];
    const Point here = grid_.centre(now);
    const Point wanted = (*task_.at)[k][person];
    const double longest_m = task_.longest_m[k - 1];
    const CellIndex near = grid_.nearest(wanted);
    const bool leads_home = beyond_m(k, person, near) <= 0;
    if (leads_home && distance(here, wanted) <= longest_m && ways_to(k).straight(here, wanted)) return wanted;
    const Point goal = leads_home ? wanted : grid_.centre(task_.to[person]);
    // Around a corner only as far as can be walked straight; the first bend of the way is a cell.
    double walk_m = longest_m;
    Point at = ways_to(k).toward(here, goal, walk_m).at;
    while (walk_m > pitch_ / 2 && !ways_to(k).straight(here, at)) {
      walk_m *= kShorter;
      at = ways_to(k).toward(here, goal, walk_m).at;
    }
    return at;
  }

  std::vector<Choice> choices(std::size_t k, std::uint32_t person, double radius_m) {
    std::vector<Choice> out;
    const CellIndex now = out_.cells[k - 1][person];
    const Point at = aim(k, person);
    const auto cost = [&](CellIndex cell) {
      const double beyond = beyond_m(k, person, cell) / pitch_;
      const double off = squared_length(grid_.centre(cell) - at) / (pitch_ * pitch_);
      return off + soon(k, cell) + (cell == now ? 0 : kStep) + (beyond > 0 ? kTooFar + beyond * beyond : 0);
    };
    bool stays = false;
    for (const CellIndex cell : grid_.within(at, radius_m)) {
      if (!ways_to(k).can_stand(cell) || !free(k, now, cell)) continue;
      out.push_back({cell, cost(cell)});
      stays = stays || cell == now;
    }
    if (!stays && ways_to(k).can_stand(now)) out.push_back({now, kStay + cost(now)});
    return out;
  }

  using Offered = std::vector<std::vector<Choice>>;  ///< to each person, in the order of `order_`

  [[nodiscard]] std::optional<std::vector<CellIndex>> seated(const Offered& offered) const {
    const auto places = cheapest_places(offered, static_cast<std::size_t>(grid_.size()));
    if (!places) return std::nullopt;
    std::vector<CellIndex> cells(order_.size());
    for (std::size_t n = 0; n < order_.size(); ++n) cells[order_[n]] = (*places)[n];
    return cells;
  }

  /// Pairs of different kinds that come too near to each other on the way to instant k, and from there to the places at
  /// the end when these are next.
  [[nodiscard]] std::vector<NearPair> conflicts(std::size_t k, const std::vector<CellIndex>& cells) const {
    if (task_.kind.empty() || task_.clearance_m <= 0) return {};
    std::vector<NearPair> close = conflicts(out_.cells[k - 1], cells);
    if (task_.to.empty() || k + 2 < task_.at_s.size()) return close;
    const std::vector<NearPair> then = conflicts(cells, task_.to);
    close.insert(close.end(), then.begin(), then.end());
    return close;
  }
  [[nodiscard]] std::vector<NearPair> conflicts(std::span<const CellIndex> from, std::span<const CellIndex> to) const {
    std::vector<Walk> walks;
    for (std::size_t p = 0; p < from.size(); ++p) walks.push_back({grid_.centre(from[p]), grid_.centre(to[p])});
    std::vector<NearPair> close = near_pairs(walks, task_.clearance_m);
    std::erase_if(close, [&](const NearPair& pair) { return task_.kind[pair.a] == task_.kind[pair.b]; });
    return close;
  }

  /// Makes the cells dearer on the way to which people conflict, and seats everybody again; the best is taken.
  [[nodiscard]] std::vector<CellIndex> keep_clear(std::size_t k, Offered& offered, std::vector<CellIndex> cells) const {
    std::vector<NearPair> close = conflicts(k, cells);
    std::vector<CellIndex> best = cells;
    std::size_t fewest = close.size();
    std::vector<std::size_t> place_of(order_.size());
    for (std::size_t n = 0; n < order_.size(); ++n) place_of[order_[n]] = n;
    for (int round = 0; round < kRounds && !close.empty(); ++round) {
      for (const NearPair& pair : close) {
        for (const std::uint32_t person : {pair.a, pair.b}) {
          for (Choice& choice : offered[place_of[person]]) choice.cost += choice.cell == cells[person] ? kToll : 0;
        }
      }
      cells = *seated(offered);
      close = conflicts(k, cells);
      if (close.size() >= fewest) continue;
      fewest = close.size();
      best = cells;
    }
    return best;
  }

  /// Marks of instant k. @return false when somebody is caught
  bool step(std::size_t k) {
    Offered offered(order_.size());
    for (const double radius : kRadii) {
      for (std::size_t n = 0; n < order_.size(); ++n) offered[n] = choices(k, order_[n], radius * pitch_);
      auto cells = seated(offered);
      if (!cells) continue;
      out_.cells.push_back(keep_clear(k, offered, *std::move(cells)));
      return true;
    }
    // Whoever has the fewest cells to go to is named.
    const auto least = std::min_element(offered.begin(), offered.end(),
                                        [](const auto& a, const auto& b) { return a.size() < b.size(); });
    const std::uint32_t who = order_[static_cast<std::size_t>(least - offered.begin())];
    out_.caught = SnappedCrowd::Caught{k, grid_.centre(out_.cells[k - 1][who])};
    return false;
  }

  void compare(std::size_t k) {
    for (std::size_t p = 0; p < order_.size(); ++p) {
      const double off_m = distance(grid_.centre(out_.cells[k][p]), (*task_.at)[k][p]);
      out_.mean_m += off_m;
      if (off_m <= out_.max_m) continue;
      out_.max_m = off_m;
      out_.farthest_instant = k;
    }
  }

  const SnapCrowdTask& task_;
  const Progress& progress_;
  const Ways& ways_;
  const Grid& grid_;
  double pitch_;
  std::vector<std::uint32_t> order_;  ///< people by where they stand at the beginning
  std::vector<double> reach_m_;       ///< from each instant to the end
  std::vector<std::vector<double>> rest_m_;
  WayHome home_;
  SnappedCrowd out_;
};

}  // namespace

std::optional<SnappedCrowd> snap_crowd(const SnapCrowdTask& task, const Progress& progress) {
  return CrowdSnapper(task, progress).run();
}

double followed_share(const Grid& grid, double walk_m) {
  // A cell in the middle of a floor that is large enough; on triangles the two ways that cells point are each other's
  // mirror image, and half of the steps begin on each.
  const int around = static_cast<int>(std::ceil(2.4 * walk_m / grid.pitch_m())) + 3;
  const auto floor = Grid::make(grid.kind(), 2 * around + 1, 2 * around + 1, grid.pitch_m());
  if (!floor || walk_m <= 0) return 0;
  constexpr int kDirections = 360;
  double least_m = std::numeric_limits<double>::infinity();
  for (int d = 0; d < kDirections; ++d) {
    const double angle = 2 * std::numbers::pi * d / kDirections;
    const Point along{std::cos(angle), std::sin(angle)};
    double sum_m = 0;
    for (const int shift : {0, 1}) {
      const Point middle = floor->centre(Cell{around + shift, around});
      double far_m = 0;
      for (const CellIndex cell : floor->within(middle, walk_m)) {
        far_m = std::max(far_m, dot(floor->centre(cell) - middle, along));
      }
      sum_m += far_m / 2;
    }
    least_m = std::min(least_m, sum_m);
  }
  return least_m / walk_m;
}

}  // namespace footlight::planner
