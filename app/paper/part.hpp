// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "core/plan.hpp"
#include "core/show.hpp"

namespace footlight::app {

/// Who comes nearest on a walk.
struct Encounter {
  PerformerIndex who;
  double distance_m = 0;
  Instant at;
};

/// The walk from a place to the next one.
struct Way {
  Instant leave;
  Instant arrive;
  Point walk;  ///< from here to there, m
  double length_m = 0;
  int steps = 1;          ///< one a count; two or four where one would be longer than kLongestStep
  bool left_foot = true;  ///< first: the left foot leaves the floor on odd counts, so that everybody is in step
  std::optional<Encounter> closest;  ///< somebody within sight, exact
  [[nodiscard]] double step_m() const { return length_m / steps; }
};

/// Longer steps than this are made two of, m.
inline constexpr double kLongestStep_m = 0.9;
/// People farther away than so many pitches are not told of.
inline constexpr double kSightPitches = 3;

/// A cell on which a performer stays, turns or changes pace, or at which a formation finds her.
struct Place {
  Instant from;   ///< arrives; the first: the show's first instant
  Instant until;  ///< leaves; the last: the show's last instant
  CellIndex cell;
  std::string_view look;               ///< "here", "arrive", "handover", "dark": of the mark at `from`, as in marks.csv
  std::optional<PerformerIndex> left;  ///< nearest person on that side of her, facing the audience, at `from`
  std::optional<PerformerIndex> right;
  std::optional<PerformerIndex> ahead;  ///< downstage
  std::optional<Way> way;               ///< to the next place; the last has none
};

/// What one performer has to learn, in the order of time.
using Part = std::vector<Place>;

/// Everybody's part. Waits become one place; a mark that is passed in a straight line without changing pace is left out
/// unless a formation stands then. Complexity: O(marks log marks + near pairs). Deterministic.
[[nodiscard]] std::vector<Part> parts_of(const Plan& plan, const Show& show);

}  // namespace footlight::app
