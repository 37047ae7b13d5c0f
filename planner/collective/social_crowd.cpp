// SPDX-License-Identifier: Apache-2.0
#include "planner/collective/social_crowd.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "core/check.hpp"
#include "core/rng.hpp"

namespace footlight::planner::collective {
namespace {

/// Forces are cut off where they have fallen to exp(-this) of what they are where two touch.
constexpr double kCutOff = 3.5;
/// What is wanted in less time than this would be a jerk, reaction times.
constexpr double kLeastTime = 1;

template <class Work>
void for_each_person(std::size_t people, Work work) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, people, 64), [&](const auto& range) {
    for (std::size_t p = range.begin(); p != range.end(); ++p) work(p);
  });
}

/// Anywhere in a disc of radius `most`, evenly: xi of Eq. 7.
Point fluctuation(Rng rng, double most) {
  const double turn = 2 * std::numbers::pi * rng.uniform();
  const double size = most * std::sqrt(rng.uniform());
  return {size * std::cos(turn), size * std::sin(turn)};
}

}  // namespace

SocialCrowd::SocialCrowd(const MotionTask& task, const CollectiveOptions& options, const TimedWays& ways,
                         std::vector<std::uint32_t> subgroup)
    : task_(task),
      options_(options),
      ways_(ways),
      subgroup_(std::move(subgroup)),
      repulsion_{options.repulsion_mps2, options.repulsion_range_m},
      separation_{options.separation_mps2, options.group_range_m},
      cohesion_{options.cohesion_mps2, options.group_range_m} {
  FL_CHECK(subgroup_.empty() || subgroup_.size() == task.people());
  for (const std::uint32_t one : subgroup_) subgroups_ = std::max(subgroups_, one + 1);
  double widest_m = 0;
  double fastest_mps = 0;
  for (std::size_t p = 0; p < task.people(); ++p) {
    widest_m = std::max(widest_m, task.radius_m[p]);
    fastest_mps = std::max(fastest_mps, task.speed_mps[p]);
  }
  classes_ = {task.floor->low(), options.bin_m, options.sectors, fastest_mps};
  const double range_m = subgroup_.empty() ? repulsion_.range_m : std::max(repulsion_.range_m, separation_.range_m);
  look_m_ = 2 * widest_m + kCutOff * range_m;
  const Grid& grid = task.floor->ways().grid();
  near_blocked_.assign(static_cast<std::size_t>(grid.size()), 0);
  const double felt_m = widest_m + kCutOff * repulsion_.range_m + task.floor->ways().keep_m() + 2 * grid.pitch_m();
  for (const CellIndex blocked : task.floor->ways().blocked()) {
    for (const CellIndex cell : grid.within(grid.centre(blocked), felt_m)) near_blocked_[cell.at()] = 1;
  }
}

SocialCrowd::State SocialCrowd::begin() const {
  State state;
  state.position = task_.from;
  state.velocity.assign(task_.people(), {});
  state.next_corner.assign(task_.people(), 1);
  return state;
}

/// The end of a leg is passed when it is time, a corner on the way when the one after it can be walked to; who is
/// pushed back behind one goes around it again.
std::uint32_t SocialCrowd::corner_of(const State& now, std::size_t person, double at_s) const {
  const auto way = ways_.of(person);
  const Point here = now.position[person];
  const auto can_walk = [&](std::uint32_t corner) { return task_.floor->ways().straight(here, way[corner].at); };
  std::uint32_t corner = now.next_corner[person];
  while (corner + 1 < way.size() && (way[corner].timed ? at_s >= way[corner].at_s : can_walk(corner + 1))) ++corner;
  while (corner > 1 && !way[corner - 1].timed && !can_walk(corner)) --corner;
  return corner;
}

SocialCrowd::Wishes SocialCrowd::wishes(const State& next, const std::vector<Point>& position, double at_s) const {
  Wishes out{std::vector<Point>(position.size()), std::vector<double>(position.size())};
  for_each_person(position.size(), [&](std::size_t p) {
    const TimedWays::Corner& corner = ways_.of(p)[next.next_corner[p]];
    const Point way = corner.at - position[p];
    const double left_s = corner.timed ? corner.at_s - at_s : corner.end_s - at_s;
    const double left_m = length(way) + (corner.timed ? 0 : corner.left_m);
    out.heading[p] = unit(way);
    out.speed_mps[p] = std::min(task_.speed_mps[p], left_m / std::max(left_s, kLeastTime * options_.reaction_s));
  });
  return out;
}

