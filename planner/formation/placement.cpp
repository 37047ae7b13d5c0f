// SPDX-License-Identifier: Apache-2.0
#include "planner/formation/placement.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "planner/formation/cell_shares.hpp"

namespace footlight::planner {
namespace {

/// Columns and rows of cells, both ends included.
struct CellBlock {
  int column0 = 0;
  int row0 = 0;
  int column1 = -1;
  int row1 = -1;
  [[nodiscard]] int size() const { return (column1 - column0 + 1) * (row1 - row0 + 1); }
};

/// Largest block under a row of column heights whose last row is `row` (histogram stack).
CellBlock largest_under(const std::vector<int>& height, int row) {
  CellBlock best;
  std::vector<int> open;  // columns of increasing height
  const int columns = static_cast<int>(height.size());
  for (int column = 0; column <= columns; ++column) {
    const int here = column < columns ? height[static_cast<std::size_t>(column)] : 0;
    while (!open.empty() && height[static_cast<std::size_t>(open.back())] >= here) {
      const int tall = height[static_cast<std::size_t>(open.back())];
      open.pop_back();
      const CellBlock block{open.empty() ? 0 : open.back() + 1, row - tall + 1, column - 1, row};
      if (tall > 0 && block.size() > best.size()) best = block;
    }
    open.push_back(column);
  }
  return best;
}

Box metres(const Grid& grid, const CellBlock& block) {
  Box box{1e300, 1e300, -1e300, -1e300};
  const auto widen = [&](Cell cell) {
    for (const Point p : grid.outline(grid.index(cell))) {
      box = {std::min(box.x0, p.x), std::min(box.y0, p.y), std::max(box.x1, p.x), std::max(box.y1, p.y)};
    }
  };
  for (int row : {block.row0, std::min(block.row0 + 1, block.row1), block.row1}) {
    for (int column : {block.column0, std::min(block.column0 + 1, block.column1), block.column1}) {
      widen({column, row});
    }
  }
  return box;
}

/// Scale (pixels a metre), picture's middle in the frame and on the floor -> map.
StageToFrame map_of(double scale, Point frame_middle, Point floor_middle) {
  return {scale, 0, frame_middle.x - scale * floor_middle.x, 0, -scale, frame_middle.y + scale * floor_middle.y};
}

double usable_cells(const std::vector<double>& shares, const CellFlags& usable) {
  double sum = 0;
  for (std::size_t i = 0; i < shares.size(); ++i) sum += usable[i] != 0 ? shares[i] : 0.0;
  return sum;
}

/// Eq. 6 with the sharpness of the drawing (picture area of the best NUM cells) to decide among equals; smaller is
/// better.
struct Misfit {
  double count = 0;
  double blur = 0;
  friend auto operator<=>(const Misfit&, const Misfit&) = default;
};

Misfit misfit(const std::vector<double>& shares, const CellFlags& usable, int people) {
  std::vector<std::int32_t> missing;  // millionths, so that the order of adding does not matter
  int above = 0;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    if (shares[i] <= 0 || usable[i] == 0) continue;
    missing.push_back(static_cast<std::int32_t>(std::lround((1 - shares[i]) * 1e6)));
    above += shares[i] > 0.5 ? 1 : 0;
  }
  const std::size_t count = std::min(missing.size(), static_cast<std::size_t>(people));
  const auto end = missing.begin() + static_cast<std::ptrdiff_t>(count);
  if (end != missing.end()) std::nth_element(missing.begin(), end, missing.end());
  const auto sum = std::accumulate(missing.begin(), end, std::int64_t{0});
  return {static_cast<double>(std::abs(above - people)), static_cast<double>(sum) / 1e6 - static_cast<double>(count)};
}

Point descend_offset(const PlacementTask& task, double scale, Point frame_middle, Point floor_middle) {
  const double pitch = task.stage->grid.pitch_m();
  const auto trial = [&](Point offset) {
    const StageToFrame map = map_of(scale, frame_middle, floor_middle + pitch * offset);
    return misfit(cell_shares(*task.largest, task.stage->grid, map), *task.usable, task.people);
  };
  Point best{};
  Misfit least = trial(best);
  for (double step = 0.25; step > 0.03;) {
    Point next = best;
    Misfit next_misfit = least;
    for (int direction = 0; direction < 9; ++direction) {
      const Point at{best.x + step * (direction % 3 - 1), best.y + step * (direction / 3 - 1)};
      if (std::abs(at.x) > 0.5 || std::abs(at.y) > 0.5 || direction == 4) continue;
      const Misfit here = trial(at);
      if (here < next_misfit) {
        next_misfit = here;
        next = at;
      }
    }
    if (next == best) {
      step /= 2;
    } else {
      best = next;
      least = next_misfit;
    }
  }
  return best;
}

}  // namespace

