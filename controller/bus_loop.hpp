// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "controller/cue_schedule.hpp"
#include "controller/lateness.hpp"
#include "core/time.hpp"
#include "drivers/driver.hpp"

namespace footlight::controller {

/// Where the show stands, as the cue engine says it.
struct BusTarget {
  std::size_t current = 0;   ///< switch whose lamps should be lit now
  std::size_t next = 0;      ///< the one that comes after it; `current` when there is none
  Instant next_at = kNever;  ///< clock time of `next`; kNever while the show waits for GO
  Duration show_time{};      ///< for heartbeats
  double rate = 1;           ///< of show time against the clock, while it goes on

  friend bool operator==(const BusTarget&, const BusTarget&) = default;
};

/// What a bus has done since the start.
struct BusCounters {
  std::uint64_t deliveries = 0;  ///< markers whose look had to change and was confirmed by sequence and CRC
  std::uint64_t unverified = 0;  ///< the same on devices that cannot be read back: sent and receipted
  std::uint64_t retries = 0;     ///< preloads and questions sent again
  std::uint64_t misses = 0;      ///< no answer, a wrong one or a refusal
  std::uint64_t quarantines = 0;
  std::uint64_t boots = 0;         ///< restarts of nodes that were noticed
  std::uint64_t latches = 0;       ///< moments carried
  std::uint64_t late_latches = 0;  ///< of them, more than 1 ms late
  Duration worst_lateness{};       ///< of a latch's last bit
};

/// Times that each look is sent at the start: uploads have no receipt.
inline constexpr int kUploads = 2;

/// One bus: brings what its nodes show to what the schedule says, level-triggered. For each node there is a desired
/// state and a last confirmed one; the difference is sent again and again until it is confirmed, so a lost frame, a
/// rebooted node, a seek and a restarted controller are one case.
///
/// Each switch: preload the next looks, latch so that its last bit is on the wire at the switch's instant, ask who had
/// to change, repair by preload and a repeated latch, refresh round robin in idle time. Where the latch carries no
/// sequence (CANopen), nothing of the next switch is preloaded before the verification of this one has had its time,
/// and from the first such preload no latch is sent but the switch's own.
///
/// Nodes of a supply that staggers are lit for the first time one after the other, after the start and after they have
/// booted: until its turn a node gets neither preload nor repair, and takes no part in the latches of running cues,
/// whose moment is that of all nodes that are lit.
///
/// Pure stepping on one thread; `step` neither allocates, locks nor throws. Borrows schedule and driver.
class BusLoop final : private drivers::EventSink {
 public:
  /// @param switch_on for every node of the rig; empty: all at once
  BusLoop(const CueSchedule& schedule, std::vector<drivers::NodeAddress> nodes, drivers::Driver& driver,
          const std::vector<SwitchOn>& switch_on = {});

  class Part;
  /// What this loop needs of another schedule for the same nodes, whose looks have the same numbers (look_table.hpp).
  /// Any thread. @param before that it will have until then
  [[nodiscard]] std::unique_ptr<Part> part_of(const CueSchedule& schedule, const CueSchedule& before) const;
  /// Goes over to another schedule as soon as its driver has finished what is under way; targets of the next steps mean
  /// that one. No lamp changes by it: a node that shows what it should stays as it is. @param part borrowed until
  /// `schedule` is the new one; then it may go with the old schedule
  void take(Part& part) noexcept { taking_ = &part; }
  [[nodiscard]] const CueSchedule& schedule() const noexcept { return *schedule_; }

  /// Does what is due. @return when to call again, if nothing arrives before
  Instant step(Instant now, const BusTarget& target) noexcept;

