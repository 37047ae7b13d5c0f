// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/cast_tracks.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "core/check.hpp"
#include "planner/schedule/class_match.hpp"

namespace footlight::planner {
namespace {

using Classes = std::vector<std::uint32_t>;

std::vector<std::size_t> bound_stations(const Casting& casting) {
  std::vector<std::size_t> bound;
  for (std::size_t s = 0; s < casting.bindings.size(); ++s) {
    if (casting.bindings[s].binds()) bound.push_back(s);
  }
  return bound;
}

/// Between two stations that bind, the change with most time in it; the later of equals, and none whose people are
/// given by the drawing where there is another.
std::size_t changing_interval(const std::vector<Station>& stations, std::size_t first, std::size_t last) {
  const auto room = [&](std::size_t k) {
    return std::pair(!stations[k + 1].follows, stations[k + 1].arrive - stations[k].depart);
  };
  std::size_t best = first;
  for (std::size_t k = first; k < last; ++k) {
    if (room(k) >= room(best)) best = k;
  }
  return best;
}

class Caster {
 public:
  Caster(const Grid& grid, const std::vector<Station>& stations, const Casting& casting, const PairStations& pair,
         std::vector<std::vector<std::uint32_t>> ready)
      : grid_(grid), stations_(stations), casting_(casting), pair_(pair), people_(stations.front().cells.size()) {
    tracks_.pairing = std::move(ready);
    tracks_.pairing.resize(stations.size() - 1);
    for (const std::size_t k : changing_intervals(stations, casting)) tracks_.pairing[k].clear();
  }

  CastTracks run() {
    so_far_.assign(people_, 0);
    Classes label(people_, 0);  // of each place, at the last binding
    const std::vector<std::size_t> bound = bound_stations(casting_);
    for (std::size_t n = 0; n < bound.size(); ++n) {
      const Binding& binding = casting_.bindings[bound[n]];
      Classes asked = n == 0 ? with_open_places(stations_[bound[0]], binding) : binding.place;
      Classes came(people_, 0);
      if (n > 0) came = change(bound[n - 1], bound[n], label, asked);
      Refinement refined;
      for (std::size_t p = 0; p < people_; ++p) so_far_[p] = refined.of(so_far_[p], binding.person[p]);
      for (std::size_t i = 0; i < people_; ++i) label[i] = refined.of(came[i], asked[i]);
    }
    for (std::size_t k = 0; k < tracks_.pairing.size(); ++k) pair_freely(k);
    name(bound.empty() ? 0 : bound.back(), label);
    return std::move(tracks_);
  }

 private:
  void pair_freely(std::size_t k) {
    if (tracks_.pairing[k].empty()) tracks_.pairing[k] = pair_(stations_[k], stations_[k + 1]);
  }

  /// Of the first station that binds: whoever is left takes the open places, each class near its own.
  [[nodiscard]] Classes with_open_places(const Station& station, const Binding& binding) const {
    Classes place = binding.place;
    const Classes nobody;
    settle_open_places({&grid_, {}, {}, station.cells, nobody, binding.person}, place);
    return place;
  }

  /// Pairs everything between two stations that bind. @param label class of each place of the first so far
  /// @param asked in and out: of the places of the last; open ones become of whoever comes
  /// @return for each place of the last the class so far of who comes
  Classes change(std::size_t first, std::size_t last, Classes label, Classes& asked) {
    const std::size_t at = changing_interval(stations_, first, last);
    for (std::size_t k = first; k < last; ++k) {
      if (k != at) pair_freely(k);
    }
    for (std::size_t k = first; k < at; ++k) label = forward(k, label);
    Classes wanted = asked;
    for (std::size_t k = last; k-- > at + 1;) wanted = backward(k, wanted);
    const ClassMatchTask task{&grid_, stations_[at].cells, label, stations_[at + 1].cells, so_far_, person_of(last)};
    settle_open_places(task, wanted);
    if (stations_[at + 1].follows && agree(label, wanted, last)) {
      pair_freely(at);
    } else {
      tracks_.pairing[at] = match_classes(task, wanted, [&](const ClassLot& lot) { return pair_lot(at, lot); });
    }
    label = forward(at, label);
    for (std::size_t k = at + 1; k < last; ++k) {
      label = forward(k, label);
      wanted = forward(k, wanted);
    }
    asked = std::move(wanted);
    return label;
  }

