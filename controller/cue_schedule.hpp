// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "controller/supply_load.hpp"
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

/// Everybody's way back to an earlier place, as lamps tell it: switches of its own beside those of the show.
struct ResetMove {
  /// `time` counts from the beginning of the move; the last one is not lit: there everybody stands where the show goes
  /// on, and the show's own lamps say so.
  std::vector<Switch> switches;
  std::vector<LookIndex> table{};                    ///< switches x nodes x 32
  std::vector<drivers::WearableContent> contents{};  ///< switches x worn

  [[nodiscard]] Duration length() const {
    return switches.empty() ? Duration{} : switches.back().time.time_since_epoch();
  }
};

/// Lamps of the whole show while some groups are muted (docs/looks.md, "Solo and mute").
struct MutedLamps {
  std::vector<LookIndex> table{};                    ///< switches x nodes x 32
  std::vector<drivers::WearableContent> contents{};  ///< switches x worn
};

/// What a lamp shows whose people are muted: steady, dim, and not dark.
inline constexpr Look kQuiet{{0, 0, 255}, Effect::steady, 40};

/// Whose lamp has which number, so that what is compiled later speaks the same language.
struct LookNumbers {
  std::vector<std::uint8_t> pattern;  ///< of each performer
  std::vector<LookIndex> of_entry;    ///< of each look that the show could have (LookBook); kDark: it is not used
  LookIndex quiet = kDark;            ///< kQuiet; kDark: nobody can be muted
};

/// What nodes have to keep for a plan to be theirs; plan 0: nobody asks.
struct WantedChecks {
  std::uint32_t plan = 0;
  std::vector<std::uint32_t> patches{};  ///< patch_check of every node of the rig
};

/// What every lamp and wearable shows from switch to switch: a function of show time alone.
class CueSchedule {
 public:
  /// Reset moves that one schedule takes, and switches that each may have.
  static constexpr std::size_t kMostResets = 4096;
  static constexpr std::size_t kMostResetSwitches = 1024;
  /// Sets of muted groups that one schedule takes.
  static constexpr std::size_t kMostMuted = 200;

  CueSchedule(std::vector<Look> looks, std::vector<Switch> switches, std::size_t nodes, std::vector<LookIndex> table,
              std::uint8_t plan_byte, LampConfusion confusion);

  /// Entry i is look i; entry 0 is dark; at most 254 entries.
  [[nodiscard]] const std::vector<Look>& looks() const { return looks_; }
  /// Ascending by time; the first is the opening, lit before the show starts.
  [[nodiscard]] const std::vector<Switch>& switches() const { return switches_; }
  /// All 32 channels of a node from switch `k` until the next; unused channels are dark. @param k of the show, or of a
  /// reset move that was added. Any thread.
  [[nodiscard]] std::span<const LookIndex> looks_of(std::size_t k, NodeIndex node) const;
  /// What wearable `w` of contents() tells from switch `k` on; `k` as above. Any thread.
  [[nodiscard]] const drivers::WearableContent& content(std::size_t k, std::size_t w) const;
  /// Takes a reset move, beside threads that read what is there already. One thread.
  /// @return the number of its first switch, for as long as the schedule lives; nothing when there are too many
  std::optional<std::size_t> add(ResetMove move);
  /// Whether `k` is a switch of the show, or of a reset move that was added. Any thread.
  [[nodiscard]] bool has(std::size_t k) const;
  /// The move that switch `k` belongs to, k >= switches().size(). Lives as long as the schedule. Any thread.
  [[nodiscard]] const ResetMove& reset_of(std::size_t k) const;
  /// Takes the lamps of a set of muted groups, as `add` does. @return the number of its first switch: switch k of the
  /// show is k more; its sequence on the wire is another one than that of k
  std::optional<std::size_t> add(MutedLamps lamps);
  /// Whether `add` has given this number. Any thread.
  [[nodiscard]] bool is_muted_set(std::size_t first) const;
  /// The same switch with nobody muted.
  [[nodiscard]] std::size_t plain(std::size_t k) const {
    return k < first_muted() ? k : (k - first_muted()) % muted_stride();
  }
  /// Makes room for kQuiet, where the looks of the show leave some. Before anything borrows the schedule.
  /// @param most looks besides dark that every marker of the rig knows
  void add_quiet(std::size_t most);
  [[nodiscard]] std::uint8_t plan_byte() const { return plan_byte_; }
  [[nodiscard]] const WantedChecks& checks() const { return checks_; }
  void set_checks(WantedChecks checks) { checks_ = std::move(checks); }
  [[nodiscard]] LampConfusion confusion() const { return confusion_; }
  /// What wearables tell besides their looks; empty unless it was set.
  [[nodiscard]] const WearableContents& contents() const { return contents_; }
  /// @param contents of as many switches
  void set_contents(WearableContents contents);
  [[nodiscard]] const LookNumbers& numbers() const { return numbers_; }
  void set_numbers(LookNumbers numbers) { numbers_ = std::move(numbers); }
  /// Other numbers for the same looks. @param looks the whole table  @param now of each number so far
  void renumber(std::vector<Look> looks, std::span<const LookIndex> now, std::uint8_t plan_byte);
  /// Numbers that a lamp may show: of the show, or of a reset move.
  [[nodiscard]] std::vector<bool> numbers_shown() const;
  /// What the rig's supplies have to give; empty unless the rig lists supplies.
  [[nodiscard]] const std::vector<SupplyLoad>& supplies() const { return supplies_; }
  void set_supplies(std::vector<SupplyLoad> supplies) { supplies_ = std::move(supplies); }

