// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "drivers/transport.hpp"
#include "sim/markers/canopen_objects.hpp"
#include "sim/markers/node_model.hpp"
#include "sim/markers/sdo_server.hpp"

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
    emergency,  ///< emergency(), at once
    sdo,        ///< sdo_answer(), at once
  };

  /// @param id 1..126  @param model borrowed  @param serial its own serial number
  CanopenMarker(std::uint8_t id, NodeModel& model, std::uint32_t serial = 0)
      : id_(id), model_(model), objects_(id, serial, model, counters_), sdo_(id, objects_) {}
  CanopenMarker(const CanopenMarker&) = delete;  // its parts know each other
  CanopenMarker& operator=(const CanopenMarker&) = delete;

  /// Pre-operational; the model is powered on by its owner.
  void power_on();
  Reaction receive(const drivers::CanFrame& frame, Instant now);
  /// An error frame was seen on the bus.
  void count_error() { ++counters_.errors; }

  [[nodiscard]] drivers::CanFrame status() const;
  [[nodiscard]] drivers::CanFrame heartbeat() const;
  [[nodiscard]] drivers::CanFrame boot_up() const;
  [[nodiscard]] drivers::CanFrame emergency() const;
  [[nodiscard]] const drivers::CanFrame& sdo_answer() const { return sdo_answer_; }
  [[nodiscard]] const CanopenObjects& objects() const { return objects_; }

 private:
  enum class NmtState : std::uint8_t { stopped = 4, operational = 5, pre_operational = 127 };

  Reaction manage(const drivers::CanFrame& frame, Instant now);
  Reaction take_pdo(int number, const drivers::CanFrame& frame);
  void take_mpdo(const drivers::CanFrame& frame);

  std::uint8_t id_;
  NodeModel& model_;
  NmtState nmt_ = NmtState::pre_operational;
  CanopenObjects::Counters counters_;
  CanopenObjects objects_;
  SdoServer sdo_;
  drivers::CanFrame sdo_answer_;
};

}  // namespace footlight::sim
