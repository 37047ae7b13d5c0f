// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "drivers/transport.hpp"
#include "sim/markers/node_model.hpp"

namespace footlight::sim {

/// A marker node that speaks CANopen (docs/wire-protocol.md, section 3). Takes any frame; what it does not know it
/// ignores. Holds no time: who owns it sends what a reaction asks for.
class CanopenMarker {
 public:
  /// What the node has to send because of a frame.
  enum class Reaction {
    none,
    status,     ///< status(), 0..5 ms after the SYNC
    boot_up,    ///< boot_up(), at once
    emergency,  ///< length_emergency(), at once
  };

  /// @param id 1..126  @param model borrowed
  CanopenMarker(std::uint8_t id, NodeModel& model) : id_(id), model_(model) {}

  /// Pre-operational; the model is powered on by its owner.
  void power_on();
  Reaction receive(const drivers::CanFrame& frame, Instant now);
  /// An error frame was seen on the bus.
  void count_error() { ++errors_; }

  [[nodiscard]] drivers::CanFrame status() const;
  [[nodiscard]] drivers::CanFrame heartbeat() const;
  [[nodiscard]] drivers::CanFrame boot_up() const;
  [[nodiscard]] drivers::CanFrame length_emergency() const;

 private:
  enum class NmtState : std::uint8_t { stopped = 4, operational = 5, pre_operational = 127 };

  Reaction manage(const drivers::CanFrame& frame, Instant now);
  Reaction take_pdo(int number, const drivers::CanFrame& frame);
  void take_mpdo(const drivers::CanFrame& frame);

  std::uint8_t id_;
  NodeModel& model_;
  NmtState nmt_ = NmtState::pre_operational;
  std::uint16_t errors_ = 0;
};

}  // namespace footlight::sim