void SocialCrowd::feed_back(const State& now, const PlaceInformation& information, Wishes& wishes) const {
  if (!options_.feedback || information.moving == 0) return;
  struct Bin {
    Point heading;
    double speed_mps = 0;
    double people = 0;
  };
  const Point span = task_.floor->high() - task_.floor->low();
  const std::size_t columns = std::size_t{classes_.bin(span.x)} + 1;
  std::vector<Bin> bins(columns * (std::size_t{classes_.bin(span.y)} + 1));
  std::vector<std::size_t> bin_of(now.position.size());
  for (std::size_t p = 0; p < bin_of.size(); ++p) {
    const Point at = now.position[p] - classes_.low;
    bin_of[p] = std::min(bins.size() - 1, classes_.bin(at.y) * columns + classes_.bin(at.x));
    Bin& bin = bins[bin_of[p]];
    bin.heading = bin.heading + wishes.heading[p];
    bin.speed_mps += wishes.speed_mps[p];
    ++bin.people;
  }
  for_each_person(bin_of.size(), [&](std::size_t p) {
    const Bin& bin = bins[bin_of[p]];
    if (bin.people < 2) return;
    const double others = bin.people - 1;
    const Point heading = wishes.heading[p];
    const double speed = wishes.speed_mps[p];
    wishes.heading[p] = fed_back_heading(heading, 1 / others * (bin.heading - heading), information.direction_bits);
    wishes.speed_mps[p] = std::clamp(fed_back_speed(speed, (bin.speed_mps - speed) / others, information.speed_bits),
                                     0.0, task_.speed_mps[p]);
  });
}

SocialCrowd::Pushes SocialCrowd::pushes(const State& now) const {
  const std::size_t people = now.position.size();
  Pushes out{std::vector<Point>(people), std::vector<Point>(people)};
  Neighbours near;
  near.sort(now.position, look_m_);
  for_each_person(people, [&](std::size_t p) {
    const Point here = now.position[p];
    near.visit(here, look_m_, [&](std::uint32_t other, double squared) {
      if (other == p || squared == 0) return;
      const double touch_m = task_.radius_m[p] + task_.radius_m[other];
      const double room_m = std::sqrt(squared) - touch_m;
      const bool stranger = !subgroup_.empty() && subgroup_[p] != subgroup_[other];
      Point& sum = stranger ? out.strangers[p] : out.own[p];
      if (room_m < kCutOff * repulsion_.range_m) {
        sum = sum + repulse_force(here, now.position[other], touch_m, repulsion_);
      }
      if (stranger && room_m < kCutOff * separation_.range_m) {
        sum = sum + repulse_force(here, now.position[other], touch_m, separation_);
      }
    });
  });
  return out;
}

/// A sub-group takes part of what strangers do to its people as one.
void SocialCrowd::share_pushes(Pushes& pushes) const {
  if (subgroup_.empty() || options_.rigidity <= 0) return;
  std::vector<Point> mean(subgroups_);
  std::vector<double> people(subgroups_, 0);
  for (std::size_t p = 0; p < subgroup_.size(); ++p) {
    mean[subgroup_[p]] = mean[subgroup_[p]] + pushes.strangers[p];
    ++people[subgroup_[p]];
  }
  for (std::size_t p = 0; p < subgroup_.size(); ++p) {
    const std::uint32_t one = subgroup_[p];
    pushes.strangers[p] = (1 - options_.rigidity) * pushes.strangers[p] + options_.rigidity / people[one] * mean[one];
  }
}

/// From each person to where the rest of her sub-group has her place: how far they all are from their ideal places on
/// average, less how far she is.
std::vector<Point> SocialCrowd::missing(const State& now, double at_s) const {
  std::vector<Point> off(now.position.size());
  for_each_person(off.size(), [&](std::size_t p) { off[p] = now.position[p] - ways_.place(p, at_s); });
  std::vector<Point> sum(subgroups_);
  std::vector<double> people(subgroups_, 0);
  for (std::size_t p = 0; p < off.size(); ++p) {
    sum[subgroup_[p]] = sum[subgroup_[p]] + off[p];
    ++people[subgroup_[p]];
  }
  for (std::size_t p = 0; p < off.size(); ++p) off[p] = 1 / people[subgroup_[p]] * sum[subgroup_[p]] - off[p];
  return off;
}

