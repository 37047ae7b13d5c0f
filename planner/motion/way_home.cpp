// SPDX-License-Identifier: Apache-2.0
#include "planner/motion/way_home.hpp"

#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace footlight::planner {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();
/// Lengths that are kept at the same time: 256 MiB.
constexpr std::size_t kMostKept = 64U << 20U;

}  // namespace

WayHome::WayHome(const Ways& ways, std::span<const CellIndex> to) : ways_(ways), to_(to), length_m_(to.size()) {}

double WayHome::length_m(std::uint32_t person, CellIndex from) {
  if (steps_.empty()) find_steps();
  std::vector<float>& own = length_m_[person];
  if (own.empty()) {
    if (kept_ > kMostKept) {
      for (auto& other : length_m_) other = {};
      kept_ = 0;
    }
    own = flood(to_[person]);
    kept_ += own.size();
  }
  return static_cast<double>(own[from.at()]);
}

void WayHome::find_steps() {
  const Grid& grid = ways_.grid();
  const double reach_m = (grid.kind() == GridKind::square ? 1.5 : 1.8) * grid.pitch_m();
  steps_.resize(static_cast<std::size_t>(grid.size()));
  for (std::size_t c = 0; c < steps_.size(); ++c) {
    const CellIndex cell = CellIndex::of(c);
    if (!ways_.can_stand(cell)) continue;
    const Point here = grid.centre(cell);
    for (const CellIndex near : grid.within(here, reach_m)) {
      if (near == cell || !ways_.can_stand(near) || !ways_.straight(here, grid.centre(near))) continue;
      steps_[c].push_back({near, static_cast<float>(distance(here, grid.centre(near)))});
    }
  }
}

std::vector<float> WayHome::flood(CellIndex to) const {
  std::vector<float> length_m(steps_.size(), kFar);
  using Entry = std::pair<float, CellIndex>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  length_m[to.at()] = 0;
  open.emplace(0.0F, to);
  while (!open.empty()) {
    const auto [here_m, cell] = open.top();
    open.pop();
    if (here_m > length_m[cell.at()]) continue;
    for (const Step& step : steps_[cell.at()]) {
      const float next_m = here_m + step.length_m;
      if (next_m >= length_m[step.to.at()]) continue;
      length_m[step.to.at()] = next_m;
      open.emplace(next_m, step.to);
    }
  }
  return length_m;
}

}  // namespace footlight::planner
