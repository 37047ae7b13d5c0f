// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/look.hpp"
#include "drivers/transport.hpp"

namespace footlight::contracts {

/// Addresses of the two simulated markers at the far end of every bench, with four channels each; another is nobody's.
inline constexpr std::uint8_t kFirstMarker = 1;
inline constexpr std::uint8_t kSecondMarker = 2;
inline constexpr std::uint8_t kNobody = 9;
inline constexpr int kChannels = 4;

/// A port, real or simulated, with two markers at its far end.
template <class PortType>
class PortBench {
 public:
  virtual ~PortBench() = default;
  virtual PortType& port() = 0;
  /// Lets the far end do something: a millisecond at most.
  virtual void pass() = 0;
  /// What marker `address` shows now on its first channel.
  virtual LookIndex shown(std::uint8_t address) = 0;
  /// Pulls the cable, puts it back. @return false where nothing can be pulled
  virtual bool unplug() { return false; }
  virtual void replug() {}
  [[nodiscard]] virtual bool real() const = 0;
};

using SerialBench = PortBench<drivers::ByteStream>;
using ModbusBench = PortBench<drivers::ModbusPort>;

// Every transport of its kind that this machine has without hardware. The real ones answer from a thread of their own.
std::unique_ptr<SerialBench> simulated_serial();
std::unique_ptr<SerialBench> pseudo_terminal_serial();
std::unique_ptr<ModbusBench> simulated_rtu();
std::unique_ptr<ModbusBench> simulated_tcp();
std::unique_ptr<ModbusBench> pseudo_terminal_rtu();
std::unique_ptr<ModbusBench> loopback_tcp();

}  // namespace footlight::contracts
