// SPDX-License-Identifier: Apache-2.0
#include "planner/srd/groups.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <tuple>

#include <fmt/format.h>

#include "core/check.hpp"
#include "planner/assignment/assignment.hpp"
#include "planner/srd/open_ranks.hpp"

namespace footlight::planner::srd {
namespace {

constexpr double kAnyLength = std::numeric_limits<double>::infinity();

std::string told(Point at) { return fmt::format("({:.1f} m, {:.1f} m)", at.x, at.y); }

using Numbers = std::vector<std::uint32_t>;

Point middle(const std::vector<Point>& all, const Numbers& which) {
  Point sum;
  for (const std::uint32_t i : which) sum = sum + all[i];
  return 1 / static_cast<double>(which.size()) * sum;
}

const GroupPath* path_of(const MotionTask& task, std::uint32_t group) {
  const GroupPath* general = nullptr;
  for (const GroupPath& path : task.paths) {
    if (!path.group) {
      general = &path;
    } else if (path.group->value() == group) {
      return &path;
    }
  }
  return general;
}

/// One group while it is put together.
struct Band {
  Numbers people;
  Numbers places;  ///< none: wherever its path leads
  std::vector<Point> path;
  std::vector<Point> corners;  ///< of the way, with the beginning and the goal
};

class Division {
 public:
  Division(const MotionTask& task, const SrdOptions& options, const FreeFloor& floor)
      : task_(task), options_(options), floor_(floor) {}

  Result<Groups> run() {
    if (auto error = gather()) return *error;
    if (auto error = give_places()) return *error;
    out_.offsets.resize(task_.people());
    if (!task_.to.empty()) out_.place_of.resize(task_.people());
    for (Band& band : bands_) {
      if (auto error = lead(band)) return *error;
      if (auto error = settle(band)) return *error;
      if (auto error = time(band)) return *error;
    }
    open_ranks(tasks_, options_, floor_, task_, out_);
    return std::move(out_);
  }

 private:
  std::optional<Error> gather() {
    std::map<std::uint32_t, std::size_t> band_of;
    for (std::uint32_t i = 0; i < task_.people(); ++i) {
      const std::uint32_t group = task_.group.empty() ? kNoGroup : task_.group[i];
      const auto [found, is_new] = band_of.emplace(group, bands_.size());
      if (is_new) bands_.emplace_back();
      bands_[found->second].people.push_back(i);
      out_.of.push_back(static_cast<std::int32_t>(found->second));
    }
    for (const auto& [group, band] : band_of) {
      if (const GroupPath* path = path_of(task_, group)) bands_[band].path = path->through;
    }
    if (task_.to.empty()) return std::nullopt;
    for (std::uint32_t j = 0; j < task_.to_group.size(); ++j) {
      const auto found = band_of.find(task_.to_group[j]);
      if (found == band_of.end()) {
        return input_error(fmt::format("nobody is in the group whose place {} is", told(task_.to[j])));
      }
      bands_[found->second].places.push_back(j);
    }
    return std::nullopt;
  }

  /// Each group's places, where they are nobody's in particular.
  std::optional<Error> give_places() {
    if (task_.to.empty()) return std::nullopt;
    if (task_.to_group.empty()) {
      std::vector<Point> ends = task_.from;
      for (const Band& band : bands_) {
        const Point from = middle(task_.from, band.people);
        for (const std::uint32_t i : band.people) {
          if (!band.path.empty()) ends[i] = ends[i] + (band.path.back() - from);
        }
      }
      const auto pairs = assign(apart(std::move(ends)), task_.to, WalkCost::squared, kAnyLength);
      if (!pairs) return internal_error("no assignment of everybody to any place");
      for (Band& band : bands_) {
        for (const std::uint32_t i : band.people) band.places.push_back(pairs->target_of[i]);
        std::sort(band.places.begin(), band.places.end());
      }
    }
    for (const Band& band : bands_) {
      if (band.places.size() == band.people.size()) continue;
      return input_error(fmt::format("a group of {} people has {} places", band.people.size(), band.places.size()));
    }
    return std::nullopt;
  }

