// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/ways.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <tuple>
#include <utility>

#include "planner/segment.hpp"

namespace footlight::planner {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr double kRounding_m = 1e-9;

double point_to_segment(Point p, Point a, Point b) { return distance(p, nearest_on(p, a, b)); }

double segment_to_segment(Point a, Point b, Point c, Point d) {
  const double one = cross(b - a, c - a);
  const double two = cross(b - a, d - a);
  const double three = cross(d - c, a - c);
  const double four = cross(d - c, b - c);
  if (((one > 0) != (two > 0)) && ((three > 0) != (four > 0)) && one * two != 0 && three * four != 0) return 0;
  return std::min(std::min(point_to_segment(a, c, d), point_to_segment(b, c, d)),
                  std::min(point_to_segment(c, a, b), point_to_segment(d, a, b)));
}

bool inside(Point p, const std::vector<Point>& outline) {
  for (std::size_t i = 0; i < outline.size(); ++i) {
    if (cross(outline[(i + 1) % outline.size()] - outline[i], p - outline[i]) < 0) return false;
  }
  return true;
}

}  // namespace

Ways::Ways(const Stage& stage, double keep_m)
    : grid_(stage.grid),
      keep_m_(keep_m),
      blocked_cells_(stage.blocked),
      blocked_(static_cast<std::size_t>(stage.grid.size()), 0),
      standable_(static_cast<std::size_t>(stage.grid.size()), 1) {
  for (const CellIndex cell : stage.blocked) blocked_[cell.at()] = 1;
  for (const Point corner : grid_.outline(CellIndex(0))) {
    cell_radius_m_ = std::max(cell_radius_m_, distance(corner, grid_.centre(CellIndex(0))));
  }
  for (const CellIndex cell : stage.blocked) {
    standable_[cell.at()] = 0;
    for (const CellIndex near : grid_.within(grid_.centre(cell), keep_m_ + cell_radius_m_)) {
      const Point centre = grid_.centre(near);
      if (outline_distance(centre, centre, cell) < keep_m_ - kRounding_m) standable_[near.at()] = 0;
    }
  }
}

Ways Ways::beside(const std::vector<SweptDisc>& during, const std::vector<SweptDisc>& after) const {
  Ways out = *this;
  for (const auto* discs : {&during, &after}) {
    for (const SweptDisc& disc : *discs) {
      const double keep_off_m = disc.radius_m + keep_m_;
      const Point middle = 0.5 * (disc.from + disc.to);
      for (const CellIndex cell : grid_.within(middle, distance(disc.from, disc.to) / 2 + keep_off_m)) {
        const double away_m = point_to_segment(grid_.centre(cell), disc.from, disc.to);
        if (away_m < keep_off_m - kRounding_m) out.standable_[cell.at()] = 0;
      }
    }
  }
  out.during_ = during;
  return out;
}

double Ways::outline_distance(Point from, Point to, CellIndex blocked) const {
  const auto outline = grid_.outline(blocked);
  if (inside(from, outline)) return 0;
  double least = kFar;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    least = std::min(least, segment_to_segment(from, to, outline[i], outline[(i + 1) % outline.size()]));
  }
  return least;
}

bool Ways::straight(Point from, Point to) const {
  for (const SweptDisc& disc : during_) {
    if (segment_to_segment(from, to, disc.from, disc.to) < disc.radius_m + keep_m_ - kRounding_m) return false;
  }
  if (blocked_cells_.empty()) return true;
  // Circles along the walk, so that a long walk does not look at a square of its own length.
  const double walk_m = distance(from, to);
  const int pieces = std::max(1, static_cast<int>(std::ceil(walk_m / (2 * grid_.pitch_m()))));
  const double reach = walk_m / pieces / 2 + keep_m_ + cell_radius_m_;
  for (int piece = 0; piece < pieces; ++piece) {
    const Point middle = from + (piece + 0.5) / pieces * (to - from);
    for (const CellIndex cell : grid_.within(middle, reach)) {
      if (blocked_[cell.at()] != 0 && outline_distance(from, to, cell) < keep_m_ - kRounding_m) return false;
    }
  }
  return true;
}

std::vector<Point> Ways::around(Point from, Point to) const {
  const CellIndex start = grid_.nearest(from);
  const CellIndex goal = grid_.nearest(to);
  const std::size_t size = static_cast<std::size_t>(grid_.size());
  std::vector<double> walked(size, kFar);
  std::vector<CellIndex> before(size);
  using Entry = std::tuple<double, double, CellIndex>;  // estimate, walked, cell
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  walked[start.at()] = 0;
  open.emplace(0.0, 0.0, start);
  while (!open.empty()) {
    const auto [estimate, here_m, cell] = open.top();
    open.pop();
    if (cell == goal) break;
    if (here_m > walked[cell.at()]) continue;
    const Point here = grid_.centre(cell);
    for (const CellIndex next : grid_.within(here, around_cell_m())) {
      const Point there = grid_.centre(next);
      const double next_m = here_m + distance(here, there);
      if (!can_stand(next) || next_m >= walked[next.at()] || !straight(here, there)) continue;
      walked[next.at()] = next_m;
      before[next.at()] = cell;
      open.emplace(next_m + distance(there, grid_.centre(goal)), next_m, next);
    }
  }
  std::vector<Point> way;
  if (walked[goal.at()] == kFar) return way;
  way.push_back(to);
  for (CellIndex cell = goal; cell != start; cell = before[cell.at()]) way.push_back(grid_.centre(cell));
  way.push_back(grid_.centre(start));
  way.push_back(from);
  std::reverse(way.begin(), way.end());
  return way;
}

std::vector<Point> Ways::way(Point from, Point to) const {
  if (straight(from, to)) return {from, to};
  return taut(around(from, to));
}

std::vector<Point> Ways::taut(std::vector<Point> way) const {
  std::size_t corners = 0;
  for (std::size_t at = 0; at + 1 < way.size(); ++corners) {
    std::size_t next = way.size() - 1;  // as far as can be seen
    while (next > at + 1 && !straight(way[at], way[next])) --next;
    way[corners + 1] = way[next];
    at = next;
  }
  way.resize(way.empty() ? 0 : corners + 1);
  return way;
}

Ways::Step Ways::toward(Point from, Point to, double walked_m) const {
  const std::vector<Point> corners = way(from, to);
  if (corners.empty()) return {from, kFar};
  Step step{from, 0};
  double left = walked_m;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const double piece = distance(corners[i - 1], corners[i]);
    if (left >= piece) {
      step.at = corners[i];
    } else if (left > 0) {
      step.at = corners[i - 1] + left / piece * (corners[i] - corners[i - 1]);
    }
    left -= piece;
    step.length_m += piece;
  }
  return step;
}

}  // namespace footlight::planner
