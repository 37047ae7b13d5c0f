// SPDX-License-Identifier: Apache-2.0
#include "sim/can_bus.hpp"

#include <algorithm>
#include <utility>

#include "sim/can_bits.hpp"
#include "sim/markers/canopen_marker.hpp"
#include "sim/markers/output_module.hpp"

namespace footlight::sim {
namespace {

using drivers::CanFrame;
using drivers::SendStatus;

constexpr Duration kLongestStatusDelay = milliseconds(5);
constexpr Duration kHeartbeatPeriod = milliseconds(1000);
constexpr std::size_t kReceiveQueue = 8192;
constexpr Duration kRestartTime = milliseconds(100);
constexpr Duration kShortestJam = milliseconds(50);
constexpr Duration kLongestJam = milliseconds(500);
constexpr Duration kUnplugged = milliseconds(1000);
constexpr Duration kShortestStall = milliseconds(70);
constexpr std::int64_t kLongestTurnBits =
    std::int64_t{190} * 135;  // answers to a SYNC and heartbeats that go before the controller
// Classes of error frames, as of linux/can/error.h.
constexpr std::uint16_t kErrorBusOff = 0x40;
constexpr std::uint16_t kErrorRestarted = 0x100;
constexpr int kErrorFlagBits = 6;
constexpr int kErrorDelimiterBits = 8;

/// As candump writes it: "201#0102".
std::string text_of(const CanFrame& frame) {
  std::string text{"000#"};
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  for (unsigned i = 0; i < 3; ++i) text[i] = kDigits[(frame.id >> (8U - 4U * i)) & 0xFU];
  return text + to_hex(std::span(frame.data).first(frame.length));
}

std::string to_text(LineFault fault) {
  switch (fault) {
    case LineFault::bus_off:
      return "bus-off";
    case LineFault::full:
      return "nothing leaves";
    case LineFault::unplug:
      return "unplugged";
  }
  return {};
}

}  // namespace

std::size_t CanBus::add(std::unique_ptr<SimulatedNode> node) {
  FL_CHECK(node->address() < 128);
  const std::size_t slot = nodes_.size();
  slot_of_id_[node->address()] = static_cast<int>(slot);
  const auto id = static_cast<std::uint8_t>(node->address());
  if (bus_.outputs) {
    markers_.push_back(std::make_unique<OutputModuleNode>(id, *bus_.outputs, node->model(), node->unique_id()));
  } else {
    markers_.push_back(std::make_unique<CanopenMarker>(id, node->model(), node->unique_id()));
  }
  nodes_.push_back(std::move(node));
  return slot;
}

void CanBus::begin() {
  for (std::size_t slot = 0; slot < nodes_.size(); ++slot) {
    nodes_[slot]->power_on();
    if (!nodes_[slot]->powered()) continue;
    ++powered_;
    // Switched on at different times: heartbeats come in no order.
    around_.world.schedule(around_.world.now() + around_.timing.up_to(kHeartbeatPeriod), *this,
                           token(kHeartbeatDue, slot, nodes_[slot]->epoch()));
  }
}

void CanBus::power_off(std::size_t slot) {
  if (!nodes_[slot]->powered()) return;
  nodes_[slot]->power_off();
  --powered_;
}

void CanBus::power_on(std::size_t slot) {
  if (nodes_[slot]->powered()) return;
  nodes_[slot]->power_on();
  if (!nodes_[slot]->powered()) return;
  ++powered_;
  markers_[slot]->power_on();
  want(slot, markers_[slot]->boot_up());
  around_.world.schedule(around_.world.now() + kHeartbeatPeriod, *this,
                         token(kHeartbeatDue, slot, nodes_[slot]->epoch()));
}

void CanBus::act(std::uint64_t token_of_event) {
  const std::size_t slot = slot_of(token_of_event);
  switch (kind_of(token_of_event)) {
    case kIdle:
      woken_ = false;
      busy_ = false;
      start_next();
      return;
    case kEnd:
      end();
      return;
    case kStatusDue:
      if (nodes_[slot]->epoch() == generation_of(token_of_event)) want(slot, markers_[slot]->status());
      return;
    case kLineBack:
      line_back();
      return;
    default: {
      if (nodes_[slot]->epoch() != generation_of(token_of_event)) return;
      const Duration period = markers_[slot]->beat(around_.world.now());
      const CanFrame heartbeat = markers_[slot]->heartbeat();
      if (heartbeat.id != 0) want(slot, heartbeat);
      if (bus_.outputs) nodes_[slot]->after_receiving();  // its outputs may have fallen back
      around_.world.schedule(around_.world.now() + period, *this, token_of_event);
      return;
    }
  }
}

SendStatus CanBus::send(const CanFrame& frame) {
  FL_CHECK(frame.kind == CanFrame::Kind::classic && frame.length <= 8 && frame.id <= 0x7FF);
  if (line_ != drivers::CanState::active) return SendStatus::down;
  if (queued() >= kQueue) return SendStatus::busy;
  if (queue_.empty()) progress_ = around_.world.now();
  queue_.push_back(frame);
  wake();
  return SendStatus::accepted;
}

bool CanBus::receive(CanFrame& frame) {
  if (received_.empty()) return false;
  frame = received_.front();
  received_.pop_front();
  return true;
}

Duration CanBus::wire_time(const CanFrame& frame) const {
  return bit_time(can_worst_frame_bits(frame.length) + kCanInterframeBits, bus_.bits_per_second);
}

bool CanBus::yields(const Wish& a, const Wish& b) {
  return a.frame.id != b.frame.id ? a.frame.id > b.frame.id : a.order > b.order;
}

void CanBus::want(std::size_t slot, const CanFrame& frame) {
  wishes_.push_back({frame, order_++, slot, nodes_[slot]->epoch()});
  std::push_heap(wishes_.begin(), wishes_.end(), yields);
  wake();
}

/// An idle bus arbitrates among all who want to send at this instant, hence not within the call.
void CanBus::wake() {
  if (busy_ || woken_) return;
  woken_ = true;
  around_.world.schedule(around_.world.now(), *this, token(kIdle, 0, 0));
}

void CanBus::start_next() {
  while (!wishes_.empty() && nodes_[wishes_.front().slot]->epoch() != wishes_.front().epoch) {
    std::pop_heap(wishes_.begin(), wishes_.end(), yields);  // of a node that has been switched off since
    wishes_.pop_back();
  }
  const bool may_speak = controller_may_speak();
  if (!may_speak && wishes_.empty()) return;
  busy_ = true;
  const bool controller = wishes_.empty() || (may_speak && queue_.front().id <= wishes_.front().frame.id);
  if (controller) {
    now_sending_ = {queue_.front(), kController, 0, Fate::good, line_epoch_};
  } else {
    const Wish& wish = wishes_.front();
    now_sending_ = {wish.frame, static_cast<int>(wish.slot), wish.epoch, Fate::good, wish.order};
    std::pop_heap(wishes_.begin(), wishes_.end(), yields);
    wishes_.pop_back();
  }
  draw_fate(can_frame_bits(now_sending_.frame));
}

void CanBus::draw_fate(int frame_bits) {
  int bits = frame_bits;
  const bool heard = now_sending_.speaker != kController || powered_ > 0;
  const int error_bits = kErrorFlagBits + kErrorDelimiterBits;
  if (around_.faults.corrupted()) {
    now_sending_.fate = Fate::disturbed;
    bits = 1 + static_cast<int>(around_.faults.below(static_cast<std::uint64_t>(frame_bits))) + error_bits +
           static_cast<int>(around_.faults.below(kErrorFlagBits + 1));
  } else if (!heard) {
    now_sending_.fate = Fate::unacknowledged;
    bits = frame_bits - kCanTailBits + 2 + error_bits;  // CRC delimiter and the slot that stays recessive
  } else if (around_.faults.duplicated()) {
    now_sending_.fate = Fate::repeated;
    bits = frame_bits + error_bits;
  }
  use_.busy += bit_time(bits + kCanInterframeBits, bus_.bits_per_second);
  ++use_.frames;
  around_.world.schedule(around_.world.now() + bit_time(bits, bus_.bits_per_second), *this, token(kEnd, 0, 0));
}

void CanBus::end() {
  std::string note;
  const bool cut = cut_off(now_sending_);
  if (cut) {
    note = "cut off";
  } else if (now_sending_.fate == Fate::disturbed) {
    note = "corrupt";
    for (std::size_t slot = 0; slot < nodes_.size(); ++slot) {
      if (nodes_[slot]->powered()) markers_[slot]->count_error();
    }
  } else if (now_sending_.fate == Fate::unacknowledged) {
    note = "not acknowledged";
  } else {
    if (now_sending_.fate == Fate::repeated) note = "repeated";
    draw_losses(note);
  }
  const Transmission done = now_sending_;
  if (around_.trace.on()) {
    around_.trace.line(around_.world.now(), bus_.name, done.speaker == kController ? '>' : '<', text_of(done.frame),
                       note);
  }
  if (!cut && (done.fate == Fate::good || done.fate == Fate::repeated)) deliver();
  const Fate fate = done.fate;
  if (done.speaker == kController) {
    if (fate == Fate::good && !cut) {
      queue_.pop_front();
      progress_ = around_.world.now();
    }
  } else if (fate != Fate::good && !cut) {
    wishes_.push_back({done.frame, done.order, static_cast<std::size_t>(done.speaker), done.epoch});
    std::push_heap(wishes_.begin(), wishes_.end(), yields);
  }
  now_sending_.speaker = kNobody;  // the space after the frame is nobody's
  woken_ = true;
  around_.world.schedule(around_.world.now() + bit_time(kCanInterframeBits, bus_.bits_per_second), *this,
                         token(kIdle, 0, 0));
}

int CanBus::addressee() const {
  const std::uint16_t id = now_sending_.frame.id;
  if (id < 0x200 || id == 0x77F) return kController;  // NMT, SYNC, MPDO, heartbeat: everybody
  const int slot = slot_of_id_[id & 0x7FU];
  return slot < 0 ? kNobody : slot;
}

void CanBus::draw_losses(std::string& note) {
  if (now_sending_.speaker != kController) {
    controller_missed_ = misses("controller", note);
    return;
  }
  const int only = addressee();
  if (only == kNobody) return;
  const auto first = only == kController ? 0 : static_cast<std::size_t>(only);
  const auto end = only == kController ? nodes_.size() : first + 1;
  for (std::size_t slot = first; slot < end; ++slot) {
    missed_[slot] = nodes_[slot]->powered() && misses(nodes_[slot]->name(), note);
  }
}

void CanBus::deliver() {
  if (now_sending_.speaker != kController) {
    if (line_ != drivers::CanState::active) return;
    if (!controller_missed_ && received_.size() < kReceiveQueue) received_.push_back(now_sending_.frame);
    return;
  }
  const int only = addressee();
  if (only == kNobody) return;
  if (only != kController) return deliver_to(static_cast<std::size_t>(only));
  for (std::size_t slot = 0; slot < nodes_.size(); ++slot) deliver_to(slot);
}

void CanBus::deliver_to(std::size_t slot) {
  if (!nodes_[slot]->powered() || missed_[slot]) return;
  switch (markers_[slot]->receive(now_sending_.frame, around_.world.now())) {
    case CanNode::Reaction::none:
      break;
    case CanNode::Reaction::status:
      around_.world.schedule(
          around_.world.now() + around_.timing.up_to(kLongestStatusDelay) + around_.faults.lateness(), *this,
          token(kStatusDue, slot, nodes_[slot]->epoch()));
      break;
    case CanNode::Reaction::boot_up:
      want(slot, markers_[slot]->boot_up());
      break;
    case CanNode::Reaction::emergency:
      want(slot, markers_[slot]->emergency());
      break;
    case CanNode::Reaction::sdo:
      want(slot, markers_[slot]->sdo_answer());
      break;
  }
  nodes_[slot]->after_receiving();
}

bool CanBus::cut_off(const Transmission& transmission) const {
  if (transmission.speaker == kController) return transmission.order != line_epoch_;
  return transmission.speaker >= 0 &&
         nodes_[static_cast<std::size_t>(transmission.speaker)]->epoch() != transmission.epoch;
}

bool CanBus::controller_may_speak() const {
  return !queue_.empty() && line_ == drivers::CanState::active && around_.world.now() >= line_back_at_;
}

drivers::CanState CanBus::state() const {
  if (line_ != drivers::CanState::active) return line_;
  const Duration stall = std::max(kShortestStall, bit_time(kLongestTurnBits, bus_.bits_per_second));
  const bool waits = !queue_.empty() && around_.world.now() >= progress_ + stall;
  return waits ? drivers::CanState::stalled : drivers::CanState::active;
}

bool CanBus::strike(LineFault fault) {
  const Instant now = around_.world.now();
  Duration length = kRestartTime;
  if (fault == LineFault::full) {
    length = kShortestJam + around_.timing.up_to(kLongestJam - kShortestJam);
  } else {
    if (fault == LineFault::unplug) length = kUnplugged;
    line_ = fault == LineFault::unplug ? drivers::CanState::down : drivers::CanState::bus_off;
    queue_.clear();
    received_.clear();
    ++line_epoch_;
    if (fault == LineFault::bus_off) tell(kErrorBusOff);
  }
  if (around_.trace.on()) around_.trace.line(now, bus_.name, '*', {}, to_text(fault));
  line_back_at_ = std::max(line_back_at_, now + length);
  around_.world.schedule(line_back_at_, *this, token(kLineBack, 0, 0));
  return true;
}

void CanBus::line_back() {
  if (around_.world.now() != line_back_at_) return;  // struck once more meanwhile
  if (line_ == drivers::CanState::bus_off) tell(kErrorRestarted);
  line_ = drivers::CanState::active;
  wake();
}

void CanBus::tell(std::uint16_t error_classes) { received_.push_back({error_classes, 8, {}, CanFrame::Kind::error}); }

}  // namespace footlight::sim
