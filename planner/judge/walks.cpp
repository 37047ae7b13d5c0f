// SPDX-License-Identifier: Apache-2.0
#include "planner/judge/walks.hpp"

#include <algorithm>
#include <utility>

namespace footlight::planner::judge {
namespace {

bool same_times(const std::vector<Stand>& a, const std::vector<Stand>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Stand& x, const Stand& y) { return x.time == y.time; });
}

}  // namespace

Walks::Walks(const Plan& plan) {
  tracks_.reserve(plan.tracks.size());
  for (const std::vector<Mark>& marks : plan.tracks) add_track(plan.stage.grid, marks);
  gather_times();
}

Walks::Walks(const Plan& plan, Instant from, Instant to) {
  const auto earlier = [](const Mark& a, const Mark& b) { return a.time < b.time; };
  tracks_.reserve(plan.tracks.size());
  for (const std::vector<Mark>& marks : plan.tracks) {
    std::span<const Mark> needed(marks);
    auto first = std::upper_bound(marks.begin(), marks.end(), Mark{from, {}}, earlier);
    auto last = std::lower_bound(marks.begin(), marks.end(), Mark{to, {}}, earlier);
    if (first != marks.begin()) --first;
    if (last != marks.end()) ++last;
    if (first < last && std::is_sorted(first, last, earlier)) {
      needed = needed.subspan(static_cast<std::size_t>(first - marks.begin()), static_cast<std::size_t>(last - first));
    }
    add_track(plan.stage.grid, needed);
  }
  gather_times();
}

void Walks::add_track(const Grid& grid, std::span<const Mark> marks) {
  std::vector<Stand> track;
  track.reserve(marks.size());
  for (const Mark& mark : marks) {
    if (static_cast<int>(mark.cell.value()) < grid.size())
      track.push_back({mark.time, mark.cell, grid.centre(mark.cell)});
  }
  const auto earlier = [](const Stand& a, const Stand& b) { return a.time < b.time; };
  if (!std::is_sorted(track.begin(), track.end(), earlier)) std::stable_sort(track.begin(), track.end(), earlier);
  track.erase(std::unique(track.begin(), track.end(), [](const Stand& a, const Stand& b) { return a.time == b.time; }),
              track.end());
  tracks_.push_back(std::move(track));
}

void Walks::gather_times() {
  // Most people share all their instants: neighbours with equal times are counted together.
  std::vector<std::pair<Instant, std::uint32_t>> counted;
  for (std::size_t i = 0; i < tracks_.size();) {
    std::size_t next = i + 1;
    while (next < tracks_.size() && same_times(tracks_[i], tracks_[next])) ++next;
    for (const Stand& stand : tracks_[i]) counted.emplace_back(stand.time, static_cast<std::uint32_t>(next - i));
    i = next;
  }
  std::sort(counted.begin(), counted.end());
  for (const auto& [time, people] : counted) {
    if (times_.empty() || times_.back() != time) {
      times_.push_back(time);
      marks_at_.push_back(0);
    }
    marks_at_.back() += people;
  }
}

std::size_t Walks::stand_before(std::uint32_t person, Instant time) const {
  const std::vector<Stand>& track = tracks_[person];
  const auto after =
      std::upper_bound(track.begin(), track.end(), time, [](Instant t, const Stand& stand) { return t < stand.time; });
  return after == track.begin() ? 0 : static_cast<std::size_t>(after - track.begin()) - 1;
}

Point Walks::position(std::uint32_t person, std::size_t before, Instant time) const {
  const std::vector<Stand>& track = tracks_[person];
  const Stand& from = track[before];
  if (time <= from.time || before + 1 == track.size()) return from.at;
  const Stand& to = track[before + 1];
  const double share = to_seconds(time - from.time) / to_seconds(to.time - from.time);
  return from.at + share * (to.at - from.at);
}

}  // namespace footlight::planner::judge