  /// True when every node that is not in quarantine is confirmed to show what it should, and look table and roll call
  /// are done.
  [[nodiscard]] bool settled() const noexcept;
  [[nodiscard]] const BusCounters& counters() const noexcept { return counters_; }
  /// Switch that has been latched last, whoever is muted.
  [[nodiscard]] std::size_t lit() const noexcept { return schedule_->plain(current_); }
  /// Nodes that have not answered for so long that they are only asked from time to time.
  [[nodiscard]] std::vector<NodeIndex> quarantined() const;
  /// Nodes that are not confirmed to show what they should now, those in quarantine among them. O(nodes)
  [[nodiscard]] std::size_t unconfirmed() const noexcept;
  /// What a node keeps of plan and patch, as it has said itself since it was told of the plan.
  enum class Keeps : std::uint8_t {
    unknown,      ///< not asked, or no answer yet
    same,         ///< both are the show's
    other_plan,   ///< it has not heard of this plan
    other_patch,  ///< its lamps are those of another patch, or of another node
    no_patch,     ///< it was never commissioned
    untold,       ///< it cannot tell
  };
  /// What is known of a node.
  struct NodeStanding {
    NodeIndex node;
    bool right = false;        ///< confirmed to show what it should now
    bool silent = false;       ///< it has not answered what it was asked last
    bool quarantined = false;  ///< asked only from time to time
    Keeps keeps = Keeps::unknown;
    std::uint8_t boots = 0;  ///< restarts that were noticed, modulo 256
  };
  [[nodiscard]] std::size_t nodes() const noexcept { return nodes_.size(); }
  /// @param position of the node on this bus, < nodes()
  [[nodiscard]] NodeStanding standing(std::size_t position) const noexcept {
    const NodeState& node = nodes_[position];
    return {node.address.node, node.right, node.misses > 0, node.quarantined, node.keeps, node.boots};
  }
  /// False: what its nodes show is taken for granted once it was sent.
  [[nodiscard]] bool verifies() const noexcept { return can_.readback; }
  /// False: its nodes keep nothing of plan and patch.
  [[nodiscard]] bool keeps_checks() const noexcept { return can_.keeps_checks; }
  /// How late the last bit of each latch left, as far as the loop can know.
  [[nodiscard]] const Lateness& lateness() const noexcept { return lateness_; }
  /// How long before a switch of unknown instant (a GO) this bus has to know it, so that its latch is not late.
  /// Any thread, at any time. @param from what is lit before  O(nodes)
  [[nodiscard]] Duration notice(const CueSchedule& schedule, std::size_t from, std::size_t to) const noexcept;
  /// From the switch before.
  [[nodiscard]] Duration notice(const CueSchedule& schedule, std::size_t k) const {
    return k == 0 ? Duration{} : notice(schedule, k - 1, k);
  }
  /// Time in which a silent node is noticed: 1 s, or a round of questions that takes a fifth of the bus.
  [[nodiscard]] Duration suspect_time() const;

 private:
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  enum class Operation : std::uint8_t { none, latch, heartbeat, upload, ask, preload, content, keep };
  /// A wearable of this bus, and what its node is known to hold for it.
  struct WornState {
    std::size_t index = 0;     ///< in the schedule's contents
    std::size_t position = 0;  ///< of its node
    int channel = 0;
    std::size_t held = kNone;     ///< switch whose content it has
    std::size_t pending = kNone;  ///< switch whose content waits for its latch
  };

