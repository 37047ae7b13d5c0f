// SPDX-License-Identifier: Apache-2.0
// What the nodes of a bus loop say, and what follows from it: confirmed, missed, refused, in quarantine, booted.
#include <algorithm>

#include "controller/bus_loop.hpp"

namespace footlight::controller {
namespace {

constexpr Duration kFirstBackoff = milliseconds(50);
constexpr Duration kFirstRest = milliseconds(20);  // of a device that is busy
constexpr Duration kLongestRest = milliseconds(640);
constexpr Duration kAskAgain = milliseconds(250);
constexpr Duration kLongestBackoff = milliseconds(1000);
constexpr Duration kHopeful = milliseconds(2500);  // T2: so long a node that is silent is asked more often
constexpr Duration kHopefulBackoff = milliseconds(100);
constexpr Duration::rep kHopefulShare = 3;  // and costs at most a quarter of the bus's idle time
constexpr std::uint8_t kMissesToQuarantine = 3;
constexpr std::uint8_t kOffersToMiss = 6;  // a node that answers and never shows what it was given is as good as silent
constexpr Duration kKeepWrong = milliseconds(2000);  // until a node that keeps the wrong thing is asked again
constexpr std::uint8_t kPlanTold = 8;  // times that a node is told of the plan and still keeps another one
constexpr Duration kRetryDown = milliseconds(100);
constexpr std::uint8_t kStateShowing = 1;
constexpr std::uint8_t kStateHold = 2;

}  // namespace

BusLoop::NodeState* BusLoop::find(NodeIndex node) noexcept {
  const std::int32_t position = node.at() < by_node_.size() ? by_node_[node.at()] : -1;
  return position < 0 ? nullptr : &nodes_[static_cast<std::size_t>(position)];
}

void BusLoop::on_event(const drivers::DeviceEvent& event) {
  using Kind = drivers::DeviceEvent::Kind;
  if (event.kind == Kind::bus_down || event.kind == Kind::bus_up) {
    down_until_ = event.kind == Kind::bus_down ? now_ + kRetryDown : now_;
    for (NodeState& node : nodes_) {
      node.right = false;
      node.in_flight = false;
      node.pending = kNone;
      node.verify = can_.readback && can_.sequenced_latch;
    }
    return;
  }
  NodeState* node = find(event.node);
  if (node == nullptr) return;
  switch (event.kind) {
    case Kind::preloaded:
      node->in_flight = false;
      node->stale = false;
      node->rest = {};
      if (node->offered != kNone && event.sequence == sequence_of(node->offered)) node->pending = node->offered;
      if (!can_.pushes_status) {
        if (node->offers < kOffersToMiss) node->misses = 0;
        if (!can_.readback) node->quarantined = false;
      }
      break;
    case Kind::showing:
      on_showing(*node, event);
      break;
    case Kind::booted:
      on_boot(*node);
      break;
    case Kind::missed:
      on_miss(*node);
      break;
    case Kind::fenced:
      on_fenced(*node);
      break;
    case Kind::rejected:
      on_refusal(*node, event.again);
      break;
    case Kind::content:
      node->misses = 0;
      on_content(event);
      break;
    case Kind::keeps:
      on_keeps(*node, event.kept);
      break;
    case Kind::bus_down:
    case Kind::bus_up:
      break;
  }
}

void BusLoop::on_showing(NodeState& node, const drivers::DeviceEvent& event) noexcept {
  const bool fresh = event.sequence == sequence_of(current_);
  node.shown = event.sequence;
  const bool guides = event.state == kStateShowing || event.state == kStateHold;
  const bool as_told = guides && event.crc == node.crc && (node.right || fresh);
  if (!as_told && (fresh || !can_.pushes_status) && node.offered == current_ && node.offers >= kOffersToMiss) {
    // Its misses go on in a row. Another question would be answered as this one: it is offered its looks again.
    node.right = false;
    on_miss(node);
    node.verify = false;
    if (node.quarantined) rest_for_long(node);
    return;
  }
  node.misses = 0;
  node.quarantined = false;
  if (as_told) {
    node.verify = false;
    on_confirmed(node);
    return;
  }
  if (can_.pushes_status && !fresh) return;  // an answer to the latch before
  node.right = false;
  node.verify = false;
}

void BusLoop::on_confirmed(NodeState& node) noexcept {
  node.right = true;
  node.rest = {};
  if (node.counted) return;
  node.counted = true;
  (can_.readback ? counters_.deliveries : counters_.unverified) += changed_channels(node);
}

void BusLoop::on_miss(NodeState& node) noexcept {
  ++counters_.misses;
  node.in_flight = false;
  if (node.misses == 0) node.silent_since = now_;
  if (!can_.readback) node.right = false;  // perhaps what it was given has not reached it
  if (can_.pushes_status) {
    // Unconfirmed: it gets preload and latch again. Who was right before has most often lost an answer, no more; it is
    // asked again soon.
    node.verify = false;
    if (node.misses > 0) node.right = false;
    if (node.right) refresh_at_ = std::min(refresh_at_, now_ + kAskAgain);
    wake_due_ = wake_due_ || (!node.right && !node.quarantined);
  } else if (node.offered != next_ || node.pending == next_) {
    node.verify = can_.readback;  // a question was missed: ask again at once
  }
  if (node.quarantined) {
    node.verify = false;
    wait_after_miss(node);
    return;
  }
  if (++node.misses >= kMissesToQuarantine) quarantine(node);
}

/// Most often it has lost the frame that says who leads now, and with it all that was sent to everybody since.
void BusLoop::on_fenced(NodeState& node) noexcept {
  heartbeat_at_ = now_;
  for (std::size_t i = 1; i < schedule_->looks().size(); ++i) uploads_[i] = std::max(uploads_[i], std::uint8_t{1});
  need_looks(current_, node);
  need_looks(next_, node);
  on_miss(node);
  if (node.quarantined) rest_for_long(node);  // somebody else's for good
}

void BusLoop::on_refusal(NodeState& node, drivers::DeviceEvent::Again again) noexcept {
  using Again = drivers::DeviceEvent::Again;
  if (again == Again::later && !node.quarantined && node.rest < kLongestRest) {
    node.in_flight = false;
    node.rest = std::max(kFirstRest, 2 * node.rest);
    node.rests_until = now_ + node.rest;
    return;
  }
  if (again == Again::soon) return on_miss(node);
  ++counters_.misses;
  node.in_flight = false;
  if (!node.quarantined) quarantine(node);
  rest_for_long(node);
}

void BusLoop::rest_for_long(NodeState& node) noexcept {
  node.backoff = kLongestBackoff;
  node.ask_at = now_ + node.backoff;
}

void BusLoop::quarantine(NodeState& node) noexcept {
  ++counters_.quarantines;
  node.quarantined = true;
  node.right = false;
  node.verify = false;
  node.pending = kNone;
  node.offered = kNone;
  node.backoff = kFirstBackoff;
  node.ask_at = now_ + node.backoff;
}

void BusLoop::on_keeps(NodeState& node, const drivers::KeptChecks& kept) noexcept {
  const WantedChecks& wanted = schedule_->checks();
  const std::size_t n = node.address.node.at();
  node.keep_asks = 0;
  if (kept.plan != wanted.plan) {
    plan_told_ = false;  // it has missed the word; others may have, too
    const bool missed = ++node.other_plans < kPlanTold;
    node.keep_at = missed ? now_ : now_ + kKeepWrong;
    if (missed) return;
    node.other_plans = kPlanTold;
    node.keeps = Keeps::other_plan;
    return;
  }
  const bool same = n >= wanted.patches.size() || kept.patch == wanted.patches[n];
  node.keeps = same ? Keeps::same : kept.patch == 0 ? Keeps::no_patch : Keeps::other_patch;
  node.other_plans = 0;
  node.keep_at = now_ + kKeepWrong;
}

void BusLoop::forget_checks() noexcept {
  plan_told_ = false;
  for (NodeState& node : nodes_) {
    node.keeps = Keeps::unknown;
    node.keep_asks = 0;
    node.other_plans = 0;
    node.keep_at = now_;
  }
}

bool BusLoop::hopeful(const NodeState& node) const noexcept { return now_ - node.silent_since < kHopeful; }

/// A node that has answered a moment ago is more likely to be misheard than dead: a bad line takes many answers in a
/// row, and a second between two questions would leave its lamps wrong for as long.
void BusLoop::wait_after_miss(NodeState& node) noexcept {
  Duration most = kLongestBackoff;
  if (hopeful(node)) {
    most = std::max(kHopefulBackoff, kHopefulShare * longest_[static_cast<std::size_t>(Operation::ask)]);
  }
  node.backoff = std::min(2 * node.backoff, most);
  node.ask_at = now_ + node.backoff;
}

void BusLoop::on_boot(NodeState& node) noexcept {
  ++counters_.boots;
  ++node.boots;
  node.misses = 0;
  node.quarantined = false;
  node.right = false;
  node.verify = false;
  node.in_flight = false;
  node.pending = kNone;
  node.offered = kNone;
  node.keeps = Keeps::unknown;
  node.keep_asks = 0;
  node.other_plans = 0;
  if (node.switch_on.stagger.count() > 0 && node.turn <= now_) {
    // Its supply may have been off: then all of its nodes come back at the same time.
    Instant& next = next_turn_[node.switch_on.supply];
    node.turn = std::max(now_, next);
    next = node.turn + node.switch_on.stagger;
  }
  for (WornState& worn : worn_) {
    if (&nodes_[worn.position] == &node) worn.held = worn.pending = kNone;
  }
  // It has lost its look table, too: first what it must show, the rest in idle time.
  for (std::size_t i = 1; i < schedule_->looks().size(); ++i) uploads_[i] = std::uint8_t{kUploads};
  need_looks(current_, node);
  need_looks(next_, node);
}

void BusLoop::need_looks(std::size_t k, const NodeState& node) noexcept {
  for (const LookIndex look : looks(k, node)) urgent_[look] = look != kDark;
}

}  // namespace footlight::controller
