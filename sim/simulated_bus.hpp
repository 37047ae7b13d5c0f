// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/check.hpp"
#include "core/rig.hpp"
#include "core/rng.hpp"
#include "sim/faults.hpp"
#include "sim/simulated_node.hpp"
#include "sim/simulated_rig.hpp"
#include "sim/trace.hpp"
#include "sim/world.hpp"

namespace footlight::sim {

/// What every bus lives in. World and trace are borrowed; the chances are the bus's own.
struct Surroundings {
  World& world;
  Trace& trace;
  Chance faults;
  Chance timing;  ///< jitter and turnarounds; apart from the faults, so that faults do not shift it
};

/// Speaker of the controller on a bus; nodes speak under their slot.
inline constexpr int kController = -1;

/// @return the time of `bits` on a wire, to the nearest nanosecond
[[nodiscard]] constexpr Duration bit_time(std::int64_t bits, std::int64_t bits_per_second) {
  return Duration((bits * 1'000'000'000 + bits_per_second / 2) / bits_per_second);
}

/// A wire with its nodes. A node's slot is its place in the order of addition.
class SimulatedBus : public Actor {
 public:
  SimulatedBus(const Bus& bus, const Surroundings& surroundings) : bus_(bus), around_(surroundings) {}

  /// @return the slot
  virtual std::size_t add(std::unique_ptr<SimulatedNode> node) = 0;
  /// The show begins: whatever has power has had it for a while.
  virtual void begin() {
    for (auto& node : nodes_) node->power_on();
  }
  void end_faults() {
    around_.faults.end();
    around_.timing.end();
  }
  /// @return false: this kind of bus knows no such fault, and nothing happens
  virtual bool strike(LineFault /*fault*/) { return false; }
  virtual void power_off(std::size_t slot) = 0;
  virtual void power_on(std::size_t slot) = 0;

  [[nodiscard]] const SimulatedNode& node(std::size_t slot) const { return *nodes_.at(slot); }
  [[nodiscard]] BusUse use() const { return use_; }
  [[nodiscard]] const Bus& bus() const { return bus_; }

 protected:
  /// A token for an event of a node, or of anything counted.
  static constexpr std::uint64_t token(unsigned kind, std::size_t slot, std::uint32_t generation) {
    return (std::uint64_t{generation} << 32U) | (static_cast<std::uint64_t>(slot) << 8U) | kind;
  }
  static constexpr unsigned kind_of(std::uint64_t token) { return token & 0xFFU; }
  static constexpr std::size_t slot_of(std::uint64_t token) { return (token >> 8U) & 0xFFFFFFU; }
  static constexpr std::uint32_t generation_of(std::uint64_t token) { return static_cast<std::uint32_t>(token >> 32U); }

  /// Whether a receiver misses a frame; if so, its name goes into the note of the frame.
  bool misses(const std::string& receiver, std::string& note) {
    if (!around_.faults.lost()) return false;
    if (around_.trace.on()) note.append(note.empty() ? "lost by " : ", lost by ").append(receiver);
    return true;
  }

  const Bus& bus_;
  Surroundings around_;
  std::vector<std::unique_ptr<SimulatedNode>> nodes_;
  BusUse use_;
};

}  // namespace footlight::sim