Point SocialCrowd::obstacles(std::size_t person, Point at, const std::vector<MotionFloor::Disc>& discs) const {
  Point sum;
  const double radius_m = task_.radius_m[person];
  if (near_blocked_[task_.floor->ways().grid().nearest(at).at()] != 0) {
    const auto near = task_.floor->nearest(at, radius_m + kCutOff * repulsion_.range_m);
    if (near) sum = sum + obstacle_force(at, near->at, radius_m, repulsion_);
  }
  for (const MotionFloor::Disc& disc : discs) {
    const Point away = at - disc.centre;
    const double room_m = length(away) - disc.radius_m - radius_m;
    if (room_m > kCutOff * repulsion_.range_m) continue;
    sum = sum + obstacle_force(at, disc.centre + disc.radius_m * unit(away), radius_m, repulsion_);
  }
  return sum;
}

/// A step, swept: along what is in the way as far as it is free, out of discs that came.
Point SocialCrowd::moved(std::size_t person, Point from, Point by, const std::vector<MotionFloor::Disc>& discs) const {
  const MotionFloor& floor = *task_.floor;
  const Grid& grid = floor.ways().grid();
  const auto inside = [&](Point p) {
    return Point{std::clamp(p.x, floor.low().x, floor.high().x), std::clamp(p.y, floor.low().y, floor.high().y)};
  };
  Point to = inside(from + by);
  for (const MotionFloor::Disc& disc : discs) {
    const double keep_m = disc.radius_m + task_.radius_m[person];
    if (distance(to, disc.centre) >= keep_m) continue;
    const Point away = to == disc.centre ? Point{1, 0} : unit(to - disc.centre);
    to = inside(disc.centre + keep_m * away);
  }
  const bool free = length(to - from) < grid.pitch_m() && near_blocked_[grid.nearest(from).at()] == 0;
  if (free) return to;
  const double share = floor.free_share(from, to);
  const Point here = from + share * (to - from);
  if (share >= 1) return here;
  const auto near = floor.nearest(here, floor.ways().keep_m() + grid.pitch_m());
  if (!near || near->distance_m <= 0) return here;
  const Point normal = unit(here - near->at);
  const Point left = to - here;
  const Point along = left - dot(left, normal) * normal;
  return here + floor.free_share(here, here + along) * along;
}

void SocialCrowd::step(const State& now, State& next) const {
  const double at_s = step_s() * static_cast<double>(now.tick);
  for_each_person(now.position.size(), [&](std::size_t p) { next.next_corner[p] = corner_of(now, p, at_s); });
  Wishes wanted = wishes(next, now.position, at_s);
  if (options_.feedback) {
    next.information = place_information(now.position, now.velocity, classes_);
    feed_back(now, next.information, wanted);
  }
  Pushes pushed = pushes(now);
  share_pushes(pushed);
  const std::vector<Point> off = subgroup_.empty() ? std::vector<Point>() : missing(now, at_s);
  const std::vector<MotionFloor::Disc> discs = task_.floor->discs(at_s + step_s());
  const Rng chance(task_.seed);
  for_each_person(now.position.size(), [&](std::size_t p) {
    Point force = drive_force(now.velocity[p], wanted.heading[p], wanted.speed_mps[p], options_.reaction_s) +
                  pushed.own[p] + pushed.strangers[p] + obstacles(p, now.position[p], discs);
    if (!off.empty()) force = force + cohesion_force(off[p], cohesion_);
    if (options_.fluctuation_mps2 > 0) {
      force = force + fluctuation(chance.split(p).split(now.tick), options_.fluctuation_mps2);
    }
    Point velocity = now.velocity[p] + step_s() * force;
    const double fast = length(velocity) / task_.speed_mps[p];
    if (fast > 1) velocity = 1 / fast * velocity;
    next.position[p] = moved(p, now.position[p], step_s() * velocity, discs);
    next.velocity[p] = 1 / step_s() * (next.position[p] - now.position[p]);
  });
}

}  // namespace footlight::planner::collective
