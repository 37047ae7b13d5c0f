// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "drivers/transport.hpp"

namespace footlight::drivers {

/// An open serial device that never blocks; what a library has to give.
class SerialDevice {
 public:
  virtual ~SerialDevice() = default;
  /// @return bytes taken, 0 when the queue is full, nothing when the device is gone
  virtual std::optional<std::size_t> write_some(std::span<const std::uint8_t> bytes) = 0;
  /// @return bytes read, 0 when none has arrived, nothing when the device is gone
  virtual std::optional<std::size_t> read_some(std::span<std::uint8_t> buffer) = 0;
  /// File descriptor to poll for input.
  [[nodiscard]] virtual int poll_handle() const = 0;
};

using OpenSerialDevice = std::function<Result<std::unique_ptr<SerialDevice>>()>;

/// The whole-frame-or-nothing stream over a device. What the device has not taken yet waits here, and writes are busy
/// until it has. A device that is gone is opened anew by each write, so that a cable may be put back.
class SerialStream final : public ByteStream {
 public:
  /// @param bits_per_second of the wire, 10 bits a character (8N1)
  SerialStream(std::unique_ptr<SerialDevice> device, OpenSerialDevice reopen, int bits_per_second);

  SendStatus write(std::span<const std::uint8_t> bytes) override;
  std::size_t read(std::span<std::uint8_t> buffer) override;
  [[nodiscard]] Duration wire_time(std::size_t bytes) const override;
  [[nodiscard]] int poll_handle() const override { return device_ ? device_->poll_handle() : -1; }

 private:
  void push_unsent();
  void lose_device();

  std::unique_ptr<SerialDevice> device_;  ///< null: gone
  OpenSerialDevice reopen_;
  int bits_per_second_;
  std::vector<std::uint8_t> unsent_;
};

/// Opens a serial port by libserialport, or a pseudo-terminal, which that library refuses, by termios.
/// @param path as "/dev/serial/by-id/..."
/// Errors: ErrorKind::device, with what the machine said.
[[nodiscard]] Result<std::unique_ptr<ByteStream>> open_serial(const std::string& path, int bits_per_second);

/// The two kinds of device. libserialport's says so when the program was built without that library.
[[nodiscard]] Result<std::unique_ptr<SerialDevice>> open_serial_port_device(const std::string& path,
                                                                            int bits_per_second);
[[nodiscard]] Result<std::unique_ptr<SerialDevice>> open_terminal_device(const std::string& path);

}  // namespace footlight::drivers
