// SPDX-License-Identifier: Apache-2.0
#include "drivers/devices/modbus/modbus_driver.hpp"

#include <utility>

#include "core/check.hpp"

namespace footlight::drivers {
namespace {

constexpr std::uint8_t kBroadcast = 0;
constexpr std::uint8_t kDeviceFailure = 4;           // the only exception that is tried again at once
constexpr Duration kPollInterval = milliseconds(1);  // for a reply that is later than it should be
constexpr std::uint8_t kAnyUnit = 1;                 // for budgets

}  // namespace

ModbusDriver::ModbusDriver(ModbusPort& port, ModbusProfile profile, const std::vector<NodeAddress>& nodes,
                           std::uint8_t plan_byte)
    : port_(port), profile_(std::move(profile)), nodes_(nodes), plan_byte_(plan_byte) {
  FL_CHECK(profile_.looks_per_register == 1 || profile_.looks_per_register == 2);
  for (const NodeAddress& node : nodes_) FL_CHECK(node.address >= 1 && node.address <= 247);
}

Capabilities ModbusDriver::capabilities() const {
  Capabilities can;
  can.readback = profile_.status_register.has_value();
  can.lease = profile_.heartbeat_register.has_value();
  can.sequenced_latch = profile_.has_preload_sequence && profile_.latch_register.has_value();
  return can;
}

Duration ModbusDriver::preload_time(int channels) const {
  const std::vector<LookIndex> looks(static_cast<std::size_t>(channels));
  return port_.wire_time(modbus::preload(profile_, kAnyUnit, plan_byte_, 1, looks));
}

Duration ModbusDriver::status_time() const {
  if (!profile_.status_register) return {};
  return port_.wire_time(modbus::status_request(profile_, kAnyUnit));
}

Duration ModbusDriver::latch_time() const {
  if (profile_.latch_register) return port_.wire_time(modbus::latch(profile_, kBroadcast, plan_byte_, 1));
  Duration sum{};
  for (const NodeAddress& node : nodes_) sum += preload_time(node.channels);
  return sum;
}

Duration ModbusDriver::heartbeat_time() const {
  if (!profile_.heartbeat_register) return {};
  return port_.wire_time(modbus::heartbeat(profile_, kBroadcast, 0));
}

Duration ModbusDriver::upload_time() const {
  if (!profile_.look_table_register) return {};
  return port_.wire_time(modbus::look_entry(profile_, kBroadcast, 1, Look{}));
}

bool ModbusDriver::ready() const { return !under_way_ && jobs_.empty() && !port_.busy(); }

SendStatus ModbusDriver::start(Instant /*now*/) { return SendStatus::accepted; }

SendStatus ModbusDriver::preload(const NodeAddress& node, Sequence sequence, std::span<const LookIndex> looks,
                                 Instant now) {
  FL_CHECK(sequence >= 1 && sequence <= kLastSequence);
  FL_CHECK(looks.size() == node.channels);
  if (!profile_.latch_register) {
    if (!ready()) return SendStatus::busy;
    kept_[node.node] = Kept{node, {looks.begin(), looks.end()}};
    due_.push_back({DeviceEvent::Kind::preloaded, node.node, sequence});
    return SendStatus::accepted;
  }
  return run(
      {{Purpose::preload, node.node, sequence, modbus::preload(profile_, node.address, plan_byte_, sequence, looks)}},
      now);
}

SendStatus ModbusDriver::latch(Sequence sequence, Instant now) {
  FL_CHECK(sequence >= 1 && sequence <= kLastSequence);
  if (profile_.latch_register) {
    return run({{Purpose::latch, NodeIndex{}, sequence, modbus::latch(profile_, kBroadcast, plan_byte_, sequence)}},
               now);
  }
  std::vector<Job> writes;
  writes.reserve(kept_.size());
  for (const auto& [node, kept] : kept_) {
    writes.push_back({Purpose::late_write, node, sequence,
                      modbus::preload(profile_, kept.node.address, plan_byte_, sequence, kept.looks)});
  }
  const SendStatus status = run(std::move(writes), now);
  if (status == SendStatus::accepted) kept_.clear();
  return status;
}

SendStatus ModbusDriver::heartbeat(Duration show_time, Instant now) {
  if (!profile_.heartbeat_register) return SendStatus::accepted;
  const auto show_ms = static_cast<std::uint32_t>(show_time / milliseconds(1));
  return run({{Purpose::heartbeat, NodeIndex{}, 0, modbus::heartbeat(profile_, kBroadcast, show_ms)}}, now);
}

SendStatus ModbusDriver::ask(const NodeAddress& node, Instant now) {
  if (!profile_.status_register) return SendStatus::accepted;
  return run({{Purpose::status, node.node, 0, modbus::status_request(profile_, node.address)}}, now);
}

SendStatus ModbusDriver::upload_look(LookIndex index, const Look& look, Instant now) {
  if (!profile_.look_table_register) return SendStatus::accepted;
  return run({{Purpose::look, NodeIndex{}, 0, modbus::look_entry(profile_, kBroadcast, index, look)}}, now);
}

SendStatus ModbusDriver::run(std::vector<Job> jobs, Instant now) {
  if (!ready()) return SendStatus::busy;
  if (jobs.empty()) return SendStatus::accepted;
  const SendStatus status = submit(jobs.front(), now);
  if (status != SendStatus::accepted) return status;
  jobs_.assign(jobs.begin() + 1, jobs.end());
  return status;
}

SendStatus ModbusDriver::submit(const Job& job, Instant now) {
  const SendStatus status = port_.submit(job.request);
  if (status != SendStatus::busy) down_ = status == SendStatus::down;
  if (status != SendStatus::accepted) return status;
  under_way_ = job;
  expected_ = now + port_.wire_time(job.request);
  return status;
}

Instant ModbusDriver::step(Instant now, EventSink& events) {
  for (const DeviceEvent& event : due_) events.on_event(event);
  due_.clear();
  tell_bus(events);
  if (under_way_) {
    const std::optional<ModbusReply> reply = port_.poll();
    const bool broadcast_over = under_way_->request.unit == kBroadcast && !port_.busy();
    if (!reply && !broadcast_over) return expected_ > now ? expected_ : now + kPollInterval;
    const Job job = *std::exchange(under_way_, std::nullopt);
    if (reply && job.request.unit != kBroadcast) finish(job, *reply, events);
  }
  submit_next(now, events);
  tell_bus(events);
  if (under_way_) return expected_ > now ? expected_ : now + kPollInterval;
  return jobs_.empty() ? kNever : now + kPollInterval;
}

void ModbusDriver::submit_next(Instant now, EventSink& events) {
  if (jobs_.empty() || port_.busy()) return;
  const SendStatus status = submit(jobs_.front(), now);
  if (status == SendStatus::accepted) {
    jobs_.pop_front();
  } else if (status == SendStatus::down) {
    for (const Job& job : jobs_) events.on_event({DeviceEvent::Kind::missed, job.node, job.sequence});
    jobs_.clear();
  }
}

void ModbusDriver::finish(const Job& job, const ModbusReply& reply, EventSink& events) {
  DeviceEvent event{DeviceEvent::Kind::missed, job.node, job.sequence};
  const bool fits = reply.unit == job.request.unit && reply.function == job.request.function;
  if (reply.outcome == ModbusReply::Outcome::exception && fits) {
    if (reply.exception_code == kDeviceFailure && !job.retried) {
      jobs_.push_front(job);
      jobs_.front().retried = true;
      return;
    }
    event.kind = DeviceEvent::Kind::rejected;
    event.detail = reply.exception_code;
    events.on_event(event);
  } else if (reply.outcome != ModbusReply::Outcome::ok || !fits) {
    events.on_event(event);
  } else if (job.purpose == Purpose::status) {
    tell_status(job, reply, events);
  } else if (job.purpose == Purpose::preload) {
    event.kind = DeviceEvent::Kind::preloaded;
    events.on_event(event);
  }
}

void ModbusDriver::tell_status(const Job& job, const ModbusReply& reply, EventSink& events) {
  const auto status = modbus::decode_status(reply.values);
  if (!status) {
    events.on_event({DeviceEvent::Kind::missed, job.node, job.sequence});
    return;
  }
  std::optional<std::uint16_t>& boots = boots_[job.node];
  if (boots && *boots != status->boots) events.on_event({DeviceEvent::Kind::booted, job.node});
  boots = status->boots;
  DeviceEvent event{DeviceEvent::Kind::showing, job.node, status->shown_sequence};
  event.crc = status->crc;
  event.state = status->state;
  event.boots = status->boots;
  events.on_event(event);
}

void ModbusDriver::tell_bus(EventSink& events) {
  if (down_ == down_told_) return;
  down_told_ = down_;
  events.on_event({down_ ? DeviceEvent::Kind::bus_down : DeviceEvent::Kind::bus_up, NodeIndex{}});
}

}  // namespace footlight::drivers
