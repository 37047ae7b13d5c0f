// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>

#include <libserialport.h>
#include <linux/serial.h>
#include <sys/ioctl.h>

#include "drivers/transports/serial_device.hpp"
#include "drivers/transports/serial_ports.hpp"

namespace footlight::drivers {
namespace {

struct ClosePort {
  void operator()(sp_port* port) const {
    sp_close(port);  // an error only says that it was not open
    sp_free_port(port);
  }
};
using PortPointer = std::unique_ptr<sp_port, ClosePort>;

int file_of(const sp_port* port) {
  int file = -1;
  return sp_get_port_handle(port, &file) == SP_OK ? file : -1;
}

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

  [[nodiscard]] int poll_handle() const override { return file_of(port_.get()); }

 private:
  PortPointer port_;
};

std::string reason(sp_return code) {
  if (code != SP_ERR_FAIL) return code == SP_ERR_ARG ? "not a serial port" : "not supported by the port";
  const std::unique_ptr<char, decltype(&sp_free_error_message)> message(sp_last_error_message(), sp_free_error_message);
  return message.get();
}

using Outcome = std::pair<std::string, sp_return>;  // what was not possible; empty when all was

Outcome set(sp_port* port, const SerialSettings& settings) {
  constexpr const char* kCharacters = "its characters without flow control refused";
  const sp_parity parity = settings.characters == Characters::e1   ? SP_PARITY_EVEN
                           : settings.characters == Characters::o1 ? SP_PARITY_ODD
                                                                   : SP_PARITY_NONE;
  for (const sp_return code : {sp_set_bits(port, 8), sp_set_parity(port, parity),
                               sp_set_stopbits(port, settings.characters == Characters::n2 ? 2 : 1),
                               sp_set_flowcontrol(port, SP_FLOWCONTROL_NONE)}) {
    if (code != SP_OK) return {kCharacters, code};
  }
  const std::string speed = std::to_string(settings.bits_per_second) + " Bd refused";
  if (const sp_return code = sp_set_baudrate(port, settings.bits_per_second); code != SP_OK) return {speed, code};
  return {"", SP_OK};
}

/// A divisor that does not reach the speed is rounded in silence; receivers bear two per cent. 0: not known.
int speed_of(sp_port* port) {
  sp_port_config* config = nullptr;
  if (sp_new_config(&config) != SP_OK) return 0;
  int speed = 0;
  if (sp_get_config(port, config) != SP_OK || sp_get_config_baudrate(config, &speed) != SP_OK) speed = 0;
  sp_free_config(config);
  return speed;
}

/// An FTDI adapter holds what it has heard for 16 ms by default, with this for 1 ms. Not every driver has it.
void hold_nothing_back(int file) {
  struct serial_struct settings {};
  if (::ioctl(file, TIOCGSERIAL, &settings) != 0) return;
  settings.flags |= ASYNC_LOW_LATENCY;
  (void)::ioctl(file, TIOCSSERIAL, &settings);
}

std::string text_or_empty(const char* text) { return text == nullptr ? "" : text; }

SerialPort described(const sp_port* port) {
  SerialPort out;
  out.path = text_or_empty(sp_get_port_name(port));
  out.stable_path = stable_path_of(out.path, "/dev/serial/by-id");
  out.description = text_or_empty(sp_get_port_description(port));
  if (sp_get_port_transport(port) != SP_TRANSPORT_USB) return out;
  SerialPort::Usb usb;
  int vendor = 0;
  int product = 0;
  if (sp_get_port_usb_vid_pid(port, &vendor, &product) == SP_OK) {
    usb.vendor = static_cast<std::uint16_t>(vendor);
    usb.product = static_cast<std::uint16_t>(product);
  }
  usb.manufacturer = text_or_empty(sp_get_port_usb_manufacturer(port));
  usb.name = text_or_empty(sp_get_port_usb_product(port));
  usb.serial_number = text_or_empty(sp_get_port_usb_serial(port));
  out.usb = std::move(usb);
  return out;
}

}  // namespace

Result<std::vector<SerialPort>> list_serial_ports() {
  sp_port** list = nullptr;
  if (const sp_return code = sp_list_ports(&list); code != SP_OK) {
    return device_error("serial ports: not listed: " + reason(code));
  }
  std::vector<SerialPort> ports;
  for (sp_port** port = list; *port != nullptr; ++port) ports.push_back(described(*port));
  sp_free_port_list(list);
  std::ranges::sort(ports, {}, &SerialPort::path);
  return ports;
}

Result<std::unique_ptr<SerialDevice>> open_serial_port_device(const std::string& path, const SerialSettings& settings) {
  const auto failed = [&](const std::string& what, const std::string& why) {
    return device_error("serial port \"" + path + "\": " + what + ": " + why +
                        " (a port as listed in /dev/serial/by-id, and membership of the group dialout)");
  };
  std::error_code broken;
  const std::string name = std::filesystem::canonical(path, broken).string();  // the library knows no links
  sp_port* raw = nullptr;
  if (const sp_return code = sp_get_port_by_name(broken ? path.c_str() : name.c_str(), &raw); code != SP_OK) {
    return failed("not found", reason(code));
  }
  PortPointer port(raw);
  if (const sp_return code = sp_open(raw, SP_MODE_READ_WRITE); code != SP_OK) return failed("not opened", reason(code));
  if (::ioctl(file_of(raw), TIOCEXCL) != 0) return failed("not ours alone", std::generic_category().message(errno));
  if (const Outcome outcome = set(raw, settings); outcome.second != SP_OK) {
    return failed(outcome.first, reason(outcome.second));
  }
  const int speed = speed_of(raw);
  if (speed != 0 && std::abs(speed - settings.bits_per_second) > settings.bits_per_second / 50) {
    return failed(std::to_string(settings.bits_per_second) + " Bd refused",
                  "the nearest that it can do is " + std::to_string(speed));
  }
  hold_nothing_back(file_of(raw));
  sp_flush(raw, SP_BUF_BOTH);
  return std::unique_ptr<SerialDevice>(std::make_unique<LibserialportDevice>(std::move(port)));
}

}  // namespace footlight::drivers
