// SPDX-License-Identifier: Apache-2.0
#include "app/import/drone_walks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include <fmt/format.h>

#include "app/numbers.hpp"

namespace footlight::app {
namespace {

struct Slopes {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

/// The points of a track at which it starts, stops or turns: the first, the last, and as few between as keep every
/// other point within `tolerance_m` of the straight way at its time (on each axis). O(points), one pass with a cone of
/// slopes for each axis.
std::vector<std::size_t> turns_of(const std::vector<DronePoint>& points, double tolerance_m) {
  std::vector<std::size_t> out{0};
  std::size_t from = 0;
  Slopes cone[2];
  for (std::size_t i = 1; i < points.size(); ++i) {
    const auto slope = [&](double Point::*axis, double more) {
      return (points[i].at.*axis - points[from].at.*axis + more) /
             static_cast<double>(points[i].time_ms - points[from].time_ms);
    };
    bool inside = true;
    int a = 0;
    for (const auto axis : {&Point::x, &Point::y}) {
      inside = inside && slope(axis, 0) >= cone[a].low && slope(axis, 0) <= cone[a].high;
      ++a;
    }
    if (!inside) {
      from = i - 1;
      out.push_back(from);
      cone[0] = cone[1] = {};
    }
    a = 0;
    for (const auto axis : {&Point::x, &Point::y}) {
      cone[a].low = std::max(cone[a].low, slope(axis, -tolerance_m));
      cone[a].high = std::min(cone[a].high, slope(axis, tolerance_m));
      ++a;
    }
  }
  if (points.size() > 1) out.push_back(points.size() - 1);
  return out;
}

/// Where a track is, asked for in ascending order of time.
class Follower {
 public:
  explicit Follower(const DroneTrack& track) : track_(&track) {}

  /// The last point at or before the time, the first one before all.
  std::size_t last_at(std::int64_t time_ms) {
    const auto& points = track_->points;
    while (at_ + 1 < points.size() && points[at_ + 1].time_ms <= time_ms) ++at_;
    return at_;
  }
  Point where(double time_ms) {
    const auto& points = track_->points;
    const std::size_t i = last_at(static_cast<std::int64_t>(std::floor(time_ms)));
    if (i + 1 == points.size() || time_ms <= static_cast<double>(points[i].time_ms)) return points[i].at;
    const double share = (time_ms - static_cast<double>(points[i].time_ms)) /
                         static_cast<double>(points[i + 1].time_ms - points[i].time_ms);
    return points[i].at + share * (points[i + 1].at - points[i].at);
  }

 private:
  const DroneTrack* track_;
  std::size_t at_ = 0;
};

Error wrong(const DroneTrack& track, std::size_t point, const std::string& what, const std::string& hint) {
  return input_error(to_text({Severity::error, {track.file, track.lines.at(point), 1}, "", what, hint}));
}

std::optional<Error> unequal(const std::vector<DroneTrack>& tracks) {
  const DroneTrack& first = tracks.front();
  for (const DroneTrack& track : tracks) {
    for (const bool end : {false, true}) {
      const auto time = [&](const DroneTrack& of) { return (end ? of.points.back() : of.points.front()).time_ms; };
      if (time(track) == time(first)) continue;
      return wrong(track, end ? track.points.size() - 1 : 0,
                   fmt::format("{} {} at {} ms, and {} at {} ms", track.name, end ? "ends" : "begins", time(track),
                               first.name, time(first)),
                   "everybody's file covers the same time");
    }
  }
  return std::nullopt;
}

/// The count with the fewest decimals that is this millisecond.
double count_of(const TempoMap& tempo, std::int64_t time_ms) {
  const double exact_count = tempo.count_at(Instant(milliseconds(time_ms)));
  double scale = 1;
  for (int decimals = 0; decimals < 9; ++decimals, scale *= 10) {
    const double count = std::round(exact_count * scale) / scale;
    if (std::llround(1000 * to_seconds(tempo.at(count))) == time_ms) return count;
  }
  return exact_count;
}

/// Instants that may be formations, ascending, and whether somebody turns there.
std::map<std::int64_t, bool> candidates(const std::vector<DroneTrack>& tracks,
                                        const std::vector<std::vector<std::size_t>>& turns, bool turns_alone) {
  std::map<std::int64_t, bool> out;
  for (std::size_t p = 0; p < tracks.size(); ++p) {
    for (const std::size_t i : turns[p]) out[tracks[p].points[i].time_ms] = true;
  }
  if (turns_alone) return out;
  std::vector<std::int64_t> common;
  for (const DronePoint& point : tracks.front().points) common.push_back(point.time_ms);
  for (const DroneTrack& track : tracks) {
    std::vector<std::int64_t> both;
    std::size_t i = 0;
    for (const std::int64_t time_ms : common) {
      while (i < track.points.size() && track.points[i].time_ms < time_ms) ++i;
      if (i < track.points.size() && track.points[i].time_ms == time_ms) both.push_back(time_ms);
    }
    common = std::move(both);
  }
  for (const std::int64_t time_ms : common) out.try_emplace(time_ms, false);
  return out;
}

class Walks {
 public:
  Walks(const std::vector<DroneTrack>& tracks, const WalkChoice& choice) : tracks_(tracks), choice_(choice) {
    const double tolerance_m = std::max(choice.grid.snap_m, kRounding_m);
    for (const DroneTrack& track : tracks) turns_.push_back(turns_of(track.points, tolerance_m));
  }

