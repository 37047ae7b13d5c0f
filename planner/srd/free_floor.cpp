// SPDX-License-Identifier: Apache-2.0
#include "planner/srd/free_floor.hpp"

#include <algorithm>
#include <limits>

#include <tbb/parallel_for.h>

#include "planner/motion/cell_steps.hpp"

namespace footlight::planner::srd {
namespace {

constexpr double kFarthest_m = 6;

}  // namespace

FreeFloor::FreeFloor(const MotionFloor& floor) : floor_(&floor) {
  if (open()) return;
  measure();
  find_places();
  part_ = CellSteps(floor.ways(), floor.ways().around_cell_m()).parts();
}

void FreeFloor::measure() {
  const Grid& grid = floor_->ways().grid();
  const double keep_m = floor_->ways().keep_m();
  free_m_.assign(static_cast<std::size_t>(grid.size()), 0);
  tbb::parallel_for(std::size_t{0}, free_m_.size(), [&](std::size_t i) {
    const auto near = floor_->nearest(grid.centre(CellIndex::of(i)), kFarthest_m);
    free_m_[i] = static_cast<float>(std::max(0.0, (near ? near->distance_m : kFarthest_m) - keep_m));
  });
}

void FreeFloor::find_places() {
  const Ways& ways = floor_->ways();
  const Grid& grid = ways.grid();
  place_.resize(free_m_.size());
  for (std::size_t i = 0; i < place_.size(); ++i) {
    place_[i] = CellIndex::of(i);
    const Point centre = grid.centre(place_[i]);
    for (double radius_m = grid.pitch_m(); !ways.can_stand(place_[i]); radius_m *= 2) {
      double best = std::numeric_limits<double>::infinity();
      for (const CellIndex near : grid.within(centre, radius_m)) {
        const double away = squared_length(grid.centre(near) - centre);
        if (!ways.can_stand(near) || away >= best) continue;
        best = away;
        place_[i] = near;
      }
      if (radius_m > grid.pitch_m() * (grid.columns() + grid.rows())) break;  // nobody can stand anywhere
    }
  }
}

double FreeFloor::free_m(Point at) const {
  if (open()) return std::numeric_limits<double>::infinity();
  const Grid& grid = floor_->ways().grid();
  const CellIndex cell = grid.nearest(at);
  return free_m_[cell.at()] - distance(at, grid.centre(cell));
}

Point FreeFloor::free_place(Point at) const {
  if (free_m(at) >= 0 || floor_->ways().straight(at, at)) return at;
  const Grid& grid = floor_->ways().grid();
  return grid.centre(place_[grid.nearest(at).at()]);
}

bool FreeFloor::sees(Point from, Point to) const {
  return open() || free_m(from) >= distance(from, to) || floor_->ways().straight(from, to);
}

Point FreeFloor::first_corner(Point from, Point to) const {
  if (sees(from, to)) return to;
  const std::vector<Point> way = floor_->ways().way(from, to);
  return way.empty() ? from : way[1];
}

Point FreeFloor::pushed_out(Point at) const {
  if (free_m(at) >= 0) return at;
  const double keep_m = floor_->ways().keep_m();
  const auto near = floor_->nearest(at, keep_m);
  if (!near || near->distance_m >= keep_m || near->distance_m <= 0) return at;
  return near->at + keep_m / near->distance_m * (at - near->at);
}

bool FreeFloor::connected(Point from, Point to) const {
  if (open()) return true;
  const Grid& grid = floor_->ways().grid();
  const std::uint32_t a = part_[place_[grid.nearest(from).at()].at()];
  return a != CellSteps::kNoCell && a == part_[place_[grid.nearest(to).at()].at()];
}

}  // namespace footlight::planner::srd
