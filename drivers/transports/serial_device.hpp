// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "core/result.hpp"
#include "core/rig.hpp"
#include "core/time.hpp"

namespace footlight::drivers {

/// An open serial device that never blocks, but for the time of its own bytes where the controller turns the
/// transceiver; what a library has to give.
class SerialDevice {
 public:
  virtual ~SerialDevice() = default;
  /// @return bytes taken, 0 when the queue is full, nothing when the device is gone
  virtual std::optional<std::size_t> write_some(std::span<const std::uint8_t> bytes) = 0;
  /// @return bytes read, 0 when none has arrived, nothing when the device is gone
  virtual std::optional<std::size_t> read_some(std::span<std::uint8_t> buffer) = 0;
  /// File descriptor to poll for input.
  [[nodiscard]] virtual int poll_handle() const = 0;
  /// True when somebody else who writes to `poll_handle` has to call `speak` before and `listen` after it.
  [[nodiscard]] virtual bool turned_by_us() const { return false; }
  virtual void speak() {}
  /// Blocks until what was written is on the wire. @param written time that it takes
  virtual void listen(Duration /*written*/) {}
};

/// Speed, characters and direction of a line.
struct SerialSettings {
  int bits_per_second = 115'200;
  Characters characters = Characters::n1;
  SerialLine line{};  ///< for its direction

  [[nodiscard]] static SerialSettings of(const Bus& bus) { return {bus.bits_per_second, bus.characters(), bus.line}; }
  [[nodiscard]] int bits_per_character() const { return characters == Characters::n1 ? 10 : 11; }
  /// Time of `characters` on the wire, rounded up.
  [[nodiscard]] Duration time_of(std::size_t characters) const;
};

/// Opens a serial port by libserialport, or a pseudo-terminal, which that library refuses, by termios; sets its
/// direction.
/// @param place as "/dev/serial/by-id/...", or "usb/NUMBER" for the port of the adapter with that USB serial number
/// Errors: ErrorKind::device, with what the machine said.
[[nodiscard]] Result<std::unique_ptr<SerialDevice>> open_serial_device(const std::string& place,
                                                                       const SerialSettings& settings);

/// The two kinds of device, without direction. libserialport's says so when the program was built without that library.
[[nodiscard]] Result<std::unique_ptr<SerialDevice>> open_serial_port_device(const std::string& path,
                                                                            const SerialSettings& settings);
[[nodiscard]] Result<std::unique_ptr<SerialDevice>> open_terminal_device(const std::string& path);

}  // namespace footlight::drivers
