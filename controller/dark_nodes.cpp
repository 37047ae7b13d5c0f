// SPDX-License-Identifier: Apache-2.0
#include "controller/dark_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "core/check.hpp"

namespace footlight::controller {
namespace {

constexpr double kTolerance_m = 1e-6;
constexpr std::uint32_t kNone = 0xFFFFFFFFU;
/// Side of the tiles in which people are looked up, pitches.
constexpr double kTile = 4;

/// A stretch in which somebody is not where the plan has her, because a unit is dark.
struct Astray {
  std::uint32_t unit = 0;
  std::uint32_t person = 0;
  std::uint32_t cue = 0;  ///< the walk that she was not shown
  Instant start;
  Instant end;
  CellIndex from;
  CellIndex to;
};

/// A walk that was not shown, and who came nearest for it.
struct LostCue {
  std::uint32_t unit = 0;
  UnsafeCue cue;
  bool unsafe = false;
};

/// Where somebody is at both ends of a stretch of time.
struct Sweep {
  Point from;
  Point to;
};

class DarkSearch {
 public:
  DarkSearch(const Plan& plan, const Rig& rig) : plan_(plan), grid_(plan.stage.grid) {
    FL_CHECK(plan.radius_m.size() == plan.tracks.size());
    name_units(rig);
    units_of_lamp_.assign(static_cast<std::size_t>(grid_.size()), kNone);
    units_of_wearable_.assign(plan.tracks.size(), kNone);
    for (std::size_t n = 0; n < rig.nodes.size(); ++n) {
      for (const Channel& channel : rig.nodes[n].channels) {
        const auto node = static_cast<std::uint32_t>(n);
        if (channel.kind == Channel::Kind::cell) units_of_lamp_[channel.cell.at()] = node;
        if (channel.kind == Channel::Kind::wearable) units_of_wearable_[channel.performer.at()] = node;
      }
    }
  }

  std::vector<DarkUnit> run(std::size_t keep) {
    for (std::uint32_t p = 0; p < plan_.tracks.size(); ++p) lose(p);
    judge_all();
    for (const LostCue& lost : cues_) {
      DarkUnit& unit = units_[lost.unit];
      ++unit.not_shown;
      if (!lost.unsafe) continue;
      ++unit.unsafe;
      unit.worst.push_back(lost.cue);
    }
    for (DarkUnit& unit : units_) {
      std::stable_sort(unit.worst.begin(), unit.worst.end(), [](const UnsafeCue& a, const UnsafeCue& b) {
        return std::tie(a.distance_m, a.told, a.who) < std::tie(b.distance_m, b.told, b.who);
      });
    }
    const auto nearest_m = [](const DarkUnit& unit) {
      return unit.worst.empty() ? std::numeric_limits<double>::infinity() : unit.worst.front().distance_m;
    };
    std::stable_sort(units_.begin(), units_.end(), [&](const DarkUnit& a, const DarkUnit& b) {
      return std::pair(b.unsafe, nearest_m(a)) < std::pair(a.unsafe, nearest_m(b));
    });
    for (DarkUnit& unit : units_) unit.worst.resize(std::min(keep, unit.worst.size()));
    return std::move(units_);
  }

 private:
  /// A unit for each node, then one for each supply.
  void name_units(const Rig& rig) {
    std::map<std::string, std::uint32_t> supplies;
    for (const Node& node : rig.nodes) units_.push_back({DarkUnit::Kind::node, node.name, 1, 0, 0, {}});
    for (std::size_t n = 0; n < rig.nodes.size(); ++n) {
      supply_of_node_.push_back(kNone);
      const std::string& name = rig.nodes[n].supply;
      if (name.empty()) continue;
      const auto [at, is_new] = supplies.emplace(name, static_cast<std::uint32_t>(units_.size()));
      if (is_new) units_.push_back({DarkUnit::Kind::supply, name, 0, 0, 0, {}});
      ++units_[at->second].nodes;
      supply_of_node_[n] = at->second;
    }
  }

  /// The node that shows the goal of a walk; none: nothing in the rig does.
  [[nodiscard]] std::uint32_t guide_of(std::uint32_t person, CellIndex goal) const {
    const std::uint32_t lamp = units_of_lamp_[goal.at()];
    return lamp != kNone ? lamp : units_of_wearable_[person];
  }

  /// What happens to one person, for every unit that shows any of her goals.
  void lose(std::uint32_t person) {
    const std::vector<Mark>& track = plan_.tracks[person];
    std::vector<std::pair<std::uint32_t, std::uint32_t>> lost;  // unit, mark from which she walks
    for (std::uint32_t k = 0; k + 1 < track.size(); ++k) {
      if (track[k].cell == track[k + 1].cell) continue;
      const std::uint32_t node = guide_of(person, track[k + 1].cell);
      if (node == kNone) continue;
      lost.emplace_back(node, k);
      if (supply_of_node_[node] != kNone) lost.emplace_back(supply_of_node_[node], k);
    }
    std::sort(lost.begin(), lost.end());
    for (std::size_t first = 0; first < lost.size();) {
      std::size_t last = first;
      std::vector<char> dark(track.size(), 0);
      for (; last < lost.size() && lost[last].first == lost[first].first; ++last) dark[lost[last].second] = 1;
      wander(person, lost[first].first, dark);
      first = last;
    }
  }

