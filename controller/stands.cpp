// SPDX-License-Identifier: Apache-2.0
#include "controller/stands.hpp"

#include <algorithm>

#include "core/check.hpp"

namespace footlight::controller {

Stands::Stands(const Plan& plan) {
  const auto merge = [&] {
    std::ranges::sort(walking_, {}, &Walking::begins);
    std::size_t kept = 0;
    for (const Walking& walk : walking_) {
      if (kept > 0 && walk.begins < walking_[kept - 1].ends) {
        walking_[kept - 1].ends = std::max(walking_[kept - 1].ends, walk.ends);
        walking_[kept - 1].shortest = std::min(walking_[kept - 1].shortest, walk.shortest);
      } else {
        walking_[kept++] = walk;
      }
    }
    walking_.resize(kept);
  };
  for (const auto& track : plan.tracks) {
    for (std::size_t m = 0; m + 1 < track.size(); ++m) {
      if (track[m].cell == track[m + 1].cell) continue;
      walking_.push_back({track[m].time, track[m + 1].time, track[m + 1].time - track[m].time});
    }
    if (walking_.size() > 4'000'000) merge();
  }
  merge();
}

Instant Stands::from(Instant position, bool waits) const noexcept {
  const auto next = std::ranges::upper_bound(walking_, position, {}, &Walking::ends);
  if (next == walking_.end() || position < next->begins || (waits && position == next->begins)) return position;
  return next->ends;
}

std::optional<Stands::Rest> Stands::rest(Instant stand) const noexcept {
  const auto next = std::ranges::lower_bound(walking_, stand, {}, &Walking::begins);
  if (next == walking_.end()) return std::nullopt;
  return Rest{next->begins - stand, next->shortest};
}

Instant Stands::until(Instant position) const noexcept {
  const auto next = std::ranges::upper_bound(walking_, position, {}, &Walking::ends);
  return next == walking_.end() || position <= next->begins ? position : next->begins;
}

std::vector<CellIndex> cells_at(const Plan& plan, Instant stand) {
  std::vector<CellIndex> cells;
  for (const auto& track : plan.tracks) {
    const auto after = std::ranges::upper_bound(track, stand, {}, &Mark::time);
    FL_CHECK(after != track.begin());
    const Mark& mark = *std::prev(after);
    FL_CHECK(mark.time == stand || after == track.end() || after->cell == mark.cell);
    cells.push_back(mark.cell);
  }
  return cells;
}

}  // namespace footlight::controller
