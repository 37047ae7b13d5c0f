// SPDX-License-Identifier: Apache-2.0
// What a bus loop puts on the wire, and in which order. Where it stands and what it knows: bus_loop.cpp.
#include <algorithm>

#include "controller/bus_loop.hpp"

namespace footlight::controller {
namespace {

constexpr Duration kRefreshRound = milliseconds(800);  // every node is asked this often, the wire allowing
constexpr Duration kSyncPoll = milliseconds(500);
constexpr Duration kResendRound = milliseconds(2000);  // devices that cannot be read back
constexpr Duration kTableRefresh = milliseconds(500);  // one look each
constexpr Duration kTimeSync = milliseconds(1000);
constexpr Duration kLateness = milliseconds(1);
constexpr Duration kRetryDown = milliseconds(100);
constexpr Duration kAnswerWindow =
    milliseconds(15);  // turnaround and margin of nodes that answer a latch by themselves
constexpr Duration kKeepAgain = milliseconds(500);
constexpr std::uint8_t kKeepAsks = 5;  // whoever leaves so many open does not know the question
constexpr double kLeastWire = 0.1;     // heartbeats leave so much, in any case
constexpr double kRepeats = 1.4;       // room for lost preloads: 1 / (1 - 30 %)

}  // namespace

bool BusLoop::act() noexcept {
  if (next_ != current_ && now_ >= latch_at()) return latch_next();
  if (repeat_latch() || send_heartbeat()) return true;
  if (can_.keeps_time && started_ && send_time()) return true;
  if (!started_) {
    started_ = took(driver_.start(now_), Operation::heartbeat, latch_time_);
    return started_;
  }
  if (in_hurry() && preload_next()) return true;
  // After a death nodes mostly show what they should, and have the looks: a question tells sooner than an upload mends.
  return verify(true) || upload(true) || verify(false) || ask_quarantined(true) || repair() ||
         (can_.sequenced_latch && preload_next()) || ask_quarantined(false) || send_content() || check_plan() ||
         refresh() || upload(false);
}

bool BusLoop::took(drivers::SendStatus status, Operation operation, Duration time) noexcept {
  if (status == drivers::SendStatus::accepted) {
    under_way_ = operation;
    since_ = now_;
    line_free_ = std::max(line_free_, now_) + time;
    return true;
  }
  if (status == drivers::SendStatus::down) {
    down_until_ = now_ + kRetryDown;
  } else {
    refused_ = true;
  }
  return false;
}

// ---- the moment

Instant BusLoop::latch_at() const noexcept {
  return next_ == current_ || next_at_ == kNever ? kNever : next_at_ - latch_time_;
}

bool BusLoop::latch_next() noexcept {
  const bool needed = std::ranges::any_of(
      nodes_, [&](const NodeState& node) { return node.changes || node.offered == next_ || node.pending == next_; });
  if (!needed) {
    if (now_ < next_at_) return false;
    switch_over(false);
    return true;
  }
  const Instant end = std::max(line_free_, now_) + latch_time_;
  if (!took(driver_.latch(sequence_of(next_), now_), Operation::latch, latch_time_)) return false;
  const Duration late = std::max(Duration{}, end - next_at_);
  ++counters_.latches;
  lateness_.add(late);
  counters_.late_latches += late > kLateness ? 1 : 0;
  counters_.worst_lateness = std::max(counters_.worst_lateness, late);
  switch_over(true);
  return true;
}

bool BusLoop::latch_current() noexcept {
  return took(driver_.latch(sequence_of(current_), now_), Operation::latch, latch_time_);
}

bool BusLoop::repeat_latch() noexcept {
  if (repeats_ == 0 || !fits(time_of(Operation::latch))) return false;
  if (!latch_current()) return false;
  --repeats_;
  return true;
}

// ---- standing duties

bool BusLoop::send_heartbeat() noexcept {
  if (now_ < heartbeat_at_ || !fits(time_of(Operation::heartbeat))) return false;
  if (!took(driver_.heartbeat(show_time_, now_), Operation::heartbeat, heartbeat_time_)) return false;
  heartbeat_at_ = now_ + drivers::kHeartbeatPeriod;
  return true;
}

bool BusLoop::upload(bool urgent_only) noexcept {
  if (!fits(time_of(Operation::upload)) || (in_hurry() && !fits_before(time_of(Operation::upload), preload_from()))) {
    return false;
  }
  std::size_t most = 0;
  for (std::size_t i = 1; i < schedule_->looks().size(); ++i) {
    if ((!urgent_only || urgent_[i]) && uploads_[i] > (most == 0 ? 0 : uploads_[most])) most = i;
  }
  if (most == 0) return false;
  const auto index = static_cast<LookIndex>(most);
  if (!took(driver_.upload_look(index, schedule_->looks()[most], now_), Operation::upload, upload_time_)) return false;
  if (--uploads_[most] == 0) urgent_[most] = false;
  return true;
}

// ---- after the moment

bool BusLoop::awaits_status() const noexcept {
  return can_.pushes_status &&
         std::ranges::any_of(nodes_, [](const NodeState& node) { return node.verify && !node.quarantined; });
}

bool BusLoop::verify(bool not_missed) noexcept {
  if (can_.pushes_status || !fits(time_of(Operation::ask))) return false;
  NodeState* least = nullptr;
  for (NodeState& node : nodes_) {
    if (!node.verify || node.quarantined || rests(node) || (not_missed && node.misses > 0)) continue;
    if (least == nullptr || node.misses < least->misses) least = &node;
  }
  return least != nullptr && send_ask(*least);
}

bool BusLoop::repair() noexcept {
  if (!may_latch_current() || awaits_status()) return false;
  const Instant deadline = can_.sequenced_latch ? latch_at() : preload_from();
  if (wake_due_ && fits_before(latch_time_, deadline)) {
    wake_due_ = false;
    return took(driver_.start(now_), Operation::heartbeat, latch_time_);
  }
  bool under_way = false;
  bool ready = false;
  for (NodeState& node : nodes_) {
    if (node.right || node.verify || node.quarantined || rests(node) || waits(node)) continue;
    under_way = under_way || node.in_flight;
    ready = ready || node.pending == current_;
    if (node.in_flight || node.pending == current_) continue;
    // What the next switch has preloaded into this node is lost by a repair and has to find its time again.
    const Duration again = node.pending == next_ && next_ != current_ ? time_of(Operation::preload) : Duration{};
    if (!fits_before(time_of(Operation::preload) + time_of(Operation::latch) + again, deadline)) continue;
    return send_preload(node, current_);
  }
  if (under_way || !ready || !fits_before(time_of(Operation::latch), deadline) || !latch_current()) return false;
  for (NodeState& node : nodes_) {
    const bool repaired = node.pending == current_ && !node.right;
    if (repaired) node.pending = kNone;
    if (repaired && !can_.readback) on_confirmed(node);
    node.verify = can_.readback && !node.quarantined && !node.right && (node.verify || repaired || can_.pushes_status);
  }
  repeats_ = can_.sequenced_latch ? 1 : 0;
  return true;
}

// ---- before the next one

bool BusLoop::wants_preload(const NodeState& node) const noexcept {
  if (next_ == current_ || node.quarantined || node.in_flight || rests(node) || waits(node) ||
      (node.right && !node.changes)) {
    return false;
  }
  if (can_.sequenced_latch) return node.pending != next_;
  return node.offered != next_ || node.offers < passes_;
}

Duration BusLoop::preloads_left() const noexcept {
  Duration sum{};
  for (const NodeState& node : nodes_) {
    if (!wants_preload(node)) continue;
    const int sent = node.offered == next_ ? node.offers : 0;
    const int left = can_.sequenced_latch ? 1 : std::max(1, passes_ - sent);
    sum += left * preload_time_[node.address.channels];
  }
  return sum;
}

Instant BusLoop::preload_from() const noexcept {
  const Instant latch = latch_at();
  if (latch == kNever) return kNever;
  const Duration left = preloads_left();
  if (left.count() == 0) return latch;
  // Heartbeats go on meanwhile.
  const double beating = static_cast<double>(heartbeat_time_.count()) / drivers::kHeartbeatPeriod.count();
  const double stretch = kRepeats / std::max(1 - beating, kLeastWire);
  const auto room = Duration(static_cast<Duration::rep>(static_cast<double>(left.count()) * stretch));
  return latch - room - 2 * time_of(Operation::preload) - time_of(Operation::heartbeat);
}

bool BusLoop::in_hurry() const noexcept { return next_ != current_ && (unlatched_ || now_ >= preload_from()); }

bool BusLoop::preload_next() noexcept {
  if (!fits(time_of(Operation::preload))) return false;
  NodeState* least = nullptr;
  int fewest = 0;
  for (NodeState& node : nodes_) {
    if (!wants_preload(node)) continue;
    const int sent = node.offered == next_ ? node.offers : 0;
    if (least == nullptr || sent < fewest) {
      least = &node;
      fewest = sent;
    }
  }
  return least != nullptr && send_preload(*least, next_);
}

bool BusLoop::send_preload(NodeState& node, std::size_t k) noexcept {
  const drivers::SendStatus status = driver_.preload(node.address, sequence_of(k), looks(k, node), now_);
  if (!took(status, Operation::preload, preload_time_[node.address.channels])) return false;
  const bool again = node.offered == k;
  // Where nothing is receipted, a second pass before the moment is the rule and no retry.
  if (again && (can_.sequenced_latch || k == current_)) ++counters_.retries;
  node.offers = again ? static_cast<std::uint8_t>(std::min(node.offers + 1, 250)) : std::uint8_t{1};
  node.offered = k;
  node.pending = kNone;
  node.in_flight = true;
  if (k != current_ && !can_.sequenced_latch) unlatched_ = true;
  return true;
}

bool BusLoop::send_ask(NodeState& node) noexcept {
  if (!took(driver_.ask(node.address, now_), Operation::ask, status_time_)) return false;
  counters_.retries += node.misses > 0 ? 1 : 0;
  return true;
}

// ---- wearables

void BusLoop::follow_time() noexcept {
  if (now_ <= followed_at_) return;
  const bool goes = show_time_ != followed_;
  if (goes != goes_) sync_at_ = now_;
  goes_ = goes;
  followed_at_ = now_;
  followed_ = show_time_;
}

bool BusLoop::send_time() noexcept {
  if (worn_.empty() || now_ < sync_at_ || !fits(sync_time_time_)) return false;
  if (!took(driver_.sync_time(show_time_, goes_ ? rate_ : 0, now_), Operation::heartbeat, sync_time_time_))
    return false;
  sync_at_ = now_ + kTimeSync;
  return true;
}

/// What a wearable should tell now, then what it should tell after the next switch.
bool BusLoop::send_content() noexcept {
  if (worn_.empty() || !fits(std::max(content_time_, time_of(Operation::content)))) return false;
  const auto same = [&](std::size_t w, std::size_t a, std::size_t b) {
    return a != kNone && (a == b || schedule_->content(a, w) == schedule_->content(b, w));
  };
  for (WornState& worn : worn_) {
    const NodeState& node = nodes_[worn.position];
    if (node.quarantined || !node.right || node.shown == 0) continue;  // what it shows comes first
    if (!same(worn.index, worn.held, current_)) return send_content(worn, current_);
    worn.held = current_;
  }
  for (WornState& worn : worn_) {
    const NodeState& node = nodes_[worn.position];
    // A latch that a node does not need is not taken by it: then the content follows after the switch.
    if (next_ == current_ || node.quarantined || !node.changes || worn.pending == next_) continue;
    if (!same(worn.index, current_, next_)) return send_content(worn, next_);
  }
  return false;
}

bool BusLoop::send_content(WornState& worn, std::size_t k) noexcept {
  const NodeState& node = nodes_[worn.position];
  const drivers::SendStatus status = driver_.send_content(
      node.address, worn.channel, k == current_ ? node.shown : sequence_of(k), schedule_->content(k, worn.index), now_);
  if (!took(status, Operation::content, content_time_)) return false;
  sent_content_ = k;
  return true;
}

void BusLoop::on_content(const drivers::DeviceEvent& event) noexcept {
  for (WornState& worn : worn_) {
    if (nodes_[worn.position].address.node != event.node || worn.channel != event.detail) continue;
    (sent_content_ == current_ ? worn.held : worn.pending) = sent_content_;
  }
}

// ---- idle time

bool BusLoop::wants_check(const NodeState& node) noexcept {
  return node.keeps != Keeps::same && node.keeps != Keeps::untold;
}

/// All nodes are told which plan leads them, then each that shows what it should is asked, once, what it keeps.
bool BusLoop::check_plan() noexcept {
  if (!can_.keeps_checks || schedule_->checks().plan == 0) return false;
  if (!fits_before(time_of(Operation::keep), preload_from())) return false;
  for (NodeState& node : nodes_) {
    if (!wants_check(node) || !node.right || node.quarantined || rests(node) || now_ < node.keep_at) continue;
    if (!plan_told_) {
      plan_told_ = took(driver_.tell_plan(schedule_->checks().plan, now_), Operation::keep, upload_time_);
      return plan_told_;
    }
    if (!took(driver_.ask_kept(node.address, now_), Operation::keep, kept_time_)) return false;
    node.keep_at = now_ + kKeepAgain;
    if (++node.keep_asks > kKeepAsks) node.keeps = Keeps::untold;
    return true;
  }
  return false;
}

bool BusLoop::ask_quarantined(bool hopeful_only) noexcept {
  // Who answers a latch by itself needs no question.
  if (can_.pushes_status || !fits(std::max(time_of(Operation::ask), time_of(Operation::preload)))) return false;
  for (NodeState& node : nodes_) {
    if (!node.quarantined || node.in_flight || now_ < node.ask_at || (hopeful_only && !hopeful(node))) continue;
    if (can_.readback) {
      if (!send_ask(node)) return false;
    } else if (waits(node) || !may_latch_current() || !send_preload(node, current_)) {
      return false;
    }
    node.ask_at = now_ + node.backoff;
    return true;
  }
  return false;
}

bool BusLoop::refresh() noexcept {
  if (now_ >= table_refresh_at_ && schedule_->looks().size() > 1) {
    table_refresh_at_ = now_ + kTableRefresh;
    table_cursor_ = table_cursor_ + 1 < schedule_->looks().size() ? table_cursor_ + 1 : 1;
    if (uploads_[table_cursor_] == 0) uploads_[table_cursor_] = 1;
  }
  if (now_ < refresh_at_ || nodes_.empty()) return false;
  const auto count = static_cast<Duration::rep>(nodes_.size());
  if (can_.pushes_status) {
    const Duration answers = count * status_time_ + kAnswerWindow;
    if (awaits_status() || !may_latch_current() || !fits_before(latch_time_ + answers, preload_from())) {
      return false;
    }
    if (!latch_current()) return false;
    refresh_at_ = now_ + kSyncPoll;
    for (NodeState& node : nodes_) node.verify = !node.quarantined && !node.right;
    return true;
  }
  refresh_cursor_ = (refresh_cursor_ + 1) % nodes_.size();
  NodeState& node = nodes_[refresh_cursor_];
  if (can_.readback) {
    if (!fits(time_of(Operation::ask))) return false;
    refresh_at_ = now_ + std::max(kRefreshRound / count, 2 * status_time_);
    return !node.quarantined && !node.verify && send_ask(node);
  }
  // Sent again like a repair: what cannot be read back may have been switched off and on.
  refresh_at_ = now_ + std::max(kResendRound / count, 2 * preload_time_[kChannelsPerNode]);
  if (may_latch_current()) node.right = false;
  return may_latch_current();
}

Duration BusLoop::time_of(Operation operation) const noexcept {
  Duration budget = latch_time_;
  if (operation == Operation::ask) budget = status_time_;
  if (operation == Operation::preload) budget = preload_time_[kChannelsPerNode];
  if (operation == Operation::heartbeat) budget = heartbeat_time_;
  if (operation == Operation::upload) budget = upload_time_;
  if (operation == Operation::content) budget = content_time_;
  if (operation == Operation::keep) budget = std::max(kept_time_, upload_time_);
  return std::max(budget, longest_[static_cast<std::size_t>(operation)]);
}

bool BusLoop::fits_before(Duration time, Instant deadline) const noexcept {
  return deadline == kNever || std::max(line_free_, now_) + time <= deadline;
}

}  // namespace footlight::controller
