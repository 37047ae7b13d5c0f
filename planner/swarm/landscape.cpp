// SPDX-License-Identifier: Apache-2.0
#include "planner/swarm/landscape.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "core/check.hpp"
#include "planner/assignment/assignment.hpp"

namespace footlight::planner::swarm {
namespace {

constexpr double kRounding_m = 1e-6;
/// Beyond so many scopes nobody minds what is blocked: e^-9.
constexpr double kFarScopes = 3;
/// A field of ways for a moving target holds so long, unless that were more fields than this.
constexpr double kField_s = 1;
constexpr double kMostFields = 200;

std::string at_text(Point at) { return fmt::format("({:.2f} m, {:.2f} m)", at.x, at.y); }

/// People and places by the class they may exchange in.
using Classes = std::map<std::pair<std::uint32_t, std::uint32_t>,
                         std::pair<std::vector<std::uint32_t>, std::vector<std::uint32_t>>>;

}  // namespace

Landscape::Landscape(const MotionTask& task, const SwarmOptions& options)
    : task_(&task), options_(options), floor_(task.floor) {
  FL_CHECK(floor_ != nullptr);
}

Result<Landscape> Landscape::make(const MotionTask& task, const SwarmOptions& options) {
  Landscape out(task, options);
  const Ways& ways = out.floor_->ways();
  for (const double radius_m : task.radius_m) out.scope_m_.push_back(options.person_m.value_or(radius_m));
  out.still_scope_m_ = std::max(ways.keep_m(), options.person_m.value_or(0));
  const double floor_m = distance(out.floor_->low(), out.floor_->high());
  out.per_floor_square_ = floor_m > 0 ? 1 / (floor_m * floor_m) : 1;
  out.hardest_ = std::exp(-options.hardness);
  if (!ways.open()) out.passages_ = std::make_unique<Passages>(ways);
  out.look_around();
  out.sort_into_crowds();
  if (auto error = out.place_people()) return *std::move(error);
  if (auto error = out.lay_paths()) return *std::move(error);
  out.lay_fields();
  return out;
}

void Landscape::look_around() {
  const Ways& ways = floor_->ways();
  if (ways.open()) return;
  const Grid& grid = ways.grid();
  double fastest_mps = 0;
  for (const double speed_mps : task_->speed_mps) fastest_mps = std::max(fastest_mps, speed_mps);
  double cell_radius_m = 0;
  for (const Point corner : grid.outline(CellIndex(0))) {
    cell_radius_m = std::max(cell_radius_m, distance(corner, grid.centre(CellIndex(0))));
  }
  // Of two points in one cell, and a step from there.
  const double reach_m =
      3 * cell_radius_m + std::max(kFarScopes * still_scope_m_, ways.keep_m()) + fastest_mps * options_.step_s;
  open_.assign(static_cast<std::size_t>(grid.size()), 1);
  for (const CellIndex cell : ways.blocked()) {
    for (const CellIndex near : grid.within(grid.centre(cell), reach_m)) open_[near.at()] = 0;
  }
}

void Landscape::sort_into_crowds() {
  std::map<std::uint32_t, std::uint32_t> number;
  for (const std::uint32_t group : task_->group) number.emplace(group, 0);
  std::uint32_t next = 0;
  for (auto& [group, crowd] : number) crowd = next++;
  crowds_.resize(number.size());
  for (const std::uint32_t group : task_->group) crowd_of_.push_back(number[group]);
}

std::optional<Error> Landscape::place_people() {
  const std::size_t people = task_->people();
  const Ways& ways = floor_->ways();
  places_ = task_->to.empty() ? task_->from : task_->to;
  for (const Point place : places_) {
    const auto near = floor_->nearest(place, ways.keep_m());
    if (!near || near->distance_m >= ways.keep_m() - kRounding_m) continue;
    return input_error(
        fmt::format("the target at {} lies in an obstacle (people stay {:g} m away from what is blocked)",
                    at_text(place), ways.keep_m()));
  }
  Classes classes;
  const bool grouped = !task_->to_group.empty();
  const auto part = [&](Point at) { return passages_ ? passages_->part(at) : 0; };
  for (std::uint32_t p = 0; p < people; ++p) {
    classes[{grouped ? task_->group[p] : 0, part(task_->from[p])}].first.push_back(p);
    classes[{grouped ? task_->to_group[p] : 0, part(places_[p])}].second.push_back(p);
  }
  first_place_.assign(people, 0);
  class_of_.assign(people, 0);
  std::uint32_t number = 0;
  for (const auto& [key, both] : classes) {
    const auto& [who, where] = both;
    if (where.size() > who.size()) {
      return input_error(
          fmt::format("{} target{} cannot be reached, for example that at {}: what is blocked lies between "
                      "{} and everybody who may go there (open a way, or move the formation)",
                      where.size() - who.size(), where.size() - who.size() == 1 ? "" : "s",
                      at_text(places_[where.back()]), where.size() - who.size() == 1 ? "it" : "them"));
    }
    std::vector<Point> from;
    std::vector<Point> to;
    for (const std::uint32_t p : who) from.push_back(task_->from[p]);
    for (const std::uint32_t place : where) to.push_back(places_[place]);
    if (from.size() != to.size()) continue;  // another class has too many and says so
    const auto pairing =
        task_->to.empty() ? std::nullopt : assign(from, to, WalkCost::squared, std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < who.size(); ++i) {
      first_place_[who[i]] = pairing ? where[pairing->target_of[i]] : who[i];
      class_of_[who[i]] = number;
    }
    ++number;
  }
  return std::nullopt;
}

std::optional<Error> Landscape::lay_paths() {
  std::vector<std::size_t> people(crowds_.size(), 0);
  std::vector<const GroupPath*> path(crowds_.size(), nullptr);
  for (std::size_t p = 0; p < task_->people(); ++p) {
    Lead& crowd = crowds_[crowd_of_[p]];
    crowd.rest = crowd.rest + places_[first_place_[p]];
    ++people[crowd_of_[p]];
    for (const GroupPath& one : task_->paths) {
      const bool own = one.group && one.group->value() == task_->group[p];
      if (own || (!one.group && path[crowd_of_[p]] == nullptr)) path[crowd_of_[p]] = &one;
    }
  }
  for (std::size_t c = 0; c < crowds_.size(); ++c) {
    Lead& crowd = crowds_[c];
    crowd.rest = 1.0 / static_cast<double>(people[c]) * crowd.rest;
    if (path[c] == nullptr) continue;
    crowd.through = path[c]->through;
    if (task_->to.empty()) {
      // The formation goes along with its middle on the path and ends where the path does.
      const Point shift = crowd.through.back() - crowd.rest;
      for (std::size_t p = 0; p < task_->people(); ++p) {
        if (crowd_of_[p] == c) places_[first_place_[p]] = places_[first_place_[p]] + shift;
      }
      crowd.rest = crowd.through.back();
    }
    crowd.through.push_back(crowd.rest);
    for (std::size_t n = 1; n < crowd.through.size(); ++n) {
      const Point from = crowd.through[n - 1];
      const Point to = crowd.through[n];
      const bool last = n + 1 == crowd.through.size();  // the middle of a ring may well be blocked
      if (!last && !floor_->ways().straight(from, to)) {
        return input_error(
            fmt::format("the target's way leads through an obstacle, between {} and {} (lead it around, "
                        "{:g} m away from what is blocked)",
                        at_text(from), at_text(to), floor_->ways().keep_m()));
      }
      crowd.length_m += distance(from, to);
    }
    double slowest_mps = std::numeric_limits<double>::infinity();
    for (std::size_t p = 0; p < task_->people(); ++p) {
      if (crowd_of_[p] == c) slowest_mps = std::min(slowest_mps, task_->speed_mps[p]);
    }
    const double target_mps = crowd.length_m / follow_s();
    if (target_mps > slowest_mps) {
      notes_.push_back(
          fmt::format("a target moves at {:.2f} m/s, and not everybody who follows it can walk more than "
                      "{:.2f} m/s",
                      target_mps, slowest_mps));
    }
  }
  return std::nullopt;
}

std::vector<Point> Landscape::shifts(double at_s) const {
  std::vector<Point> out;
  for (const Lead& crowd : crowds_) {
    const double share = at_s / follow_s();
    if (crowd.through.empty() || share >= 1) {
      out.emplace_back();
      continue;
    }
    double left_m = share * crowd.length_m;
    Point at = crowd.through.front();
    for (std::size_t n = 1; n < crowd.through.size(); ++n) {
      const double piece_m = distance(crowd.through[n - 1], crowd.through[n]);
      if (left_m <= piece_m) {
        if (piece_m > 0) at = crowd.through[n - 1] + left_m / piece_m * (crowd.through[n] - crowd.through[n - 1]);
        break;
      }
      left_m -= piece_m;
      at = crowd.through[n];
    }
    out.push_back(at - crowd.rest);
  }
  return out;
}

void Landscape::lay_fields() {
  if (!passages_) return;
  field_s_ = std::max(kField_s, follow_s() / kMostFields);
  fields_.resize(crowds_.size());
  std::vector<std::uint32_t> part(crowds_.size(), 0);
  for (std::size_t p = 0; p < task_->people(); ++p) part[crowd_of_[p]] = passages_->part(task_->from[p]);
  for (std::size_t c = 0; c < crowds_.size(); ++c) {
    const auto count = crowds_[c].through.empty() ? 1 : static_cast<std::size_t>(follow_s() / field_s_) + 2;
    for (std::size_t n = 0; n < count; ++n) {
      const Point shift = count == 1 ? Point{} : shifts(static_cast<double>(n) * field_s_)[c];
      fields_[c].emplace_back(*passages_, passages_->nearest_in(part[c], crowds_[c].rest + shift));
    }
  }
}

double Landscape::still_squared(Point at, double beyond) const {
  if (open_around(at)) return beyond;
  const auto near = floor_->nearest(at, kFarScopes * still_scope_m_);
  if (!near) return beyond;
  return std::min(beyond, near->distance_m * near->distance_m / (still_scope_m_ * still_scope_m_));
}

bool Landscape::step_is_free(Point from, Point to, bool open) const {
  if (!open) return floor_->free_share(from, to) >= 1;
  const Point low = floor_->low();
  const Point high = floor_->high();
  return to.x >= low.x && to.x <= high.x && to.y >= low.y && to.y <= high.y;
}

WayField::Toward Landscape::toward(std::size_t person, Point at, Point target, double at_s) const {
  const Ways& ways = floor_->ways();
  if (ways.straight(at, target)) return {target, 0};
  const auto& fields = fields_[crowd_of_[person]];
  const auto n = std::min(fields.size() - 1, static_cast<std::size_t>(at_s / field_s_));
  const WayField::Toward way = fields[n].toward(at);
  const double pitch_m = ways.grid().pitch_m();
  // Where the crowd's own way ends the place may still be around a corner.
  if (distance(at, way.at) + way.rest_m < distance(at, target) + 2 * pitch_m) {
    const Ways::Step own = ways.toward(at, target, 2 * pitch_m);
    if (own.length_m < std::numeric_limits<double>::infinity()) {
      return {own.at, std::max(0.0, own.length_m - distance(at, own.at))};
    }
  }
  return way;
}

}  // namespace footlight::planner::swarm
