// SPDX-License-Identifier: Apache-2.0
#include "app/machine_wires.hpp"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "drivers/transports/urls.hpp"

namespace footlight::app {
namespace {

using Json = nlohmann::ordered_json;
using drivers::CanInterface;
using drivers::CanState;
using drivers::GpioChip;
using drivers::SerialPort;

bool same_file(const std::string& one, const std::string& other) {
  std::error_code broken;  // a name that leads nowhere is no port
  return one == other || (std::filesystem::equivalent(one, other, broken) && !broken);
}

std::vector<std::string> names_of(const Rig& rig, const std::function<bool(const Bus&)>& is_on) {
  std::vector<std::string> names;
  for (const Bus& bus : rig.buses) {
    if (is_on(bus)) names.push_back(bus.name);
  }
  return names;
}

std::string_view word_for(CanState state) {
  switch (state) {
    case CanState::active:
      return "active";
    case CanState::warning:
      return "warning";
    case CanState::passive:
      return "passive";
    case CanState::stalled:
      return "stalled";
    case CanState::bus_off:
      return "bus-off";
    case CanState::down:
      return "down";
  }
  return "down";
}

/// "; bus left", or nothing.
std::string used_by(const std::vector<std::string>& buses) {
  std::string text;
  for (const std::string& bus : buses) text += (text.empty() ? "; bus " : ", ") + bus;
  return text;
}

std::string words_for(const SerialPort& port) {
  if (!port.usb) return port.description;
  std::string text = fmt::format("USB {:04x}:{:04x}", port.usb->vendor, port.usb->product);
  for (const std::string& part : {port.usb->manufacturer, port.usb->name}) {
    if (!part.empty()) text += " " + part;
  }
  if (!port.usb->serial_number.empty()) text += ", serial number " + port.usb->serial_number;
  return text;
}

std::string words_for(const CanInterface& interface) {
  std::string text = interface.up ? "up" : "down";
  if (interface.controller) {
    const CanInterface::Controller& controller = *interface.controller;
    if (controller.bits_per_second > 0) text += fmt::format(", {} bit/s", controller.bits_per_second);
    text += fmt::format(", {}, restart {}", word_for(controller.state),
                        controller.restart_ms > 0 ? fmt::format("{} ms", controller.restart_ms) : "never");
  } else {
    text += ", virtual";
  }
  return text + fmt::format(", queue of {}", interface.queue_length);
}

Json serial_json(const SerialPort& port, const Rig& rig) {
  Json out{{"path", port.path}, {"stable_path", port.stable_path}, {"description", port.description}};
  if (port.usb) {
    out["usb"] = {{"vendor", fmt::format("{:04x}", port.usb->vendor)},
                  {"product", fmt::format("{:04x}", port.usb->product)},
                  {"manufacturer", port.usb->manufacturer},
                  {"name", port.usb->name},
                  {"serial_number", port.usb->serial_number}};
  }
  out["buses"] = buses_on(port, rig);
  return out;
}

Json can_json(const CanInterface& interface, const Rig& rig) {
  Json out{{"name", interface.name}, {"up", interface.up}, {"queue_length", interface.queue_length}};
  if (interface.controller) {
    out["bits_per_second"] = interface.controller->bits_per_second;
    out["restart_ms"] = interface.controller->restart_ms;
    out["state"] = word_for(interface.controller->state);
    out["transmit_errors"] = interface.controller->transmit_errors;
    out["receive_errors"] = interface.controller->receive_errors;
  }
  out["buses"] = buses_on(interface, rig);
  return out;
}

}  // namespace

MachineWires look_at_machine() {
  MachineWires wires;
  if (auto ports = drivers::list_serial_ports()) {
    wires.serial = std::move(ports).value();
  } else {
    wires.troubles.push_back(ports.error().message);
  }
  for (const std::string& name : drivers::can_interface_names()) {
    if (auto interface = drivers::read_can_interface(name)) {
      wires.can.push_back(std::move(interface).value());
    } else {
      wires.troubles.push_back(interface.error().message);
    }
  }
  for (const std::string& path : drivers::gpio_chip_paths()) {
    if (auto chip = drivers::read_gpio_chip(path)) {
      wires.gpio.push_back(std::move(chip).value());
    } else {
      wires.troubles.push_back(chip.error().message);
    }
  }
  return wires;
}

std::vector<std::string> buses_on(const SerialPort& port, const Rig& rig) {
  return names_of(rig, [&](const Bus& bus) {
    if (bus.kind != BusKind::serial && bus.kind != BusKind::modbus_rtu && bus.kind != BusKind::dmx) return false;
    const std::string place(drivers::place_of(bus.url));
    if (port.usb && !port.usb->serial_number.empty() && place == "usb/" + port.usb->serial_number) return true;
    return same_file(place, port.path) || (!port.stable_path.empty() && place == port.stable_path);
  });
}

std::vector<std::string> buses_on(const CanInterface& interface, const Rig& rig) {
  return names_of(rig, [&](const Bus& bus) { return bus.url == "can://" + interface.name; });
}

std::vector<std::string> buses_on(const GpioChip& chip, const Rig& rig) {
  return names_of(rig, [&](const Bus& bus) {
    if (bus.line.direction != LineDirection::gpio) return false;
    const std::string& name = bus.line.direction_chip;
    return name == chip.name || name == chip.label || name == "/dev/" + chip.name;
  });
}

std::string wires_text(const MachineWires& wires, const Rig& rig) {
  std::string text = "this machine has\n";
  for (const SerialPort& port : wires.serial) {
    text += fmt::format("  serial port {}  {}{}\n", port.stable_path.empty() ? port.path : port.stable_path,
                        words_for(port), used_by(buses_on(port, rig)));
  }
  for (const CanInterface& interface : wires.can) {
    text += fmt::format("  CAN interface {}  {}{}\n", interface.name, words_for(interface),
                        used_by(buses_on(interface, rig)));
  }
  for (const GpioChip& chip : wires.gpio) {
    text += fmt::format("  GPIO chip {}  {}, {} lines{}\n", chip.name, chip.label, chip.lines,
                        used_by(buses_on(chip, rig)));
  }
  if (wires.serial.empty()) text += "  no serial port\n";
  if (wires.can.empty()) text += "  no CAN interface\n";
  if (wires.gpio.empty()) text += "  no GPIO chip\n";
  for (const std::string& trouble : wires.troubles) text += "  " + trouble + "\n";
  text.pop_back();
  return text;
}

Json wires_json(const MachineWires& wires, const Rig& rig) {
  Json serial = Json::array();
  for (const SerialPort& port : wires.serial) serial.push_back(serial_json(port, rig));
  Json can = Json::array();
  for (const CanInterface& interface : wires.can) can.push_back(can_json(interface, rig));
  Json gpio = Json::array();
  for (const GpioChip& chip : wires.gpio) {
    gpio.push_back({{"name", chip.name}, {"label", chip.label}, {"lines", chip.lines}, {"buses", buses_on(chip, rig)}});
  }
  return {
      {"serial", std::move(serial)}, {"can", std::move(can)}, {"gpio", std::move(gpio)}, {"troubles", wires.troubles}};
}

}  // namespace footlight::app
