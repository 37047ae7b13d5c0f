// SPDX-License-Identifier: Apache-2.0
#include "planner/motion/neighbours.hpp"

#include <cmath>

#include "core/check.hpp"

namespace footlight::planner {

namespace {
/// More bins for each person than this are never made.
constexpr double kBinsEach = 4;
}  // namespace

void Neighbours::sort(std::span<const Point> people, double bin_m) {
  FL_CHECK(bin_m > 0);
  Point high;
  low_ = high = people.empty() ? Point{} : people.front();
  for (const Point at : people) {
    low_ = {std::min(low_.x, at.x), std::min(low_.y, at.y)};
    high = {std::max(high.x, at.x), std::max(high.y, at.y)};
  }
  const double most = kBinsEach * static_cast<double>(people.size()) + 1;
  const auto bins = [&](double side_m) { return std::floor(side_m / bin_m) + 1; };
  while (bins(high.x - low_.x) * bins(high.y - low_.y) > most) bin_m *= 1.5;
  bin_m_ = bin_m;
  columns_ = static_cast<int>(bins(high.x - low_.x));
  rows_ = static_cast<int>(bins(high.y - low_.y));
  start_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
  bin_of_.resize(people.size());
  for (std::size_t i = 0; i < people.size(); ++i) {
    const int x = bin(people[i].x - low_.x, columns_);
    const int y = bin(people[i].y - low_.y, rows_);
    bin_of_[i] = static_cast<std::uint32_t>(y * columns_ + x);
    ++start_[bin_of_[i] + 1];
  }
  for (std::size_t b = 1; b < start_.size(); ++b) start_[b] += start_[b - 1];
  who_.resize(people.size());
  where_.resize(people.size());
  std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
  for (std::size_t i = 0; i < people.size(); ++i) {
    const std::uint32_t k = next[bin_of_[i]]++;
    who_[k] = static_cast<std::uint32_t>(i);
    where_[k] = people[i];
  }
}

}  // namespace footlight::planner