  /// Whether everybody can stay on the track that she follows: as many tracks lead from each class to each class as
  /// there are such performers.
  [[nodiscard]] bool agree(const Classes& label, const Classes& wanted, std::size_t last) const {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::int64_t> left;
    for (std::size_t i = 0; i < people_; ++i) {
      ++left[{label[i], wanted[i]}];
      --left[{so_far_[i], person_of(last)[i]}];
    }
    return std::all_of(left.begin(), left.end(), [](const auto& one) { return one.second == 0; });
  }

  [[nodiscard]] const Classes& person_of(std::size_t station) const { return casting_.bindings[station].person; }

  [[nodiscard]] Classes forward(std::size_t k, const Classes& of) const {
    Classes out(of.size());
    for (std::size_t i = 0; i < of.size(); ++i) out[tracks_.pairing[k][i]] = of[i];
    return out;
  }
  [[nodiscard]] Classes backward(std::size_t k, const Classes& of) const {
    Classes out(of.size());
    for (std::size_t i = 0; i < of.size(); ++i) out[i] = of[tracks_.pairing[k][i]];
    return out;
  }

  [[nodiscard]] std::vector<std::uint32_t> pair_lot(std::size_t k, const ClassLot& lot) const {
    const auto part = [](const Station& whole, const std::vector<std::uint32_t>& places) {
      Station out = whole;
      out.cells.clear();
      out.pinned = out.follows = false;
      for (const std::uint32_t place : places) out.cells.push_back(whole.cells[place]);
      return out;
    };
    if (lot.from.size() == 1) return {0};
    return pair_(part(stations_[k], lot.from), part(stations_[k + 1], lot.to));
  }

  /// Performers of one class are numbered as their places in the opening form.
  void name(std::size_t last, Classes label) {
    for (std::size_t k = last; k-- > 0;) label = backward(k, label);
    std::vector<std::uint32_t> places(people_);
    std::iota(places.begin(), places.end(), 0U);
    std::vector<std::uint32_t> performers = places;
    std::stable_sort(places.begin(), places.end(), [&](auto a, auto b) { return label[a] < label[b]; });
    std::stable_sort(performers.begin(), performers.end(), [&](auto a, auto b) { return so_far_[a] < so_far_[b]; });
    tracks_.who.assign(stations_.size(), Classes(people_));
    for (std::size_t i = 0; i < people_; ++i) {
      FL_CHECK(label[places[i]] == so_far_[performers[i]]);
      tracks_.who[0][places[i]] = performers[i];
    }
    for (std::size_t k = 0; k + 1 < stations_.size(); ++k) tracks_.who[k + 1] = forward(k, tracks_.who[k]);
  }