  Result<DroneWalks> run() {
    people();
    auto grid = fitting_grid(out_.imported, turn_places(), choice_.grid);
    if (!grid) return grid.error();
    out_.grid = *grid;
    if (auto error = formations()) return *error;
    if (auto error = off_counts()) return *error;
    return std::move(out_);
  }

 private:
  void people() {
    bool high = false;
    std::size_t several = 0;
    for (const DroneTrack& track : tracks_) {
      out_.imported.files.push_back(track.file);
      std::map<std::tuple<int, int, int>, std::size_t> seen;
      const DronePoint* lit = nullptr;
      for (const DronePoint& point : track.points) {
        high = high || std::abs(point.height_m) > kRounding_m;
        if (point.colour == Colour{}) continue;
        if (lit == nullptr) lit = &point;
        ++seen[{point.colour.red, point.colour.green, point.colour.blue}];
      }
      if (seen.size() > 1) ++several;
      out_.imported.people.push_back({track.name, lit == nullptr ? std::nullopt : std::optional(lit->colour)});
    }
    if (high) out_.imported.ignored.emplace_back("heights (z_m): everybody stands on the floor");
    if (several > 0) {
      out_.imported.ignored.push_back(
          fmt::format("changes of colour, of {} people: each has the first that is not black", several));
    }
  }

  [[nodiscard]] ImportedPlace place(std::size_t person, std::size_t point, Point at) const {
    return {at, static_cast<int>(person), tracks_[person].lines.at(point), 1};
  }
  [[nodiscard]] std::vector<ImportedPlace> turn_places() const {
    std::vector<ImportedPlace> out;
    for (std::size_t p = 0; p < tracks_.size(); ++p) {
      for (const std::size_t i : turns_[p]) out.push_back(place(p, i, tracks_[p].points[i].at));
    }
    return out;
  }

  std::optional<Error> formations() {
    std::vector<Follower> followers(tracks_.begin(), tracks_.end());
    std::vector<CellIndex> before;
    bool passed_a_turn = false;
    const bool sampled = is_sampled();
    for (const auto& [time_ms, turn] : candidates(tracks_, turns_, sampled)) {
      ImportedFormation now;
      std::vector<CellIndex> cells;
      bool all_on = true;
      for (std::size_t p = 0; p < tracks_.size() && all_on; ++p) {
        const std::size_t last = followers[p].last_at(time_ms);
        const Point at = followers[p].where(static_cast<double>(time_ms));
        now.places.push_back(place(p, last, at));
        cells.push_back(out_.grid.cell(at));
        all_on = out_.grid.off_m(at) <= out_.grid.tolerance_m;
      }
      if (!all_on) {
        passed_a_turn = passed_a_turn || turn;
        continue;
      }
      if (!turn && !distinct(cells)) continue;
      const double count = count_of(choice_.tempo, time_ms);
      // Lines that are marks all come back: a hold has two of them.
      const bool may_hold =
          sampled || out_.imported.formations.empty() || out_.imported.formations.back().hold_counts == 0;
      if (cells == before && !passed_a_turn && may_hold) {
        ImportedFormation& held = out_.imported.formations.back();
        held.hold_counts = tidy_count(count - held.count);
        continue;
      }
      now.name = fmt::format("formation {}", out_.imported.formations.size() + 1);
      now.count = count;
      dark(followers, now);
      out_.imported.formations.push_back(std::move(now));
      before = std::move(cells);
      passed_a_turn = false;
    }
    if (out_.imported.formations.empty()) return input_error("at no instant is everybody on a cell");
    return std::nullopt;
  }

