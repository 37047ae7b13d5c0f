// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <utility>

#include <libserialport.h>

#include "drivers/transports/serial_stream.hpp"

namespace footlight::drivers {
namespace {

struct ClosePort {
  void operator()(sp_port* port) const {
    sp_close(port);  // an error only says that it was not open
    sp_free_port(port);
  }
};
using PortPointer = std::unique_ptr<sp_port, ClosePort>;

class LibserialportDevice final : public SerialDevice {
 public:
  explicit LibserialportDevice(PortPointer port) : port_(std::move(port)) {}

  std::optional<std::size_t> write_some(std::span<const std::uint8_t> bytes) override {
    const int count = sp_nonblocking_write(port_.get(), bytes.data(), bytes.size());
    if (count < 0) return std::nullopt;
    return static_cast<std::size_t>(count);
  }

  std::optional<std::size_t> read_some(std::span<std::uint8_t> buffer) override {
    const int count = sp_nonblocking_read(port_.get(), buffer.data(), buffer.size());
    if (count < 0) return std::nullopt;
    // After an unplug reads go on returning 0 without an error; only this call tells.
    if (count == 0 && sp_input_waiting(port_.get()) < 0) return std::nullopt;
    return static_cast<std::size_t>(count);
  }

  [[nodiscard]] int poll_handle() const override {
    int file = -1;
    return sp_get_port_handle(port_.get(), &file) == SP_OK ? file : -1;
  }

 private:
  PortPointer port_;
};

std::string reason(sp_return code) {
  if (code != SP_ERR_FAIL) return code == SP_ERR_ARG ? "not a serial port" : "not supported by the port";
  const std::unique_ptr<char, decltype(&sp_free_error_message)> message(sp_last_error_message(), sp_free_error_message);
  return message.get();
}

}  // namespace

Result<std::unique_ptr<SerialDevice>> open_serial_port_device(const std::string& path, int bits_per_second) {
  const auto failed = [&](const std::string& what, sp_return code) {
    return device_error("serial port \"" + path + "\": " + what + ": " + reason(code) +
                        " (a port as listed in /dev/serial/by-id, and membership of the group dialout)");
  };
  sp_port* raw = nullptr;
  if (const sp_return code = sp_get_port_by_name(path.c_str(), &raw); code != SP_OK) return failed("not found", code);
  PortPointer port(raw);
  if (const sp_return code = sp_open(raw, SP_MODE_READ_WRITE); code != SP_OK) return failed("not opened", code);
  for (const sp_return code : {sp_set_bits(raw, 8), sp_set_parity(raw, SP_PARITY_NONE), sp_set_stopbits(raw, 1),
                               sp_set_flowcontrol(raw, SP_FLOWCONTROL_NONE)}) {
    if (code != SP_OK) return failed("8N1 without flow control refused", code);
  }
  if (const sp_return code = sp_set_baudrate(raw, bits_per_second); code != SP_OK) {
    return failed(std::to_string(bits_per_second) + " Bd refused", code);
  }
  sp_flush(raw, SP_BUF_BOTH);
  return std::unique_ptr<SerialDevice>(std::make_unique<LibserialportDevice>(std::move(port)));
}

}  // namespace footlight::drivers