  /// @param dark one flag a mark: the walk that begins there is not shown
  void wander(std::uint32_t person, std::uint32_t unit, const std::vector<char>& dark) {
    const std::vector<Mark>& track = plan_.tracks[person];
    CellIndex here = track.front().cell;
    std::uint32_t cue = kNone;  // the last walk that was not shown, while she is astray
    for (std::size_t k = 0; k + 1 < track.size(); ++k) {
      const CellIndex goal = track[k + 1].cell;
      if (dark[k] != 0) {
        cue = static_cast<std::uint32_t>(cues_.size());
        cues_.push_back({unit, {PerformerIndex(person), goal, track[k].time, {}, 0, {}}, false});
      }
      const bool walks = dark[k] == 0 && (cue == kNone || track[k].cell != goal);
      const CellIndex there = walks ? goal : here;
      if (cue != kNone) astray_.push_back({unit, person, cue, track[k].time, track[k + 1].time, here, there});
      here = there;
      if (here == goal) cue = kNone;
    }
  }

  void judge_all() {
    std::vector<Instant> times;
    for (const auto& track : plan_.tracks) {
      for (const Mark& mark : track) times.push_back(mark.time);
    }
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    std::stable_sort(astray_.begin(), astray_.end(), [](const Astray& a, const Astray& b) {
      return std::tie(a.start, a.unit) < std::tie(b.start, b.unit);
    });
    std::vector<std::uint32_t> active;
    std::size_t next = 0;
    cursor_.assign(plan_.tracks.size(), 0);
    group_of_.assign(plan_.tracks.size(), kNone);
    for (std::size_t i = 0; i + 1 < times.size(); ++i) {
      std::erase_if(active, [&](std::uint32_t n) { return astray_[n].end <= times[i]; });
      for (; next < astray_.size() && astray_[next].start <= times[i]; ++next) {
        active.push_back(static_cast<std::uint32_t>(next));
      }
      if (active.empty()) continue;
      std::stable_sort(active.begin(), active.end(),
                       [&](std::uint32_t a, std::uint32_t b) { return astray_[a].unit < astray_[b].unit; });
      judge_stretch(active, times[i], times[i + 1]);
    }
  }

  /// Everybody walks straight between two neighbouring mark instants.
  void judge_stretch(const std::vector<std::uint32_t>& active, Instant start, Instant end) {
    sweep_everybody(start, end);
    for (std::size_t first = 0; first < active.size();) {
      std::size_t last = first;
      while (last < active.size() && astray_[active[last]].unit == astray_[active[first]].unit) ++last;
      for (std::size_t n = first; n < last; ++n) group_of_[astray_[active[n]].person] = active[n];
      for (std::size_t n = first; n < last; ++n) {
        const Astray& one = astray_[active[n]];
        const Sweep own = sweep_of(one, start, end);
        for (const std::uint32_t other : people_near(own)) {
          if (other == one.person || group_of_[other] != kNone) continue;
          measure(one, own, other, sweeps_[other], start, end);
        }
        for (std::size_t m = first; m < last; ++m) {
          const Astray& other = astray_[active[m]];
          if (other.person != one.person) measure(one, own, other.person, sweep_of(other, start, end), start, end);
        }
      }
      for (std::size_t n = first; n < last; ++n) group_of_[astray_[active[n]].person] = kNone;
      first = last;
    }
  }

  [[nodiscard]] Sweep sweep_of(const Astray& one, Instant start, Instant end) const {
    const Point from = grid_.centre(one.from);
    const Point way = grid_.centre(one.to) - from;
    const double whole_s = to_seconds(one.end - one.start);
    return {from + (to_seconds(start - one.start) / whole_s) * way,
            from + (to_seconds(end - one.start) / whole_s) * way};
  }

  void sweep_everybody(Instant start, Instant end) {
    sweeps_.resize(plan_.tracks.size());
    double reach_m = 0;
    for (std::size_t p = 0; p < sweeps_.size(); ++p) {
      const std::vector<Mark>& track = plan_.tracks[p];
      std::size_t& at = cursor_[p];
      while (at + 1 < track.size() && track[at + 1].time <= start) ++at;
      sweeps_[p] = {where(track, at, start), where(track, at, end)};
      reach_m = std::max(reach_m, plan_.radius_m[p]);
    }
    reach_m_ = std::max(plan_.stage.clearance_m, 2 * reach_m);
    lay_tiles();
  }
  [[nodiscard]] Point where(const std::vector<Mark>& track, std::size_t at, Instant time) const {
    const Point from = grid_.centre(track[at].cell);
    if (time <= track[at].time || at + 1 == track.size()) return from;
    const double share = to_seconds(time - track[at].time) / to_seconds(track[at + 1].time - track[at].time);
    return from + share * (grid_.centre(track[at + 1].cell) - from);
  }

