// SPDX-License-Identifier: Apache-2.0
#include "planner/stand_in.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "planner/casting.hpp"

namespace footlight::planner {
namespace {

constexpr double kSpeedTolerance = 1e-6;  // as the judge's

Duration on_stage(const Show& show, const std::vector<Mark>& track) {
  const auto waits = [&](const Mark& mark) {
    return std::binary_search(show.stage.reserve.begin(), show.stage.reserve.end(), mark.cell);
  };
  Duration out{};
  for (std::size_t m = 0; m + 1 < track.size(); ++m) {
    if (!waits(track[m]) || !waits(track[m + 1])) out += track[m + 1].time - track[m].time;
  }
  return out;
}

double fastest_mps(const Grid& grid, const std::vector<Mark>& track) {
  double out = 0;
  for (std::size_t m = 0; m + 1 < track.size(); ++m) {
    const double walk_m = distance(grid.centre(track[m].cell), grid.centre(track[m + 1].cell));
    if (walk_m > 0) out = std::max(out, walk_m / to_seconds(track[m + 1].time - track[m].time));
  }
  return out;
}

}  // namespace

std::optional<std::size_t> understudy_of(const Show& show, const Performer& absent) {
  const auto found = std::find_if(show.understudies.begin(), show.understudies.end(),
                                  [&](const Understudy& one) { return one.id == absent.cover; });
  if (!absent.absent || found == show.understudies.end()) return std::nullopt;
  return static_cast<std::size_t>(found - show.understudies.begin());
}

std::vector<StandIn> stand_ins(const Show& show, const std::vector<std::vector<Mark>>& tracks, bool wide_enough) {
  std::vector<StandIn> out;
  const auto& people = show.performers;
  if (std::none_of(people.begin(), people.end(), [](const Performer& one) { return one.absent; })) return out;
  std::vector<Duration> worth;
  std::vector<char> free;  // comes, and stands in for nobody
  for (std::size_t p = 0; p < people.size(); ++p) {
    worth.push_back(on_stage(show, tracks[p]));
    free.push_back(people[p].absent ? 0 : 1);
  }
  const auto covering = [&](const Performer& absent) {
    return std::find_if(people.begin(), people.end(), [&](const Performer& one) { return one.id == absent.cover; });
  };
  for (const Performer& one : people) {
    // Who covers somebody is not taken for somebody else before.
    const auto cover = one.absent && !one.cover.empty() ? covering(one) : people.end();
    if (cover != people.end()) free[static_cast<std::size_t>(cover - people.begin())] = 0;
  }
  const std::vector<char> bound = bound_groups(show);
  const auto own_group = [&](const Performer& one) {
    return one.group && bound[one.group->at()] != 0 ? one.group : std::nullopt;
  };
  for (std::size_t a = 0; a < people.size(); ++a) {
    if (!people[a].absent) continue;
    StandIn& one = out.emplace_back(StandIn{PerformerIndex::of(a), {}, worth[a], {}, tracks[a].size()});
    if (!people[a].cover.empty()) {
      const auto cover = covering(people[a]);
      if (cover != people.end()) {
        one.taker = PerformerIndex::of(cover - people.begin());
        one.given_up = worth[one.taker->at()];
      } else {
        one.understudy = understudy_of(show, people[a]);
      }
      continue;
    }
    const double pace_mps = fastest_mps(show.stage.grid, tracks[a]);
    const auto can_walk = [&](const Performer& who) {
      const bool fast_enough = who.max_speed_mps <= 0 || pace_mps <= who.max_speed_mps * (1 + kSpeedTolerance);
      if (own_group(who) != own_group(people[a])) return false;
      return fast_enough && (wide_enough || who.radius_m <= people[a].radius_m);
    };
    Duration least = worth[a];
    for (std::size_t p = 0; p < people.size(); ++p) {
      if (free[p] == 0 || worth[p] >= least || !can_walk(people[p])) continue;
      least = worth[p];
      one.taker = PerformerIndex::of(p);
    }
    if (!one.taker) continue;
    one.given_up = least;
    free[one.taker->at()] = 0;
  }
  return out;
}

std::string stand_in_text(const Show& show, const StandIn& stand_in) {
  const std::string absent = fmt::format("performer {} is absent: ", show.performers[stand_in.absent.at()].id);
  if (stand_in.understudy) {
    return fmt::format("{}{} covers the whole way; nobody else changes", absent,
                       show.understudies[*stand_in.understudy].id);
  }
  if (stand_in.on_stage == Duration{} && !stand_in.taker)
    return absent + "nobody has to stand in, since the way never leaves the reserve";
  if (!stand_in.taker) {
    return absent + "the place stays empty, since nobody who is on stage for less time is free and can walk the way";
  }
  std::string text = fmt::format("{}performer {} takes the way; 1 of {} people changes, {} marks", absent,
                                 show.performers[stand_in.taker->at()].id, show.performers.size(), stand_in.marks);
  if (stand_in.given_up > Duration{}) {
    text += fmt::format("; the taker's own place, {:.1f} s on stage instead of {:.1f} s, stays empty",
                        to_seconds(stand_in.given_up), to_seconds(stand_in.on_stage));
  }
  return text;
}

}  // namespace footlight::planner
