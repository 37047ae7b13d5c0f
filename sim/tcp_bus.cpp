// SPDX-License-Identifier: Apache-2.0
#include "sim/tcp_bus.hpp"

#include <algorithm>
#include <utility>

#include "sim/modbus_frames.hpp"

namespace footlight::sim {
namespace {

using drivers::ModbusReply;
using drivers::ModbusRequest;

constexpr Duration kShortestLatency = microseconds(80);
constexpr Duration kLongestLatency = microseconds(200);
constexpr Duration kLongestJitter = microseconds(50);
constexpr Duration kShortestTurnaround = microseconds(500);
constexpr Duration kLongestTurnaround = milliseconds(5);
constexpr Duration kRetransmission = milliseconds(200);  // the least of Linux
constexpr std::int64_t kNetworkBitsPerSecond = 100'000'000;
constexpr std::size_t kHeaders = 90;  // preamble 8, Ethernet 18, gap 12, IPv4 20, TCP with time stamps 32
constexpr std::size_t kMbap = 7;
constexpr std::size_t kMostUnheard = 1024;

Duration network_time(std::size_t bytes) {
  return bit_time(static_cast<std::int64_t>(8 * (bytes + kHeaders)), kNetworkBitsPerSecond);
}

}  // namespace

std::size_t TcpBus::add(std::unique_ptr<SimulatedNode> node) {
  markers_.emplace_back(static_cast<std::uint8_t>(node->address()), bus_.profile.value_or(footlight_profile()),
                        node->model(), node->unique_id());
  connections_.push_back({kShortestLatency + around_.timing.up_to(kLongestLatency - kShortestLatency), kStart, kStart});
  nodes_.push_back(std::move(node));
  return nodes_.size() - 1;
}

void TcpBus::power_off(std::size_t slot) { nodes_[slot]->power_off(); }

void TcpBus::power_on(std::size_t slot) {
  nodes_[slot]->power_on();
  markers_[slot].power_on();
}

drivers::SendStatus TcpBus::submit(const ModbusRequest& request) {
  const auto pdu = request_pdu(request);
  if (busy_) return drivers::SendStatus::busy;
  busy_ = true;
  request_ = request;
  reply_.reset();
  ++generation_;
  Instant at = around_.world.now();
  for (std::size_t slot = 0; slot < nodes_.size(); ++slot) {
    const std::uint8_t unit = markers_[slot].address();
    if (request.unit != 0 && request.unit != unit) continue;
    auto frame = tcp_frame(++transaction_, unit, pdu);
    at += network_time(frame.size());
    transmit({slot, nodes_[slot]->epoch(), false, std::move(frame), kPort}, kNodeHears, at);
  }
  if (request.unit == 0) {
    around_.world.schedule(at, *this, token(kBroadcastOver, 0, generation_));
  } else {
    around_.world.schedule(around_.world.now() + kReplyTimeout, *this, token(kGiveUp, 0, generation_));
  }
  return drivers::SendStatus::accepted;
}

std::optional<ModbusReply> TcpBus::poll() { return std::exchange(reply_, std::nullopt); }

void TcpBus::say(int client, std::span<const std::uint8_t> frame) {
  if (frame.size() < kMbap) return;
  for (std::size_t slot = 0; slot < nodes_.size(); ++slot) {
    if (markers_[slot].address() != frame[kMbap - 1]) continue;
    transmit({slot, nodes_[slot]->epoch(), false, {frame.begin(), frame.end()}, client}, kNodeHears,
             around_.world.now() + network_time(frame.size()));
  }
}

bool TcpBus::hear(int& client, std::vector<std::uint8_t>& frame) {
  if (unheard_.empty()) return false;
  client = unheard_.front().first;
  frame = std::move(unheard_.front().second);
  unheard_.pop_front();
  return true;
}

Duration TcpBus::wire_time(const ModbusRequest& request) const {
  const Duration out = network_time(request_pdu(request).size() + kMbap);
  if (request.unit == 0) {
    return out * static_cast<Duration::rep>(std::max<std::size_t>(1, nodes_.size())) + kLongestLatency + kLongestJitter;
  }
  return out + 2 * (kLongestLatency + kLongestJitter) + kLongestTurnaround +
         network_time(reply_pdu_size(request) + kMbap);
}

Instant TcpBus::transmit(Message message, Kind kind, Instant from) {
  Connection& connection = connections_[message.slot];
  Instant& last = kind == kNodeHears ? connection.last_to_node : connection.last_to_port;
  const Duration time = network_time(message.bytes.size());
  ++use_.frames;
  use_.busy += time;
  Instant arrival = from + connection.latency + around_.timing.up_to(kLongestJitter);
  if (around_.faults.lost() || around_.faults.corrupted()) {
    message.sent_again = true;
    arrival += kRetransmission;
    ++use_.frames;
    use_.busy += time;
  }
  last = std::max(last, arrival);
  const Instant at = last;
  around_.world.schedule(at, *this, token(kind, keep(std::move(message)), 0));
  return at;
}

void TcpBus::act(std::uint64_t token_of_event) {
  switch (kind_of(token_of_event)) {
    case kNodeHears:
      node_hears(release(slot_of(token_of_event)));
      return;
    case kNodeAnswers: {
      Message message = release(slot_of(token_of_event));
      if (nodes_[message.slot]->epoch() != message.epoch) return;
      const Instant out = around_.world.now() + network_time(message.bytes.size());
      transmit(std::move(message), kPortHears, out);
      return;
    }
    case kPortHears:
      port_hears(release(slot_of(token_of_event)));
      return;
    case kGiveUp:
      if (!busy_ || generation_of(token_of_event) != generation_) return;
      busy_ = false;
      reply_ = ModbusReply{ModbusReply::Outcome::timeout, request_.unit, request_.function, 0, {}};
      return;
    default:
      busy_ = false;
      return;
  }
}

void TcpBus::node_hears(Message message) {
  SimulatedNode& node = *nodes_[message.slot];
  trace(message, '>');
  if (!node.powered() || node.epoch() != message.epoch) return;  // the connection went with the power
  message.bytes = markers_[message.slot].receive_tcp(message.bytes, around_.world.now());
  message.sent_again = false;
  node.after_receiving();
  if (message.bytes.empty()) return;
  const Duration turnaround =
      kShortestTurnaround + around_.timing.up_to(kLongestTurnaround - kShortestTurnaround) + around_.faults.lateness();
  around_.world.schedule(around_.world.now() + turnaround, *this, token(kNodeAnswers, keep(std::move(message)), 0));
}

void TcpBus::port_hears(const Message& message) {
  trace(message, '<');
  if (message.client != kPort) {
    if (unheard_.size() < kMostUnheard) unheard_.emplace_back(message.client, message.bytes);
    return;
  }
  if (!busy_ || request_.unit == 0) return;
  if (auto reply = tcp_reply(request_, transaction_, message.bytes)) {
    busy_ = false;
    reply_ = std::move(*reply);
  }
}

void TcpBus::trace(const Message& message, char direction) {
  if (!around_.trace.on()) return;
  std::string note = message.sent_again ? "sent again by TCP" : "";
  const SimulatedNode& node = *nodes_[message.slot];
  if (direction == '>' && (!node.powered() || node.epoch() != message.epoch)) {
    note.append(note.empty() ? "" : ", ").append("nobody there");
  }
  around_.trace.line(around_.world.now(), bus_.name, direction, to_hex(message.bytes), note);
}

std::size_t TcpBus::keep(Message message) {
  if (free_.empty()) {
    free_.push_back(messages_.size());
    messages_.emplace_back();
  }
  const std::size_t place = free_.back();
  free_.pop_back();
  messages_[place] = std::move(message);
  return place;
}

TcpBus::Message TcpBus::release(std::size_t place) {
  free_.push_back(place);
  return std::exchange(messages_[place], {});
}

}  // namespace footlight::sim