  /// Tiles that the box around a sweep covers.
  struct Tiles {
    int x0, y0, x1, y1;
  };
  [[nodiscard]] Tiles tiles_of(const Sweep& sweep, double grow_m) const {
    const double side = kTile * grid_.pitch_m();
    const auto column = [&](double x) {
      return std::clamp(static_cast<int>(std::floor((x - left_m_) / side)), 0, columns_ - 1);
    };
    const auto row = [&](double y) { return std::clamp(static_cast<int>(std::floor(y / side)), 0, rows_ - 1); };
    return {column(std::min(sweep.from.x, sweep.to.x) - grow_m), row(std::min(sweep.from.y, sweep.to.y) - grow_m),
            column(std::max(sweep.from.x, sweep.to.x) + grow_m), row(std::max(sweep.from.y, sweep.to.y) + grow_m)};
  }
  template <class Visit>
  void for_each_tile(const Tiles& tiles, Visit visit) const {
    for (int y = tiles.y0; y <= tiles.y1; ++y) {
      for (int x = tiles.x0; x <= tiles.x1; ++x) visit(static_cast<std::size_t>(y * columns_ + x));
    }
  }

  void lay_tiles() {
    const double side = kTile * grid_.pitch_m();
    const Point last = grid_.centre(Cell{grid_.columns() - 1, grid_.rows() - 1});
    left_m_ = grid_.centre(Cell{0, 0}).x - grid_.pitch_m();
    columns_ = static_cast<int>((last.x + grid_.pitch_m() - left_m_) / side) + 1;
    rows_ = static_cast<int>((last.y + grid_.pitch_m()) / side) + 1;
    first_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
    for (const Sweep& sweep : sweeps_) {
      for_each_tile(tiles_of(sweep, 0), [&](std::size_t tile) { ++first_[tile + 1]; });
    }
    for (std::size_t t = 1; t < first_.size(); ++t) first_[t] += first_[t - 1];
    members_.resize(first_.back());
    std::vector<std::uint32_t> fill(first_.begin(), first_.end() - 1);
    for (std::uint32_t p = 0; p < sweeps_.size(); ++p) {
      for_each_tile(tiles_of(sweeps_[p], 0), [&](std::size_t tile) { members_[fill[tile]++] = p; });
    }
  }

  /// Whoever the plan may bring near, ascending.
  const std::vector<std::uint32_t>& people_near(const Sweep& sweep) {
    near_.clear();
    for_each_tile(tiles_of(sweep, reach_m_), [&](std::size_t tile) {
      near_.insert(near_.end(), members_.begin() + first_[tile], members_.begin() + first_[tile + 1]);
    });
    std::sort(near_.begin(), near_.end());
    near_.erase(std::unique(near_.begin(), near_.end()), near_.end());
    return near_;
  }

  /// Closed form: least |d0 + (d1 - d0) share| over the stretch.
  void measure(const Astray& one, const Sweep& own, std::uint32_t other, const Sweep& theirs, Instant start,
               Instant end) {
    const double least_m =
        std::max(plan_.stage.clearance_m, plan_.radius_m[one.person] + plan_.radius_m[other]) - kTolerance_m;
    const Point d0 = own.from - theirs.from;
    const Point way = (own.to - theirs.to) - d0;
    const double squared = squared_length(way);
    const double share = squared > 0 ? std::clamp(-dot(d0, way) / squared, 0.0, 1.0) : 0.0;
    const double distance_m = length(d0 + share * way);
    if (distance_m >= least_m) return;
    LostCue& lost = cues_[one.cue];
    if (lost.unsafe && lost.cue.distance_m <= distance_m) return;
    lost.unsafe = true;
    lost.cue.other = PerformerIndex(other);
    lost.cue.distance_m = distance_m;
    lost.cue.at = start + Duration(std::llround(share * static_cast<double>((end - start).count())));
  }

  const Plan& plan_;
  const Grid& grid_;
  std::vector<DarkUnit> units_;
  std::vector<std::uint32_t> supply_of_node_;
  std::vector<std::uint32_t> units_of_lamp_;      // of each cell, its node
  std::vector<std::uint32_t> units_of_wearable_;  // of each performer, her node
  std::vector<LostCue> cues_;
  std::vector<Astray> astray_;
  std::vector<std::size_t> cursor_;      // of each performer, the last mark at or before the stretch
  std::vector<std::uint32_t> group_of_;  // of each performer, her stretch astray under the unit that is looked at
  std::vector<Sweep> sweeps_;
  double reach_m_ = 0;
  double left_m_ = 0;
  int columns_ = 1;
  int rows_ = 1;
  std::vector<std::uint32_t> first_;  // of each tile in members_
  std::vector<std::uint32_t> members_;
  std::vector<std::uint32_t> near_;
};

}  // namespace

std::vector<DarkUnit> find_dark_units(const Plan& plan, const Rig& rig, std::size_t keep) {
  return DarkSearch(plan, rig).run(keep);
}

}  // namespace footlight::controller
