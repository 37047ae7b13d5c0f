// SPDX-License-Identifier: Apache-2.0
#include "planner/collective/social_crowd.hpp"

#include <algorithm>
#include <cmath>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include "core/check.hpp"
#include "core/rng.hpp"
#include "planner/collective/pushes.hpp"

namespace footlight::planner::collective {
namespace {

/// What is wanted in less time than this would be a jerk, reaction times.
constexpr double kLeastTime = 1;

/// Who slides along something stays so far off it.
constexpr double kSlideOff_m = 0.005;

/// Calls work(first, last) for chunks of people on all cores. What a chunk does must not depend on another.
template <class Work>
void for_chunks(std::size_t people, Work work) {
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, people, 256), [&](const auto& range) { work(range.begin(), range.end()); },
      tbb::simple_partitioner());
}

template <class Work>
void for_each_person(std::size_t people, Work work) {
  for_chunks(people, [&](std::size_t first, std::size_t last) {
    for (std::size_t p = first; p != last; ++p) work(p);
  });
}

/// Anywhere in a disc of radius `most`, evenly: xi of Eq. 7. The first draw within it of those in its square.
Point fluctuation(Rng rng, double most) {
  for (;;) {
    const Point drawn{2 * rng.uniform() - 1, 2 * rng.uniform() - 1};
    if (squared_length(drawn) <= 1) return most * drawn;
  }
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
  for (const std::uint32_t one : subgroup_) {
    if (one >= subgroup_people_.size()) subgroup_people_.resize(one + 1, 0);
    ++subgroup_people_[one];
  }
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
  if (task.floor->ways().blocked().empty()) return;
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

SocialCrowd::Wish SocialCrowd::wish(std::uint32_t corner, std::size_t person, Point at, double limit_mps,
                                    double at_s) const {
  const TimedWays::Corner& next = ways_.of(person)[corner];
  const Point way = next.at - at;
  const double way_m = std::sqrt(squared_length(way));
  const double left_s = (next.timed ? next.at_s : next.end_s) - at_s;
  const double left_m = way_m + (next.timed ? 0 : next.left_m);
  return {way_m > 0 ? 1 / way_m * way : Point{},
          std::min(limit_mps, left_m / std::max(left_s, kLeastTime * options_.reaction_s))};
}

void SocialCrowd::make_wishes(const State& now, State& next, double at_s, Scratch& scratch) const {
  scratch.wish.resize(now.position.size());
  scratch.classes.resize(options_.feedback ? now.position.size() : 0);
  for_each_person(now.position.size(), [&](std::size_t p) {
    const Point here = now.position[p];
    next.next_corner[p] = corner_of(now, p, at_s);
    scratch.wish[p] = wish(next.next_corner[p], p, here, limit_mps(p, here), at_s);
    if (options_.feedback) scratch.classes[p] = walk_classes(here, now.velocity[p], classes_);
  });
  if (!options_.feedback) return;
  next.information = place_information(scratch.classes);
  feed_back(now, next.information, scratch);
}

void SocialCrowd::feed_back(const State& now, const PlaceInformation& information, Scratch& scratch) const {
  if (information.moving == 0) return;
  struct Bin {
    Wish sum;
    double people = 0;
  };
  const Point span = task_.floor->high() - task_.floor->low();
  const std::size_t columns = std::size_t{classes_.bin(span.x)} + 1;
  std::vector<Bin> bins(columns * (std::size_t{classes_.bin(span.y)} + 1));
  const auto bin_of = [&](std::size_t p) -> Bin& {
    return bins[std::min(bins.size() - 1, scratch.classes[p].up * columns + scratch.classes[p].across)];
  };
  for (std::size_t p = 0; p < now.position.size(); ++p) {
    Bin& bin = bin_of(p);
    bin.sum.heading = bin.sum.heading + scratch.wish[p].heading;
    bin.sum.speed_mps += scratch.wish[p].speed_mps;
    ++bin.people;
  }
  for_each_person(now.position.size(), [&](std::size_t p) {
    const Bin& bin = bin_of(p);
    if (bin.people < 2) return;
    const double others = bin.people - 1;
    Wish& own = scratch.wish[p];
    const Point heading = 1 / others * (bin.sum.heading - own.heading);
    const double speed_mps = (bin.sum.speed_mps - own.speed_mps) / others;
    own.heading = fed_back_heading(own.heading, heading, information.direction_bits);
    own.speed_mps = std::clamp(fed_back_speed(own.speed_mps, speed_mps, information.speed_bits), 0.0,
                               limit_mps(p, now.position[p]));
  });
}

void SocialCrowd::find_pushes(const State& now, Scratch& scratch) const {
  const std::size_t people = now.position.size();
  const Neighbours& near = scratch.near;
  const std::span<const std::uint32_t> order = near.order();
  scratch.own.resize(people);
  scratch.strangers.resize(people);
  scratch.radius_m.resize(people);
  scratch.subgroup.resize(people);
  for_each_person(people, [&](std::size_t k) {
    scratch.radius_m[k] = task_.radius_m[order[k]];
    scratch.subgroup[k] = subgroup_.empty() ? 0 : subgroup_[order[k]];
  });
  const double squared_look = look_m_ * look_m_;
  for_chunks(people, [&](std::size_t first, std::size_t last) {
    Around around;
    for (std::size_t k = first; k < last; ++k) {
      const Point here = near.places()[k];
      std::size_t most = 0;
      near.visit_rows(here, look_m_, [&](std::uint32_t begin, std::uint32_t end) { most += end - begin; });
      around.clear(most);
      near.visit_rows(here, look_m_, [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t other = begin; other < end; ++other) {
          around.add(here - near.places()[other], squared_look, scratch.radius_m[k] + scratch.radius_m[other],
                     scratch.subgroup[k] != scratch.subgroup[other]);
        }
      });
      const Around::Sums sums = around.pushes(repulsion_, separation_);
      scratch.own[order[k]] = sums.own;
      scratch.strangers[order[k]] = sums.strangers;
    }
  });
}

