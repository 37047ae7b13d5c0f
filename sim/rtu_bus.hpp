// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "drivers/transport.hpp"
#include "sim/markers/modbus_marker.hpp"
#include "sim/modbus_line.hpp"
#include "sim/shared_line.hpp"
#include "sim/simulated_bus.hpp"

namespace footlight::sim {

/// Modbus RTU (Modbus over Serial Line V1.02): 11 bits a character as a rule, 3.5 characters of silence before each
/// frame and 1.75 ms above 19,200 Bd, nodes answer 0.5 to 5 ms after a request. A node knows a frame by the silence
/// after it, the port knows a reply by its length.
///
/// The port is as forgetful as real ones: a reply that comes when nobody waits any more stays in its receive buffer and
/// is the first thing that the next request hears. It passes over replies of other units, and a broadcast, which has no
/// reply, empties the buffer. So after one late reply every later request to that node is answered by the reply before
/// it, without an error, as libmodbus 3.1.6 does it. A frame that is heard twice is obeyed twice and answered once.
///
/// As a ModbusLine it takes any bytes for a frame, one after the other, and hands on whatever the nodes say.
class RtuBus final : public SimulatedBus, public drivers::ModbusPort, public ModbusLine, private SharedLine::Listener {
 public:
  /// From the last moment at which a reply may begin until nobody waits for it any more.
  static constexpr Duration kReplyMargin = milliseconds(25);
  static constexpr Duration kBroadcastGap = milliseconds(2);  ///< from the last bit, until the port is free

  RtuBus(const Bus& bus, const Surroundings& surroundings);

  std::size_t add(std::unique_ptr<SimulatedNode> node) override;
  void power_off(std::size_t slot) override;
  void power_on(std::size_t slot) override;
  void act(std::uint64_t token) override;

  drivers::SendStatus submit(const drivers::ModbusRequest& request) override;
  std::optional<drivers::ModbusReply> poll() override;
  [[nodiscard]] bool busy() const override { return phase_ != Phase::idle; }
  bool discard() override;
  [[nodiscard]] Duration wire_time(const drivers::ModbusRequest& request) const override;

  void say(int client, std::span<const std::uint8_t> frame) override;
  bool hear(int& client, std::vector<std::uint8_t>& frame) override;

 private:
  enum Kind : unsigned { kNodesHear, kNodeAnswers, kGiveUp, kBroadcastOver };
  enum class Phase { idle, sending, waiting, broadcast, stranger };
  /// Of a slow device, too: it answers every request, one after the other.
  struct Answers {
    std::deque<std::vector<std::uint8_t>> waiting;
    Instant free_at = kStart;      ///< the last of them has been given
    std::uint32_t generation = 0;  ///< changes with the power
  };

  void heard(int speaker, std::span<const std::uint8_t> bytes, bool copy) override;
  void draw_losses(int speaker, std::string& note) override;
  void request_is_out();
  void say_next();
  void nodes_hear();
  void node_hears(std::size_t slot, bool copy);
  void take(std::span<const std::uint8_t> frame);
  void give_up(std::uint32_t generation);
  void conclude(drivers::ModbusReply reply);
  /// Modbus over Serial Line V1.02, 2.5.1.1.
  static Duration silence(const Bus& bus);

  Duration silence_;
  SharedLine line_;
  std::vector<ModbusMarker> markers_;
  std::vector<Answers> answers_;
  std::vector<bool> missed_;
  bool controller_missed_ = false;

  Phase phase_ = Phase::idle;
  drivers::ModbusRequest request_;
  std::uint32_t generation_ = 0;      ///< of the request
  std::vector<std::uint8_t> in_air_;  ///< the request as the nodes hear it
  bool heard_twice_ = false;
  Instant quiet_at_ = kStart;  ///< the port may speak again
  std::optional<drivers::ModbusReply> reply_;
  std::deque<std::vector<std::uint8_t>> unread_;  ///< heard when nobody waited
  std::deque<std::vector<std::uint8_t>> unsaid_;  ///< of a stranger
};

}  // namespace footlight::sim
