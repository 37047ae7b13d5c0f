// SPDX-License-Identifier: Apache-2.0
#include "app/machine_wires.hpp"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/temporary_folder.hpp"

namespace footlight::app {
namespace {

using Names = std::vector<std::string>;

Bus bus(const std::string& name, BusKind kind, const std::string& url) {
  Bus made;
  made.name = name;
  made.kind = kind;
  made.url = url;
  return made;
}

drivers::SerialPort ftdi(const std::string& path) {
  drivers::SerialPort port;
  port.path = path;
  port.stable_path = "/dev/serial/by-id/usb-FTDI_FT232R_A50285BI";
  port.usb = {0x0403, 0x6001, "FTDI", "FT232R", "A50285BI"};
  return port;
}

TEST(MachineWires, ABusIsFoundOnItsPortByEachOfTheNamesThatThePortHas) {
  const test::TemporaryFolder folder;
  const std::string port = (folder.path() / "ttyUSB0").string();
  std::ofstream(port) << "stands for a port";
  const std::string link = (folder.path() / "left").string();
  std::filesystem::create_symlink(port, link);
  Rig rig;
  rig.buses = {bus("by path", BusKind::serial, "serial://" + port),
               bus("by link", BusKind::modbus_rtu, "rtu://" + link),
               bus("by number", BusKind::dmx, "dmx://usb/A50285BI"),
               bus("by id", BusKind::serial, "serial:///dev/serial/by-id/usb-FTDI_FT232R_A50285BI"),
               bus("another", BusKind::serial, "serial:///dev/ttyUSB9"),
               bus("a host of that name", BusKind::modbus_tcp, "tcp://" + port)};
  EXPECT_EQ(buses_on(ftdi(port), rig), (Names{"by path", "by link", "by number", "by id"}));
}

TEST(MachineWires, AnInterfaceAndADirectionLineHaveTheirBuses) {
  Rig rig;
  rig.buses = {bus("far", BusKind::can, "can://can0"), bus("near", BusKind::modbus_rtu, "rtu:///dev/ttyS0")};
  rig.buses[1].line.direction = LineDirection::gpio;
  rig.buses[1].line.direction_chip = "pinctrl-bcm2711";
  drivers::CanInterface can0;
  can0.name = "can0";
  EXPECT_EQ(buses_on(can0, rig), Names{"far"});
  can0.name = "can1";
  EXPECT_EQ(buses_on(can0, rig), Names{});
  EXPECT_EQ(buses_on(drivers::GpioChip{"gpiochip0", "pinctrl-bcm2711", 58}, rig), Names{"near"});
  EXPECT_EQ(buses_on(drivers::GpioChip{"gpiochip0", "gpio-sim", 8}, rig), Names{});
}

TEST(MachineWires, AreToldWithUsbDataStateAndBuses) {
  MachineWires wires;
  wires.serial = {ftdi("/dev/ttyUSB0"), {"/dev/ttyS0", "", "ttyS0", std::nullopt}};
  drivers::CanInterface can0;
  can0.name = "can0";
  can0.up = true;
  can0.queue_length = 10;
  can0.controller = drivers::CanInterface::Controller{500'000, 100, drivers::CanState::bus_off, 255, 3, true};
  wires.can = {can0, {"vcan0", false, 1000, std::nullopt}};
  wires.gpio = {{"gpiochip0", "gpio-sim", 8}};
  wires.troubles = {"GPIO chip \"/dev/gpiochip1\": not opened: Permission denied (membership of the group gpio)"};
  Rig rig;
  rig.buses = {bus("left", BusKind::serial, "serial://usb/A50285BI"), bus("far", BusKind::can, "can://can0")};
  EXPECT_EQ(wires_text(wires, rig),
            "this machine has\n"
            "  serial port /dev/serial/by-id/usb-FTDI_FT232R_A50285BI  USB 0403:6001 FTDI FT232R, serial number "
            "A50285BI; bus left\n"
            "  serial port /dev/ttyS0  ttyS0\n"
            "  CAN interface can0  up, 500000 bit/s, bus-off, restart 100 ms, queue of 10; bus far\n"
            "  CAN interface vcan0  down, virtual, queue of 1000\n"
            "  GPIO chip gpiochip0  gpio-sim, 8 lines\n"
            "  GPIO chip \"/dev/gpiochip1\": not opened: Permission denied (membership of the group gpio)");
  const auto json = wires_json(wires, rig);
  EXPECT_EQ(json["serial"][0]["usb"]["vendor"], "0403");
  EXPECT_EQ(json["serial"][0]["buses"], (Names{"left"}));
  EXPECT_FALSE(json["serial"][1].contains("usb"));
  EXPECT_EQ(json["can"][0]["transmit_errors"], 255);
  EXPECT_FALSE(json["can"][1].contains("state")) << "virtual interfaces have none";
  EXPECT_EQ(json["gpio"][0]["lines"], 8);
  EXPECT_EQ(json["troubles"].size(), 1U);
}

TEST(MachineWires, WhatIsNotThereIsSaid) {
  EXPECT_EQ(wires_text({}, {}), "this machine has\n  no serial port\n  no CAN interface\n  no GPIO chip");
}

TEST(MachineWires, InterfacesAndChipsAreFoundByWhatTheKernelSays) {
  const test::TemporaryFolder folder;
  for (const auto& [name, type] : {std::pair{"eth0", "1"}, {"can1", "280"}, {"can0", "280"}}) {
    std::filesystem::create_directory(folder.path() / name);
    std::ofstream(folder.path() / name / "type") << type << "\n";
  }
  EXPECT_EQ(drivers::can_interface_names(folder.path().string()), (Names{"can0", "can1"}));
  EXPECT_EQ(drivers::can_interface_names("/nowhere"), Names{});
  for (const char* name : {"gpiochip1", "gpiochip0", "gpio"}) std::ofstream(folder.path() / name) << "";
  EXPECT_EQ(drivers::gpio_chip_paths(folder.path().string()),
            (Names{(folder.path() / "gpiochip0").string(), (folder.path() / "gpiochip1").string()}));
  const auto no_chip = drivers::read_gpio_chip((folder.path() / "gpiochip0").string());
  ASSERT_FALSE(no_chip);
  EXPECT_EQ(no_chip.error().message.find("GPIO chip \"" + (folder.path() / "gpiochip0").string() + "\": "), 0U);
}

}  // namespace
}  // namespace footlight::app
