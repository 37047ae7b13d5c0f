// SPDX-License-Identifier: Apache-2.0
#include "app/edit/walk_changes.hpp"

#include <algorithm>
#include <span>
#include <unordered_map>

#include <fmt/format.h>

#include "app/natural_order.hpp"

namespace footlight::app {
namespace {

constexpr double kSamePlace_m = 1e-9;

bool same(const Grid& before, const Mark& a, const Grid& now, const Mark& b) {
  return a.time == b.time && distance(before.centre(a.cell), now.centre(b.cell)) < kSamePlace_m;
}

/// Marks in [start, end].
std::span<const Mark> marks_in(const std::vector<Mark>& track, Instant start, Instant end) {
  const auto first = std::ranges::lower_bound(track, start, {}, &Mark::time);
  const auto last = std::ranges::upper_bound(track, end, {}, &Mark::time);
  return {first, std::max(first, last)};
}

}  // namespace

std::string WalkChanges::text() const {
  return fmt::format("{} {}, {} {}", transitions, transitions == 1 ? "transition" : "transitions", people.size(),
                     people.size() == 1 ? "person" : "people");
}

WalkChanges walk_changes(const Plan& before, const Plan& now) {
  WalkChanges out;
  std::unordered_map<std::string, std::size_t> known;
  for (std::size_t p = 0; p < before.performers.size(); ++p) known.emplace(before.performers[p], p);
  std::vector<bool> changed(now.transitions.size(), false);
  const Grid& old_grid = before.stage.grid;
  const Grid& grid = now.stage.grid;
  for (std::size_t p = 0; p < now.performers.size(); ++p) {
    const auto was = known.find(now.performers[p]);
    if (was == known.end()) {
      out.people.push_back(now.performers[p]);
      continue;
    }
    const auto& old = before.tracks[was->second];
    const auto& track = now.tracks[p];
    const auto equal = [&](std::span<const Mark> a, std::span<const Mark> b) {
      return std::ranges::equal(a, b, [&](const Mark& x, const Mark& y) { return same(old_grid, x, grid, y); });
    };
    known.erase(was);
    if (equal(old, track)) continue;
    out.people.push_back(now.performers[p]);
    for (std::size_t t = 0; t < changed.size(); ++t) {
      const TransitionFacts& stretch = now.transitions[t];
      const auto moved = [&](Instant at) {
        return distance(position_at(old_grid, old, at), position_at(grid, track, at)) >= kSamePlace_m;
      };
      changed[t] = changed[t] || moved(stretch.start) || moved(stretch.end) ||
                   !equal(marks_in(old, stretch.start, stretch.end), marks_in(track, stretch.start, stretch.end));
    }
  }
  for (const std::string& id : before.performers) {
    if (known.contains(id)) out.left.push_back(id);
  }
  // Whoever is new walks in all of them, unless it is somebody's way that goes on.
  out.transitions = static_cast<std::size_t>(std::ranges::count(changed, true));
  std::ranges::sort(out.people, natural_less);
  return out;
}

}  // namespace footlight::app
