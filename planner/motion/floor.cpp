// SPDX-License-Identifier: Apache-2.0
#include "planner/motion/floor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "planner/segment.hpp"

namespace footlight::planner {
namespace {

/// A sweep that comes so close to what it must keep off has arrived.
constexpr double kTouch_m = 1e-6;

}  // namespace

MotionFloor::MotionFloor(const Ways& ways, std::vector<MovingObstacle> moving, const TempoMap& tempo, Instant start,
                         const Terrain* terrain)
    : ways_(&ways), blocked_(static_cast<std::size_t>(ways.grid().size()), 0), terrain_(terrain) {
  const Grid& grid = ways.grid();
  low_ = high_ = terrain_low_ = terrain_high_ = grid.centre(CellIndex(0));
  const auto widen = [](Point& low, Point& high, Point at) {
    low = {std::min(low.x, at.x), std::min(low.y, at.y)};
    high = {std::max(high.x, at.x), std::max(high.y, at.y)};
  };
  for (int i = 0; i < grid.size(); ++i) {
    widen(low_, high_, grid.centre(CellIndex::of(i)));
    if (terrain_ == nullptr) continue;
    for (const Point corner : grid.outline(CellIndex::of(i))) widen(terrain_low_, terrain_high_, corner);
  }
  for (const CellIndex cell : ways.blocked()) blocked_[cell.at()] = 1;
  for (const MovingObstacle& one : moving) {
    Moving& out = moving_.emplace_back();
    out.radius_m = one.radius_m;
    for (const MovingObstacle::At& at : one.at) {
      out.at_s.push_back(to_seconds(tempo.at(at.count) - start));
      out.centre.push_back(at.centre);
    }
  }
}

std::optional<MotionFloor::Nearest> MotionFloor::nearest(Point from, double radius_m) const {
  if (ways_->open()) return std::nullopt;
  const Grid& grid = ways_->grid();
  Nearest best{{}, std::numeric_limits<double>::infinity()};
  for (const CellIndex cell : grid.within(from, radius_m + ways_->cell_radius_m())) {
    if (blocked_[cell.at()] == 0) continue;
    const std::vector<Point> outline = grid.outline(cell);
    bool inside = true;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Point a = outline[i];
      const Point b = outline[(i + 1) % outline.size()];
      inside = inside && cross(b - a, from - a) >= 0;
      const Point at = nearest_on(from, a, b);
      const double away_m = distance(from, at);
      if (away_m < best.distance_m) best = {at, away_m};
    }
    if (inside) return Nearest{from, 0};
  }
  if (best.distance_m > radius_m) return std::nullopt;
  return best;
}

double MotionFloor::free_share(Point from, Point to) const {
  const double whole_m = distance(from, to);
  if (whole_m <= 0) return 1;
  double share = 1;
  const auto stay_within = [&](double start, double end, double low, double high) {
    if (end > high && end > start) share = std::min(share, std::max(0.0, (high - start) / (end - start)));
    if (end < low && end < start) share = std::min(share, std::max(0.0, (low - start) / (end - start)));
  };
  stay_within(from.x, to.x, low_.x, high_.x);
  stay_within(from.y, to.y, low_.y, high_.y);
  if (ways_->open()) return share;
  // Sphere tracing: as far as nothing can be in the way, again and again.
  const double keep_m = ways_->keep_m();
  const double look_m = keep_m + std::max(1.0, ways_->grid().pitch_m());
  double walked = 0;
  while (walked < share) {
    const Point here = from + walked * (to - from);
    const auto near = nearest(here, look_m);
    const double free_m = (near ? near->distance_m : look_m) - keep_m;
    if (free_m < kTouch_m) {
      // Away from what is too near already is free.
      if (near && dot(to - from, here - near->at) > 0) {
        walked += std::max(kTouch_m, free_m) / whole_m;
        continue;
      }
      return std::min(share, walked);
    }
    walked += free_m / whole_m;
  }
  return share;
}

std::vector<MotionFloor::Disc> MotionFloor::discs(double at_s) const {
  std::vector<Disc> out;
  for (const Moving& one : moving_) {
    const auto after = std::upper_bound(one.at_s.begin(), one.at_s.end(), at_s);
    if (after == one.at_s.begin()) {
      out.push_back({one.centre.front(), {}, one.radius_m});
    } else if (after == one.at_s.end()) {
      out.push_back({one.centre.back(), {}, one.radius_m});
    } else {
      const auto n = static_cast<std::size_t>(after - one.at_s.begin());
      const double span_s = one.at_s[n] - one.at_s[n - 1];
      const Point velocity = 1 / span_s * (one.centre[n] - one.centre[n - 1]);
      out.push_back({one.centre[n - 1] + (at_s - one.at_s[n - 1]) * velocity, velocity, one.radius_m});
    }
  }
  return out;
}

}  // namespace footlight::planner
