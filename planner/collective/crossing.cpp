// SPDX-License-Identifier: Apache-2.0
#include "planner/collective/crossing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "planner/collective/social_force.hpp"
#include "planner/motion/neighbours.hpp"

namespace footlight::planner::collective {
namespace {

constexpr double kSample_s = 0.25;
/// Formations that come no nearer than this many rooms of a person do not meet.
constexpr double kRooms = 1.5;
/// Longest shift, of the two together.
constexpr double kMostRooms = 4;
/// Shifts that are tried to each side.
constexpr int kSteps = 64;
/// Steps aside are taken at this share of the slowest person's speed, beside the way itself.
constexpr double kSideSpeed = 0.35;

using People = std::vector<std::uint32_t>;

double least_gap(std::span<const double> first, std::span<const double> second, double shift) {
  // Both ascending: the nearest of `second` moves up with `first`.
  double least = std::numeric_limits<double>::infinity();
  std::size_t k = 0;
  for (const double a : first) {
    const double at = a + shift;
    while (k + 1 < second.size() && std::abs(second[k + 1] - at) <= std::abs(second[k] - at)) ++k;
    least = std::min(least, std::abs(second[k] - at));
  }
  return least;
}

/// Least distance of anybody of one to anybody of the other; more than `look_m`: infinity.
double nearest(const TimedWays& ways, const People& first, const People& second, double at_s, double look_m) {
  std::vector<Point> there;
  for (const std::uint32_t p : second) there.push_back(ways.place(p, at_s));
  Neighbours near;
  near.sort(there, look_m);
  double least = std::numeric_limits<double>::infinity();
  for (const std::uint32_t p : first) {
    near.visit(ways.place(p, at_s), look_m,
               [&](std::uint32_t, double squared) { least = std::min(least, std::sqrt(squared)); });
  }
  return least;
}

Point mean_velocity(const TimedWays& ways, const People& who, double at_s) {
  Point sum;
  for (const std::uint32_t p : who) sum = sum + (ways.place(p, at_s + kSample_s) - ways.place(p, at_s - kSample_s));
  return 1 / (2 * kSample_s * static_cast<double>(who.size())) * sum;
}

std::vector<double> across(const TimedWays& ways, const People& who, double at_s, Point normal) {
  std::vector<double> out;
  for (const std::uint32_t p : who) out.push_back(dot(ways.place(p, at_s), normal));
  std::sort(out.begin(), out.end());
  return out;
}

/// When the two are in each other, and how near they come then.
std::optional<Crossing> meeting(const MotionTask& task, const TimedWays& ways, const People& first,
                                const People& second, double room_m) {
  Crossing out;
  out.before_m = std::numeric_limits<double>::infinity();
  bool met = false;
  for (double at_s = kSample_s; at_s < task.duration_s() - kSample_s; at_s += kSample_s) {
    const double least = nearest(ways, first, second, at_s, kRooms * room_m);
    if (!std::isfinite(least)) continue;
    if (!met) out.from_s = at_s - kSample_s;
    met = true;
    out.until_s = at_s + kSample_s;
    out.before_m = std::min(out.before_m, least);
  }
  return met ? std::optional(out) : std::nullopt;
}

struct Limits {
  double room_m = 0;  ///< of the widest person
  double slowest_mps = std::numeric_limits<double>::infinity();
};

/// Nothing: the two do not meet, or go the same way at the same speed.
std::optional<Crossing> pass(const MotionTask& task, const People& first, const People& second, const Limits& limits,
                             TimedWays& ways) {
  auto crossing = meeting(task, ways, first, second, limits.room_m);
  if (!crossing) return std::nullopt;
  const double middle_s = (crossing->from_s + crossing->until_s) / 2;
  const Point passing = unit(mean_velocity(ways, first, middle_s) - mean_velocity(ways, second, middle_s));
  if (squared_length(passing) == 0) return std::nullopt;
  const Point normal{-passing.y, passing.x};
  const double shift = widest_shift(across(ways, first, middle_s, normal), across(ways, second, middle_s, normal),
                                    kMostRooms * limits.room_m);
  crossing->aside = shift / 2 * normal;
  if (shift != 0) {
    const double lead_s = std::max(1.0, std::abs(shift) / 2 / (kSideSpeed * limits.slowest_mps));
    ways.step_aside(first, {crossing->aside, crossing->from_s, crossing->until_s, lead_s}, *task.floor);
    ways.step_aside(second, {-1.0 * crossing->aside, crossing->from_s, crossing->until_s, lead_s}, *task.floor);
  }
  const auto after = meeting(task, ways, first, second, limits.room_m);
  crossing->after_m = after ? after->before_m : kRooms * limits.room_m;
  return crossing;
}

}  // namespace

double widest_shift(std::span<const double> first, std::span<const double> second, double most_m) {
  std::vector<double> a(first.begin(), first.end());
  std::vector<double> b(second.begin(), second.end());
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  double best = 0;
  double widest = least_gap(a, b, 0);
  for (int k = 1; k <= kSteps; ++k) {
    for (const double shift : {k * most_m / kSteps, -k * most_m / kSteps}) {
      const double gap = least_gap(a, b, shift);
      if (gap <= widest + 1e-9) continue;
      widest = gap;
      best = shift;
    }
  }
  return best;
}

std::vector<Crossing> pass_between(const MotionTask& task, TimedWays& ways) {
  std::map<std::uint32_t, People> groups;
  Limits limits;
  for (std::uint32_t p = 0; p < task.people(); ++p) {
    groups[task.group[p]].push_back(p);
    limits.room_m = std::max(limits.room_m, 2 * task.radius_m[p]);
    limits.slowest_mps = std::min(limits.slowest_mps, task.speed_mps[p]);
  }
  std::vector<Crossing> out;
  for (auto one = groups.begin(); one != groups.end(); ++one) {
    for (auto two = std::next(one); two != groups.end(); ++two) {
      if (one->second.size() < 2 || two->second.size() < 2) continue;
      auto crossing = pass(task, one->second, two->second, limits, ways);
      if (!crossing) continue;
      crossing->first = one->first;
      crossing->second = two->first;
      out.push_back(*crossing);
    }
  }
  return out;
}

}  // namespace footlight::planner::collective
