// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <iosfwd>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/clock.hpp"
#include "core/result.hpp"
#include "core/rig.hpp"
#include "drivers/transport.hpp"

namespace footlight::sim {

/// Faults drawn from a seed. "loss=5%,corrupt=1%,duplicate=1%,delay=3ms,reboot=2,dead=1"
struct Faults {
  double loss = 0;       ///< share of frames that a receiver does not hear, 0..0.3
  double corrupt = 0;    ///< share of frames with a flipped bit, 0..0.3
  double duplicate = 0;  ///< share of frames heard twice, 0..0.5
  Duration delay{};      ///< most that an answer is late, on top of the turnaround
  int reboot = 0;        ///< restarts of random nodes at random instants of the show
  int dead = 0;          ///< nodes that never answer and never light
  /// Errors name the part that is wrong and what is possible.
  static Result<Faults> parse(std::string_view text);
};

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
  /// @param show_length reboots fall into [show_start, show_start + show_length)
  /// @param trace one line for each frame, or null; borrowed for the life of the rig
  SimulatedRig(const Rig& rig, const Faults& faults, std::uint64_t seed, Instant show_start, Duration show_length,
               ManualClock& clock, std::ostream* trace);
  ~SimulatedRig();
  SimulatedRig(const SimulatedRig&) = delete;
  SimulatedRig& operator=(const SimulatedRig&) = delete;

  /// The port of a bus; the kind must be the bus's own.
  [[nodiscard]] drivers::ByteStream& serial(BusIndex bus);
  [[nodiscard]] drivers::CanPort& can(BusIndex bus);
  [[nodiscard]] drivers::ModbusPort& modbus(BusIndex bus);

  /// Instant of the next thing that happens by itself (a frame ends, a node answers, a lease runs out); kNever when
  /// nothing does.
  [[nodiscard]] Instant next_event() const;
  /// Lets everything up to and including `instant` happen and moves the clock there. Must not skip calls of the
  /// controller: advance at most to the earlier of next_event() and the controller's own wish.
  void advance_to(Instant instant);

  /// What a lamp shows now.
  [[nodiscard]] LookIndex shown(NodeIndex node, int channel) const;
  [[nodiscard]] BusUse use(BusIndex bus) const;
  [[nodiscard]] const std::vector<Reboot>& reboots() const;
  [[nodiscard]] const std::vector<NodeIndex>& dead() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace footlight::sim