  const Grid& grid_;
  const std::vector<Station>& stations_;
  const Casting& casting_;
  const PairStations& pair_;
  std::size_t people_;
  Classes so_far_;  ///< class of each performer by all bindings so far
  CastTracks tracks_;
};

/// Numbers 0, 1, 2 ... in the order in which the classes come, and how many are in each.
std::vector<std::uint32_t> sizes(const Classes& of) {
  std::vector<std::uint32_t> out;
  for (const std::uint32_t one : of) {
    if (one >= out.size()) out.resize(one + 1, 0);
    ++out[one];
  }
  return out;
}

}  // namespace

std::vector<std::size_t> changing_intervals(const std::vector<Station>& stations, const Casting& casting) {
  const std::vector<std::size_t> bound = bound_stations(casting);
  std::vector<std::size_t> out;
  for (std::size_t n = 1; n < bound.size(); ++n) out.push_back(changing_interval(stations, bound[n - 1], bound[n]));
  return out;
}

CastTracks cast_tracks(const Grid& grid, const std::vector<Station>& stations, const Casting& casting,
                       const PairStations& pair, std::vector<std::vector<std::uint32_t>> ready) {
  return Caster(grid, stations, casting, pair, std::move(ready)).run();
}

std::vector<std::vector<std::uint32_t>> exchange_kinds(const Casting& casting, std::size_t people,
                                                       std::size_t stations) {
  const std::size_t intervals = stations - 1;
  std::vector<std::vector<std::uint32_t>> kinds(intervals);
  if (casting.free()) return kinds;
  Refinement first;
  Classes start(people, 0);
  for (std::size_t p = 0; p < people && !casting.kind.empty(); ++p) start[p] = first.of(0, casting.kind[p]);
  const auto refine = [&](Classes& classes, std::size_t station) {
    if (station >= casting.bindings.size() || !casting.bindings[station].binds()) return;
    Refinement refined;
    for (std::size_t p = 0; p < people; ++p) {
      classes[p] = refined.of(classes[p], casting.bindings[station].person[p]);
    }
  };
  std::vector<Classes> later(intervals);  // by the stations after each interval
  Classes classes = start;
  for (std::size_t k = intervals; k-- > 0;) {
    refine(classes, k + 1);
    later[k] = classes;
  }
  classes = start;
  for (std::size_t k = 0; k < intervals; ++k) {
    refine(classes, k);
    const std::vector<std::uint32_t> before = sizes(classes);
    const std::vector<std::uint32_t> after = sizes(later[k]);
    Refinement numbers;
    kinds[k].resize(people);
    for (std::size_t p = 0; p < people; ++p) {
      const bool by_past = before[classes[p]] >= after[later[k][p]];
      kinds[k][p] = numbers.of(by_past ? 0 : 1, by_past ? classes[p] : later[k][p]);
    }
    if (std::count(kinds[k].begin(), kinds[k].end(), 0U) == static_cast<std::ptrdiff_t>(people)) kinds[k].clear();
  }
  return kinds;
}

NamedTracks name_tracks(const Casting& casting, const std::vector<std::vector<std::uint32_t>>& who,
                        const std::vector<TrackPlaces>& visited, std::size_t people) {
  NamedTracks named;
  named.first_place.resize(people);
  std::iota(named.first_place.begin(), named.first_place.end(), 0U);
  named.alike.assign(people, 0);
  if (casting.free()) return named;
  Refinement of_kind;
  for (std::size_t p = 0; p < people && !casting.kind.empty(); ++p) named.alike[p] = of_kind.of(0, casting.kind[p]);
  Classes track(people, 0);
  for (std::size_t i = 0; i < people; ++i) track[i] = named.alike[who[0][i]];
  for (const TrackPlaces& here : visited) {
    const Classes& person = casting.bindings[here.station].person;
    Refinement refined;
    for (std::size_t p = 0; p < people; ++p) named.alike[p] = refined.of(named.alike[p], person[p]);
    for (std::size_t i = 0; i < people; ++i) track[i] = refined.of(track[i], person[who[here.station][here.place[i]]]);
  }
  Classes performers = named.first_place;
  Classes tracks = named.first_place;
  std::stable_sort(performers.begin(), performers.end(),
                   [&](auto a, auto b) { return named.alike[a] < named.alike[b]; });
  std::stable_sort(tracks.begin(), tracks.end(), [&](auto a, auto b) { return track[a] < track[b]; });
  for (std::size_t n = 0; n < people; ++n) {
    FL_CHECK(named.alike[performers[n]] == track[tracks[n]]);
    named.first_place[performers[n]] = tracks[n];
  }
  return named;
}

}  // namespace footlight::planner
