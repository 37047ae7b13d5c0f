// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace footlight::sim {

/// A Modbus bus as any other program finds it: whole frames as they are on the wire, framing and check sums included.
/// Who speaks here does not use the bus's port.
class ModbusLine {
 public:
  virtual ~ModbusLine() = default;
  /// @param client who speaks; over TCP the answer goes to the same one, a serial line has only one
  virtual void say(int client, std::span<const std::uint8_t> frame) = 0;
  /// The next frame of a node that has arrived. @return false when there is none
  virtual bool hear(int& client, std::vector<std::uint8_t>& frame) = 0;
};

}  // namespace footlight::sim
