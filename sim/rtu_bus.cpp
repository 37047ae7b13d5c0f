// SPDX-License-Identifier: Apache-2.0
#include "sim/rtu_bus.hpp"

#include <algorithm>
#include <utility>

#include "sim/modbus_frames.hpp"

namespace footlight::sim {
namespace {

using drivers::ModbusReply;
using drivers::ModbusRequest;

constexpr int kFastestCounted = 19'200;
constexpr Duration kFixedSilence = microseconds(1750);
constexpr Duration kShortestTurnaround = microseconds(500);
constexpr Duration kLongestTurnaround = milliseconds(5);
constexpr std::size_t kAddressAndCheckSum = 3;
constexpr std::size_t kMostUnread = 16;

}  // namespace

Duration RtuBus::silence(const Bus& bus) {
  if (bus.bits_per_second > kFastestCounted) return kFixedSilence;
  return bit_time(7 * std::int64_t{bus.bits_per_character()}, 2 * std::int64_t{bus.bits_per_second});
}

RtuBus::RtuBus(const Bus& bus, const Surroundings& surroundings)
    : SimulatedBus(bus, surroundings),
      silence_(silence(bus)),
      line_(bus_, bus.bits_per_character(), silence_, around_, use_, *this) {}

std::size_t RtuBus::add(std::unique_ptr<SimulatedNode> node) {
  markers_.emplace_back(static_cast<std::uint8_t>(node->address()), bus_.profile.value_or(footlight_profile()),
                        node->model(), node->unique_id());
  answers_.emplace_back();
  missed_.push_back(false);
  nodes_.push_back(std::move(node));
  return nodes_.size() - 1;
}

void RtuBus::power_off(std::size_t slot) {
  nodes_[slot]->power_off();
  answers_[slot] = {{}, kStart, answers_[slot].generation + 1};
  line_.cut(static_cast<int>(slot));
}

void RtuBus::power_on(std::size_t slot) {
  nodes_[slot]->power_on();
  markers_[slot].power_on();
}

drivers::SendStatus RtuBus::submit(const ModbusRequest& request) {
  const auto pdu = request_pdu(request);
  if (busy()) return drivers::SendStatus::busy;
  request_ = request;
  ++generation_;
  reply_.reset();
  phase_ = Phase::sending;
  line_.say(kController, rtu_frame(request.unit, pdu), std::max(around_.world.now(), quiet_at_));
  return drivers::SendStatus::accepted;
}

std::optional<ModbusReply> RtuBus::poll() { return std::exchange(reply_, std::nullopt); }

bool RtuBus::discard() {
  const bool any = !unread_.empty();
  unread_.clear();
  return any;
}

Duration RtuBus::wire_time(const ModbusRequest& request) const {
  const Duration out = line_.time_of(request_pdu(request).size() + kAddressAndCheckSum);
  if (request.unit == 0) return out + std::max(kBroadcastGap, silence_);
  return out + std::max(kLongestTurnaround, silence_) + line_.time_of(reply_pdu_size(request) + kAddressAndCheckSum) +
         silence_;
}

void RtuBus::say(int /*client*/, std::span<const std::uint8_t> frame) {
  if (frame.empty() || unsaid_.size() == kMostUnread) return;
  unsaid_.emplace_back(frame.begin(), frame.end());
  if (!busy()) say_next();
}

bool RtuBus::hear(int& client, std::vector<std::uint8_t>& frame) {
  if (unread_.empty()) return false;
  client = 0;
  frame = std::move(unread_.front());
  unread_.pop_front();
  return true;
}

void RtuBus::say_next() {
  auto frame = std::move(unsaid_.front());
  unsaid_.pop_front();
  request_ = {.unit = frame.front(), .function = 0, .first_register = 0, .count = 0, .values = {}};
  ++generation_;
  phase_ = Phase::stranger;
  line_.say(kController, std::move(frame), std::max(around_.world.now(), quiet_at_));
}

void RtuBus::draw_losses(int speaker, std::string& note) {
  if (speaker != kController) {
    controller_missed_ = misses("controller", note);
    return;
  }
  for (std::size_t slot = 0; slot < nodes_.size(); ++slot) {
    const bool concerned = request_.unit == 0 || request_.unit == markers_[slot].address();
    missed_[slot] = concerned && nodes_[slot]->powered() && misses(nodes_[slot]->name(), note);
  }
}

void RtuBus::heard(int speaker, std::span<const std::uint8_t> bytes, bool copy) {
  quiet_at_ = around_.world.now() + silence_;
  if (speaker == kController) {
    if (copy) {
      heard_twice_ = true;
      return;
    }
    in_air_.assign(bytes.begin(), bytes.end());
    heard_twice_ = false;
    around_.world.schedule(quiet_at_, *this, token(kNodesHear, 0, generation_));
    if (phase_ != Phase::stranger) request_is_out();
    return;
  }
  // Nodes hear each other's replies as well; none has the address of another, so nothing comes of it.
  if (!controller_missed_) take(bytes);
}

void RtuBus::request_is_out() {
  const Instant now = around_.world.now();
  if (request_.unit == 0) {
    phase_ = Phase::broadcast;
    around_.world.schedule(now + std::max(kBroadcastGap, silence_), *this, token(kBroadcastOver, 0, generation_));
    return;
  }
  phase_ = Phase::waiting;
  around_.world.schedule(now + std::max(kLongestTurnaround, silence_) + kReplyMargin, *this,
                         token(kGiveUp, 0, generation_));
  while (phase_ == Phase::waiting && !unread_.empty()) {
    const auto frame = std::move(unread_.front());
    unread_.pop_front();
    take(frame);
  }
}

void RtuBus::act(std::uint64_t token_of_event) {
  const std::size_t slot = slot_of(token_of_event);
  switch (kind_of(token_of_event)) {
    case kNodesHear:
      nodes_hear();
      if (phase_ != Phase::stranger) return;
      phase_ = Phase::idle;
      if (!unsaid_.empty()) say_next();
      return;
    case kNodeAnswers: {
      Answers& answers = answers_[slot];
      if (answers.generation != generation_of(token_of_event)) return;
      line_.say(static_cast<int>(slot), std::move(answers.waiting.front()), around_.world.now());
      answers.waiting.pop_front();
      return;
    }
    case kGiveUp:
      give_up(generation_of(token_of_event));
      return;
    default:
      phase_ = Phase::idle;
      unread_.clear();
      return;
  }
}

void RtuBus::nodes_hear() {
  for (int time = 0; time < (heard_twice_ ? 2 : 1); ++time) {
    for (std::size_t slot = 0; slot < nodes_.size(); ++slot) {
      if (nodes_[slot]->powered() && !missed_[slot]) node_hears(slot, time > 0);
    }
  }
}

void RtuBus::node_hears(std::size_t slot, bool copy) {
  auto answer = markers_[slot].receive_rtu(in_air_, around_.world.now());
  nodes_[slot]->after_receiving();
  if (answer.empty() || copy) return;
  const Duration turnaround =
      kShortestTurnaround + around_.timing.up_to(kLongestTurnaround - kShortestTurnaround) + around_.faults.lateness();
  Answers& answers = answers_[slot];
  // The turnaround runs from the last bit of the request, and never ends before the silence has been heard.
  const Instant at = std::max(around_.world.now() + std::max(turnaround, silence_) - silence_, answers.free_at);
  answers.free_at = at + line_.time_of(answer.size()) + silence_;
  answers.waiting.push_back(std::move(answer));
  around_.world.schedule(at, *this, token(kNodeAnswers, slot, answers.generation));
}

void RtuBus::take(std::span<const std::uint8_t> frame) {
  if (phase_ != Phase::waiting) {
    if (unread_.size() < kMostUnread) unread_.emplace_back(frame.begin(), frame.end());
    return;
  }
  if (auto reply = rtu_reply(request_, frame)) conclude(std::move(*reply));
}

void RtuBus::give_up(std::uint32_t generation) {
  if (phase_ != Phase::waiting || generation != generation_) return;
  const Instant quiet = line_.quiet_at();
  if (quiet > around_.world.now()) {  // a reply has begun in time and is heard to its end
    around_.world.schedule(quiet, *this, token(kGiveUp, 0, generation_));
    return;
  }
  conclude({ModbusReply::Outcome::timeout, request_.unit, request_.function, 0, {}});
}

void RtuBus::conclude(ModbusReply reply) {
  phase_ = Phase::idle;
  reply_ = std::move(reply);
}

}  // namespace footlight::sim