  /// Whether lines are samples of walks, and no marks: then a line on a cell may be an accident, and only turns count;
  /// as where people are moved, since samples on the way would be moved, too.
  [[nodiscard]] bool is_sampled() const {
    if (choice_.grid.snap_m > 0) return true;
    return std::any_of(tracks_.begin(), tracks_.end(), [&](const DroneTrack& track) {
      return std::any_of(track.points.begin(), track.points.end(),
                         [&](const DronePoint& point) { return out_.grid.off_m(point.at) > out_.grid.tolerance_m; });
    });
  }

  void dark(std::vector<Follower>& followers, const ImportedFormation& formation) {
    const std::int64_t time_ms = std::llround(1000 * to_seconds(choice_.tempo.at(formation.count)));
    for (std::size_t p = 0; p < tracks_.size(); ++p) {
      const DronePoint& point = tracks_[p].points[followers[p].last_at(time_ms)];
      if (point.colour == Colour{}) out_.imported.dark.push_back(formation.places[p].at);
    }
  }

  static bool distinct(std::vector<CellIndex> cells) {
    std::sort(cells.begin(), cells.end());
    return std::adjacent_find(cells.begin(), cells.end()) == cells.end();
  }

  [[nodiscard]] std::optional<Error> off_counts() const {
    if (choice_.between_counts) return std::nullopt;
    std::size_t off = 0;
    double first = 0;
    for (const ImportedFormation& formation : out_.imported.formations) {
      double count = formation.count;
      if (std::abs(count - std::round(count)) <= 1e-6) count += formation.hold_counts;
      if (std::abs(count - std::round(count)) > 1e-6 && off++ == 0) first = count;
    }
    if (off == 0) return std::nullopt;
    return input_error(fmt::format(
        "{}: error: {} of {} formations begin or end on no count; the first is {} ms, count {:.6g} (give the music's "
        "--tempo or its file, or keep the times as they are with --between-counts)",
        tracks_.front().file, off, out_.imported.formations.size(),
        std::llround(1000 * to_seconds(choice_.tempo.at(first))), first));
  }

  const std::vector<DroneTrack>& tracks_;
  const WalkChoice& choice_;
  std::vector<std::vector<std::size_t>> turns_;
  DroneWalks out_;
};

}  // namespace

Result<DroneWalks> drone_walks(const std::vector<DroneTrack>& tracks, const WalkChoice& choice) {
  FL_CHECK(!tracks.empty());
  if (auto error = unequal(tracks)) return *error;
  return Walks(tracks, choice).run();
}

WayDifference difference_of(const Plan& plan, const std::vector<DroneTrack>& tracks, Point shift) {
  FL_CHECK(plan.tracks.size() == tracks.size());
  WayDifference out;
  for (std::size_t p = 0; p < tracks.size(); ++p) {
    std::vector<Instant> when;
    for (const Mark& mark : plan.tracks[p]) when.push_back(mark.time);
    for (const DronePoint& point : tracks[p].points) when.emplace_back(milliseconds(point.time_ms));
    std::sort(when.begin(), when.end());
    Follower follower(tracks[p]);
    double largest_m = 0;
    for (const Instant instant : when) {
      const Point there = follower.where(1000 * to_seconds(instant)) + shift;
      const double away_m = distance(position_at(plan.stage.grid, plan.tracks[p], instant), there);
      largest_m = std::max(largest_m, away_m);
      if (away_m > out.largest_m) out = {away_m, p, instant, out.people};
    }
    // Marks are exact to the nanosecond, lines to the millisecond: half of one at 5 m/s is 2.5 mm.
    if (largest_m > kRounding_m) ++out.people;
  }
  return out;
}

}  // namespace footlight::app
