// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/slabs.hpp"

namespace footlight::planner {

Slabs::Slabs(const Grid& grid, std::span<const double> at, const std::vector<std::vector<Knot>>& paths, double keep_m,
             double late_share, double fastest_m)
    : at_(at), paths_(paths), keep_m_(keep_m), late_share_(late_share), fastest_m_(fastest_m), slabs_(at.size() - 1) {
  const Point first = grid.centre(CellIndex(0));
  const Point last = grid.centre(CellIndex::of(grid.size() - 1));
  low_ = {first.x - grid.pitch_m(), first.y - grid.pitch_m()};
  side_m_ = 2 * grid.pitch_m();
  columns_ = static_cast<int>((last.x + grid.pitch_m() - low_.x) / side_m_) + 1;
  rows_ = static_cast<int>((last.y + grid.pitch_m() - low_.y) / side_m_) + 1;
}

void Slabs::fill(std::size_t slab) {
  if (!slabs_[slab].empty()) return;
  slabs_[slab].resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (std::uint32_t i = 0; i < paths_.size(); ++i) put(slab, i, paths_[i]);
}

void Slabs::put(std::size_t slab, std::uint32_t person, std::span<const Knot> path) {
  const double first = at_[slab] - late_share_;
  const double last = at_[slab + 1] + late_share_;
  double speed_m = 0;
  for (std::size_t k = 0; k + 1 < path.size(); ++k) {
    if (path[k + 1].at < first || path[k].at > last) continue;
    speed_m = std::max(speed_m, distance(path[k].point, path[k + 1].point) / (path[k + 1].at - path[k].at));
  }
  const Point at = in_the_middle_of(slab, path);
  slabs_[slab][bucket(at)].push_back({person, at, speed_m * moving_share(slab)});
}

Point Slabs::in_the_middle_of(std::size_t slab, std::span<const Knot> path) const {
  const double middle = (at_[slab] + at_[slab + 1]) / 2;
  std::size_t k = 0;
  while (k + 2 < path.size() && path[k + 1].at < middle) ++k;
  const double share = (middle - path[k].at) / (path[k + 1].at - path[k].at);
  return path[k].point + share * (path[k + 1].point - path[k].point);
}

std::vector<std::uint32_t> Slabs::near(std::span<const Knot> path) {
  std::vector<std::uint32_t> people;
  for (std::size_t slab = 0; slab < slabs_.size(); ++slab) {
    visit_near(slab, in_the_middle_of(slab, path), fastest_m_, [&](std::uint32_t one) { people.push_back(one); });
  }
  std::sort(people.begin(), people.end());
  people.erase(std::unique(people.begin(), people.end()), people.end());
  return people;
}

void Slabs::remove(std::uint32_t person, std::span<const Knot> path) {
  for (std::size_t slab = 0; slab < slabs_.size(); ++slab) {
    if (slabs_[slab].empty()) continue;
    auto& here = slabs_[slab][bucket(in_the_middle_of(slab, path))];
    std::erase_if(here, [&](const Entry& entry) { return entry.person == person; });
  }
}

void Slabs::add(std::uint32_t person, std::span<const Knot> path) {
  for (std::size_t slab = 0; slab < slabs_.size(); ++slab) {
    if (!slabs_[slab].empty()) put(slab, person, path);
  }
}

}  // namespace footlight::planner
