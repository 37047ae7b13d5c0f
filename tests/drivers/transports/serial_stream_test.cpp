// SPDX-License-Identifier: Apache-2.0
#include "drivers/transports/serial_stream.hpp"

#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "drivers/devices/footlight_serial/serial_driver.hpp"
#include "tests/drivers/recording_ports.hpp"
#include "tests/drivers/transports/pseudo_terminal.hpp"

namespace footlight::drivers {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// A device that takes only so many bytes at a time, or is gone.
class NarrowDevice final : public SerialDevice {
 public:
  struct Wire {
    std::size_t room = 0;
    bool gone = false;
    Bytes taken;
  };
  explicit NarrowDevice(Wire& wire) : wire_(wire) {}
  std::optional<std::size_t> write_some(std::span<const std::uint8_t> bytes) override {
    if (wire_.gone) return std::nullopt;
    const std::size_t count = std::min(wire_.room, bytes.size());
    wire_.taken.insert(wire_.taken.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
    wire_.room -= count;
    return count;
  }
  std::optional<std::size_t> read_some(std::span<std::uint8_t> /*buffer*/) override {
    if (wire_.gone) return std::nullopt;
    return 0;
  }
  [[nodiscard]] int poll_handle() const override { return 17; }

 private:
  Wire& wire_;
};

SerialStream narrow_stream(NarrowDevice::Wire& wire) {
  OpenSerialDevice open = [&wire]() -> Result<std::unique_ptr<SerialDevice>> {
    if (wire.gone) return device_error("gone");
    return std::unique_ptr<SerialDevice>(std::make_unique<NarrowDevice>(wire));
  };
  return {std::make_unique<NarrowDevice>(wire), open, SerialSettings{}};
}

TEST(SerialStream, TakesAFrameAsAWholeThoughTheDeviceTakesItInParts) {
  NarrowDevice::Wire wire;
  SerialStream stream = narrow_stream(wire);
  EXPECT_EQ(stream.write(Bytes{1, 2, 3, 4}), SendStatus::busy) << "no room at all: nothing taken";
  wire.room = 3;
  EXPECT_EQ(stream.write(Bytes{1, 2, 3, 4}), SendStatus::accepted);
  EXPECT_EQ(stream.write(Bytes{5}), SendStatus::busy);
  EXPECT_EQ(wire.taken, (Bytes{1, 2, 3}));
  wire.room = 10;
  Bytes buffer(16);
  EXPECT_EQ(stream.read(buffer), 0U);
  EXPECT_EQ(wire.taken, (Bytes{1, 2, 3, 4}));
  EXPECT_EQ(stream.write(Bytes{5}), SendStatus::accepted);
  EXPECT_EQ(wire.taken, (Bytes{1, 2, 3, 4, 5}));
}

TEST(SerialStream, ADeviceThatComesBackIsOpenedAgainAndGetsNothingOld) {
  NarrowDevice::Wire wire;
  wire.room = 1;
  SerialStream stream = narrow_stream(wire);
  EXPECT_EQ(stream.write(Bytes{1, 2}), SendStatus::accepted);
  wire.gone = true;
  EXPECT_EQ(stream.write(Bytes{3}), SendStatus::down);
  EXPECT_EQ(stream.write(Bytes{4}), SendStatus::down);
  wire.gone = false;
  wire.room = 10;
  EXPECT_EQ(stream.write(Bytes{5}), SendStatus::accepted);
  EXPECT_EQ(wire.taken, (Bytes{1, 5}));
}

TEST(SerialStream, AnUnplugIsSeenByReading) {
  NarrowDevice::Wire wire;
  SerialStream stream = narrow_stream(wire);
  wire.gone = true;
  Bytes buffer(16);
  EXPECT_EQ(stream.read(buffer), 0U);
  EXPECT_EQ(stream.write(Bytes{1}), SendStatus::down);
}

TEST(SerialStream, IsPolledByItsDeviceUntilThatIsGone) {
  NarrowDevice::Wire wire;
  SerialStream stream = narrow_stream(wire);
  EXPECT_EQ(stream.poll_handle(), 17);
  wire.gone = true;
  Bytes buffer(16);
  stream.read(buffer);
  EXPECT_EQ(stream.poll_handle(), -1);
}

TEST(SerialStream, TenBitsACharacterAndElevenWithParity) {
  NarrowDevice::Wire wire;
  EXPECT_EQ(narrow_stream(wire).wire_time(11'520), seconds(1));
  EXPECT_EQ(narrow_stream(wire).wire_time(1), Duration(86'806)) << "rounded up";
  EXPECT_EQ((SerialSettings{.bits_per_second = 110'000, .characters = Characters::o1}).time_of(10'000), seconds(1));
}

TEST(SerialStream, SaysWhyItIsDownUntilItIsUp) {
  NarrowDevice::Wire wire;
  wire.room = 10;
  SerialStream stream = narrow_stream(wire);
  EXPECT_EQ(stream.trouble(), "");
  wire.gone = true;
  EXPECT_EQ(stream.write(Bytes{1}), SendStatus::down);
  EXPECT_EQ(stream.trouble(), "unplugged");
  EXPECT_EQ(stream.write(Bytes{1}), SendStatus::down);
  EXPECT_EQ(stream.trouble(), "gone") << "what opening it again says";
  wire.gone = false;
  EXPECT_EQ(stream.write(Bytes{1}), SendStatus::accepted);
  EXPECT_EQ(stream.trouble(), "");
}

TEST(SerialPort, BytesPassBothWaysThroughAPseudoTerminalUnchanged) {
  PseudoTerminal terminal;
  auto stream = open_serial(terminal.path(), SerialSettings{});
  ASSERT_TRUE(stream) << stream.error().message;
  Bytes all(256);
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint8_t>(i);  // XON, ^C, CR among them
  ASSERT_EQ((*stream)->write(all), SendStatus::accepted);
  EXPECT_EQ(terminal.read(256), all);
  terminal.write(all);
  Bytes got;
  Bytes buffer(100);
  for (int tries = 0; tries < 2'000 && got.size() < all.size(); ++tries) {
    const std::size_t count = (*stream)->read(buffer);
    got.insert(got.end(), buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(count));
    if (count == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(got, all);
}

TEST(SerialPort, APulledCableIsDown) {
  PseudoTerminal terminal;
  auto stream = open_serial(terminal.path(), SerialSettings{});
  ASSERT_TRUE(stream);
  terminal.unplug();
  Bytes buffer(16);
  (*stream)->read(buffer);
  EXPECT_EQ((*stream)->write(Bytes{1}), SendStatus::down);
}

TEST(SerialPort, TheDriverSpeaksToAMarkerBehindAPseudoTerminal) {
  using footlight_serial::Frame;
  PseudoTerminal terminal;
  auto stream = open_serial(terminal.path(), SerialSettings{});
  ASSERT_TRUE(stream);
  const NodeAddress node{NodeIndex(0), 7, 3};
  SerialDriver driver(**stream, {node}, 0xA3);
  EventLog log;
  const std::vector<LookIndex> looks{1, 2, 3};
  Instant now = instant_at(1);
  ASSERT_EQ(driver.preload(node, 17, looks, now), SendStatus::accepted);
  footlight_serial::FrameReceiver marker;
  std::optional<Frame> request;
  for (const std::uint8_t byte : terminal.read(footlight_serial::frame_length(4))) {
    if (auto frame = marker.take(byte)) request = frame;
  }
  ASSERT_TRUE(request);
  EXPECT_EQ(request->body, (Bytes{0, 1, 2, 3}));
  const std::uint16_t crc = looks_crc(looks);
  terminal.write(Bytes{0x13, 0x37, 0xFF});  // somebody else's noise first
  terminal.write(encode(Frame{footlight_serial::Direction::from_node,
                              request->command,
                              7,
                              0xA3,
                              request->sequence,
                              {static_cast<std::uint8_t>(crc & 0xFF), static_cast<std::uint8_t>(crc >> 8)}}));
  for (int tries = 0; tries < 2'000 && log.events.empty(); ++tries) {
    driver.step(now, log);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ASSERT_EQ(log.events.size(), 1U);
  EXPECT_EQ(log.events[0].kind, DeviceEvent::Kind::preloaded);
}

std::string refusal_of(const std::string& path) {
  const auto stream = open_serial(path, SerialSettings{});
  return stream ? "" : stream.error().message;
}

TEST(SerialPort, WhatIsNoSerialPortIsRefusedWithItsName) {
  EXPECT_EQ(
      refusal_of("/dev/serial/by-id/none"),
      "serial port \"/dev/serial/by-id/none\": No such file or directory (a port as listed in /dev/serial/by-id)");
  EXPECT_EQ(refusal_of("/etc/passwd"),
            "serial port \"/etc/passwd\": not a serial port (a port as listed in /dev/serial/by-id)");
#if FOOTLIGHT_WITH_libserialport
  EXPECT_TRUE(refusal_of("/dev/null").starts_with("serial port \"/dev/null\": not ")) << refusal_of("/dev/null");
#else
  EXPECT_EQ(refusal_of("/dev/null"),
            "serial port \"/dev/null\": this program was built without libserialport (install libserialport-dev and "
            "build again)");
#endif
}

}  // namespace
}  // namespace footlight::drivers