/// A sub-group takes part of what strangers do to its people as one.
void SocialCrowd::share_pushes(Scratch& scratch) const {
  if (subgroup_.empty() || options_.rigidity <= 0) return;
  scratch.sum.assign(subgroup_people_.size(), {});
  for (std::size_t p = 0; p < subgroup_.size(); ++p) {
    scratch.sum[subgroup_[p]] = scratch.sum[subgroup_[p]] + scratch.strangers[p];
  }
  for (std::size_t p = 0; p < subgroup_.size(); ++p) {
    const std::uint32_t one = subgroup_[p];
    scratch.strangers[p] =
        (1 - options_.rigidity) * scratch.strangers[p] + options_.rigidity / subgroup_people_[one] * scratch.sum[one];
  }
}

/// From each person to where the rest of her sub-group has her place: how far they all are from their ideal places on
/// average, less how far she is.
void SocialCrowd::find_missing(const State& now, double at_s, Scratch& scratch) const {
  std::vector<Point>& off = scratch.off;
  off.resize(subgroup_.size());
  if (subgroup_.empty()) return;
  for_each_person(off.size(), [&](std::size_t p) { off[p] = now.position[p] - ways_.place(p, at_s); });
  scratch.sum.assign(subgroup_people_.size(), {});
  for (std::size_t p = 0; p < off.size(); ++p) scratch.sum[subgroup_[p]] = scratch.sum[subgroup_[p]] + off[p];
  for (std::size_t p = 0; p < off.size(); ++p) {
    off[p] = 1 / subgroup_people_[subgroup_[p]] * scratch.sum[subgroup_[p]] - off[p];
  }
}

Point SocialCrowd::obstacles(std::size_t person, Point at, bool near_blocked,
                             const std::vector<MotionFloor::Disc>& discs) const {
  Point sum;
  const double radius_m = task_.radius_m[person];
  if (near_blocked) {
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
Point SocialCrowd::moved(std::size_t person, Point from, Point by, bool near_blocked,
                         const std::vector<MotionFloor::Disc>& discs) const {
  const MotionFloor& floor = *task_.floor;
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
  const double pitch_m = floor.ways().grid().pitch_m();
  if (!near_blocked && (near_blocked_.empty() || squared_length(to - from) < pitch_m * pitch_m)) return to;
  const double share = floor.free_share(from, to);
  const Point here = from + share * (to - from);
  if (share >= 1) return here;
  const auto near = floor.nearest(here, floor.ways().keep_m() + pitch_m);
  if (!near || near->distance_m <= 0) return here;
  const Point normal = unit(here - near->at);
  const Point left = to - here;
  // A little off first: a sweep along something that is touched ends where it begins. No longer than what is left.
  const double left_m = length(left);
  const double off_m = std::min(kSlideOff_m, left_m / 2);
  const Point beside = here + floor.free_share(here, here + off_m * normal) * off_m * normal;
  const double shorter = left_m > 0 ? std::sqrt(1 - off_m / left_m * (off_m / left_m)) : 0;
  const Point along = shorter * (left - dot(left, normal) * normal);
  return beside + floor.free_share(beside, beside + along) * along;
}

void SocialCrowd::step(const State& now, State& next) const {
  const double at_s = step_s() * static_cast<double>(now.tick);
  const auto lent = scratch_.take();
  Scratch& scratch = *lent;
  tbb::parallel_invoke([&] { scratch.near.sort(now.position, look_m_ / 2); },
                       [&] { make_wishes(now, next, at_s, scratch); });
  find_pushes(now, scratch);
  share_pushes(scratch);
  find_missing(now, at_s, scratch);
  const std::vector<MotionFloor::Disc> discs = task_.floor->discs(at_s + step_s());
  const Rng chance(task_.seed);
  for_each_person(now.position.size(), [&](std::size_t p) {
    const Point here = now.position[p];
    const bool blocked = near_blocked(here);
    const Wish& wanted = scratch.wish[p];
    Point force = drive_force(now.velocity[p], wanted.heading, wanted.speed_mps, options_.reaction_s) + scratch.own[p] +
                  scratch.strangers[p];
    if (blocked || !discs.empty()) force = force + obstacles(p, here, blocked, discs);
    if (!subgroup_.empty()) force = force + cohesion_force(scratch.off[p], cohesion_);
    if (options_.fluctuation_mps2 > 0) {
      force = force + fluctuation(chance.split(p).split(now.tick), options_.fluctuation_mps2);
    }
    Point velocity = now.velocity[p] + step_s() * force;
    const double limit = limit_mps(p, here);
    const double squared = squared_length(velocity);
    if (squared > limit * limit) velocity = limit / std::sqrt(squared) * velocity;
    next.position[p] = moved(p, here, step_s() * velocity, blocked, discs);
    next.velocity[p] = 1 / step_s() * (next.position[p] - here);
  });
}

}  // namespace footlight::planner::collective