  struct NodeState {
    drivers::NodeAddress address;
    std::uint16_t crc = 0;  ///< of the looks of `current_`
    bool right = false;     ///< confirmed to show the looks of `current_`
    bool verify = false;    ///< a latch may have changed it: its status is awaited or to be asked
    bool changes = false;   ///< looks of `next_` differ from those of `current_`
    bool counted = false;   ///< its delivery of `current_` is counted
    bool quarantined = false;
    std::uint8_t boots = 0;       ///< restarts that were noticed, modulo 256
    std::uint8_t misses = 0;      ///< in a row
    drivers::Sequence shown = 0;  ///< of the latch that it has taken last, as it said; 0: not known
    std::uint8_t offers = 0;      ///< preloads of `offered` sent
    std::size_t offered = kNone;  ///< switch preloaded last
    bool in_flight = false;       ///< a preload is under way
    bool stays = false;           ///< while the loop goes over to another schedule: shows the same in both
    bool stale = false;           ///< holds looks of a switch that will not come: they have to be written over
    std::size_t pending = kNone;  ///< switch whose preload is receipted and not yet latched
    Instant silent_since;         ///< first of the misses in a row
    Instant ask_at;               ///< not before, after a miss
    Duration backoff{};           ///< in quarantine
    Instant rests_until;          ///< it has said that it is busy
    Duration rest{};              ///< the last one; doubled while it goes on
    SwitchOn switch_on;
    Instant turn;  ///< it may be lit from then on
    Keeps keeps = Keeps::unknown;
    std::uint8_t keep_asks = 0;    ///< since it was told anything, without an answer
    std::uint8_t other_plans = 0;  ///< times that it has told another plan
    Instant keep_at;               ///< not asked before
  };

  [[nodiscard]] std::vector<WornState> worn_in(const CueSchedule& schedule) const;
  void on_event(const drivers::DeviceEvent& event) override;
  void on_showing(NodeState& node, const drivers::DeviceEvent& event) noexcept;
  void on_miss(NodeState& node) noexcept;
  void on_fenced(NodeState& node) noexcept;
  void on_refusal(NodeState& node, drivers::DeviceEvent::Again again) noexcept;
  void quarantine(NodeState& node) noexcept;
  void wait_after_miss(NodeState& node) noexcept;
  void rest_for_long(NodeState& node) noexcept;
  void on_boot(NodeState& node) noexcept;
  void on_confirmed(NodeState& node) noexcept;
  [[nodiscard]] NodeState* find(NodeIndex node) noexcept;

  void follow(const BusTarget& target) noexcept;
  void aim(std::size_t next, Instant at) noexcept;
  void seek(std::size_t k) noexcept;
  void go_over(std::size_t k) noexcept;
  void switch_over(bool latched) noexcept;

  // One operation, or false when there is nothing to do now. In this order of importance.
  bool act() noexcept;
  bool latch_next() noexcept;
  bool repeat_latch() noexcept;
  bool send_heartbeat() noexcept;
  bool upload(bool urgent_only) noexcept;
  bool verify(bool not_missed) noexcept;
  bool repair() noexcept;
  bool preload_next() noexcept;
  bool ask_quarantined(bool hopeful_only) noexcept;
  [[nodiscard]] bool rests(const NodeState& node) const noexcept { return now_ < node.rests_until; }
  /// It is dark yet, and its supply lights others first.
  [[nodiscard]] bool waits(const NodeState& node) const noexcept { return now_ < node.turn && !node.right; }
  void give_turns() noexcept;
  [[nodiscard]] bool hopeful(const NodeState& node) const noexcept;
  bool refresh() noexcept;

  bool send_preload(NodeState& node, std::size_t k) noexcept;
  bool send_ask(NodeState& node) noexcept;
  bool took(drivers::SendStatus status, Operation operation, Duration time) noexcept;

