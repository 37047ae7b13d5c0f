// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "drivers/transport.hpp"
#include "sim/markers/modbus_marker.hpp"
#include "sim/modbus_line.hpp"
#include "sim/simulated_bus.hpp"

namespace footlight::sim {

/// Modbus TCP: a connection a node, in order, with a latency of its own; no wire to share, so a broadcast goes to each
/// node in turn. What is lost or corrupted below is sent again by TCP 200 ms later and holds up what follows it;
/// duplicates do not reach the application. Use is counted on a network of 100 Mbit/s.
///
/// As a ModbusLine it is a gateway: a frame goes to the node of its unit id, its answer to the client that asked; for
/// a unit that nobody is, there is none.
class TcpBus final : public SimulatedBus, public drivers::ModbusPort, public ModbusLine {
 public:
  static constexpr Duration kReplyTimeout = milliseconds(30);

  TcpBus(const Bus& bus, const Surroundings& surroundings) : SimulatedBus(bus, surroundings) {}

  std::size_t add(std::unique_ptr<SimulatedNode> node) override;
  void power_off(std::size_t slot) override;
  void power_on(std::size_t slot) override;
  void act(std::uint64_t token) override;

  drivers::SendStatus submit(const drivers::ModbusRequest& request) override;
  std::optional<drivers::ModbusReply> poll() override;
  [[nodiscard]] bool busy() const override { return busy_; }
  bool discard() override { return false; }  // what belongs to another transaction has been passed over already
  [[nodiscard]] Duration wire_time(const drivers::ModbusRequest& request) const override;

  void say(int client, std::span<const std::uint8_t> frame) override;
  bool hear(int& client, std::vector<std::uint8_t>& frame) override;

 private:
  enum Kind : unsigned { kNodeHears, kNodeAnswers, kPortHears, kGiveUp, kBroadcastOver };
  static constexpr int kPort = -1;  ///< who asks is the bus's own port
  struct Connection {
    Duration latency{};             ///< one way
    Instant last_to_node = kStart;  ///< nothing overtakes
    Instant last_to_port = kStart;
  };
  struct Message {
    std::size_t slot = 0;
    std::uint32_t epoch = 0;
    bool sent_again = false;
    std::vector<std::uint8_t> bytes;
    int client = kPort;
  };

  Instant transmit(Message message, Kind kind, Instant from);
  void trace(const Message& message, char direction);
  void node_hears(Message message);
  void port_hears(const Message& message);
  std::size_t keep(Message message);
  Message release(std::size_t place);

  std::vector<ModbusMarker> markers_;
  std::vector<Connection> connections_;
  std::vector<Message> messages_;
  std::vector<std::size_t> free_;
  bool busy_ = false;
  std::uint16_t transaction_ = 0;
  std::uint32_t generation_ = 0;
  drivers::ModbusRequest request_;
  std::optional<drivers::ModbusReply> reply_;
  std::deque<std::pair<int, std::vector<std::uint8_t>>> unheard_;  ///< by strangers
};

}  // namespace footlight::sim
