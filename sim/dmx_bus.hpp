// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <vector>

#include "core/look.hpp"
#include "drivers/transport.hpp"
#include "sim/markers/usb_pro_widget.hpp"
#include "sim/simulated_bus.hpp"

namespace footlight::sim {

/// A DMX line (ANSI E1.11) behind a DMX USB Pro widget. The widget repeats its last packet without end; new levels
/// reach the lamps at the end of the first packet that has them. A lamp that misses a packet takes the next one.
/// Nobody answers. A lamp has no looks, only levels.
class DmxBus final : public SimulatedBus, public drivers::ByteStream {
 public:
  static constexpr std::size_t kBuffer = 4096;

  DmxBus(const Bus& bus, const Surroundings& surroundings);

  std::size_t add(std::unique_ptr<SimulatedNode> node) override;
  void power_off(std::size_t slot) override { nodes_[slot]->power_off(); }
  void power_on(std::size_t slot) override { nodes_[slot]->power_on(); }
  void act(std::uint64_t token) override;

  drivers::SendStatus write(std::span<const std::uint8_t> bytes) override;
  std::size_t read(std::span<std::uint8_t> buffer) override;
  [[nodiscard]] Duration wire_time(std::size_t bytes) const override;

  /// Levels of the slots of one lamp; all 0 without power.
  [[nodiscard]] std::vector<std::uint8_t> levels(std::size_t slot, int channel) const;
  /// What an eye sees of it.
  [[nodiscard]] Colour colour(std::size_t slot, int channel) const;

 private:
  enum Kind : unsigned { kWidgetHears, kPacketEnds };

  UsbProWidget widget_;
  std::deque<std::vector<std::uint8_t>> on_the_way_;
  std::deque<std::array<std::uint8_t, UsbProWidget::kSlots>> packets_;
  std::array<std::uint8_t, UsbProWidget::kSlots> line_{};              ///< as the lamps know it
  std::vector<std::array<std::uint8_t, UsbProWidget::kSlots>> heard_;  ///< by each node
  std::deque<std::uint8_t> answers_;
  Instant sent_until_ = kStart;
  Instant packet_until_ = kStart;
};

}  // namespace footlight::sim
