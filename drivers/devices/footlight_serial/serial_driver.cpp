// SPDX-License-Identifier: Apache-2.0
#include "drivers/devices/footlight_serial/serial_driver.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/check.hpp"

namespace footlight::drivers {
namespace {

using footlight_serial::Command;
using footlight_serial::Frame;
using footlight_serial::frame_length;

constexpr Duration kTurnaround = milliseconds(2);  // longest, of a node
constexpr Duration kMargin = milliseconds(10);     // scheduling of the machine, an adapter's latency, a late node
constexpr Duration kLongestMargin = milliseconds(40);
constexpr Duration kForgetLate = milliseconds(5000);
constexpr std::size_t kWhoSlotCharacters = 30;  // docs/wire-protocol.md, WHO
constexpr int kReadsPerStep = 64;               // a flood must not keep us from sending

}  // namespace

SerialDriver::SerialDriver(ByteStream& port, const std::vector<NodeAddress>& nodes, std::uint8_t plan_byte,
                           Leadership* leadership)
    : port_(port),
      leadership_(leadership),
      plan_byte_(leadership == nullptr ? plan_byte : leading_byte(plan_byte, leadership->epoch)),
      margin_(kMargin) {
  for (const NodeAddress& node : nodes) {
    FL_CHECK(node.address >= 1 && node.address <= 254);
    FL_CHECK(boots_.emplace(node.unit(), std::nullopt).second);
  }
}

void SerialDriver::take_plan(std::uint8_t plan_byte) {
  const std::uint8_t byte = leadership_ == nullptr ? plan_byte : leading_byte(plan_byte, leadership_->epoch);
  lead_due_ = lead_due_ || (leadership_ != nullptr && byte != plan_byte_);
  plan_byte_.store(byte);
}

Duration SerialDriver::preload_time(int channels) const {
  const auto looks = static_cast<std::size_t>(channels);
  return port_.wire_time(frame_length(1 + looks)) + kTurnaround +
         port_.wire_time(frame_length(footlight_serial::kReceiptBody));
}

Duration SerialDriver::status_time() const {
  return port_.wire_time(frame_length(0)) + kTurnaround + port_.wire_time(frame_length(footlight_serial::kStatusBody));
}

Duration SerialDriver::latch_time() const { return wire_time(footlight_serial::latch(plan_byte_, 1)); }

Duration SerialDriver::heartbeat_time() const {
  const Duration lead = leadership_ == nullptr ? Duration{} : wire_time(footlight_serial::lead(plan_byte_, 0));
  return lead + wire_time(footlight_serial::heartbeat(plan_byte_, 0));
}

Duration SerialDriver::upload_time() const { return wire_time(footlight_serial::look_entry(plan_byte_, 1, Look{})); }

Duration SerialDriver::wire_time(const Frame& frame) const { return port_.wire_time(frame_length(frame.body.size())); }

SendStatus SerialDriver::start(Instant /*now*/) { return SendStatus::accepted; }

SendStatus SerialDriver::preload(const NodeAddress& node, Sequence sequence, std::span<const LookIndex> looks,
                                 Instant now) {
  FL_CHECK(sequence >= 1 && sequence <= kLastSequence);
  FL_CHECK(looks.size() == node.channels);
  const Frame frame = footlight_serial::preload(node.unit(), plan_byte_, sequence, looks);
  return send(frame, Awaited{node, Command::preload, sequence, looks_crc(looks)}, footlight_serial::kReceiptBody, now);
}

SendStatus SerialDriver::latch(Sequence sequence, Instant now) {
  FL_CHECK(sequence >= 1 && sequence <= kLastSequence);
  return send(footlight_serial::latch(plan_byte_, sequence), std::nullopt, 0, now);
}

SendStatus SerialDriver::heartbeat(Duration show_time, Instant now) {
  const auto show_ms = static_cast<std::uint32_t>(show_time / milliseconds(1));
  const Frame beat = footlight_serial::heartbeat(plan_byte_, show_ms);
  lead_due_ = lead_due_ || (leadership_ != nullptr && beats_since_lead_++ % kBeatsALead == 0);
  return send(beat, std::nullopt, 0, now);
}

SendStatus SerialDriver::ask(const NodeAddress& node, Instant now) {
  const Frame frame = footlight_serial::status_request(node.unit(), plan_byte_);
  return send(frame, Awaited{node, Command::status}, footlight_serial::kStatusBody, now);
}

SendStatus SerialDriver::upload_look(LookIndex index, const Look& look, Instant now) {
  return send(footlight_serial::look_entry(plan_byte_, index, look), std::nullopt, 0, now);
}

Duration SerialDriver::content_time() const {
  const Frame frame = footlight_serial::content(1, plan_byte_, 1, 0, {});
  return wire_time(frame) + kTurnaround + port_.wire_time(frame_length(footlight_serial::kContentReceiptBody));
}

SendStatus SerialDriver::send_content(const NodeAddress& node, int channel, Sequence sequence,
                                      const WearableContent& content, Instant now) {
  FL_CHECK(sequence >= 1 && sequence <= kLastSequence && channel >= 0 && channel < node.channels);
  const Frame frame = footlight_serial::content(node.unit(), plan_byte_, sequence, channel, content);
  return send(frame, Awaited{node, Command::content, sequence, looks_crc(frame.body), channel},
              footlight_serial::kContentReceiptBody, now);
}

Duration SerialDriver::sync_time_time() const { return wire_time(footlight_serial::time(plan_byte_, {}, 1)); }

SendStatus SerialDriver::sync_time(Duration show_time, double rate, Instant now) {
  // Nodes take the time at the frame's last byte, which leaves so much later.
  const auto ahead = Duration(std::llround(static_cast<double>(sync_time_time().count()) * rate));
  const Duration at_end = std::max(Duration{}, show_time + ahead);
  const SendStatus status = send(footlight_serial::time(plan_byte_, at_end, rate), std::nullopt, 0, now);
  if (status == SendStatus::accepted) told_ = {at_end, now + sync_time_time(), rate};
  return status;
}

SendStatus SerialDriver::tell_plan(std::uint32_t check, Instant now) {
  return send(footlight_serial::keep(0, plan_byte_, footlight_serial::Kept::plan, check), std::nullopt, 0, now);
}

SendStatus SerialDriver::ask_kept(const NodeAddress& node, Instant now) {
  const Frame frame = footlight_serial::keep_request(node.unit(), plan_byte_);
  return send(frame, Awaited{node, Command::keep}, footlight_serial::kKeepBody, now);
}

Duration SerialDriver::kept_time() const {
  return port_.wire_time(frame_length(0)) + kTurnaround + port_.wire_time(frame_length(footlight_serial::kKeepBody));
}

SendStatus SerialDriver::serve(const Frame& frame, Task task, std::size_t answer_bytes, Instant now) {
  Awaited awaited;
  awaited.node.address = frame.address;
  awaited.command = frame.command;
  awaited.task = task;
  awaited.dropped_before = receiver_.dropped();
  awaited.several = frame.command == Command::who;
  const SendStatus status = send(frame, awaited, answer_bytes, now);
  if (status == SendStatus::accepted) receiver_.forget();
  return status;
}

SendStatus SerialDriver::probe(std::uint16_t address, unsigned round, Instant now) {
  const auto unit = static_cast<std::uint8_t>(address);
  if (round == 0) {
    return serve(footlight_serial::status_request(unit, plan_byte_), Task::probe, footlight_serial::kStatusBody, now);
  }
  const SendStatus status = serve(footlight_serial::who(unit, plan_byte_, static_cast<std::uint8_t>(round)),
                                  Task::probe, footlight_serial::kWhoBody, now);
  if (status == SendStatus::accepted) line_free_ += (footlight_serial::kWhoSlots - 1) * who_slot();
  return status;
}

Duration SerialDriver::who_slot() const { return port_.wire_time(kWhoSlotCharacters) + kTurnaround; }

SendStatus SerialDriver::identify(std::uint16_t address, bool on, Instant now) {
  return serve(footlight_serial::identify(static_cast<std::uint8_t>(address), plan_byte_, on), Task::identify,
               footlight_serial::kStatusBody, now);
}

SendStatus SerialDriver::set_address(std::uint16_t from, std::optional<std::uint32_t> unique_id, std::uint16_t to,
                                     Instant now) {
  FL_CHECK(unique_id.has_value() && to >= 1 && to <= 254);
  return serve(footlight_serial::new_address(static_cast<std::uint8_t>(from), plan_byte_, *unique_id,
                                             static_cast<std::uint8_t>(to)),
               Task::set_address, footlight_serial::kWhoBody, now);
}

SendStatus SerialDriver::ask_health(std::uint16_t address, Instant now) {
  return serve(footlight_serial::health_request(static_cast<std::uint8_t>(address), plan_byte_), Task::health,
               footlight_serial::kHealthBody, now);
}

SendStatus SerialDriver::ask_clock(std::uint16_t address, Instant now) {
  const Frame frame = footlight_serial::clock_request(static_cast<std::uint8_t>(address), plan_byte_);
  const SendStatus status = serve(frame, Task::clock, footlight_serial::kClockBody, now);
  if (status == SendStatus::accepted) clock_asked_at_ = now + wire_time(frame);
  return status;
}

SendStatus SerialDriver::ask_patch(std::uint16_t address, std::optional<std::uint32_t> patch, Instant now) {
  using footlight_serial::Kept;
  const auto unit = static_cast<std::uint8_t>(address);
  return serve(patch ? footlight_serial::keep(unit, plan_byte_, Kept::patch, *patch)
                     : footlight_serial::keep_request(unit, plan_byte_),
               Task::patch, footlight_serial::kKeepBody, now);
}

std::vector<HealthValue> SerialDriver::clock_values(const footlight_serial::NodeClock& clock) const {
  std::vector<HealthValue> values{{"TIME frames", static_cast<double>(clock.times_taken), "taken"}};
  if (!clock.set || !told_) return values;
  const double since_s = to_seconds(clock_asked_at_ - told_->at) * told_->rate;
  values.push_back({"clock error", (to_seconds(clock.show_time - told_->show_time) - since_s) * 1e3, "ms"});
  return values;
}

SendStatus SerialDriver::send(const Frame& frame, std::optional<Awaited> awaited, std::size_t answer_bytes,
                              Instant now) {
  if (awaited_ || now < line_free_) return SendStatus::busy;
  std::vector<std::uint8_t> bytes = encode(frame);
  if (lead_due_) {
    // What nobody answers may be followed at once.
    const std::vector<std::uint8_t> first = encode(footlight_serial::lead(plan_byte_, leadership_->epoch));
    bytes.insert(bytes.begin(), first.begin(), first.end());
  }
  const SendStatus status = port_.write(bytes);
  if (status != SendStatus::busy) down_ = status == SendStatus::down;
  if (status != SendStatus::accepted) return status;
  lead_due_ = false;
  line_free_ = now + port_.wire_time(bytes.size());
  if (now - last_late_ >= kForgetLate) margin_ = kMargin;
  if (awaited) line_free_ += kTurnaround + port_.wire_time(frame_length(answer_bytes)) + margin_;
  // Asked again, its next answer is a good one.
  if (awaited && given_up_ && given_up_->node.address == awaited->node.address) given_up_.reset();
  awaited_ = awaited;
  line_taken_ = true;
  return status;
}

Instant SerialDriver::step(Instant now, EventSink& events) {
  std::array<std::uint8_t, 256> buffer{};
  int reads = 0;
  for (; reads < kReadsPerStep; ++reads) {
    const std::size_t count = port_.read(buffer);
    for (std::size_t i = 0; i < count; ++i) {
      if (const auto frame = receiver_.take(buffer[i])) hear(*frame, now, events);
    }
    if (count == 0) break;
  }
  if (awaited_ && now >= line_free_) give_up(events);
  if (down_ != down_told_) {
    down_told_ = down_;
    events.on_event({down_ ? DeviceEvent::Kind::bus_down : DeviceEvent::Kind::bus_up, NodeIndex{}});
  }
  line_taken_ = awaited_ || now < line_free_;
  if (reads == kReadsPerStep) return now;
  return line_taken_ ? line_free_ : kNever;
}

void SerialDriver::give_up(EventSink& events) {
  if (!awaited_->task && awaited_->command == Command::keep) {
    given_up_ = std::exchange(awaited_, std::nullopt);
    return;
  }
  if (!awaited_->task) {
    events.on_event({DeviceEvent::Kind::missed, awaited_->node.node, awaited_->sequence});
    given_up_ = std::exchange(awaited_, std::nullopt);
    return;
  }
  const Awaited awaited = *std::exchange(awaited_, std::nullopt);
  if (awaited.heard) return;
  ServiceAnswer answer{*awaited.task, ServiceAnswer::Kind::silent, awaited.node.address, 0, {}, {}};
  if (receiver_.dropped() != awaited.dropped_before || receiver_.midway()) answer.kind = ServiceAnswer::Kind::garbled;
  events.on_answer(answer);
}

bool SerialDriver::tell_service(const Frame& frame, EventSink& events) {
  ServiceAnswer answer{*awaited_->task, ServiceAnswer::Kind::done, frame.address, 0, {}, {}};
  if (awaited_->task == Task::probe) answer.kind = ServiceAnswer::Kind::found;
  if (frame.command == Command::who || frame.command == Command::address) {
    const auto identity = decode_identity(frame);
    if (!identity) return false;
    answer.identity = *identity;
  } else if (frame.command == Command::health) {
    auto health = decode_health(frame);
    if (!health) return false;
    answer.health = std::move(*health);
  } else if (frame.command == Command::clock) {
    const auto clock = footlight_serial::decode_clock(frame);
    if (!clock) return false;
    answer.health = clock_values(*clock);
  } else if (const auto kept = decode_kept(frame)) {
    answer.kept = *kept;
  } else if (!decode_status(frame)) {
    return false;
  }
  awaited_->heard = true;
  events.on_answer(answer);
  return !awaited_->several;
}

void SerialDriver::note_late(const Frame& frame, Instant now) {
  if (!given_up_ || frame.direction != footlight_serial::Direction::from_node ||
      frame.address != given_up_->node.address || frame.command != given_up_->command) {
    return;
  }
  given_up_.reset();
  last_late_ = now;
  margin_ = std::min(2 * margin_, kLongestMargin);
}

void SerialDriver::hear(const Frame& frame, Instant now, EventSink& events) {
  note_late(frame, now);
  if (frame.command == Command::lead && awaited_ && !awaited_->task && frame.address == awaited_->node.address &&
      frame.direction == footlight_serial::Direction::from_node) {
    if (leadership_ != nullptr) leadership_->refusals.fetch_add(1, std::memory_order_relaxed);
    beats_since_lead_ = 0;
    events.on_event({DeviceEvent::Kind::fenced, awaited_->node.node, awaited_->sequence});
    awaited_.reset();
    line_free_ = Instant{};
    return;
  }
  // Who is asked to show itself answers by its status.
  const Command wanted = awaited_ && awaited_->command == Command::identify ? Command::status
                         : awaited_                                         ? awaited_->command
                                                                            : Command::status;
  if (!awaited_ || frame.address != awaited_->node.address || frame.command != wanted ||
      frame.direction != footlight_serial::Direction::from_node) {
    return;
  }
  if (awaited_->task) {
    if (!tell_service(frame, events)) return;
  } else if (const auto content = decode_content_receipt(frame)) {
    if (frame.sequence != awaited_->sequence || content->crc != awaited_->crc) return;
    DeviceEvent event{DeviceEvent::Kind::content, awaited_->node.node, frame.sequence};
    event.detail = content->channel;
    events.on_event(event);
  } else if (const auto kept = decode_kept(frame)) {
    DeviceEvent event{DeviceEvent::Kind::keeps, awaited_->node.node};
    event.kept = *kept;
    events.on_event(event);
  } else if (const auto status = decode_status(frame)) {
    tell_status(awaited_->node, *status, frame.sequence, events);
  } else if (const auto crc = decode_receipt(frame)) {
    if (frame.sequence != awaited_->sequence || *crc != awaited_->crc) return;
    events.on_event({DeviceEvent::Kind::preloaded, awaited_->node.node, frame.sequence});
  } else {
    return;
  }
  awaited_.reset();
  line_free_ = Instant{};  // the answer was the last thing on the line
}

void SerialDriver::tell_status(const NodeAddress& node, const footlight_serial::NodeStatus& status, Sequence shown,
                               EventSink& events) {
  std::optional<std::uint16_t>& boots = boots_[node.unit()];
  if (boots && *boots != status.boots) events.on_event({DeviceEvent::Kind::booted, node.node});
  boots = status.boots;
  DeviceEvent event{DeviceEvent::Kind::showing, node.node, shown};
  event.crc = status.crc;
  event.state = status.state;
  event.boots = status.boots;
  events.on_event(event);
}

}  // namespace footlight::drivers