  [[nodiscard]] bool wants_preload(const NodeState& node) const noexcept;
  [[nodiscard]] Instant latch_at() const noexcept;
  /// From here on the next switch's preloads come first.
  [[nodiscard]] Instant preload_from() const noexcept;
  [[nodiscard]] Duration preloads_left() const noexcept;
  [[nodiscard]] Duration time_of(Operation operation) const noexcept;
  [[nodiscard]] bool fits(Duration time) const noexcept { return fits_before(time, latch_at()); }
  [[nodiscard]] bool may_latch_current() const noexcept { return can_.sequenced_latch || !unlatched_; }
  [[nodiscard]] bool in_hurry() const noexcept;
  [[nodiscard]] bool fits_before(Duration time, Instant deadline) const noexcept;
  /// True while nodes that answer a latch by themselves still may.
  [[nodiscard]] bool awaits_status() const noexcept;
  [[nodiscard]] std::uint64_t changed_channels(const NodeState& node) const noexcept;
  [[nodiscard]] Instant wish(Instant driver_wish) const noexcept;
  [[nodiscard]] std::span<const LookIndex> looks(std::size_t k, const NodeState& node) const noexcept;
  void need_looks(std::size_t k, const NodeState& node) noexcept;
  void note_end() noexcept;
  bool send_time() noexcept;
  bool send_content() noexcept;
  bool send_content(WornState& worn, std::size_t k) noexcept;
  void on_content(const drivers::DeviceEvent& event) noexcept;
  bool check_plan() noexcept;
  [[nodiscard]] static bool wants_check(const NodeState& node) noexcept;
  void on_keeps(NodeState& node, const drivers::KeptChecks& kept) noexcept;
  void forget_checks() noexcept;
  void follow_time() noexcept;
  bool latch_current() noexcept;

  const CueSchedule* schedule_;
  Part* taking_ = nullptr;  ///< schedule to go over to
  drivers::Driver& driver_;
  drivers::Capabilities can_;
  // The driver's budgets, asked once: they are wanted at every step.
  Duration latch_time_{};
  Duration status_time_{};
  Duration heartbeat_time_{};
  Duration upload_time_{};
  std::array<Duration, kChannelsPerNode + 1> preload_time_{};
  std::vector<NodeState> nodes_;
  std::vector<std::int32_t> by_node_;  ///< position in nodes_ of a NodeIndex, -1: of another bus
  BusCounters counters_;
  Lateness lateness_;

  Instant now_;
  Duration show_time_{};
  double rate_ = 1;
  std::size_t previous_ = kNone;  ///< switch before `current_`
  std::size_t current_ = 0;
  std::size_t next_ = 0;
  Instant next_at_ = kNever;
  bool started_ = false;
  bool refused_ = false;      ///< the driver was ready and took nothing: try again soon
  std::uint8_t passes_ = 1;   ///< preloads of `next_` for each node, where none is receipted
  bool wake_due_ = false;     ///< a node that is not right does not answer a latch: perhaps it waits to be started
  bool placed_ = false;       ///< the first target has been seen
  bool unlatched_ = false;    ///< a preload of `next_` has been sent since the last latch
  std::uint8_t repeats_ = 0;  ///< latches of `current_` to send again at once
  Instant heartbeat_at_;
  Instant refresh_at_;
  Instant table_refresh_at_;
  Instant down_until_;
  std::size_t refresh_cursor_ = 0;
  std::size_t table_cursor_ = 1;
  std::array<std::uint8_t, 256> uploads_{};  ///< times that a look is still to be sent
  std::array<bool, 256> urgent_{};           ///< needed before a node can be lit

  // The operation under way, to learn how long one takes when an answer is late.
  Operation under_way_ = Operation::none;
  Instant since_;
  Instant line_free_;  ///< estimate, for wires with a queue
  std::array<Duration, 8> longest_{};

  std::vector<Instant> next_turn_;  ///< of each supply: of its next node that boots

  std::vector<WornState> worn_;
  std::size_t sent_content_ = kNone;  ///< switch of the content under way
  Duration content_time_{};
  Duration kept_time_{};
  bool plan_told_ = false;  ///< to all nodes, as far as is known
  Duration sync_time_time_{};
  bool goes_ = false;  ///< show time goes on
  Instant followed_at_;
  Duration followed_{};
  Instant sync_at_;
};

class BusLoop::Part {
  friend class BusLoop;
  const CueSchedule* schedule = nullptr;
  std::vector<WornState> worn;
  std::array<bool, 256> fresh{};  ///< looks that the markers do not know yet
};

}  // namespace footlight::controller
