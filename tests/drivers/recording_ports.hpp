// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "drivers/driver.hpp"
#include "drivers/transport.hpp"
#include "drivers/transports/can_socket.hpp"
#include "drivers/transports/modbus_port.hpp"

namespace footlight::drivers {

/// Ports that keep what a driver puts on them, and give it what a test puts there.
class RecordingStream final : public ByteStream {
 public:
  SendStatus write(std::span<const std::uint8_t> bytes) override {
    if (status != SendStatus::accepted) return status;
    sent.emplace_back(bytes.begin(), bytes.end());
    return SendStatus::accepted;
  }
  std::size_t read(std::span<std::uint8_t> buffer) override {
    const std::size_t count = std::min(buffer.size(), incoming.size());
    std::copy_n(incoming.begin(), count, buffer.begin());
    incoming.erase(incoming.begin(), incoming.begin() + static_cast<std::ptrdiff_t>(count));
    return count;
  }
  [[nodiscard]] Duration wire_time(std::size_t bytes) const override {
    return Duration(static_cast<Duration::rep>(bytes) * 10 * 1'000'000'000 / 115'200);
  }
  void hear(const std::vector<std::uint8_t>& bytes) { incoming.insert(incoming.end(), bytes.begin(), bytes.end()); }

  SendStatus status = SendStatus::accepted;
  std::vector<std::vector<std::uint8_t>> sent;
  std::deque<std::uint8_t> incoming;
};

class RecordingCan final : public CanPort {
 public:
  SendStatus send(const CanFrame& frame) override {
    if (status != SendStatus::accepted) return status;
    if (in_queue == capacity) return SendStatus::busy;
    ++in_queue;
    sent.push_back(frame);
    return SendStatus::accepted;
  }
  bool receive(CanFrame& frame) override {
    if (incoming.empty()) return false;
    frame = incoming.front();
    incoming.pop_front();
    return true;
  }
  [[nodiscard]] Duration wire_time(const CanFrame& frame) const override {
    return microseconds(2) * worst_can_bits(frame.length);
  }
  [[nodiscard]] std::size_t queued() const override { return in_queue; }
  [[nodiscard]] CanState state() const override { return status == SendStatus::down ? CanState::down : bus; }

  SendStatus status = SendStatus::accepted;
  CanState bus = CanState::active;
  std::size_t capacity = 10;
  std::size_t in_queue = 0;
  std::vector<CanFrame> sent;
  std::deque<CanFrame> incoming;
};

class RecordingModbus final : public ModbusPort {
 public:
  SendStatus submit(const ModbusRequest& request) override {
    if (status != SendStatus::accepted) return status;
    if (taken) return SendStatus::busy;
    taken = true;
    sent.push_back(request);
    return SendStatus::accepted;
  }
  std::optional<ModbusReply> poll() override {
    if (!reply) return std::nullopt;
    taken = false;
    return std::exchange(reply, std::nullopt);
  }
  [[nodiscard]] bool busy() const override { return taken; }
  bool discard() override {
    ++discards;
    return std::exchange(unread, false);
  }
  [[nodiscard]] Duration wire_time(const ModbusRequest& request) const override {
    return rtu_wire_time(request, 115'200);
  }
  /// The device's answer to the last request.
  void answer(ModbusReply::Outcome outcome, std::vector<std::uint16_t> values = {}, std::uint8_t exception = 0) {
    reply = ModbusReply{outcome, sent.back().unit, sent.back().function, exception, std::move(values)};
  }

  SendStatus status = SendStatus::accepted;
  bool taken = false;
  bool unread = false;  ///< something has arrived that nobody waits for
  int discards = 0;
  std::optional<ModbusReply> reply;
  std::vector<ModbusRequest> sent;
};

class EventLog final : public EventSink {
 public:
  void on_event(const DeviceEvent& event) override { events.push_back(event); }
  void on_answer(const ServiceAnswer& answer) override { answers.push_back(answer); }
  [[nodiscard]] std::size_t count(DeviceEvent::Kind kind) const {
    return static_cast<std::size_t>(
        std::count_if(events.begin(), events.end(), [&](const DeviceEvent& event) { return event.kind == kind; }));
  }
  [[nodiscard]] const DeviceEvent* last(DeviceEvent::Kind kind) const {
    const auto found =
        std::find_if(events.rbegin(), events.rend(), [&](const DeviceEvent& event) { return event.kind == kind; });
    return found == events.rend() ? nullptr : &*found;
  }

  std::vector<DeviceEvent> events;
  std::vector<ServiceAnswer> answers;
};

}  // namespace footlight::drivers