Box picture_floor(const Stage& stage) {
  const Grid& grid = stage.grid;
  std::vector<int> height(static_cast<std::size_t>(grid.columns()), 0);
  CellBlock best;
  auto reserve = stage.reserve.begin();
  for (int row = 0; row < grid.rows(); ++row) {
    for (int column = 0; column < grid.columns(); ++column) {
      const bool taken = reserve != stage.reserve.end() && *reserve == grid.index({column, row});
      if (taken) ++reserve;
      int& here = height[static_cast<std::size_t>(column)];
      here = taken ? 0 : here + 1;
    }
    const CellBlock block = largest_under(height, row);
    if (block.size() > best.size()) best = block;
  }
  if (best.size() <= 0) best = {0, 0, grid.columns() - 1, grid.rows() - 1};
  return metres(grid, best);
}

std::optional<Box> picture_extent(const std::vector<const Mask*>& masks) {
  int left = 1 << 30;
  int right = -1;
  int top = 1 << 30;
  int bottom = -1;
  for (const Mask* mask : masks) {
    const int row_words = mask->row_words();
    for (int i = 0; i < row_words * mask->height(); ++i) {
      const std::uint64_t word = mask->words()[static_cast<std::size_t>(i)];
      if (word == 0) continue;
      const int x = i % row_words * 64;
      left = std::min(left, x + std::countr_zero(word));
      right = std::max(right, x + 63 - std::countl_zero(word));
      top = std::min(top, i / row_words);
      bottom = std::max(bottom, i / row_words);
    }
  }
  if (right < 0) return std::nullopt;
  return Box{double(left), double(top), double(right + 1), double(bottom + 1)};
}

Placement place_picture(const PlacementTask& task) {
  const Box floor = picture_floor(*task.stage);
  const Point floor_middle{(floor.x0 + floor.x1) / 2, (floor.y0 + floor.y1) / 2};
  const double frame_w = task.largest->width();
  const double frame_h = task.largest->height();
  const double contain = std::max(frame_w / floor.width(), frame_h / floor.height());
  const double cover = std::min(frame_w / floor.width(), frame_h / floor.height());
  const auto picture_px = static_cast<double>(picture_area(*task.largest));
  double scale = task.fit == Fit::cover ? cover : contain;
  Placement placement;
  Point frame_middle{frame_w / 2, frame_h / 2};
  if (task.fit == Fit::area && picture_px > 0) {
    frame_middle = {(task.extent.x0 + task.extent.x1) / 2, (task.extent.y0 + task.extent.y1) / 2};
    const double smallest =  // pixels a metre at which the extent just fits on the floor
        std::max(task.extent.width() / floor.width(), task.extent.height() / floor.height());
    const double wanted = std::sqrt(picture_px / (task.people * task.stage->grid.cell_area_m2()));
    scale = wanted;
    // What blocked cells take away is made up by a larger picture; a few rounds are enough.
    for (int round = 0; round < 6 && scale > smallest; ++round) {
      const auto shares = cell_shares(*task.largest, task.stage->grid, map_of(scale, frame_middle, floor_middle));
      const double filled = usable_cells(shares, *task.usable) / task.people;
      if (filled <= 0 || std::abs(filled - 1) < 0.002) break;
      scale *= std::sqrt(filled);
    }
    if (scale < smallest) {
      placement.drawn_share = wanted / smallest;
      scale = smallest;
    }
    placement.drawn_share = std::min(placement.drawn_share, 1.0);
  }
  const Point offset = descend_offset(task, scale, frame_middle, floor_middle);
  placement.map = map_of(scale, frame_middle, floor_middle + task.stage->grid.pitch_m() * offset);
  return placement;
}

}  // namespace footlight::planner
