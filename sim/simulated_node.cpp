// SPDX-License-Identifier: Apache-2.0
#include "sim/simulated_node.hpp"

#include <span>

#include "core/check.hpp"
#include "sim/markers/check_sums.hpp"

namespace footlight::sim {

SimulatedNode::SimulatedNode(const Node& node, std::string_view bus, NodeModel model, bool dead, World& world,
                             Trace& trace)
    : name_(node.name),
      bus_(bus),
      address_(static_cast<std::uint16_t>(node.address)),
      unique_id_(crc32_ieee(std::span(reinterpret_cast<const std::uint8_t*>(name_.data()), name_.size()))),
      dead_(dead),
      model_(model),
      world_(world),
      trace_(trace) {
  FL_CHECK(node.address >= 1 && node.address <= 512);
}

void SimulatedNode::power_on() {
  if (dead_ || powered_) return;
  powered_ = true;
  ++epoch_;
  model_.power_on(world_.now());
  if (model_.boots() > 1) note("powered on");
}

void SimulatedNode::power_off() {
  if (!powered_) return;
  powered_ = false;
  ++epoch_;
  note("powered off");
}

void SimulatedNode::after_receiving() {
  if (model_.latches() != latches_traced_) {
    latches_traced_ = model_.latches();
    if (trace_.on()) note("latched " + std::to_string(model_.shown_sequence()));
  }
  // One timer is enough: when it fires too early, because of a heartbeat meanwhile, it is set again.
  if (armed_ || model_.lease_end() == kNever) return;
  armed_ = true;
  world_.schedule(model_.lease_end(), *this);
}

void SimulatedNode::act(std::uint64_t) {
  armed_ = false;
  if (!powered_) return;
  const NodeState before = model_.state();
  model_.settle(world_.now());
  if (model_.state() != before) note(model_.state() == NodeState::hold ? "holds" : "lost guidance");
  after_receiving();
}

void SimulatedNode::note(std::string_view what) {
  if (trace_.on()) trace_.line(world_.now(), bus_, '*', {}, name_ + " " + std::string(what));
}

}  // namespace footlight::sim
