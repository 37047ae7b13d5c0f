// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "core/index.hpp"
#include "core/look.hpp"
#include "core/rig.hpp"
#include "core/time.hpp"

namespace footlight::sim {

/// What a node says of itself (docs/wire-protocol.md, section 1).
enum class NodeState : std::uint8_t { boot = 0, showing = 1, hold = 2, no_guidance = 3 };

inline constexpr Duration kHoldAfter = milliseconds(1000);
inline constexpr Duration kNoGuidanceAfter = milliseconds(2500);
inline constexpr Duration kIdentifyFor = milliseconds(10'000);
inline constexpr std::uint8_t kHighestSequence = 240;

/// What a node can tell of itself.
struct NodeHealth {
  int battery_percent = 100;
  int supply_mv = 24'000;
  int temperature_c = 21;
};

/// What a wearable tells besides its look (docs/wire-protocol.md, section 2, CONTENT).
struct NodeContent {
  bool walks = false;
  std::uint8_t direction = 0;
  std::uint16_t distance_cm = 0;
  std::uint32_t starts_ms = 0;
  std::uint16_t count_ms = 0;

  friend bool operator==(const NodeContent&, const NodeContent&) = default;
};

/// The inside of a marker node, the same on every bus: looks pending and shown, sequence, lease, look table. Has no
/// clock; `now` never goes back from call to call.
class NodeModel {
 public:
  /// @param channels 1..32  @param has_lease false: a foreign device that knows no heartbeat
  /// @param at_power_on what every channel shows then: NO-GUIDANCE, or a foreign device's own number of dark
  NodeModel(int channels, bool has_lease, LookIndex at_power_on = kNoGuidance);

  /// Everything as at power-on, one more boot; what is kept is kept.
  void power_on(Instant now);

  /// Replaces what was pending; channels that it does not name keep the look that they show.
  /// @param sequence 1..240  @param first + looks.size() <= channels()
  void preload(std::uint8_t sequence, std::uint8_t plan_byte, int first, std::span<const LookIndex> looks);
  /// Takes over what is pending under this sequence. @param plan_byte absent where the bus has none
  /// @return false when nothing happened: another sequence, another plan, nothing pending
  bool latch(std::uint8_t sequence, std::optional<std::uint8_t> plan_byte, Instant now);

  /// Without sequences (CANopen RPDOs): adds to what is pending.
  void stage(int first, std::span<const LookIndex> looks);
  /// Takes over whatever is staged; the sequence becomes the shown one in either case.
  /// @return true when anything was staged
  bool take_staged(std::uint8_t sequence, Instant now);

  /// Forgets what was staged.
  void drop_staged() { staged_ = false; }

  void heartbeat(Instant now);
  /// The controller of this epoch leads, with frames of this plan byte. @return false, and
  /// nothing happens, while one of a newer epoch does
  bool lead(std::uint32_t epoch, std::uint8_t plan_byte, Instant now);
  /// Whether frames of this plan byte are refused: another controller has led within the time of a lease.
  [[nodiscard]] bool fenced(std::uint8_t plan_byte, Instant now) const { return led(now) && plan_byte != leader_; }
  /// Of whoever leads; 0: nobody does.
  [[nodiscard]] std::uint32_t epoch(Instant now) const { return led(now) ? epoch_ : 0; }
  /// Of whoever has led last since power-on; 0: nobody has.
  [[nodiscard]] std::uint32_t last_epoch() const { return epoch_; }
  /// Lets the lease run out if it is time. Called at lease_end() and before anything is asked of the node.
  void settle(Instant now);
  /// When `settle` will change the state next; kNever: not by itself.
  [[nodiscard]] Instant lease_end() const;

  /// Entries 0 and 255 stay what they are. @return false when the index or the effect is not possible
  bool set_look(std::uint8_t index, Look look);
  bool set_colour(std::uint8_t index, Colour colour);
  bool set_effect(std::uint8_t index, std::uint8_t effect, std::uint8_t brightness);
  [[nodiscard]] const Look& look(LookIndex index) const { return table_[index]; }

  /// Every channel blinks white for 10 s, or no longer.
  void identify(bool on, Instant now) { identify_until_ = on ? now + kIdentifyFor : now; }
  [[nodiscard]] bool identifying(Instant now) const { return now < identify_until_; }

  [[nodiscard]] int channels() const { return channels_; }
  [[nodiscard]] LookIndex shown(int channel) const { return showing_[static_cast<std::size_t>(channel)]; }
  [[nodiscard]] std::uint8_t shown_sequence() const { return shown_sequence_; }
  [[nodiscard]] std::uint8_t pending_sequence() const { return pending_sequence_; }
  [[nodiscard]] NodeState state() const { return state_; }
  [[nodiscard]] std::uint16_t boots() const { return boots_; }
  /// Content of a channel from latch `sequence` on; at once where that latch is shown already.
  void set_content(std::uint8_t sequence, int channel, const NodeContent& content);
  [[nodiscard]] const NodeContent& content(int channel) const { return content_[static_cast<std::size_t>(channel)]; }
  /// Whole counts until the walk begins, as a wearable counts them down; nothing without a walk or a time.
  [[nodiscard]] std::optional<int> counts_left(int channel, Instant now) const;

  /// Show time at `now`, and its rate by the clock.
  void set_time(Instant now, Duration show_time, double rate);
  [[nodiscard]] std::optional<Duration> show_time(Instant now) const;
  [[nodiscard]] std::uint8_t times_set() const { return times_set_; }

  NodeHealth health;
  [[nodiscard]] Instant powered_on_at() const { return powered_on_at_; }
  // Kept over power-off: checks of the plan and of the patch, whatever they mean to the controller; 0: none.
  [[nodiscard]] std::uint32_t plan_check() const { return plan_check_; }
  [[nodiscard]] std::uint32_t patch_check() const { return patch_check_; }
  void keep_plan(std::uint32_t check) { plan_check_ = check; }
  void keep_patch(std::uint32_t check) { patch_check_ = check; }
  /// CRC-16 over the looks shown.
  [[nodiscard]] std::uint16_t crc() const;
  /// Latches that changed what is pending into what is shown, since construction.
  [[nodiscard]] std::uint64_t latches() const { return latches_; }

 private:
  void take(std::uint8_t sequence, Instant now);
  [[nodiscard]] bool led(Instant now) const { return epoch_ != 0 && now < led_at_ + kNoGuidanceAfter; }

  int channels_;
  bool has_lease_;
  LookIndex at_power_on_;
  std::array<LookIndex, kChannelsPerNode> showing_{};
  std::array<LookIndex, kChannelsPerNode> pending_{};
  std::uint8_t shown_sequence_ = 0;
  std::uint8_t pending_sequence_ = 0;
  std::uint8_t pending_plan_ = 0;
  bool staged_ = false;
  NodeState state_ = NodeState::boot;
  std::uint16_t boots_ = 0;
  std::uint64_t latches_ = 0;
  std::uint32_t plan_check_ = 0;
  std::uint32_t patch_check_ = 0;
  Instant powered_on_at_ = kStart;
  Instant renewed_ = kStart;
  Instant identify_until_ = kStart;
  std::uint32_t epoch_ = 0;
  std::uint8_t leader_ = 0;  ///< its plan byte
  Instant led_at_ = kStart;
  std::array<Look, 256> table_;
  struct PendingContent {
    std::uint8_t sequence = 0;
    NodeContent content;
  };
  std::array<NodeContent, kChannelsPerNode> content_{};
  std::array<PendingContent, kChannelsPerNode> pending_content_{};
  Instant time_set_at_ = kStart;
  Duration time_then_{};
  double rate_ = 0;
  std::uint8_t times_set_ = 0;
};

}  // namespace footlight::sim
