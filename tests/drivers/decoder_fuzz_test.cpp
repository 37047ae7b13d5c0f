// SPDX-License-Identifier: Apache-2.0
// Random input into every decoder: nothing crashes (the suite runs under the sanitizers, too) and nothing false is
// told.
#include <optional>

#include <gtest/gtest.h>

#include "core/rng.hpp"
#include "drivers/devices/canopen/canopen_driver.hpp"
#include "drivers/devices/footlight_serial/cobs.hpp"
#include "drivers/devices/footlight_serial/serial_driver.hpp"
#include "drivers/devices/modbus/modbus_driver.hpp"
#include "tests/drivers/recording_ports.hpp"

namespace footlight::drivers {
namespace {

const NodeAddress kOne{NodeIndex(0), 1, 32};
const NodeAddress kTwo{NodeIndex(1), 2, 32};

TEST(DecoderFuzz, RandomBytesOnASerialLineTellNothing) {
  Rng rng(2026);
  RecordingStream port;
  SerialDriver driver(port, {kOne, kTwo}, 0);
  EventLog log;
  Instant now = kStart;
  for (int round = 0; round < 4'000; ++round) {
    if (driver.ready()) driver.ask(round % 2 == 0 ? kOne : kTwo, now);
    // Zeros more often than by chance: more frames end.
    for (int i = 0; i < 100; ++i) {
      port.incoming.push_back(rng.below(20) == 0 ? std::uint8_t{0} : static_cast<std::uint8_t>(rng.below(256)));
    }
    driver.step(now, log);
    now += milliseconds(5);
  }
  EXPECT_EQ(log.count(DeviceEvent::Kind::showing), 0U);
  EXPECT_EQ(log.count(DeviceEvent::Kind::preloaded), 0U);
  EXPECT_GT(log.count(DeviceEvent::Kind::missed), 500U);
}

TEST(DecoderFuzz, MutatedAnswersAreNeverTakenForOthers) {
  Rng rng(5);
  const footlight_serial::Frame right{
      footlight_serial::Direction::from_node, footlight_serial::Command::status, 1, 0, 17, {0, 1, 2, 1, 4, 0, 0, 0}};
  const auto good = encode(right);
  footlight_serial::FrameReceiver receiver;
  int passed = 0;
  for (int round = 0; round < 100'000; ++round) {
    auto bytes = good;
    const std::uint64_t changes = 1 + rng.below(4);
    for (std::uint64_t i = 0; i < changes; ++i) {
      bytes[rng.below(bytes.size())] = static_cast<std::uint8_t>(rng.below(256));
    }
    bytes.push_back(0);
    for (const std::uint8_t byte : bytes) {
      const auto frame = receiver.take(byte);
      if (!frame) continue;
      ++passed;
      ASSERT_EQ(*frame, right) << "round " << round;
    }
  }
  EXPECT_LT(passed, 10'000) << "only mutations that changed nothing or a delimiter";
}

TEST(DecoderFuzz, RandomBytesNeverBreakCobs) {
  Rng rng(11);
  std::size_t decoded = 0;
  for (int round = 0; round < 100'000; ++round) {
    std::vector<std::uint8_t> bytes(rng.below(40));
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(rng.below(8) == 0 ? rng.below(256) : 1 + rng.below(6));
    if (const auto content = footlight_serial::cobs_decode(bytes)) {
      ++decoded;
      ASSERT_LT(content->size(), bytes.size());
      ASSERT_EQ(footlight_serial::cobs_encode(*content), bytes);
    }
  }
  EXPECT_GT(decoded, 1'000U);
}

void hear_random_frames(const std::optional<OutputModule>& modules) {
  Rng rng(3);
  RecordingCan port;
  CanopenDriver driver(port, {kOne, kTwo}, modules);
  EventLog log;
  Instant now = kStart;
  driver.start(now);
  for (int round = 0; round < 100'000; ++round) {
    CanFrame frame;
    frame.id = static_cast<std::uint16_t>(rng.below(0x10000));
    if (rng.below(2) == 0) frame.id = static_cast<std::uint16_t>((rng.below(16) << 7U) + 1 + rng.below(2));
    frame.length = static_cast<std::uint8_t>(rng.below(10));
    for (auto& byte : frame.data) byte = static_cast<std::uint8_t>(rng.below(256));
    port.incoming.push_back(frame);
    if (round % 50 != 0) continue;
    driver.preload(kOne, 1, std::vector<LookIndex>(32, 1), now);
    driver.latch(1, now);
    driver.step(now, log);
    port.in_queue = 0;
    port.sent.clear();
    now += milliseconds(3);
  }
  for (const DeviceEvent& event : log.events) ASSERT_LT(event.node.value(), 2U);
  EXPECT_GT(log.events.size(), 2'000U);
}

TEST(DecoderFuzz, RandomFramesOnACanBusAreHarmless) { hear_random_frames({}); }

TEST(DecoderFuzz, RandomFramesOnABusOfOutputModulesAreHarmless) {
  OutputModule module;
  module.outputs = 32;
  hear_random_frames(module);
}

TEST(DecoderFuzz, RandomRepliesOnAModbusLineAreHarmless) {
  Rng rng(4);
  RecordingModbus port;
  ModbusDriver driver(port, footlight_marker_profile(), {kOne, kTwo}, 0);
  EventLog log;
  std::size_t right = 0;
  Instant now = kStart;
  for (int round = 0; round < 100'000; ++round) {
    now += milliseconds(1000);  // the line is quiet again, and nothing is owed
    driver.step(now, log);
    if (driver.ready()) driver.ask(rng.below(2) == 0 ? kOne : kTwo, now);
    ModbusReply reply;
    reply.outcome = static_cast<ModbusReply::Outcome>(rng.below(4));
    reply.unit = static_cast<std::uint8_t>(rng.below(3));
    reply.function = static_cast<std::uint8_t>(rng.below(5));
    reply.exception_code = static_cast<std::uint8_t>(rng.below(256));
    reply.values.resize(rng.below(9));
    for (auto& value : reply.values) value = static_cast<std::uint16_t>(rng.below(65'536));
    const bool fits = reply.outcome == ModbusReply::Outcome::ok && reply.unit == port.sent.back().unit &&
                      reply.function == 3 && reply.values.size() == port.sent.back().count && reply.values.size() >= 4;
    right += fits ? 1 : 0;
    port.reply = std::move(reply);
    driver.step(now, log);
  }
  EXPECT_GT(right, 100U);
  EXPECT_EQ(log.count(DeviceEvent::Kind::showing), right);
}

}  // namespace
}  // namespace footlight::drivers
