// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/time.hpp"

namespace footlight::drivers {

/// Answer of a port that never blocks.
enum class SendStatus {
  accepted,  ///< will be on the wire, or is already
  busy,      ///< queue full or a request under way: nothing was taken, try again after the next step
  down,      ///< the wire is gone
};

/// Bytes in, bytes out: serial ports, pseudo-terminals, the simulated serial bus. One owner; never blocks.
class ByteStream {
 public:
  virtual ~ByteStream() = default;
  /// All bytes or none.
  virtual SendStatus write(std::span<const std::uint8_t> bytes) = 0;
  /// @return how many bytes were put into `buffer`
  virtual std::size_t read(std::span<std::uint8_t> buffer) = 0;
  /// Time that `bytes` characters take on the wire.
  [[nodiscard]] virtual Duration wire_time(std::size_t bytes) const = 0;
  /// File descriptor that becomes readable when something arrives; -1: there is none now. Ask anew after each call of
  /// another member, for the wire may have been opened again.
  [[nodiscard]] virtual int poll_handle() const { return -1; }
  /// Why the wire is down, in whole words for people; empty while it is not.
  [[nodiscard]] virtual std::string trouble() const { return {}; }
};

/// A CAN data frame with an 11-bit identifier, or what the interface tells of the bus.
struct CanFrame {
  enum class Kind : std::uint8_t {
    classic,  ///< at most 8 bytes
    fd,       ///< CAN FD, all of it at the nominal bit rate
    fd_fast,  ///< CAN FD, the data at the second bit rate
    error,    ///< not on the bus: id holds the CAN_ERR_ classes of linux/can/error.h, data its eight bytes of detail
  };
  std::uint16_t id = 0;
  std::uint8_t length = 0;  ///< 0..8; CAN FD also 12, 16, 20, 24, 32, 48, 64
  std::array<std::uint8_t, 64> data{};
  Kind kind = Kind::classic;

  friend bool operator==(const CanFrame&, const CanFrame&) = default;
};

/// How a CAN interface stands; from `stalled` on nothing can be sent.
enum class CanState : std::uint8_t {
  active,   ///< error counters below 96
  warning,  ///< one of them at 96 or more
  passive,  ///< one of them at 128 or more
  stalled,  ///< frames wait and none leaves: mostly nobody is there to acknowledge
  bus_off,  ///< the transmit error counter passed 255: silent until the interface is restarted
  down,     ///< taken down, or its adapter pulled out
};

/// A CAN interface. One owner; never blocks.
class CanPort {
 public:
  virtual ~CanPort() = default;
  virtual SendStatus send(const CanFrame& frame) = 0;
  /// Data frames and error frames, in the order in which the interface told them; own frames are not among them.
  /// @return false when nothing has arrived
  virtual bool receive(CanFrame& frame) = 0;
  /// Time of one frame on the wire at worst stuffing, inter-frame space included.
  [[nodiscard]] virtual Duration wire_time(const CanFrame& frame) const = 0;
  /// Frames accepted and not known to have been on the wire.
  [[nodiscard]] virtual std::size_t queued() const = 0;
  /// As known after the last call of another member, but for `stalled`, which comes by the passing of time.
  [[nodiscard]] virtual CanState state() const = 0;
  /// As of ByteStream.
  [[nodiscard]] virtual int poll_handle() const { return -1; }
  /// As of ByteStream.
  [[nodiscard]] virtual std::string trouble() const { return {}; }
};

/// One Modbus request at the level of libmodbus; framing and check sums belong to the port.
struct ModbusRequest {
  std::uint8_t unit = 0;      ///< 0: broadcast, writes only, no answer
  std::uint8_t function = 3;  ///< 0x03 read holding registers, 0x06 write one, 0x10 write several; 0x01 read coils,
                              ///< 0x05 write one, 0x0F write several
  std::uint16_t first_register = 0;   ///< or coil
  std::uint16_t count = 0;            ///< registers or coils read, or values.size()
  std::vector<std::uint16_t> values;  ///< a coil is 0 or 1, with function 0x05 0 or 0xFF00
};

struct ModbusReply {
  enum class Outcome { ok, exception, timeout, garbled };
  Outcome outcome = Outcome::ok;
  std::uint8_t unit = 0;
  std::uint8_t function = 0;
  std::uint8_t exception_code = 0;    ///< 1..11 when outcome is exception
  std::vector<std::uint16_t> values;  ///< of a read; a coil is 0 or 1
};

/// A Modbus line or connection. One owner. One request at a time; simulated ports never block, a port of a blocking
/// library finishes the request inside `submit`.
class ModbusPort {
 public:
  virtual ~ModbusPort() = default;
  virtual SendStatus submit(const ModbusRequest& request) = 0;
  /// The reply to the request under way, once; a broadcast has none and is simply over.
  virtual std::optional<ModbusReply> poll() = 0;
  /// True while a request is on the wire or awaits its reply.
  [[nodiscard]] virtual bool busy() const = 0;
  /// Time on the wire of request, silences, the device's longest turnaround and reply.
  [[nodiscard]] virtual Duration wire_time(const ModbusRequest& request) const = 0;
  /// Throws away what has arrived and nobody waits for. Not while busy.
  /// @return true when there was something
  virtual bool discard() = 0;
  /// As of ByteStream; a port that finishes each request inside `submit` has none.
  [[nodiscard]] virtual int poll_handle() const { return -1; }
  /// As of ByteStream.
  [[nodiscard]] virtual std::string trouble() const { return {}; }
};

}  // namespace footlight::drivers