  /// Around what is blocked so far off that the formation is not bent by it, where there is so much room, else half as
  /// far, and so on.
  [[nodiscard]] std::vector<Point> wide_way(Point from, Point to, double radius_m) const {
    const Ways& ways = floor_.floor().ways();
    if (ways.straight(from, to)) return {from, to};
    Stage stage;
    stage.grid = ways.grid();
    stage.blocked = ways.blocked();
    for (const double share : {1.0, 0.5, 0.25}) {
      const Ways wide(stage, ways.keep_m() + share * radius_m);
      if (!wide.straight(from, from) || !wide.straight(to, to)) continue;
      auto way = wide.way(from, to);
      if (!way.empty()) return way;
    }
    return ways.way(from, to);
  }

  /// The way of a group's centre.
  std::optional<Error> lead(Band& band) {
    const Point from = middle(task_.from, band.people);
    band.corners.push_back(floor_.free_place(from));
    double radius_m = 0;
    for (const std::uint32_t i : band.people) radius_m = std::max(radius_m, distance(task_.from[i], from));
    std::vector<Point> through = band.path;
    if (!band.places.empty()) through.push_back(floor_.free_place(middle(task_.to, band.places)));
    for (const Point at : through) {
      const Point here = band.corners.back();
      if (distance(here, at) < 1e-9) continue;
      const auto way = wide_way(here, at, radius_m);
      if (way.empty()) {
        return input_error(fmt::format("there is no way around the blocked cells from {} to {}", told(here), told(at)));
      }
      band.corners.insert(band.corners.end(), way.begin() + 1, way.end());
    }
    return std::nullopt;
  }

  /// Who gets which place: the formation of the beginning, as it arrives, laid upon the one of the goal.
  std::optional<Error> settle(const Band& band) {
    const Point start = band.corners.front();
    const Point goal = band.corners.back();
    const Placing arrived({{}, March::whole_turn(band.corners, options_), 0, 0});
    std::vector<Point> kept;
    for (const std::uint32_t i : band.people) {
      out_.offsets[i].from = task_.from[i] - start;
      out_.offsets[i].to = arrived(out_.offsets[i]);
      kept.push_back(out_.offsets[i].to);
    }
    if (band.places.empty()) return std::nullopt;
    std::vector<Point> targets;
    for (const std::uint32_t j : band.places) targets.push_back(task_.to[j] - goal);
    const auto pairs = assign(apart(std::move(kept)), apart(targets), WalkCost::squared, kAnyLength);
    if (!pairs) return internal_error("no assignment within a group");
    for (std::size_t n = 0; n < band.people.size(); ++n) {
      const std::uint32_t i = band.people[n];
      const std::uint32_t target = pairs->target_of[n];
      out_.place_of[i] = band.places[target];
      out_.offsets[i].to = targets[target];
      if (floor_.connected(task_.from[i], task_.to[out_.place_of[i]])) continue;
      return input_error(fmt::format("nobody can walk from {} to {}: blocked cells are all around one of them",
                                     told(task_.from[i]), told(task_.to[out_.place_of[i]])));
    }
    return std::nullopt;
  }

  std::optional<Error> time(const Band& band) {
    March::Task march{band.corners, {}, {}, task_.duration_s(), {}, task_.floor};
    for (const std::uint32_t i : band.people) {
      march.offsets.push_back(out_.offsets[i]);
      march.speed_mps.push_back(task_.speed_mps[i]);
    }
    auto planned = March::plan(march, options_);
    if (!planned) return planned.error();
    out_.march.push_back(std::move(*planned));
    tasks_.push_back(std::move(march));
    return std::nullopt;
  }

  /// `assign` wants different points.
  static std::vector<Point> apart(std::vector<Point> points) {
    std::vector<std::uint32_t> order(points.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::tie(points[a].x, points[a].y, a) < std::tie(points[b].x, points[b].y, b);
    });
    for (std::size_t n = 1; n < order.size(); ++n) {
      const Point before = points[order[n - 1]];
      Point& here = points[order[n]];
      if (here.x < before.x || here == before) here = {before.x + 1e-6, here.y};
    }
    return points;
  }

  const MotionTask& task_;
  const SrdOptions& options_;
  const FreeFloor& floor_;
  std::vector<Band> bands_;
  std::vector<March::Task> tasks_;  ///< of each march
  Groups out_;
};

}  // namespace

Result<Groups> divide(const MotionTask& task, const SrdOptions& options, const FreeFloor& floor) {
  FL_CHECK(task.floor != nullptr && task.people() > 0 && task.duration_s() > 0);
  return Division(task, options, floor).run();
}

}  // namespace footlight::planner::srd
