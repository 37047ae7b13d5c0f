// SPDX-License-Identifier: Apache-2.0
#include "planner/srd/congestion.hpp"

#include <algorithm>
#include <cmath>

#include "core/check.hpp"

namespace footlight::planner::srd {

Congestion::Congestion(Point low, Point high, double side_m) : low_(low), side_m_(side_m) {
  FL_CHECK(side_m > 0);
  columns_ = static_cast<int>((high.x - low.x) / side_m) + 1;
  rows_ = static_cast<int>((high.y - low.y) / side_m) + 1;
  value_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), kEmpty);
}

int Congestion::column(double x) const {
  return std::clamp(static_cast<int>(std::floor((x - low_.x) / side_m_)), 0, columns_ - 1);
}

int Congestion::row(double y) const {
  return std::clamp(static_cast<int>(std::floor((y - low_.y) / side_m_)), 0, rows_ - 1);
}

void Congestion::fill(std::span<const Point> at, std::span<const std::int32_t> group) {
  std::fill(value_.begin(), value_.end(), kEmpty);
  for (std::size_t i = 0; i < at.size(); ++i) {
    std::int32_t& value = value_[index(column(at[i].x), row(at[i].y))];
    if (value == kEmpty) {
      value = group[i];
    } else if (value != group[i]) {
      value = kMixed;
    }
  }
}

void Congestion::add(const MotionFloor::Disc& disc) {
  const Point reach{disc.radius_m, disc.radius_m};
  const Point first = disc.centre - reach;
  const Point last = disc.centre + reach;
  for (int y = row(first.y); y <= row(last.y); ++y) {
    for (int x = column(first.x); x <= column(last.x); ++x) {
      const Point corner = low_ + side_m_ * Point{double(x), double(y)};
      const Point nearest{std::clamp(disc.centre.x, corner.x, corner.x + side_m_),
                          std::clamp(disc.centre.y, corner.y, corner.y + side_m_)};
      if (distance(nearest, disc.centre) <= disc.radius_m) value_[index(x, y)] = kMixed;
    }
  }
}

bool Congestion::meets_others(Point at, std::int32_t group) const {
  const double half_m = side_m_ / 2;
  for (int y = row(at.y - half_m); y <= row(at.y + half_m); ++y) {
    for (int x = column(at.x - half_m); x <= column(at.x + half_m); ++x) {
      const std::int32_t there = value_[index(x, y)];
      if (there != kEmpty && there != group) return true;
    }
  }
  return false;
}

}  // namespace footlight::planner::srd
