// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/plan.hpp"
#include "planner/progress.hpp"

namespace footlight::planner {

/// How late anybody may notice that the show has been frozen.
inline constexpr Duration kLatestStop = milliseconds(1500);

/// Two people who may come nearer than their clearance when the show is frozen at an instant of [from, until].
struct Touch {
  Instant from;
  Instant until;
  std::uint32_t a = 0;
  std::uint32_t b = 0;  ///< > a

  friend bool operator==(const Touch&, const Touch&) = default;
};

/// How many pairs may touch, as a function of the instant of the freeze.
class TouchCount {
 public:
  TouchCount() = default;
  /// @param touches of each pair without overlap. O(n log n)
  explicit TouchCount(const std::vector<Touch>& touches);

  [[nodiscard]] std::uint32_t at(Instant freeze) const;
  /// The first instant from `freeze` on with no pair; kNever: none. O(steps of this stretch)
  [[nodiscard]] Instant none_from(Instant freeze) const;
  struct Worst {
    std::uint32_t pairs = 0;
    Instant at;  ///< the first of them
  };
  /// Within [from, to).
  [[nodiscard]] Worst worst_in(Instant from, Instant to) const;
  /// How much of [from, to) has no pair.
  [[nodiscard]] Duration safe_in(Instant from, Instant to) const;

 private:
  struct Step {
    Instant from;
    std::uint32_t pairs = 0;
  };
  [[nodiscard]] std::size_t step_at(Instant freeze) const;
  std::vector<Step> steps_{{Instant::min(), 0}};  ///< ascending
};

/// What a freeze does, and going on after it.
struct FreezeJudgement {
  Duration late{};
  TouchCount freeze;  ///< pairs that may touch while they stop
  TouchCount resume;  ///< pairs that may touch while they go on
  std::uint64_t freeze_pairs = 0;
  std::uint64_t resume_pairs = 0;
};

/// Judges a freeze at every instant of the show, in closed form.
///
/// Frozen at T of show time, each goes on along her way for anything from 0 to `late` and stops there; whoever would
/// begin to walk in that time may begin. Two may touch when they could come below their clearance (that of `validate`).
/// Nobody passes an instant at which the show waits. Going on from there, each is ahead of the show by 0 to `late`, as
/// she likes, until the end of the straight stretch in which she was stopped: then she waits for the show.
///
/// @param waits show times at which the show waits for GO, ascending  @param late of show time: at another tempo the
/// clock's time times the tempo
/// Complexity: O(legs x neighbours) for legs and people near them, by a uniform grid, plus sorting what was found.
/// Stretches between waits in parallel; the result does not depend on how. When stopped it is worthless.
[[nodiscard]] FreezeJudgement judge_freezes(const Plan& plan, std::span<const Instant> waits,
                                            Duration late = kLatestStop, const Progress& progress = {});

/// Who is meant: the pairs at one instant, ascending. As judge_freezes, of the stretch between two waits.
struct FreezeAt {
  std::vector<Touch> freeze;
  std::vector<Touch> resume;
};
[[nodiscard]] FreezeAt judge_freeze_at(const Plan& plan, std::span<const Instant> waits, Instant freeze,
                                       Duration late = kLatestStop);

}  // namespace footlight::planner
