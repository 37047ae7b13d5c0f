// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/time.hpp"
#include "drivers/transport.hpp"

namespace footlight::sim {

/// A node of a CANopen bus, whatever device it is. Takes any frame; what it does not know it ignores. Holds no time:
/// who owns it sends what a reaction asks for.
class CanNode {
 public:
  /// What the node has to send because of a frame.
  enum class Reaction {
    none,
    status,     ///< status(), 0..5 ms after the SYNC
    boot_up,    ///< boot_up(), at once
    emergency,  ///< emergency(), at once
    sdo,        ///< sdo_answer(), at once
  };

  virtual ~CanNode() = default;
  /// Pre-operational; the model is powered on by its owner.
  virtual void power_on() = 0;
  virtual Reaction receive(const drivers::CanFrame& frame, Instant now) = 0;
  /// An error frame was seen on the bus.
  virtual void count_error() {}
  /// Its heartbeat is due. @return when the next one is
  virtual Duration beat(Instant now) = 0;

  [[nodiscard]] virtual drivers::CanFrame status() const { return {}; }
  [[nodiscard]] virtual drivers::CanFrame heartbeat() const = 0;
  [[nodiscard]] virtual drivers::CanFrame boot_up() const = 0;
  [[nodiscard]] virtual drivers::CanFrame emergency() const = 0;
  [[nodiscard]] virtual const drivers::CanFrame& sdo_answer() const = 0;
};

}  // namespace footlight::sim
