// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <vector>

#include "drivers/transport.hpp"
#include "sim/markers/serial_marker.hpp"
#include "sim/shared_line.hpp"
#include "sim/simulated_bus.hpp"

namespace footlight::sim {

/// Footlight serial over RS-485: 10 bits a character as a rule, answers 200 us to 2 ms after the request. Faults strike
/// what lies between two frame delimiters, however the controller has cut its writes.
class SerialBus final : public SimulatedBus, public drivers::ByteStream, private SharedLine::Listener {
 public:
  /// Bytes that the port takes before it is busy.
  static constexpr std::size_t kBuffer = 4096;

  SerialBus(const Bus& bus, const Surroundings& surroundings);

  std::size_t add(std::unique_ptr<SimulatedNode> node) override;
  void power_off(std::size_t slot) override;
  void power_on(std::size_t slot) override;
  /// A node answers.
  void act(std::uint64_t token) override;

  drivers::SendStatus write(std::span<const std::uint8_t> bytes) override;
  std::size_t read(std::span<std::uint8_t> buffer) override;
  [[nodiscard]] Duration wire_time(std::size_t bytes) const override { return line_.time_of(bytes); }

 private:
  struct Answer {
    std::vector<std::uint8_t> bytes;
    std::uint32_t generation = 0;  ///< a new request takes the place of an old one
  };

  void heard(int speaker, std::span<const std::uint8_t> bytes, bool copy) override;
  void draw_losses(int speaker, std::string& note) override;
  void node_hears(std::size_t slot, std::span<const std::uint8_t> bytes);

  SharedLine line_;
  std::vector<SerialMarker> markers_;
  std::vector<Answer> answers_;
  std::vector<bool> missed_;
  bool controller_missed_ = false;
  std::deque<std::uint8_t> received_;
  Instant sent_until_ = kStart;
};

}  // namespace footlight::sim
