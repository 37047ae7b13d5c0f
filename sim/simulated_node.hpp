// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/index.hpp"
#include "core/rig.hpp"
#include "sim/markers/node_model.hpp"
#include "sim/trace.hpp"
#include "sim/world.hpp"

namespace footlight::sim {

/// One node on its supply: power, lease timer, and what of it is worth a line in the trace.
class SimulatedNode final : public Actor {
 public:
  /// @param model off  @param dead never gets power
  SimulatedNode(const Node& node, std::string_view bus, NodeModel model, bool dead, World& world, Trace& trace);

  void power_on();
  void power_off();
  /// To be called after anything was received: traces a latch, arms the lease timer.
  void after_receiving();
  void act(std::uint64_t token) override;

  [[nodiscard]] bool powered() const { return powered_; }
  /// Changes with every switch of the supply: what was under way before it does not happen.
  [[nodiscard]] std::uint32_t epoch() const { return epoch_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  /// As the rig has it; a marker may have taken another one since.
  [[nodiscard]] std::uint16_t address() const { return address_; }
  /// What its maker has given it: a check sum of its name.
  [[nodiscard]] std::uint32_t unique_id() const { return unique_id_; }
  [[nodiscard]] const NodeModel& model() const { return model_; }
  [[nodiscard]] NodeModel& model() { return model_; }
  [[nodiscard]] LookIndex shown(int channel) const { return powered_ ? model_.shown(channel) : kDark; }

 private:
  void note(std::string_view what);

  std::string name_;
  std::string_view bus_;
  std::uint16_t address_;
  std::uint32_t unique_id_;
  bool dead_;
  bool powered_ = false;
  bool armed_ = false;
  std::uint32_t epoch_ = 0;
  std::uint64_t latches_traced_ = 0;
  NodeModel model_;
  World& world_;
  Trace& trace_;
};

}  // namespace footlight::sim
