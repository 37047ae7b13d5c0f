// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "controller/cue_list.hpp"
#include "core/plan.hpp"
#include "core/show.hpp"

namespace footlight::controller {

/// A mark instant at which somebody begins to walk, and from when on it is announced.
struct Announcement {
  Instant move;
  Instant since;  ///< <= move; not before the mark instant that precedes the move
};

/// An instant of show time at which lamps change.
struct Moment {
  Instant time;
  /// Everybody who arrives now stands and nobody has left yet: the opening form and the end of a set, where the show
  /// may wait for GO. The moment after it has the same time.
  bool settled = false;
  std::optional<std::size_t> cue;  ///< whose play it belongs to; none for the opening
  std::string cause;  ///< for traces and people: "growth/12 announced", "growth/12", "growth at count 17.5"
};

/// What a performer does from a moment until the next one.
struct Doing {
  CellIndex cell;                 ///< where she stands, or comes from
  std::optional<CellIndex> goal;  ///< where she walks to now
  std::optional<CellIndex> next;  ///< where her next walk leads, when it is announced
  Instant arrives;                ///< when `goal` is reached
  Instant next_arrives;           ///< when `next` is reached
};

/// When lamps change, and what everybody does then. Moments are visited in ascending order.
class Crowd {
 public:
  /// Borrows the plan. O(M log M) for M marks.
  Crowd(const Show& show, const Plan& plan, const std::vector<CuePlay>& plays);

  /// Ascending by time; a settled one before the other of the same instant. The first is the opening.
  [[nodiscard]] const std::vector<Moment>& moments() const { return moments_; }

  /// One for each performer. Cheapest when called with ascending k: O(performers), amortised.
  void look_at(std::size_t k, std::vector<Doing>& doing);
  /// Cells that are dark for who stands there, at moment k; indexed by cell.
  [[nodiscard]] const std::vector<bool>& reserve_at(std::size_t k) const;

 private:
  void find_moments(const Show& show, const std::vector<CuePlay>& plays);
  void name_moments(const Show& show);
  [[nodiscard]] std::optional<CellIndex> announced(const std::vector<Mark>& track, std::size_t segment, Instant time,
                                                   Instant& arrives) const;
  [[nodiscard]] std::size_t section_at(const Moment& moment) const;

  const Plan* plan_;
  std::vector<Instant> marks_;  ///< every instant with a mark, ascending
  std::vector<Announcement> announcements_;
  std::vector<Moment> moments_;
  std::vector<std::vector<bool>> reserve_;  ///< of each section
  std::vector<std::size_t> segment_;        ///< of each performer: last mark at or before the moment visited last
  std::size_t visited_ = 0;
};

}  // namespace footlight::controller
