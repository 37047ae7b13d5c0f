// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <span>
#include <vector>

#include "app/wire_log/pcapng.hpp"
#include "core/clock.hpp"
#include "core/rig.hpp"

namespace footlight::app {

/// Takes what goes over the wires of a rig, in the format of the wire's link type (docs/wire-protocol.md, "Wire logs").
class WireLog {
 public:
  virtual ~WireLog() = default;
  /// Thread: the owner of that bus. Hot path: must neither block nor allocate where it serves a show in real time.
  virtual void record(std::size_t bus, Heading heading, std::span<const std::uint8_t> packet) noexcept = 0;
};

/// Writes at once: for dry runs, in whose time writing takes none.
class DirectWireLog final : public WireLog {
 public:
  /// @param clock its zero counts as 1970-01-01, so that equal runs give equal files; borrowed, as is `out`
  DirectWireLog(std::ostream& out, const Rig& rig, const Clock& clock) : writer_(out), clock_(clock) {
    writer_.begin(wires_of(rig));
  }
  void record(std::size_t bus, Heading heading, std::span<const std::uint8_t> packet) noexcept override {
    writer_.packet(bus, clock_.now().time_since_epoch(), heading, packet);
  }

 private:
  PcapngWriter writer_;
  const Clock& clock_;
};

}  // namespace footlight::app
