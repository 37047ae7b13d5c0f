// SPDX-License-Identifier: Apache-2.0
#include "drivers/devices/canopen/canopen_driver.hpp"

#include <algorithm>
#include <type_traits>
#include <variant>

#include "core/check.hpp"

namespace footlight::drivers {
namespace {

// Frames that may stand in the port's queue after a preload. SocketCAN's default queue holds ten: two places stay free
// for a heartbeat and an NMT start, and a latch never waits for more than this.
constexpr std::size_t kWindow = 8;
constexpr std::size_t kMostFrames = 4;  // of one operation
constexpr int kFramesPerStep = 256;     // a flood must not keep us from sending
constexpr Duration kSilence = milliseconds(2500);
constexpr Duration kAway = milliseconds(600);  // more than two heartbeats: the machine stood still, or its cue thread
constexpr Duration kLongestTurnaround = milliseconds(5);
constexpr Duration kNodeHeartbeatPeriod = milliseconds(1000);
constexpr Duration kMargin = milliseconds(10);     // scheduling of the machine, a late node
constexpr Duration kLookAtBus = milliseconds(20);  // while frames wait or the bus is down: nothing else may tell

constexpr std::uint8_t kBootUp = 0;
constexpr std::uint8_t kStopped = 4;
constexpr std::uint8_t kOperational = 5;
constexpr std::uint8_t kPreOperational = 127;

}  // namespace

CanopenDriver::CanopenDriver(CanPort& port, const std::vector<NodeAddress>& nodes,
                             const std::optional<OutputModule>& modules, Leadership* leadership)
    : port_(port), leadership_(leadership), lead_due_(leadership != nullptr) {
  if (modules) setup_.emplace(*modules, nodes);
  lit_.fill(true);
  lit_[kDark] = false;
  by_address_.fill(-1);
  for (const NodeAddress& address : nodes) {
    FL_CHECK(address.address >= 1 && address.address <= canopen::kLastNode);
    FL_CHECK(by_address_[address.address] < 0);
    by_address_[address.address] = static_cast<std::int16_t>(nodes_.size());
    NodeState node;
    node.address = address;
    nodes_.push_back(node);
  }
}

Capabilities CanopenDriver::capabilities() const {
  Capabilities can;
  can.sequenced_latch = false;
  can.pushes_status = !setup_;
  can.keeps_checks = !setup_;
  if (!setup_) return can;
  can.readback = false;
  can.proves_looks = false;
  can.lease = setup_->module().on_failure != OutputModule::OnFailure::keep;
  return can;
}

Duration CanopenDriver::preload_time(int channels) const {
  if (setup_) return port_.wire_time(canopen::outputs(setup_->module(), 1, {}));
  const std::vector<LookIndex> looks(static_cast<std::size_t>(channels));
  Duration sum{};
  for (const CanFrame& frame : canopen::preload(1, looks)) sum += port_.wire_time(frame);
  return sum;
}

Duration CanopenDriver::status_time() const { return setup_ ? Duration{} : frame_time(); }

Duration CanopenDriver::latch_time() const {
  return port_.wire_time(setup_ ? canopen::plain_sync() : canopen::sync(kLastSequence));
}

Duration CanopenDriver::heartbeat_time() const {
  const Duration lead = leadership_ == nullptr ? Duration{} : port_.wire_time(canopen::lead(0));
  return lead + port_.wire_time(canopen::controller_heartbeat());
}

Duration CanopenDriver::node_heartbeats_time() const {
  const Duration period = setup_ ? setup_->module().heartbeat : kNodeHeartbeatPeriod;
  const double in_one_period = static_cast<double>(kHeartbeatPeriod.count()) / static_cast<double>(period.count());
  const auto all = static_cast<Duration::rep>(nodes_.size()) * port_.wire_time(canopen::controller_heartbeat());
  return Duration(static_cast<Duration::rep>(static_cast<double>(all.count()) * in_one_period));
}

Duration CanopenDriver::upload_time() const {
  Duration sum{};
  if (setup_) return sum;
  for (const CanFrame& frame : canopen::look_entry(1, Look{})) sum += port_.wire_time(frame);
  return sum;
}

bool CanopenDriver::ready() const {
  if (silent_ && !down()) return false;
  // A module's preload has no receipt and no answer to its latch: here nothing else may stand before the latch.
  if (setup_ && !down() && port_.queued() > 0) return false;
  return down() || (outbox_.empty() && (!service_ || service_->of_show) &&
                    port_.queued() + kMostFrames <= kWindow);  // down: to be told so, not to wait
}

SendStatus CanopenDriver::start(Instant now) {
  if (down()) return SendStatus::down;
  if (!ready()) return SendStatus::busy;
  // Modules are started one by one, when they are set up.
  const auto command = setup_ ? canopen::NmtCommand::pre_operational : canopen::NmtCommand::start;
  const SendStatus status = hand_over(canopen::nmt(command, 0));
  if (status != SendStatus::accepted) return status;
  started_ = true;
  for (NodeState& node : nodes_) {
    node.heard = now;
    if (setup_) setup_->want(node.address.unit(), now);
  }
  return status;
}

SendStatus CanopenDriver::preload(const NodeAddress& node, Sequence sequence, std::span<const LookIndex> looks,
                                  Instant /*now*/) {
  FL_CHECK(sequence >= 1 && sequence <= kLastSequence);
  FL_CHECK(looks.size() == node.channels);
  if (down()) return SendStatus::down;
  if (!ready()) return SendStatus::busy;
  if (setup_) {
    if (!setup_->is_set_up(node.unit())) {
      DeviceEvent event{DeviceEvent::Kind::rejected, node.node, sequence};
      event.again = setup_->refuses(node.unit()) ? DeviceEvent::Again::never : DeviceEvent::Again::later;
      told_later_.push_back(event);
      return SendStatus::accepted;
    }
    std::vector<bool> lit;
    for (const LookIndex look : looks) lit.push_back(lit_[look]);
    outbox_.push_back(canopen::outputs(setup_->module(), node.unit(), lit));
  } else {
    for (const CanFrame& frame : canopen::preload(node.unit(), looks)) outbox_.push_back(frame);
  }
  leaving_ = Preload{node.node, sequence, 0};
  unlatched_ = true;
  pump();
  if (!down()) return SendStatus::accepted;
  outbox_.clear();
  leaving_.reset();
  return SendStatus::down;
}

SendStatus CanopenDriver::latch(Sequence sequence, Instant now) {
  FL_CHECK(sequence >= 1 && sequence <= kLastSequence);
  return send_sync(sequence, now);
}

SendStatus CanopenDriver::heartbeat(Duration /*show_time*/, Instant /*now*/) {
  lead_due_ = lead_due_ || (leadership_ != nullptr && ++beats_since_lead_ % kBeatsALead == 0);
  return hand_over(canopen::controller_heartbeat());
}

SendStatus CanopenDriver::ask(const NodeAddress& node, Instant now) {
  const NodeState* state = find(node.unit());
  FL_CHECK(state != nullptr);
  if (state->awaits_status) return SendStatus::accepted;  // the last SYNC has asked already
  if (unlatched_) return SendStatus::busy;
  return send_sync(last_sequence_ == 0 ? kLastSequence : last_sequence_, now);
}

SendStatus CanopenDriver::upload_look(LookIndex index, const Look& look, Instant /*now*/) {
  if (down()) return SendStatus::down;
  if (!ready()) return SendStatus::busy;
  if (setup_) {
    lit_[index] = index != kDark && look.brightness > 0 && look.colour != Colour{};
    return SendStatus::accepted;
  }
  for (const CanFrame& frame : canopen::look_entry(index, look)) outbox_.push_back(frame);
  pump();
  if (!down()) return SendStatus::accepted;
  outbox_.clear();
  return SendStatus::down;
}

SendStatus CanopenDriver::hand_over(const CanFrame& frame) {
  if (silent_) return SendStatus::busy;
  if (lead_due_) {
    const SendStatus led = port_.send(canopen::lead(leadership_->epoch));
    if (led != SendStatus::accepted) return down() ? SendStatus::down : led;
    ++handed_over_;
    lead_due_ = false;
  }
  const SendStatus status = port_.send(frame);
  if (status == SendStatus::accepted) ++handed_over_;
  return down() ? SendStatus::down : status;
}

SendStatus CanopenDriver::send_sync(Sequence sequence, Instant now) {
  if (down()) return SendStatus::down;
  if (!outbox_.empty()) return SendStatus::busy;
  // Modules know no counter, and one that they do not expect is an error for them (CiA 301, EMCY 0x8240).
  const SendStatus status = hand_over(setup_ ? canopen::plain_sync() : canopen::sync(sequence));
  if (status != SendStatus::accepted) return status;
  last_sequence_ = sequence;
  unlatched_ = false;
  if (setup_) return status;
  for (NodeState& node : nodes_) node.awaits_status = true;
  const auto frames = static_cast<Duration::rep>(port_.queued() + nodes_.size());
  status_deadline_ = now + frames * status_time() + kLongestTurnaround + kMargin;
  return status;
}

void CanopenDriver::pump() {
  for (NodeState& node : nodes_) {
    if (!node.start_due) continue;
    if (hand_over(canopen::nmt(canopen::NmtCommand::start, node.address.unit())) != SendStatus::accepted) return;
    node.start_due = false;
  }
  while (!outbox_.empty()) {
    if (hand_over(outbox_.front()) != SendStatus::accepted) return;
    outbox_.pop_front();
  }
  if (leaving_) {
    leaving_->last_frame = handed_over_;
    on_the_way_.push_back(*leaving_);
    leaving_.reset();
  }
}

/// It is another controller's; which one leads is a matter of the epoch alone.
void CanopenDriver::hear_lead(std::uint32_t epoch, Instant now) {
  if (leadership_ == nullptr || epoch == leadership_->epoch) return;
  if (epoch > leadership_->epoch) return fall_silent(now);
  lead_due_ = true;
}

void CanopenDriver::fall_silent(Instant now) {
  leadership_->refusals.fetch_add(1, std::memory_order_relaxed);
  silent_ = true;
  silent_until_ = now + kSilence;
  outbox_.clear();
  leaving_.reset();
}

Instant CanopenDriver::step(Instant now, EventSink& events) {
  // Who was away may have been replaced: that is asked before anything else is said.
  if (leadership_ != nullptr && stepped_at_ != kNever && now - stepped_at_ > kAway) lead_due_ = true;
  stepped_at_ = now;
  if (silent_ && now >= silent_until_) {
    silent_ = false;
    lead_due_ = true;
  }
  CanFrame frame;
  int heard = 0;
  while (heard < kFramesPerStep && port_.receive(frame)) {
    ++heard;
    hear(frame, now, events);
  }
  for (const DeviceEvent& event : told_later_) events.on_event(event);
  told_later_.clear();
  if (setup_) set_up_on(now, events);
  serve_on(now, events);
  pump();
  tell_preloads(events);
  tell_bus(now, events);
  Instant next = tell_missed(now, events);
  const bool starting = std::any_of(nodes_.begin(), nodes_.end(), [](const NodeState& node) { return node.start_due; });
  const bool leaving = !outbox_.empty() || port_.queued() + kMostFrames > kWindow || !on_the_way_.empty();
  const bool not_ready = setup_ && port_.queued() > 0;
  if (!down() && (leaving || starting || not_ready)) next = std::min(next, now + frame_time());
  if (setup_ && !down() && started_) next = std::min(next, std::max(now, setup_->next()));
  if (service_) next = std::min(next, service_->deadline);
  if (silent_) next = std::min(next, silent_until_);
  if (down() || port_.queued() > 0) next = std::min(next, now + kLookAtBus);
  return heard == kFramesPerStep ? now : next;
}

void CanopenDriver::hear(const CanFrame& frame, Instant now, EventSink& events) {
  if (const auto epoch = canopen::lead_in(frame)) return hear_lead(*epoch, now);
  hear_sdo(frame, now);
  if (setup_) setup_->hear(frame, now);
  const canopen::Heard heard = canopen::decode(frame);
  const auto visit = [&](const auto& message) {
    if constexpr (!std::is_same_v<std::decay_t<decltype(message)>, std::monostate>) {
      NodeState* node = find(message.node);
      if (node == nullptr) return;
      node->heard = now;
      if constexpr (std::is_same_v<std::decay_t<decltype(message)>, canopen::StatusPdo>) {
        if (!setup_) hear_status(*node, message, events);  // of a module it says what its inputs are
      } else if constexpr (std::is_same_v<std::decay_t<decltype(message)>, canopen::NodeHeartbeat>) {
        hear_heartbeat(*node, message.state, events);
      } else if (message.code == canopen::kFencedEmergency && leadership_ != nullptr) {
        hear_lead(message.epoch, now);  // whoever was refused
        lead_due_ = lead_due_ || message.epoch == leadership_->epoch;
      } else if (message.code != 0) {
        DeviceEvent event{DeviceEvent::Kind::rejected, node->address.node};
        event.detail = message.code;
        events.on_event(event);
      }
    }
  };
  std::visit(visit, heard);
}

void CanopenDriver::hear_status(NodeState& node, const canopen::StatusPdo& status, EventSink& events) {
  node.operational = true;
  if (node.boots && *node.boots != status.boots) {
    events.on_event({DeviceEvent::Kind::booted, node.address.node});
  }
  node.boots = status.boots;
  if (status.shown_sequence == last_sequence_) node.awaits_status = false;
  DeviceEvent event{DeviceEvent::Kind::showing, node.address.node, status.shown_sequence};
  event.crc = status.crc;
  event.state = status.state;
  event.boots = status.boots;
  events.on_event(event);
}

void CanopenDriver::hear_heartbeat(NodeState& node, std::uint8_t state, EventSink& events) {
  // Pre-operational after operational: it has restarted and its boot-up message was lost.
  if (state == kBootUp || (state == kPreOperational && node.operational)) {
    node.boots.reset();
    events.on_event({DeviceEvent::Kind::booted, node.address.node});
    if (setup_ && started_) setup_->want(node.address.unit(), node.heard);
  }
  node.operational = state == kOperational;
  const bool waits = state == kBootUp || state == kStopped || state == kPreOperational;
  if (!setup_) {
    node.start_due = started_ && waits;
  } else if (started_ && waits && setup_->is_set_up(node.address.unit())) {
    node.start_due = true;  // its start was lost, and so was what it has been sent since
    events.on_event({DeviceEvent::Kind::missed, node.address.node});
  }
}

void CanopenDriver::tell_preloads(EventSink& events) {
  const std::uint64_t on_the_wire = handed_over_ - std::min<std::uint64_t>(handed_over_, port_.queued());
  while (!on_the_way_.empty() && on_the_way_.front().last_frame <= on_the_wire) {
    const Preload& preload = on_the_way_.front();
    events.on_event({DeviceEvent::Kind::preloaded, preload.node, preload.sequence});
    on_the_way_.pop_front();
  }
}

void CanopenDriver::tell_bus(Instant now, EventSink& events) {
  if (down()) {
    if (leaving_) on_the_way_.push_back(*leaving_);
    for (const Preload& preload : on_the_way_) {
      events.on_event({DeviceEvent::Kind::missed, preload.node, preload.sequence});
    }
    leaving_.reset();
    on_the_way_.clear();
    outbox_.clear();
    if (setup_) setup_->abandon(now);
  }
  if (down() == down_told_) return;
  down_told_ = down();
  DeviceEvent event{down() ? DeviceEvent::Kind::bus_down : DeviceEvent::Kind::bus_up, NodeIndex{}};
  event.detail = static_cast<std::uint16_t>(port_.state());
  events.on_event(event);
}

Instant CanopenDriver::tell_missed(Instant now, EventSink& events) {
  const bool overdue = now >= status_deadline_;
  if (overdue) status_deadline_ = kNever;
  Instant next = status_deadline_;
  const Duration silence = setup_ ? std::max(kSilence, 5 * setup_->module().heartbeat / 2) : kSilence;
  for (NodeState& node : nodes_) {
    if (overdue && node.awaits_status) {
      node.awaits_status = false;
      events.on_event({DeviceEvent::Kind::missed, node.address.node, last_sequence_});
    }
    if (!started_) continue;
    if (now - node.heard >= silence) {
      node.heard = now;  // the next miss is due after as long a silence again
      node.operational = false;
      events.on_event({DeviceEvent::Kind::missed, node.address.node});
    }
    next = std::min(next, node.heard + silence);
  }
  return next;
}

CanopenDriver::NodeState* CanopenDriver::find(std::uint8_t address) {
  const std::int16_t index = address < by_address_.size() ? by_address_[address] : std::int16_t{-1};
  return index < 0 ? nullptr : &nodes_[static_cast<std::size_t>(index)];
}

}  // namespace footlight::drivers
