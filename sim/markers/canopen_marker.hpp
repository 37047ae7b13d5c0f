// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "drivers/transport.hpp"
#include "sim/markers/can_node.hpp"
#include "sim/markers/canopen_objects.hpp"
#include "sim/markers/nmt_state.hpp"
#include "sim/markers/node_model.hpp"
#include "sim/markers/sdo_server.hpp"

namespace footlight::sim {

/// A marker node that speaks CANopen (docs/wire-protocol.md, section 3).
class CanopenMarker final : public CanNode {
 public:
  /// @param id 1..126  @param model borrowed  @param serial its own serial number
  CanopenMarker(std::uint8_t id, NodeModel& model, std::uint32_t serial = 0)
      : id_(id), model_(model), objects_(id, serial, model, counters_), sdo_(id, objects_) {}
  CanopenMarker(const CanopenMarker&) = delete;  // its parts know each other
  CanopenMarker& operator=(const CanopenMarker&) = delete;

  void power_on() override;
  Reaction receive(const drivers::CanFrame& frame, Instant now) override;
  void count_error() override { ++counters_.errors; }
  Duration beat(Instant /*now*/) override { return milliseconds(1000); }

  [[nodiscard]] drivers::CanFrame status() const override;
  [[nodiscard]] drivers::CanFrame heartbeat() const override;
  [[nodiscard]] drivers::CanFrame boot_up() const override;
  [[nodiscard]] drivers::CanFrame emergency() const override;
  [[nodiscard]] const drivers::CanFrame& sdo_answer() const override { return sdo_answer_; }
  [[nodiscard]] const CanopenObjects& objects() const { return objects_; }

 private:
  Reaction manage(const drivers::CanFrame& frame, Instant now);
  Reaction take_pdo(int number, const drivers::CanFrame& frame);
  Reaction take_mpdo(const drivers::CanFrame& frame, Instant now);
  [[nodiscard]] bool refuses(Instant now) const { return refuses_ && model_.epoch(now) != 0; }
  Reaction take_lead(std::uint32_t epoch, Instant now);

  std::uint8_t id_;
  NodeModel& model_;
  NmtState nmt_ = NmtState::pre_operational;
  CanopenObjects::Counters counters_;
  CanopenObjects objects_;
  SdoServer sdo_;
  drivers::CanFrame sdo_answer_;
  bool refuses_ = false;      ///< who spoke last leads under an older epoch
  bool tells_fence_ = false;  ///< the emergency to send is that of a refused LEAD
  std::uint32_t fenced_by_ = 0;
};

}  // namespace footlight::sim
