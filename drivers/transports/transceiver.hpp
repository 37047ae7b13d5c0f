// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "core/result.hpp"
#include "drivers/transports/serial_device.hpp"

namespace footlight::drivers {

/// What the controller turns by itself on an RS-485 line: a modem line of the port, or a line of a GPIO chip.
class Transceiver {
 public:
  virtual ~Transceiver() = default;
  /// @return false when it cannot be turned any more
  virtual bool turn(bool speak) = 0;
};

/// @param file the open port
/// @return nothing to turn where adapter or kernel does it
/// Errors: ErrorKind::device: a kernel's driver that cannot, no modem lines, no such GPIO line.
[[nodiscard]] Result<std::unique_ptr<Transceiver>> make_transceiver(int file, const SerialLine& line);

/// Waits until everything that was written to a port is on the wire, its last stop bit included: sleeps for most of
/// the time that it takes, then asks the port (TIOCOUTQ, and its shift register by TIOCSERGETLSR where the driver
/// has it). Gives up 100 ms later.
/// @param written time of what was written
void await_sent(int file, Duration written);

/// A device that speaks only while it sends. A node may answer 200 us after the last bit, so `write_some` returns when
/// the line is turned back, and takes as long as its bytes do.
class TurnedDevice final : public SerialDevice {
 public:
  TurnedDevice(std::unique_ptr<SerialDevice> device, std::unique_ptr<Transceiver> transceiver, SerialSettings settings);
  ~TurnedDevice() override;
  TurnedDevice(const TurnedDevice&) = delete;
  TurnedDevice& operator=(const TurnedDevice&) = delete;

  std::optional<std::size_t> write_some(std::span<const std::uint8_t> bytes) override;
  std::optional<std::size_t> read_some(std::span<std::uint8_t> buffer) override { return device_->read_some(buffer); }
  [[nodiscard]] int poll_handle() const override { return device_->poll_handle(); }
  [[nodiscard]] bool turned_by_us() const override { return true; }
  void speak() override;
  void listen(Duration written) override;

 private:
  std::unique_ptr<SerialDevice> device_;
  std::unique_ptr<Transceiver> transceiver_;
  SerialSettings settings_;
};

}  // namespace footlight::drivers
