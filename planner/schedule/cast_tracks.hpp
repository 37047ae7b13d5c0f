// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "planner/plan_section.hpp"

namespace footlight::planner {

/// A place of whoever is left, of any class.
inline constexpr std::uint32_t kOpenPlace = std::numeric_limits<std::uint32_t>::max();

/// Whom a formation asks for on which place: people of one class are as good as each other there.
struct Binding {
  std::vector<std::uint32_t> person;  ///< class of each performer; empty: anybody may stand anywhere
  /// Class of each place of the station, or kOpenPlace; of no class more places than people.
  std::vector<std::uint32_t> place;

  [[nodiscard]] bool binds() const { return !person.empty(); }
};

/// Who may take whose place in a show.
struct Casting {
  std::vector<std::uint32_t> kind;  ///< of each performer, from the first formation to the last; empty: one for all
  std::vector<Binding> bindings;    ///< one for each station; empty: nothing is bound

  /// Of each performer, who then is of one kind with people of the same radius alone; empty: two keep the clearance.
  std::vector<double> radius_m;

  [[nodiscard]] bool free() const { return kind.empty() && bindings.empty(); }
};

/// The places of two neighbouring stations that are matched with each other: position in `to` for each of `from`.
using PairStations = std::function<std::vector<std::uint32_t>(const Station& from, const Station& to)>;

/// Everybody's way through the formations as drawn.
struct CastTracks {
  std::vector<std::vector<std::uint32_t>> pairing;  ///< of each station with the next
  std::vector<std::vector<std::uint32_t>> who;      ///< performer on each place of each station; empty when free
};

/// The stretch of formations between two that bind people is paired as if nobody were bound, but for the one change
/// with most time in it: there each class goes to its own places, unless a model of motion has led it there
/// (`Station::follows`). Who has been anywhere so far, and where, makes the
/// class of somebody who leaves; whom the next binding asks for makes that of who arrives.
/// @param pair as if nobody were bound  @param ready pairings that need not be made anew, by interval; empty elsewhere
[[nodiscard]] CastTracks cast_tracks(const Grid& grid, const std::vector<Station>& stations, const Casting& casting,
                                     const PairStations& pair, std::vector<std::vector<std::uint32_t>> ready);

/// The intervals (number of the earlier station) in which classes go to their own places: pairings that `cast_tracks`
/// makes itself. Ascending.
[[nodiscard]] std::vector<std::size_t> changing_intervals(const std::vector<Station>& stations, const Casting& casting);

/// For each interval between two stations the kind of each performer: people of one kind may take each other's targets
/// in it, whatever else is exchanged elsewhere. Two people may exchange when they have stood on equal classes of places
/// so far (who is who so far is a name), or when they will from now on. Both at once is no equivalence, so everybody
/// goes by the larger of her two classes; the first only shrinks in time and the second only grows, so that nobody
/// goes back to the first, and exchanges in several intervals do not spoil each other.
/// @return for each interval empty where everybody is of one kind. O(stations x people log people)
[[nodiscard]] std::vector<std::vector<std::uint32_t>> exchange_kinds(const Casting& casting, std::size_t people,
                                                                     std::size_t stations);

/// Where tracks pass a station: its place for each track, numbered by the places of the first station.
struct TrackPlaces {
  std::size_t station = 0;
  std::vector<std::uint32_t> place;
};

/// Who walks which track.
struct NamedTracks {
  std::vector<std::uint32_t> first_place;  ///< of each performer, in the first station
  std::vector<std::uint32_t> alike;  ///< of each performer: people with equal numbers may have each other's tracks
};

/// Tracks of equal classes at every binding are those of people of the same classes, the first of the first.
/// @param who CastTracks::who  @param visited every station that binds, in order
[[nodiscard]] NamedTracks name_tracks(const Casting& casting, const std::vector<std::vector<std::uint32_t>>& who,
                                      const std::vector<TrackPlaces>& visited, std::size_t people);

/// Numbers for classes of classes: equal pairs get equal numbers, in the order in which they are asked for.
class Refinement {
 public:
  std::uint32_t of(std::uint32_t before, std::uint32_t now) {
    return known_.try_emplace({before, now}, static_cast<std::uint32_t>(known_.size())).first->second;
  }

 private:
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known_;
};

}  // namespace footlight::planner
