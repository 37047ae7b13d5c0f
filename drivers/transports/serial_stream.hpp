// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "drivers/transport.hpp"
#include "drivers/transports/serial_device.hpp"

namespace footlight::drivers {

using OpenSerialDevice = std::function<Result<std::unique_ptr<SerialDevice>>()>;

/// The whole-frame-or-nothing stream over a device. What the device has not taken yet waits here, and writes are busy
/// until it has. A device that is gone is opened anew by each write, so that a cable may be put back.
class SerialStream final : public ByteStream {
 public:
  SerialStream(std::unique_ptr<SerialDevice> device, OpenSerialDevice reopen, SerialSettings settings);

  SendStatus write(std::span<const std::uint8_t> bytes) override;
  std::size_t read(std::span<std::uint8_t> buffer) override;
  [[nodiscard]] Duration wire_time(std::size_t bytes) const override { return settings_.time_of(bytes); }
  [[nodiscard]] int poll_handle() const override { return device_ ? device_->poll_handle() : -1; }
  [[nodiscard]] std::string trouble() const override { return trouble_; }

 private:
  void push_unsent();
  void lose_device();

  std::unique_ptr<SerialDevice> device_;  ///< null: gone
  OpenSerialDevice reopen_;
  SerialSettings settings_;
  std::vector<std::uint8_t> unsent_;
  std::string trouble_;
};

/// @param place as of open_serial_device
/// Errors: ErrorKind::device, with what the machine said.
[[nodiscard]] Result<std::unique_ptr<ByteStream>> open_serial(const std::string& place, const SerialSettings& settings);

}  // namespace footlight::drivers
