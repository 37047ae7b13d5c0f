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
  per_bin_m_ = 1 / bin_m;
  columns_ = static_cast<std::size_t>(bins(high.x - low_.x));
  rows_ = static_cast<std::size_t>(bins(high.y - low_.y));
  // Two bins ahead: while people are put into theirs, the one ahead counts up to its end, which is the next one's
  // start.
  start_.assign(columns_ * rows_ + 2, 0);
  bin_of_.resize(people.size());
  for (std::size_t i = 0; i < people.size(); ++i) {
    const std::size_t own = bin(people[i].y - low_.y, rows_) * columns_ + bin(people[i].x - low_.x, columns_);
    bin_of_[i] = static_cast<std::uint32_t>(own);
    ++start_[own + 2];
  }
  for (std::size_t b = 2; b < start_.size(); ++b) start_[b] += start_[b - 1];
  who_.resize(people.size());
  where_.resize(people.size());
  for (std::size_t i = 0; i < people.size(); ++i) {
    const std::uint32_t k = start_[bin_of_[i] + 1]++;
    who_[k] = static_cast<std::uint32_t>(i);
    where_[k] = people[i];
  }
}

}  // namespace footlight::planner
