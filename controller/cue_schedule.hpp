// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "controller/wearable_contents.hpp"
#include "core/look.hpp"
#include "core/plan.hpp"
#include "core/result.hpp"
#include "core/rig.hpp"
#include "core/show.hpp"
#include "drivers/driver.hpp"

namespace footlight::controller {

/// An instant of show time at which lamps change, all buses together.
struct Switch {
  Instant time;
  std::string cause;  ///< for traces and people: "growth/12 announced", "growth/12"
  /// The opening form and the end of a set, where the show may wait for GO; the next switch has the same show time.
  bool settled = false;
  std::optional<std::size_t> cue;  ///< position in cue_plays() of the cue that plays it; none for the opening
};

/// Lamps that somebody could take for the own one: same look, near the own goal.
struct LampConfusion {
  std::uint64_t before = 0;  ///< with one pattern for all
  std::uint64_t after = 0;   ///< with the assigned patterns
};

/// What every lamp and wearable shows from switch to switch: a function of show time alone.
class CueSchedule {
 public:
  CueSchedule(std::vector<Look> looks, std::vector<Switch> switches, std::size_t nodes, std::vector<LookIndex> table,
              std::uint8_t plan_byte, LampConfusion confusion);

  /// Entry i is look i; entry 0 is dark; at most 254 entries.
  [[nodiscard]] const std::vector<Look>& looks() const { return looks_; }
  /// Ascending by time; the first is the opening, lit before the show starts.
  [[nodiscard]] const std::vector<Switch>& switches() const { return switches_; }
  /// All 32 channels of a node from switch `k` until the next; unused channels are dark.
  [[nodiscard]] std::span<const LookIndex> looks_of(std::size_t k, NodeIndex node) const;
  [[nodiscard]] std::uint8_t plan_byte() const { return plan_byte_; }
  [[nodiscard]] LampConfusion confusion() const { return confusion_; }
  /// What wearables tell besides their looks; empty unless it was set.
  [[nodiscard]] const WearableContents& contents() const { return contents_; }
  /// @param contents of as many switches
  void set_contents(WearableContents contents);

 private:
  std::vector<Look> looks_;
  std::vector<Switch> switches_;
  std::size_t nodes_ = 0;
  std::vector<LookIndex> table_;  ///< switches x nodes x 32
  std::uint8_t plan_byte_ = 0;
  LampConfusion confusion_;
  WearableContents contents_;
};

/// The byte of a plan that all frames of a show carry: the last two digits of its hash; a sum over its marks where it
/// has none. Drivers are made with it.
[[nodiscard]] std::uint8_t plan_byte_of(const Plan& plan);

/// Latch sequence of a switch on every wire, 1..240: the same after a restart of the controller.
[[nodiscard]] constexpr drivers::Sequence sequence_of(std::size_t k) {
  return static_cast<drivers::Sequence>(k % drivers::kLastSequence + 1);
}

/// Compiles a valid plan. Refused (ErrorKind::refused) for a plan that is not valid and, with the arithmetic, for a bus
/// that cannot carry a switch's preloads and receipts before it is due with 30 % reserve.
/// ErrorKind::input when the looks of the show are too many for a marker.
/// @param drivers one for each bus of the rig, for their budgets
/// Complexity: O(switches x (performers + cells + markers)). Deterministic.
[[nodiscard]] Result<CueSchedule> build_schedule(const Show& show, const Plan& plan, const Rig& rig,
                                                 const std::vector<std::unique_ptr<drivers::Driver>>& drivers);

}  // namespace footlight::controller
