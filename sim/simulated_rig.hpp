// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <iosfwd>
#include <memory>
#include <optional>
#include <vector>

#include "core/clock.hpp"
#include "core/look.hpp"
#include "core/rig.hpp"
#include "drivers/transport.hpp"
#include "sim/faults.hpp"
#include "sim/markers/node_model.hpp"
#include "sim/modbus_line.hpp"

namespace footlight::sim {

/// Wire time of a bus since the start.
struct BusUse {
  Duration busy{};
  std::uint64_t frames = 0;
};

/// A node's restart in virtual time; from `at` until it is lit again it is exempt for 1.25 s.
struct Reboot {
  NodeIndex node;
  Instant at;
};

/// The buses of a rig with their markers, in virtual time: exact wire timing, seeded faults, one ordered trace. Markers
/// decode the wire by docs/wire-protocol.md and share no code with the drivers. Deterministic for rig, faults, seed and
/// calls.
class SimulatedRig {
 public:
  /// @param trace one line for each frame, or null; borrowed for the life of the rig
  SimulatedRig(const Rig& rig, const Faults& faults, std::uint64_t seed, ManualClock& clock, std::ostream* trace);
  ~SimulatedRig();
  SimulatedRig(const SimulatedRig&) = delete;
  SimulatedRig& operator=(const SimulatedRig&) = delete;

  /// Draws the reboots in [start, start + length * faults.until), where the faults end. At most once, not after
  /// `start`.
  void set_show(Instant start, Duration length);

  /// The port of a bus; the kind must be the bus's own.
  [[nodiscard]] drivers::ByteStream& serial(BusIndex bus);
  [[nodiscard]] drivers::CanPort& can(BusIndex bus);
  [[nodiscard]] drivers::ModbusPort& modbus(BusIndex bus);
  /// A Modbus bus for other programs, instead of its port.
  [[nodiscard]] ModbusLine& modbus_line(BusIndex bus);

  /// Instant of the next thing that happens by itself (a frame ends, a node answers, a lease runs out); kNever when
  /// nothing does.
  [[nodiscard]] Instant next_event() const;
  /// Lets everything up to and including `instant` happen and moves the clock there. Must not skip calls of the
  /// controller: advance at most to the earlier of next_event() and the controller's own wish.
  void advance_to(Instant instant);

  /// From now on nothing more goes wrong; what has been drawn already happens. Comes by itself where Faults::until
  /// says.
  void end_faults();
  /// When that was; kNever before.
  [[nodiscard]] Instant faults_end() const;
  /// Lets it happen to a bus now. @return false: that kind of bus knows no such fault
  bool strike(BusIndex bus, LineFault fault);
  /// What a lamp shows now.
  [[nodiscard]] LookIndex shown(NodeIndex node, int channel) const;
  /// How it looks now: the entry of the node's own table; black without power; white and blinking when it identifies
  /// itself.
  [[nodiscard]] Look lamp(NodeIndex node, int channel) const;
  /// What a wearable tells besides its look (Footlight serial), and the counts that it still counts down.
  [[nodiscard]] const NodeContent& content(NodeIndex node, int channel) const;
  [[nodiscard]] std::optional<int> counts_left(NodeIndex node, int channel) const;
  /// Levels of a lamp's slots on a DMX bus.
  [[nodiscard]] std::vector<std::uint8_t> levels(NodeIndex node, int channel) const;
  [[nodiscard]] bool powered(NodeIndex node) const;
  /// True while the node keeps what it shows because it has not heard the controller for a second.
  [[nodiscard]] bool holds(NodeIndex node) const;
  [[nodiscard]] BusUse use(BusIndex bus) const;
  [[nodiscard]] const std::vector<Reboot>& reboots() const;
  [[nodiscard]] const std::vector<NodeIndex>& dead() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
  Faults faults_;
  std::uint64_t seed_ = 0;
};

}  // namespace footlight::sim
