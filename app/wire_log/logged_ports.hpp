// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <deque>
#include <memory>
#include <vector>

#include "app/wire_log/wire_log.hpp"
#include "drivers/registry.hpp"

namespace footlight::app {

/// Ports that do what other ports do and tell a log of it: the same for the simulated wires of a dry run and for real
/// ones. What a Modbus library does not hand out is put together again from request and reply: check sums, transaction
/// numbers, and for TCP the headers below. A reply that was garbled or did not come is not there.
class LoggedPorts {
 public:
  /// @param log borrowed, as are the ports
  explicit LoggedPorts(WireLog& log) : log_(log) {}
  /// @return a port in front of `port`, owned by this object
  [[nodiscard]] drivers::PortReference before(std::size_t bus, BusKind kind, drivers::PortReference port);
  /// Time that what went over a wire took there, both ways, as the port reckons it from its bits: of Modbus requests
  /// with the longest turnaround of a device, an upper bound. Any thread. @param nth port that was put in front, from 0
  [[nodiscard]] Duration carried(std::size_t nth) const noexcept {
    return Duration(carried_[nth].load(std::memory_order_relaxed));
  }

 private:
  WireLog& log_;
  std::deque<std::atomic<Duration::rep>> carried_;
  std::vector<drivers::Port> owned_;
};

}  // namespace footlight::app
