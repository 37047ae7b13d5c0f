// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/plan.hpp"

namespace footlight::planner {

/// Marks from somewhere else to somebody's own walk. They are hers: who asks next is kept off them, too.
struct GivenWay {
  PerformerIndex who;
  std::vector<Mark> marks;
};

/// Somebody who is not where the plan has her: lost, or late.
struct WayInTask {
  PerformerIndex who;
  CellIndex from;          ///< where she stands now; WaysIn::can_stand
  Instant earliest;        ///< she sets out no earlier
  Instant latest;          ///< by then she is on her own walk
  double speed_mps = 1.4;  ///< she walks no faster, and no faster than the plan has people walk
  std::span<const GivenWay> given = {};
};

/// What somebody should do.
struct WayIn {
  enum class Kind : std::uint8_t {
    join,     ///< `marks` lead her to her own walk; from the last one on she goes on by the plan
    wait,     ///< there is no way in time; where she is nobody comes too near until `until`
    aside,    ///< the same, but where the last of `marks` is; `marks` lead her there
    nowhere,  ///< somebody will be too near wherever she goes
  };
  Kind kind = Kind::nowhere;
  /// Ascending, the first one on the cell where she stands, at the beat at which her walk or her waiting begins.
  std::vector<Mark> marks;
  Instant until;  ///< all of the answer was looked at up to here

  friend bool operator==(const WayIn&, const WayIn&) = default;
};

/// Ways into a plan for people who are not where it has them. Nobody else's walk changes; every way that is given was
/// found valid by `validate`, against everybody whose walk comes near it.
class WaysIn {
 public:
  /// The plan in a stretch of the show, prepared so that many questions can be answered.
  class Stretch;

  /// @param plan valid; must outlive this
  explicit WaysIn(const Plan& plan);
  ~WaysIn();
  WaysIn(const WaysIn&) = delete;
  WaysIn& operator=(const WaysIn&) = delete;

  /// Whether somebody can stand there: on the stage, off what is blocked.
  [[nodiscard]] bool can_stand(CellIndex cell) const;

  /// @param beats at which people set out and turn: whole counts, strictly ascending, at least two. What happens after
  /// the last is not looked at.
  /// @param lag_s how late anybody may be, she and whoever she meets
  /// O(people x beats), in time and in memory
  [[nodiscard]] std::shared_ptr<const Stretch> stretch(std::vector<Instant> beats, double lag_s = 0) const;

  /// The way on which she is on her own walk soonest, and of those a short one.
  ///
  /// Best first over cells and beats: from a cell to a near one in as many whole beats as it takes, or a beat of
  /// waiting. How soon her own walk could be met from a cell, straight and with nobody around, is the bound. Steps are
  /// looked at when they are the best ones left, against all who are near, in closed form
  /// (repair/lateness.hpp). Corners that nobody needs are left out at the end.
  /// Source: a search for one walk among others that are known is one step of detours.hpp; bounded in the same way, so
  /// "wait" is no proof that there is no way.
  ///
  /// Complexity: bounded: at most kMostStates cells and beats. Deterministic. Thread: any number at once.
  [[nodiscard]] WayIn find(const Stretch& stretch, const WayInTask& task) const;

  static constexpr std::size_t kMostStates = 6000;

 private:
  struct Floor;
  const Plan& plan_;
  std::unique_ptr<const Floor> floor_;
};

}  // namespace footlight::planner
