// SPDX-License-Identifier: Apache-2.0
#include "drivers/transports/serial_ports.hpp"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "drivers/transports/serial_device.hpp"

namespace footlight::drivers {
namespace {

SerialPort adapter(const std::string& path, const std::string& number, const std::string& stable = "") {
  return {path, stable, "adapter", SerialPort::Usb{0x0403, 0x6001, "FTDI", "FT232R", number}};
}

const std::vector<SerialPort> kPorts{
    {"/dev/ttyS0", "", "ttyS0", std::nullopt},
    adapter("/dev/ttyUSB0", "FT1", "/dev/serial/by-id/usb-FTDI_FT1-if00"),
    adapter("/dev/ttyUSB1", "FT4", "/dev/serial/by-id/usb-FTDI_FT4-if00"),
    adapter("/dev/ttyUSB2", "FT4", "/dev/serial/by-id/usb-FTDI_FT4-if01"),
    adapter("/dev/ttyUSB3", ""),
};

TEST(SerialPorts, AnAdapterIsFoundByItsSerialNumberWhateverItsNameIs) {
  EXPECT_EQ(find_usb_port(kPorts, "FT1").value(), "/dev/ttyUSB0");
}

TEST(SerialPorts, OneThatIsNotPluggedInIsNamedWithThoseThatAre) {
  EXPECT_EQ(find_usb_port(kPorts, "FT2").error().message,
            "serial port of the USB serial number \"FT2\": not plugged in (there is FT1, FT4, FT4)");
  EXPECT_EQ(find_usb_port({}, "FT2").error().message,
            "serial port of the USB serial number \"FT2\": not plugged in (no port has one)");
  EXPECT_FALSE(find_usb_port(kPorts, "")) << "an adapter without a number is none";
}

TEST(SerialPorts, AnAdapterOfTwoPortsIsToldApartByThePlaceInDev) {
  EXPECT_EQ(find_usb_port(kPorts, "FT4").error().message,
            "serial port of the USB serial number \"FT4\": 2 ports have it (one of "
            "/dev/serial/by-id/usb-FTDI_FT4-if00, /dev/serial/by-id/usb-FTDI_FT4-if01)");
}

TEST(SerialPorts, TheStablePathIsTheLinkThatLeadsThere) {
  const auto folder = std::filesystem::temp_directory_path() / ("by-id-" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder / "links");
  std::ofstream(folder / "ttyUSB0") << "";
  std::filesystem::create_symlink(folder / "ttyUSB0", folder / "links" / "usb-b");
  std::filesystem::create_symlink("../ttyUSB0", folder / "links" / "usb-a");
  std::filesystem::create_symlink("../ttyUSB9", folder / "links" / "usb-broken");
  const std::string links = (folder / "links").string();
  EXPECT_EQ(stable_path_of((folder / "ttyUSB0").string(), links), links + "/usb-a");
  EXPECT_EQ(stable_path_of((folder / "ttyUSB9").string(), links), "");
  EXPECT_EQ(stable_path_of((folder / "ttyUSB0").string(), links + "/none"), "");
  std::filesystem::remove_all(folder);
}

#if FOOTLIGHT_WITH_libserialport
TEST(SerialPorts, AreListedInOrderWithAPathThatCanBeOpened) {
  const auto ports = list_serial_ports();
  ASSERT_TRUE(ports) << ports.error().message;
  std::string before;
  for (const SerialPort& port : *ports) {
    EXPECT_TRUE(port.path.starts_with("/dev/")) << port.path;
    EXPECT_LT(before, port.path);
    before = port.path;
  }
}

TEST(SerialPorts, APlaceByNumberIsSoughtWhenItIsOpened) {
  const auto opened = open_serial_device("usb/NO-SUCH-ADAPTER", {});
  ASSERT_FALSE(opened);
  EXPECT_TRUE(
      opened.error().message.starts_with("serial port of the USB serial number \"NO-SUCH-ADAPTER\": not plugged in ("))
      << opened.error().message;
}
#else
TEST(SerialPorts, SayThatTheLibraryIsMissing) {
  EXPECT_EQ(list_serial_ports().error().message,
            "serial ports: this program was built without libserialport (install libserialport-dev and build again)");
}
#endif

}  // namespace
}  // namespace footlight::drivers
