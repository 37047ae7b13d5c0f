// SPDX-License-Identifier: Apache-2.0
// Where a bus loop stands in the show and what others may know of it. What its nodes answer: bus_answers.cpp; what it
// sends: bus_work.cpp.
#include "controller/bus_loop.hpp"

#include <algorithm>

#include "core/check.hpp"

namespace footlight::controller {
namespace {

constexpr Duration kSuspect = milliseconds(1000);  // T1 of the trust model
constexpr double kPollShare = 0.2;                 // of the bus, for the promise of T1
constexpr int kMostOperations = 64;                // a step ends, whatever a driver says
constexpr Duration kRetryBusy = milliseconds(1);
constexpr Duration kPutOff = milliseconds(100);  // a switch that is put off by more has been called off

}  // namespace

BusLoop::BusLoop(const CueSchedule& schedule, std::vector<drivers::NodeAddress> nodes, drivers::Driver& driver,
                 const std::vector<SwitchOn>& switch_on)
    : schedule_(&schedule), driver_(driver), can_(driver.capabilities()) {
  latch_time_ = driver.latch_time();
  status_time_ = driver.status_time();
  heartbeat_time_ = driver.heartbeat_time();
  upload_time_ = driver.upload_time();
  for (int channels = 1; channels <= kChannelsPerNode; ++channels) {
    preload_time_[static_cast<std::size_t>(channels)] = driver.preload_time(channels);
  }
  std::size_t most = 0;
  for (const drivers::NodeAddress& address : nodes) most = std::max(most, address.node.at() + 1);
  by_node_.assign(most, -1);
  for (const drivers::NodeAddress& address : nodes) {
    by_node_[address.node.at()] = static_cast<std::int32_t>(nodes_.size());
    NodeState& node = nodes_.emplace_back();
    node.address = address;
    if (switch_on.empty()) continue;
    node.switch_on = switch_on[address.node.at()];
    next_turn_.resize(std::max(next_turn_.size(), node.switch_on.supply + 1));
  }
  for (std::size_t i = 1; i < schedule.looks().size(); ++i) {
    uploads_[i] = std::uint8_t{kUploads};
    urgent_[i] = true;
  }
  content_time_ = driver.content_time();
  kept_time_ = driver.kept_time();
  sync_time_time_ = driver.sync_time_time();
  worn_ = worn_in(schedule);
}

std::vector<BusLoop::WornState> BusLoop::worn_in(const CueSchedule& schedule) const {
  std::vector<WornState> out;
  const auto& worn = schedule.contents().worn;
  for (std::size_t w = 0; w < worn.size() && can_.contents; ++w) {
    const std::size_t node = worn[w].node.at();
    if (node >= by_node_.size() || by_node_[node] < 0) continue;
    out.push_back({w, static_cast<std::size_t>(by_node_[node]), worn[w].channel});
  }
  return out;
}

std::unique_ptr<BusLoop::Part> BusLoop::part_of(const CueSchedule& schedule, const CueSchedule& before) const {
  auto part = std::make_unique<Part>();
  part->schedule = &schedule;
  part->worn = worn_in(schedule);
  for (std::size_t i = 1; i < schedule.looks().size(); ++i) {
    part->fresh[i] = i >= before.looks().size() || schedule.looks()[i] != before.looks()[i];
  }
  return part;
}

Instant BusLoop::step(Instant now, const BusTarget& target) noexcept {
  if (nodes_.empty()) return kNever;  // nobody hears: on CAN not even an acknowledgement comes
  now_ = now;
  show_time_ = target.show_time;
  rate_ = target.rate;
  refused_ = false;
  if (taking_ != nullptr) {
    // What is under way belongs to the schedule before.
    const Instant again = driver_.ready() ? now : driver_.step(now, *this);
    if (!driver_.ready()) return again;
    note_end();
    go_over(target.current);
  }
  follow(target);
  follow_time();
  Instant driver_wish = driver_.step(now, *this);
  for (int i = 0; i < kMostOperations && now >= down_until_; ++i) {
    note_end();
    if (!driver_.ready() || !act()) break;
    follow(target);
    driver_wish = driver_.step(now, *this);
  }
  return wish(driver_wish);
}

void BusLoop::note_end() noexcept {
  if (under_way_ == Operation::none || !driver_.ready()) return;
  // A driver with a queue is ready before its frames are on the wire: there the estimate stands.
  if (!can_.pushes_status) {
    const Duration most = 4 * preload_time_[kChannelsPerNode] + milliseconds(100);
    Duration& longest = longest_[static_cast<std::size_t>(under_way_)];
    longest = std::clamp(now_ - since_, longest, std::max(longest, most));
    line_free_ = now_;
  }
  under_way_ = Operation::none;
}

Instant BusLoop::wish(Instant driver_wish) const noexcept {
  Instant earliest = driver_wish;
  const auto consider = [&](Instant instant) {
    if (instant > now_) earliest = std::min(earliest, instant);
  };
  consider(latch_at());
  if (next_ != current_) consider(next_at_);
  consider(preload_from());
  consider(heartbeat_at_);
  consider(refresh_at_);
  consider(table_refresh_at_);
  if (can_.keeps_time) consider(sync_at_);
  consider(down_until_);
  for (const NodeState& node : nodes_) {
    if (node.misses > 0 && !can_.pushes_status) consider(node.ask_at);
    if (node.rest.count() > 0) consider(node.rests_until);
    consider(node.turn);
    if (can_.keeps_checks && wants_check(node)) consider(node.keep_at);
  }
  if (refused_) consider(now_ + kRetryBusy);
  return earliest;
}

// ---- where the show stands

void BusLoop::follow(const BusTarget& target) noexcept {
  if (!placed_) {
    placed_ = true;
    give_turns();
    seek(target.current);
    for (NodeState& node : nodes_) node.counted = target.current != 0;
  }
  if (target.current == current_) {
    aim(target.next, target.next_at);
  } else if (target.current == next_) {
    // Due already and not latched yet: `latch_next` does so as soon as the wire is free.
    next_at_ = std::min(next_at_, now_);
  } else if (target.current != previous_ || target.next != current_ ||
             (target.next_at != kNever ? target.next_at - now_ > latch_time_ + kPutOff : true)) {
    seek(target.current);  // else: latched ahead by its own time on the wire
    aim(target.next, target.next_at);
  }
}

void BusLoop::aim(std::size_t next, Instant at) noexcept {
  if (next == next_ && at == next_at_) return;
  // Where a latch takes whatever is pending, looks that were preloaded for a moment that is called off have to go, or
  // no question could be asked until another moment came.
  const bool called_off = next != next_ || at == kNever || (next_at_ != kNever && at - next_at_ > kPutOff);
  if (unlatched_ && called_off && !can_.sequenced_latch) seek(current_);
  if (next != next_) {
    for (NodeState& node : nodes_) {
      node.stale = node.stale || (node.offered == next_ && next_ != current_);
      node.changes = next != current_ && (node.stale || !std::ranges::equal(looks(current_, node), looks(next, node)));
    }
  }
  next_ = next;
  next_at_ = at;
  passes_ = 1;
  if (can_.sequenced_latch || at == kNever) return;
  passes_ = 2;
  if (at - now_ < 4 * preloads_left()) passes_ = 1;
}

/// At the start: in the order of the rig, over all buses.
void BusLoop::give_turns() noexcept {
  for (NodeState& node : nodes_) {
    node.turn = now_ + node.switch_on.turn;
    if (node.switch_on.stagger.count() > 0) next_turn_[node.switch_on.supply] = node.turn + node.switch_on.stagger;
  }
}

void BusLoop::seek(std::size_t k) noexcept {
  for (NodeState& node : nodes_) {
    node.stale = node.stale || (node.offered == next_ && next_ != current_);
  }
  previous_ = kNone;
  current_ = k;
  next_ = k;
  next_at_ = kNever;
  unlatched_ = false;
  repeats_ = 0;
  for (NodeState& node : nodes_) {
    node.crc = drivers::looks_crc(looks(k, node));
    node.right = false;
    // Whoever shows it already stays as it is; without a sequence something unknown may be pending, which a question
    // by SYNC would light: there the preload comes first.
    node.verify = can_.readback && can_.sequenced_latch && !node.stale;
    node.changes = false;
    node.counted = true;
    node.pending = kNone;
    node.offered = kNone;
    node.offers = 0;
  }
}

void BusLoop::go_over(std::size_t k) noexcept {
  const CueSchedule& before = *schedule_;
  schedule_ = taking_->schedule;
  worn_.swap(taking_->worn);
  sent_content_ = kNone;
  for (std::size_t i = 0; i < taking_->fresh.size(); ++i) {
    if (!taking_->fresh[i]) continue;
    uploads_[i] = std::uint8_t{kUploads};
    urgent_[i] = true;
  }
  driver_.take_plan(schedule_->plan_byte());
  forget_checks();
  const std::size_t old = current_;
  for (NodeState& node : nodes_) {
    const bool preloaded = node.stale || (node.offered == next_ && next_ != current_);
    const auto shown = before.looks_of(old, node.address.node).first(node.address.channels);
    node.stays = node.right && !preloaded && std::ranges::equal(shown, looks(k, node));
  }
  seek(k);
  placed_ = true;
  for (NodeState& node : nodes_) {
    if (!node.stays) continue;
    node.right = true;
    node.verify = false;
  }
  taking_ = nullptr;
}

void BusLoop::switch_over(bool latched) noexcept {
  previous_ = current_;
  current_ = next_;
  next_at_ = kNever;
  unlatched_ = false;
  repeats_ = latched && can_.sequenced_latch ? 1 : 0;
  for (WornState& worn : worn_) {
    if (latched && worn.pending == current_) worn.held = current_;
    worn.pending = kNone;
  }
  for (NodeState& node : nodes_) {
    const bool offered = node.offered == current_;
    const bool receipted = node.pending == current_;
    if (node.changes) {
      node.crc = drivers::looks_crc(looks(current_, node));
      node.right = false;
      node.counted = false;
    }
    node.changes = false;
    node.pending = kNone;
    if (node.quarantined) {
      node.verify = false;
    } else if (!can_.readback) {
      if (latched && receipted) on_confirmed(node);
    } else {
      node.verify = latched && !node.right && (offered || can_.pushes_status);
    }
  }
}

// ---- what others may know

bool BusLoop::settled() const noexcept {
  if (nodes_.empty()) return true;
  if (!started_) return false;
  for (std::size_t i = 1; i < schedule_->looks().size(); ++i) {
    if (urgent_[i] && uploads_[i] > 0) return false;
  }
  return std::ranges::all_of(nodes_, [](const NodeState& node) { return node.right || node.quarantined; });
}

std::size_t BusLoop::unconfirmed() const noexcept {
  return static_cast<std::size_t>(std::ranges::count_if(nodes_, [](const NodeState& node) { return !node.right; }));
}

std::vector<NodeIndex> BusLoop::quarantined() const {
  std::vector<NodeIndex> list;
  for (const NodeState& node : nodes_) {
    if (node.quarantined) list.push_back(node.address.node);
  }
  return list;
}

Duration BusLoop::notice(const CueSchedule& schedule, std::size_t from, std::size_t to) const noexcept {
  if (can_.sequenced_latch) {
    // What is on the wire at the GO ends, then the latch takes its time.
    return latch_time_ +
           std::max({status_time_, heartbeat_time_, upload_time_, preload_time_[kChannelsPerNode], kept_time_});
  }
  Duration sum{};
  for (const NodeState& node : nodes_) {
    const auto of = [&](std::size_t k) { return schedule.looks_of(k, node.address.node).first(node.address.channels); };
    if (!std::ranges::equal(of(from), of(to))) sum += preload_time_[node.address.channels];
  }
  return 3 * sum + 2 * latch_time_ + milliseconds(20);
}

Duration BusLoop::suspect_time() const {
  const Duration round = static_cast<Duration::rep>(nodes_.size()) * status_time_;
  return std::max(kSuspect,
                  can_.pushes_status
                      ? kSuspect
                      : Duration(static_cast<Duration::rep>(static_cast<double>(round.count()) / kPollShare)));
}

std::span<const LookIndex> BusLoop::looks(std::size_t k, const NodeState& node) const noexcept {
  return schedule_->looks_of(k, node.address.node).first(node.address.channels);
}

std::uint64_t BusLoop::changed_channels(const NodeState& node) const noexcept {
  const auto now = looks(current_, node);
  std::uint64_t changed = 0;
  for (std::size_t c = 0; c < now.size(); ++c) {
    changed += now[c] != (previous_ == kNone ? kDark : looks(previous_, node)[c]) ? 1 : 0;
  }
  return changed;
}

}  // namespace footlight::controller
