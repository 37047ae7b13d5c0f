// SPDX-License-Identifier: Apache-2.0
#include "planner/judge/blocked.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace footlight::planner::judge {

BlockedFloor::BlockedFloor(const Stage& stage) {
  const Grid& grid = stage.grid;
  for (const CellIndex cell : stage.blocked) {
    if (static_cast<int>(cell.value()) >= grid.size()) continue;
    Outline outline{cell, grid.outline(cell), {}};
    for (const Point corner : outline.corners) outline.box.add(corner);
    all_.add({outline.box.x0, outline.box.y0});
    all_.add({outline.box.x1, outline.box.y1});
    cells_.push_back(std::move(outline));
  }
  if (cells_.empty()) return;
  std::sort(cells_.begin(), cells_.end(), [](const Outline& a, const Outline& b) { return a.cell < b.cell; });
  tile_m_ = 2 * grid.pitch_m();
  columns_ = static_cast<int>((all_.x1 - all_.x0) / tile_m_) + 1;
  rows_ = static_cast<int>((all_.y1 - all_.y0) / tile_m_) + 1;
  tiles_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (std::uint32_t i = 0; i < cells_.size(); ++i) {
    const Box& box = cells_[i].box;
    for (int y = row(box.y0); y <= row(box.y1); ++y) {
      for (int x = column(box.x0); x <= column(box.x1); ++x) {
        tiles_[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x)]
            .push_back(i);
      }
    }
  }
}

int BlockedFloor::column(double x) const {
  return static_cast<int>(std::clamp(std::floor((x - all_.x0) / tile_m_), 0.0, columns_ - 1.0));
}
int BlockedFloor::row(double y) const {
  return static_cast<int>(std::clamp(std::floor((y - all_.y0) / tile_m_), 0.0, rows_ - 1.0));
}

bool BlockedFloor::contains(CellIndex cell) const {
  const auto at = std::lower_bound(cells_.begin(), cells_.end(), cell,
                                   [](const Outline& outline, CellIndex c) { return outline.cell < c; });
  return at != cells_.end() && at->cell == cell;
}

std::vector<BlockedFloor::Hit> BlockedFloor::nearer_than(Point a, Point b, double limit_m) const {
  Box way;
  way.add(a);
  way.add(b);
  way.grow(limit_m);
  if (empty() || !overlap(way, all_)) return {};
  std::vector<std::uint32_t> candidates;
  for (int y = row(way.y0); y <= row(way.y1); ++y) {
    for (int x = column(way.x0); x <= column(way.x1); ++x) {
      for (const std::uint32_t i :
           tiles_[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x)]) {
        if (overlap(way, cells_[i].box)) candidates.push_back(i);
      }
    }
  }
  std::sort(candidates.begin(), candidates.end());
  candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
  std::vector<Hit> out;
  for (const std::uint32_t i : candidates) {
    const double distance_m = segment_to_polygon_m(a, b, cells_[i].corners);
    if (distance_m < limit_m) out.push_back({cells_[i].cell, distance_m});
  }
  return out;
}

}  // namespace footlight::planner::judge
