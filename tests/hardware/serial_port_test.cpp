// SPDX-License-Identifier: Apache-2.0
// libserialport and libmodbus on ports with drivers of their own: two FTDI adapters wired to each other, two 8250 wired
// to each other.
#include <algorithm>
#include <atomic>
#include <fstream>
#include <sstream>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <termios.h>

#include "core/file_descriptor.hpp"
#include "drivers/transports/modbus_port.hpp"
#include "drivers/transports/serial_ports.hpp"
#include "drivers/transports/serial_stream.hpp"
#include "tests/hardware/gpio_chip.hpp"
#include "tests/hardware/guest.hpp"

namespace footlight::hardware {
namespace {

using drivers::ByteStream;
using drivers::SendStatus;
using drivers::SerialSettings;
using Bytes = std::vector<std::uint8_t>;

constexpr const char* kHere = "/dev/ttyUSB0";
constexpr const char* kThere = "/dev/ttyUSB1";

Bytes hear(ByteStream& port, std::size_t count) {
  Bytes heard;
  eventually([&] {
    Bytes buffer(64);
    buffer.resize(port.read(buffer));
    heard.insert(heard.end(), buffer.begin(), buffer.end());
    return heard.size() >= count;
  });
  return heard;
}

std::unique_ptr<ByteStream> open(const std::string& place, const SerialSettings& settings = {}) {
  auto opened = drivers::open_serial(place, settings);
  EXPECT_TRUE(opened) << opened.error().message;
  return std::move(opened).value();
}

void pass_both_ways(ByteStream& here, ByteStream& there) {
  Bytes all(256);
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint8_t>(i);  // XON, ^C, CR among them
  ASSERT_EQ(here.write(all), SendStatus::accepted);
  EXPECT_EQ(hear(there, 256), all);
  ASSERT_EQ(there.write(all), SendStatus::accepted);
  EXPECT_EQ(hear(here, 256), all);
}

class Ftdi : public ::testing::Test {
 protected:
  static std::optional<drivers::SerialPort> port_at(const std::string& path) {
    const auto ports = drivers::list_serial_ports().value();
    const auto found = std::ranges::find(ports, path, &drivers::SerialPort::path);
    return found == ports.end() ? std::nullopt : std::optional(*found);
  }
  static std::string number_of(const std::string& path) {
    const auto port = port_at(path);
    return port && port->usb ? port->usb->serial_number : "";
  }
};

TEST_F(Ftdi, IsListedWithItsUsbData) {
  for (const char* path : {kHere, kThere}) {
    const auto port = port_at(path);
    ASSERT_TRUE(port) << path;
    ASSERT_TRUE(port->usb) << path;
    EXPECT_EQ(port->usb->vendor, 0x0403);
    EXPECT_EQ(port->usb->product, 0x6001);
    EXPECT_EQ(port->usb->manufacturer, "QEMU");
    EXPECT_FALSE(port->usb->serial_number.empty());
  }
}

TEST_F(Ftdi, CarriesEveryByteBothWaysAtSpeedsThatNoTableHas) {
  for (const int speed : {9'600, 115'200, 250'000, 1'000'000}) {
    const auto here = open(kHere, {.bits_per_second = speed});
    const auto there = open(kThere, {.bits_per_second = speed});
    pass_both_ways(*here, *there);
  }
}

TEST_F(Ftdi, RefusesASpeedThatItCannotDo) {
  const auto opened = drivers::open_serial(kHere, {.bits_per_second = 3'999'000});
  ASSERT_FALSE(opened);
  EXPECT_TRUE(
      opened.error().message.starts_with("serial port \"/dev/ttyUSB0\": 3999000 Bd refused: the nearest that it "
                                         "can do is "))
      << opened.error().message;
}

TEST_F(Ftdi, HoldsNothingBack) {
  const auto here = open(kHere);
  std::string timer_ms;
  std::ifstream("/sys/bus/usb-serial/devices/ttyUSB0/latency_timer") >> timer_ms;
  EXPECT_EQ(timer_ms, "1") << "16 by default";
}

TEST_F(Ftdi, IsFoundByItsUsbSerialNumber) {
  const std::string number = number_of(kHere);
  if (number == number_of(kThere)) {
    EXPECT_FALSE(drivers::open_serial("usb/" + number, {})) << "two adapters of one number";
    return;
  }
  const auto here = open("usb/" + number);
  const auto there = open(kThere);
  pass_both_ways(*here, *there);
}

TEST_F(Ftdi, UnpluggedIsSeenByReadingAloneAndLeavesNothingToSpinOn) {
  const auto here = open(kHere);
  const auto there = open(kThere);
  pass_both_ways(*here, *there);
  unplug("ftdi0");
  EXPECT_TRUE(eventually([&] {
    Bytes buffer(8);
    return here->read(buffer) == 0 && here->poll_handle() == -1;
  })) << "reads go on answering zero bytes without an error";
  EXPECT_EQ(here->write(Bytes{1}), SendStatus::down);
  EXPECT_NE(here->trouble(), "");
  EXPECT_EQ(there->write(Bytes{2}), SendStatus::accepted) << "the other port is unmoved";
  plug(R"("driver":"usb-serial","chardev":"ftdia","id":"ftdi0")");
  EXPECT_TRUE(eventually([&] { return here->write(Bytes{3}) == SendStatus::accepted; })) << here->trouble();
  EXPECT_EQ(here->trouble(), "");
  EXPECT_EQ(hear(*there, 1), Bytes{3});
}

/// The answer of unit 7 with the registers 0x0102, 0x0304.
const Bytes kReadAnswer{0x07, 0x03, 0x04, 0x01, 0x02, 0x03, 0x04, 0x3D, 0x3C};
const drivers::ModbusRequest kRead{7, 0x03, 0x40, 2, {}};

void exchange_rtu(drivers::ModbusPort& port, ByteStream& device) {
  Bytes asked;
  std::thread answering([&] {
    asked = hear(device, 8);
    EXPECT_EQ(device.write(kReadAnswer), SendStatus::accepted);
  });
  // Guests are slow: the answer may be late, the next one is not.
  EXPECT_EQ(port.submit(kRead), SendStatus::accepted);
  answering.join();
  EXPECT_EQ(asked.size(), 8U);
  auto reply = port.poll();
  for (int tries = 0; tries < 20 && reply && reply->outcome == drivers::ModbusReply::Outcome::timeout; ++tries) {
    std::thread again([&] {
      hear(device, 8);
      device.write(kReadAnswer);
    });
    run("sleep 0.2");
    port.discard();
    EXPECT_EQ(port.submit(kRead), SendStatus::accepted);
    again.join();
    reply = port.poll();
  }
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->outcome, drivers::ModbusReply::Outcome::ok);
  EXPECT_EQ(reply->values, (std::vector<std::uint16_t>{0x0102, 0x0304}));
}

TEST_F(Ftdi, CarriesModbusRtuAtASpeedThatLibmodbusDoesNotKnow) {
  const SerialSettings settings{.bits_per_second = 250'000, .characters = Characters::e1};
  auto port = drivers::open_modbus_rtu(kHere, settings);
  ASSERT_TRUE(port) << port.error().message;
  const auto device = open(kThere, settings);
  exchange_rtu(**port, *device);
  const FileDescriptor file(::open(kHere, O_RDWR | O_NOCTTY | O_NONBLOCK));
  if (file.get() < 0) return;  // ours alone
  struct termios now {};
  ASSERT_EQ(::tcgetattr(file.get(), &now), 0);
  EXPECT_NE(now.c_cflag & PARENB, 0U);
  EXPECT_NE(::cfgetospeed(&now), static_cast<speed_t>(B9600));
}

TEST_F(Ftdi, UnpluggedUnderModbusIsDownAndComesBack) {
  auto port = drivers::open_modbus_rtu(kHere, {.characters = Characters::e1});
  ASSERT_TRUE(port) << port.error().message;
  unplug("ftdi0");
  EXPECT_TRUE(eventually([&] {
    const SendStatus status = (*port)->submit(kRead);
    (*port)->poll();
    return status == SendStatus::down;
  }));
  EXPECT_NE((*port)->trouble(), "");
  plug(R"("driver":"usb-serial","chardev":"ftdia","id":"ftdi0")");
  EXPECT_TRUE(eventually([&] {
    const SendStatus status = (*port)->submit(kRead);
    (*port)->poll();
    return status == SendStatus::accepted;
  })) << (*port)->trouble();
}

/// The two ports of the PCI card.
class Uart8250 : public ::testing::Test {
 protected:
  Uart8250() {
    std::istringstream names(
        run("for t in /sys/class/tty/ttyS*; do case $(readlink -f $t/device) in *pci*) basename $t;; "
            "esac; done"));
    for (std::string name; names >> name;) places_.push_back("/dev/" + name);
  }
  static int modem_lines(const std::string& path) {
    const FileDescriptor file(::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK));
    int lines = 0;
    EXPECT_EQ(::ioctl(file.get(), TIOCMGET, &lines), 0);
    return lines;
  }
  static SerialSettings turned_by(LineDirection direction) {
    SerialSettings settings;
    settings.line.direction = direction;
    return settings;
  }

  std::vector<std::string> places_;
};

TEST_F(Uart8250, CarriesEveryByteBothWays) {
  ASSERT_EQ(places_.size(), 2U);
  const auto here = open(places_[0], {.bits_per_second = 57'600, .characters = Characters::o1});
  const auto there = open(places_[1], {.bits_per_second = 57'600, .characters = Characters::o1});
  pass_both_ways(*here, *there);
}

TEST_F(Uart8250, RtsIsHighOnlyWhileTheControllerSpeaks) {
  ASSERT_EQ(places_.size(), 2U);
  SerialSettings settings = turned_by(LineDirection::rts);
  for (const bool inverted : {false, true}) {
    settings.line.direction_inverted = inverted;
    auto device = drivers::open_serial_device(places_[0], settings);
    ASSERT_TRUE(device) << device.error().message;
    const auto rts = [&] {
      int lines = 0;
      EXPECT_EQ(::ioctl((*device)->poll_handle(), TIOCMGET, &lines), 0);
      return (lines & TIOCM_RTS) != 0;
    };
    EXPECT_EQ(rts(), inverted) << "listening";
    (*device)->speak();
    EXPECT_EQ(rts(), !inverted);
    (*device)->listen(Duration{});
    EXPECT_EQ(rts(), inverted);
  }
  const auto here = open(places_[0], turned_by(LineDirection::rts));
  const auto there = open(places_[1]);
  pass_both_ways(*here, *there);
}

TEST_F(Uart8250, AKernelDriverThatCannotTurnSaysWhatCould) {
  ASSERT_EQ(places_.size(), 2U);
  const auto opened = drivers::open_serial(places_[0], turned_by(LineDirection::kernel));
  if (opened) return;  // this one can
  EXPECT_TRUE(
      opened.error().message.ends_with("(direction: rts or gpio, or adapter where the adapter does it by itself)"))
      << opened.error().message;
}

TEST_F(Uart8250, AGpioLineIsHighOnlyWhileModbusSpeaks) {
  ASSERT_EQ(places_.size(), 2U);
  const GpioChip chip;
  SerialSettings settings = turned_by(LineDirection::gpio);
  settings.bits_per_second = 1'200;  // eight characters take 73 ms
  settings.characters = Characters::e1;
  settings.line.direction_chip = chip.name();
  settings.line.direction_offset = 6;
  auto port = drivers::open_modbus_rtu(places_[0], settings);
  ASSERT_TRUE(port) << port.error().message;
  SerialSettings far = settings;
  far.line = {};
  const auto device = open(places_[1], far);
  EXPECT_FALSE(chip.value(6));
  std::atomic<bool> over{false};
  bool was_high = false;
  std::thread watching([&] {
    while (!over) was_high = chip.value(6) || was_high;
  });
  exchange_rtu(**port, *device);
  over = true;
  watching.join();
  EXPECT_TRUE(was_high);
  EXPECT_FALSE(chip.value(6));
}

}  // namespace
}  // namespace footlight::hardware