 private:
  using Slot = std::unique_ptr<const ResetMove>;
  struct Resets {
    std::array<Slot, kMostResets> moves;
    std::atomic<std::size_t> count{0};
  };
  struct Muted {
    std::array<std::unique_ptr<const MutedLamps>, kMostMuted> lamps;
    std::atomic<std::size_t> count{0};
  };
  /// Latch sequences go round after 240 switches: seven more make the numbers of each set others.
  [[nodiscard]] static constexpr std::size_t apart(std::size_t k) { return (k + 239) / 240 * 240 + 7; }
  [[nodiscard]] std::size_t first_muted() const { return apart(switches_.size() + kMostResets * kMostResetSwitches); }
  [[nodiscard]] std::size_t muted_stride() const { return apart(switches_.size()); }
  [[nodiscard]] const MutedLamps& muted_of(std::size_t k) const;

  std::vector<Look> looks_;
  std::vector<Switch> switches_;
  std::size_t nodes_ = 0;
  std::vector<LookIndex> table_;  ///< switches x nodes x 32
  std::uint8_t plan_byte_ = 0;
  LampConfusion confusion_;
  WantedChecks checks_;
  WearableContents contents_;
  LookNumbers numbers_;
  std::unique_ptr<Resets> resets_ = std::make_unique<Resets>();
  std::unique_ptr<Muted> muted_ = std::make_unique<Muted>();
  std::vector<SupplyLoad> supplies_;
};

/// Latch sequence of a switch on every wire, 1..240: the same after a restart of the controller.
[[nodiscard]] constexpr drivers::Sequence sequence_of(std::size_t k) {
  return static_cast<drivers::Sequence>(k % drivers::kLastSequence + 1);
}

/// Compiles a valid plan. Refused (ErrorKind::refused) for a plan that is not valid and, with the arithmetic, for a bus
/// that cannot carry a switch's preloads and receipts before it is due with 30 % reserve, or a supply that cannot carry
/// its lamps (supply_load.hpp; dimmed where the rig says so).
/// ErrorKind::input when the looks of the show are too many for a marker.
/// @param drivers one for each bus of the rig, for their budgets
/// Complexity: O(switches x (performers + cells + markers)). Deterministic.
[[nodiscard]] Result<CueSchedule> build_schedule(const Show& show, const Plan& plan, const Rig& rig,
                                                 const std::vector<std::unique_ptr<drivers::Driver>>& drivers);

/// The lamps of the show while people of some groups are muted: docs/looks.md, "Solo and mute".
/// @param muted one for each group of the show, and last those who are in none
/// Complexity: as build_schedule without its patterns.
[[nodiscard]] MutedLamps build_muted(const Show& show, const Plan& plan, const Rig& rig, const CueSchedule& schedule,
                                     const std::vector<bool>& muted);

/// Compiles a way back with the looks and patterns of the show's schedule; a look that the show never needs is replaced
/// by the most similar one that it has (another pattern, then another role of the same colour).
/// @param move a valid plan of two sections: people stand, from time 0 on, then walk
/// @param stand begin with a switch at time 0 that shows people where they stand: no switch of the show does
/// Complexity: as build_schedule.
[[nodiscard]] ResetMove build_reset(const Show& show, const Plan& move, const Rig& rig, const CueSchedule& schedule,
                                    bool stand = false);

}  // namespace footlight::controller
