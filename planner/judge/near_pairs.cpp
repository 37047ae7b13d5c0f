// SPDX-License-Identifier: Apache-2.0
#include "planner/judge/near_pairs.hpp"

#include <cmath>
#include <cstddef>

namespace footlight::planner::judge {

void NearPairs::lay_tiles(std::span<const Box> boxes) {
  Box all;
  double sides_m = 0;
  std::size_t count = 0;
  for (const Box& box : boxes) {
    if (!(box.x0 <= box.x1)) continue;
    all.add({box.x0, box.y0});
    all.add({box.x1, box.y1});
    sides_m += (box.x1 - box.x0) + (box.y1 - box.y0);
    ++count;
  }
  columns_ = rows_ = 1;
  left_m_ = all.x0;
  bottom_m_ = all.y0;
  tiles_per_m_ = 1;
  if (count > 0) {
    // Tiles as wide as a box on average; never many more tiles than boxes.
    const double area_m2 = (all.x1 - all.x0) * (all.y1 - all.y0);
    const double side_m =
        std::max({sides_m / (2.0 * static_cast<double>(count)), std::sqrt(area_m2 / (4.0 * static_cast<double>(count))),
                  (all.x1 - all.x0) / 4096, (all.y1 - all.y0) / 4096, 1e-6});
    tiles_per_m_ = 1 / side_m;
    columns_ = static_cast<int>((all.x1 - all.x0) * tiles_per_m_) + 1;
    rows_ = static_cast<int>((all.y1 - all.y0) * tiles_per_m_) + 1;
  }
  ranges_.clear();
  for (const Box& box : boxes) {
    if (!(box.x0 <= box.x1)) {
      ranges_.push_back({0, 0, -1, -1});
      continue;
    }
    const auto column = [&](double x) {
      return std::min(columns_ - 1, static_cast<int>((x - left_m_) * tiles_per_m_));
    };
    const auto row = [&](double y) { return std::min(rows_ - 1, static_cast<int>((y - bottom_m_) * tiles_per_m_)); };
    ranges_.push_back({column(box.x0), row(box.y0), column(box.x1), row(box.y1)});
  }
}

void NearPairs::fill_tiles() {
  first_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
  const auto tile = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x);
  };
  for (const Range& r : ranges_) {
    for (int y = r.y0; y <= r.y1; ++y) {
      for (int x = r.x0; x <= r.x1; ++x) ++first_[tile(x, y) + 1];
    }
  }
  for (std::size_t t = 1; t < first_.size(); ++t) first_[t] += first_[t - 1];
  members_.resize(first_.back());
  // Filled from the back, so that afterwards first_[t] is where tile t begins.
  for (std::size_t t = first_.size() - 1; t > 0; --t) first_[t] = first_[t - 1];
  for (std::uint32_t i = 0; i < ranges_.size(); ++i) {
    const Range& r = ranges_[i];
    for (int y = r.y0; y <= r.y1; ++y) {
      for (int x = r.x0; x <= r.x1; ++x) members_[first_[tile(x, y) + 1]++] = i;
    }
  }
}

std::span<const NearPairs::Pair> NearPairs::find(std::span<const Box> boxes) {
  lay_tiles(boxes);
  fill_tiles();
  pairs_.clear();
  std::size_t tile = 0;
  for (int y = 0; y < rows_; ++y) {
    for (int x = 0; x < columns_; ++x, ++tile) {
      for (std::size_t k = first_[tile]; k < first_[tile + 1]; ++k) {
        const std::uint32_t i = members_[k];
        for (std::size_t l = k + 1; l < first_[tile + 1]; ++l) {
          const std::uint32_t j = members_[l];
          if (!overlap(boxes[i], boxes[j])) continue;
          // Boxes share several tiles: the pair belongs to the one with the lower left corner of the common part.
          if (std::max(ranges_[i].x0, ranges_[j].x0) != x || std::max(ranges_[i].y0, ranges_[j].y0) != y) continue;
          pairs_.emplace_back(i, j);
        }
      }
    }
  }
  return pairs_;
}

}  // namespace footlight::planner::judge
