// SPDX-License-Identifier: Apache-2.0
// What the drivers put on the wire, byte for byte as tests/data/wire/golden.py makes it from docs/wire-protocol.md.
#include "tests/drivers/wire_golden.hpp"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/devices/canopen/canopen_driver.hpp"
#include "drivers/devices/canopen/sdo_client.hpp"
#include "drivers/devices/footlight_serial/serial_driver.hpp"
#include "drivers/devices/modbus/modbus_driver.hpp"
#include "tests/drivers/recording_ports.hpp"

namespace footlight::drivers {
namespace {

using Kind = DeviceEvent::Kind;

constexpr std::uint8_t kPlanByte = 0xA3;
constexpr Duration kShowTime = milliseconds(0x12345678);
const NodeAddress kSeven{NodeIndex(3), 7, 32};
const NodeAddress kNine{NodeIndex(4), 9, 5};
const std::vector<LookIndex> kFiveLooks{1, 0, 0, 255, 9};
const Look kGrass{{0x7C, 0xFC, 0x00}, Effect::blink, 200};

std::vector<LookIndex> thirty_two_looks() {
  std::vector<LookIndex> looks;
  for (unsigned i = 0; i < 32; ++i) looks.push_back(static_cast<LookIndex>(7 * i));
  return looks;
}

TEST(SerialGolden, EveryFrameOfTheControllerIsAsDocumented) {
  const Golden golden("serial.txt");
  RecordingStream port;
  SerialDriver driver(port, {kSeven, kNine}, kPlanByte);
  EventLog log;
  Instant now = kStart;
  const auto wire = [&](SendStatus status) {
    EXPECT_EQ(status, SendStatus::accepted);
    now += milliseconds(100);
    driver.step(now, log);
    return port.sent.back();
  };
  EXPECT_EQ(wire(driver.preload(kSeven, 17, thirty_two_looks(), now)), golden.bytes("preload-32"));
  EXPECT_EQ(wire(driver.preload(kNine, 240, kFiveLooks, now)), golden.bytes("preload-5"));
  EXPECT_EQ(wire(driver.latch(17, now)), golden.bytes("latch"));
  EXPECT_EQ(wire(driver.heartbeat(kShowTime, now)), golden.bytes("heartbeat"));
  EXPECT_EQ(wire(driver.ask(kSeven, now)), golden.bytes("ask"));
  EXPECT_EQ(wire(driver.upload_look(5, kGrass, now)), golden.bytes("look"));
  EXPECT_EQ(wire(driver.identify(7, true, now)), golden.bytes("identify"));
  EXPECT_EQ(wire(driver.send_content(kSeven, 3, 17, {true, 64, 250, 3'662'000, 500}, now)), golden.bytes("content"));
  EXPECT_EQ(wire(driver.sync_time(microseconds(3'661'234'567) - driver.sync_time_time(), 1, now)),
            golden.bytes("time"));
  EXPECT_EQ(wire(driver.probe(7, 0, now)), golden.bytes("ask"));
  EXPECT_EQ(wire(driver.probe(7, 1, now)), golden.bytes("who"));
  EXPECT_EQ(wire(driver.set_address(7, 0x12345678, 9, now)), golden.bytes("address"));
  EXPECT_EQ(wire(driver.ask_health(7, now)), golden.bytes("ask-health"));
  EXPECT_EQ(wire(driver.ask_clock(7, now)), golden.bytes("clock"));
  EXPECT_EQ(wire(driver.tell_plan(0x89ABCDEF, now)), golden.bytes("keep-plan"));
  EXPECT_EQ(wire(driver.ask_kept(kSeven, now)), golden.bytes("ask-kept"));
  EXPECT_EQ(wire(driver.ask_patch(7, 0x12345678, now)), golden.bytes("keep-patch"));
  EXPECT_EQ(wire(driver.ask_patch(7, {}, now)), golden.bytes("ask-kept"));
}

TEST(SerialGolden, ATechniciansAnswersAreUnderstood) {
  const Golden golden("serial.txt");
  RecordingStream port;
  SerialDriver driver(port, {kSeven}, kPlanByte);
  EventLog log;
  Instant now = kStart;
  const auto hear = [&](SendStatus status, const std::string& answer) {
    EXPECT_EQ(status, SendStatus::accepted) << answer;
    port.hear(golden.bytes(answer));
    driver.step(now, log);
    now += milliseconds(100);
    driver.step(now, log);
    EXPECT_TRUE(driver.ready());
    return log.answers.empty() ? ServiceAnswer{} : log.answers.back();
  };
  const Identity seven{0x12345678, "footlight-serial", 1, 32};
  EXPECT_EQ(hear(driver.probe(7, 0, now), "status").kind, ServiceAnswer::Kind::found);
  const ServiceAnswer who = hear(driver.probe(7, 1, now), "i-am");
  EXPECT_EQ(who.kind, ServiceAnswer::Kind::found);
  EXPECT_EQ(who.identity, seven);
  EXPECT_EQ(hear(driver.identify(7, true, now), "status").kind, ServiceAnswer::Kind::done);
  EXPECT_EQ(hear(driver.set_address(7, 0x12345678, 9, now), "addressed").identity, seven);
  const ServiceAnswer health = hear(driver.ask_health(7, now), "health");
  ASSERT_EQ(health.health.size(), 4U);
  EXPECT_EQ(health.health[0].value, 87);
  EXPECT_DOUBLE_EQ(health.health[1].value, 23.456);
  EXPECT_EQ(health.health[2].value, -4);
  EXPECT_EQ(health.health[3].value, 100'000);
  const ServiceAnswer untold = hear(driver.ask_clock(7, now), "clock-answer");
  ASSERT_EQ(untold.health.size(), 1U) << "nobody has told it the time, so nobody knows how far it is off";
  EXPECT_EQ(untold.health[0].value, 5);
  const Instant told_at = now + driver.sync_time_time();
  EXPECT_EQ(driver.sync_time(microseconds(3'661'234'567) - driver.sync_time_time(), 1, now), SendStatus::accepted);
  now += milliseconds(100);
  driver.step(now, log);
  const Instant asked_at = now + port.wire_time(footlight_serial::frame_length(0));
  const ServiceAnswer clock = hear(driver.ask_clock(7, now), "clock-answer");
  ASSERT_EQ(clock.health.size(), 2U);
  EXPECT_EQ(clock.health[1].name, "clock error");
  EXPECT_NEAR(clock.health[1].value, 0.432 - to_seconds(asked_at - told_at) * 1e3, 1e-6);
  EXPECT_EQ(log.answers.size(), 7U) << "each once";
  EXPECT_TRUE(log.events.empty());
  hear(driver.send_content(kSeven, 3, 17, {true, 64, 250, 3'662'000, 500}, now), "receipt-content");
  ASSERT_EQ(log.count(Kind::content), 1U);
  EXPECT_EQ(log.last(Kind::content)->detail, 3);
  EXPECT_EQ(log.last(Kind::content)->sequence, 17);
  const KeptChecks both{0x89ABCDEF, 0x12345678};
  EXPECT_EQ(hear(driver.ask_patch(7, 0x12345678, now), "kept").kept, both);
  hear(driver.ask_kept(kSeven, now), "kept");
  ASSERT_EQ(log.count(Kind::keeps), 1U);
  EXPECT_EQ(log.last(Kind::keeps)->kept, both);
}

TEST(SerialGolden, EveryAnswerOfANodeIsUnderstood) {
  const Golden golden("serial.txt");
  RecordingStream port;
  SerialDriver driver(port, {kSeven, kNine}, kPlanByte);
  EventLog log;
  ASSERT_EQ(driver.preload(kSeven, 17, thirty_two_looks(), kStart), SendStatus::accepted);
  port.hear(golden.bytes("receipt-32"));
  driver.step(kStart, log);
  ASSERT_EQ(driver.preload(kNine, 240, kFiveLooks, kStart), SendStatus::accepted);
  port.hear(golden.bytes("receipt-5"));
  driver.step(kStart, log);
  ASSERT_EQ(driver.ask(kSeven, kStart), SendStatus::accepted);
  port.hear(golden.bytes("status"));
  driver.step(kStart, log);
  ASSERT_EQ(log.events.size(), 3U);
  EXPECT_EQ(log.events[0].kind, Kind::preloaded);
  EXPECT_EQ(log.events[1].kind, Kind::preloaded);
  EXPECT_EQ(log.events[1].sequence, 240);
  EXPECT_EQ(log.events[2].kind, Kind::showing);
  EXPECT_EQ(log.events[2].sequence, 17);
  EXPECT_EQ(log.events[2].crc, looks_crc(thirty_two_looks()));
  EXPECT_EQ(log.events[2].state, 1);
  EXPECT_EQ(log.events[2].boots, 0x0102);
}

TEST(CanopenGolden, EveryFrameOfTheControllerIsAsDocumented) {
  const Golden golden("canopen.txt");
  RecordingCan port;
  CanopenDriver driver(port, {kSeven, kNine});
  EventLog log;
  const auto wire = [&](SendStatus status) {
    EXPECT_EQ(status, SendStatus::accepted);
    port.in_queue = 0;
    driver.step(kStart, log);
    return std::exchange(port.sent, {});
  };
  EXPECT_EQ(wire(driver.start(kStart)), golden.frames("start"));
  EXPECT_EQ(wire(driver.preload(kSeven, 17, thirty_two_looks(), kStart)), golden.frames("preload-32"));
  EXPECT_EQ(wire(driver.preload(kNine, 17, kFiveLooks, kStart)), golden.frames("preload-5"));
  EXPECT_EQ(wire(driver.latch(17, kStart)), golden.frames("latch"));
  EXPECT_EQ(wire(driver.heartbeat(kShowTime, kStart)), golden.frames("heartbeat"));
  EXPECT_EQ(wire(driver.upload_look(5, kGrass, kStart)), golden.frames("look"));
  EXPECT_EQ(wire(driver.tell_plan(0x89ABCDEF, kStart)), golden.frames("plan-check"));
  port.incoming.push_back(golden.frames("boot-up").front());
  driver.step(kStart, log);
  EXPECT_EQ(std::exchange(port.sent, {}), golden.frames("start-one"));
}

TEST(CanopenGolden, EveryFrameOfANodeIsUnderstood) {
  const Golden golden("canopen.txt");
  RecordingCan port;
  CanopenDriver driver(port, {kSeven, kNine});
  EventLog log;
  for (const char* name : {"boot-up", "operational", "status", "emergency"}) {
    port.incoming.push_back(golden.frames(name).front());
  }
  driver.step(kStart, log);
  ASSERT_EQ(log.events.size(), 3U);
  EXPECT_EQ(log.events[0].kind, Kind::booted);
  EXPECT_EQ(log.events[1].kind, Kind::showing);
  EXPECT_EQ(log.events[1].sequence, 17);
  EXPECT_EQ(log.events[1].state, 1);
  EXPECT_EQ(log.events[1].crc, looks_crc(thirty_two_looks()));
  EXPECT_EQ(log.events[1].boots, 0x0102);
  EXPECT_EQ(log.events[2].kind, Kind::rejected);
  EXPECT_EQ(log.events[2].detail, 0x8210);
  EXPECT_EQ(log.events[2].node, kSeven.node);
}

TEST(CanopenGolden, WhoLeadsSaysSoBeforeItsFirstFrame) {
  const Golden golden("canopen.txt");
  RecordingCan port;
  Leadership leadership;
  leadership.epoch = 0x00010203;
  CanopenDriver driver(port, {kSeven}, {}, &leadership);
  ASSERT_EQ(driver.heartbeat(kShowTime, kStart), SendStatus::accepted);
  ASSERT_EQ(port.sent.size(), 2U);
  EXPECT_EQ(port.sent[0], golden.frames("lead").front());
  EXPECT_EQ(port.sent[1], golden.frames("heartbeat").front());
  EventLog log;
  port.incoming.push_back(golden.frames("fenced").front());
  driver.step(kStart, log);
  EXPECT_EQ(leadership.refusals.load(), 1U);
  EXPECT_TRUE(log.events.empty()) << "that a node refuses another controller is no fault of the node";
  port.in_queue = 0;
  EXPECT_EQ(driver.latch(17, kStart), SendStatus::busy);
  EXPECT_EQ(driver.heartbeat(kShowTime, kStart), SendStatus::busy);
  EXPECT_EQ(port.sent.size(), 2U) << "nothing more";
}

TEST(CanopenGolden, WhatANodeKeepsIsAskedBesideEverythingElse) {
  const Golden golden("canopen.txt");
  RecordingCan port;
  CanopenDriver driver(port, {kSeven, kNine});
  EventLog log;
  const KeptChecks both{0x89ABCDEF, 0x12345678};
  const auto asked = golden.frames("sdo-patch");
  const auto answers = golden.frames("sdo-patch-answer");
  ASSERT_EQ(driver.ask_kept(kSeven, kStart), SendStatus::accepted);
  EXPECT_TRUE(driver.ready()) << "a latch waits for nobody's answer";
  EXPECT_EQ(driver.ask_kept(kNine, kStart), SendStatus::busy);
  EXPECT_EQ(driver.latch(17, kStart), SendStatus::accepted);
  port.in_queue = 0;
  for (std::size_t i = 1; i < answers.size(); ++i) {
    EXPECT_EQ(port.sent.back().id == 0x080 ? asked[1] : port.sent.back(), asked[i]);
    port.incoming.push_back(answers[i]);
    driver.step(kStart, log);
    port.in_queue = 0;
  }
  ASSERT_EQ(log.count(Kind::keeps), 1U);
  EXPECT_EQ(log.last(Kind::keeps)->node, kSeven.node);
  EXPECT_EQ(log.last(Kind::keeps)->kept, both);
  EXPECT_TRUE(log.answers.empty()) << "no technician has asked";
  ASSERT_EQ(driver.ask_patch(7, 0x12345678, kStart), SendStatus::accepted);
  EXPECT_FALSE(driver.ready());
  for (std::size_t i = 0; i < answers.size(); ++i) {
    EXPECT_EQ(port.sent.back(), asked[i]);
    port.incoming.push_back(answers[i]);
    driver.step(kStart, log);
    port.in_queue = 0;
  }
  ASSERT_EQ(log.answers.size(), 1U);
  EXPECT_EQ(log.answers.back().kind, ServiceAnswer::Kind::done);
  EXPECT_EQ(log.answers.back().kept, both);
}

/// Plays the answers to a client and records what it says.
std::vector<CanFrame> transfer(canopen::SdoClient& client, const CanFrame& first,
                               const std::vector<CanFrame>& answers) {
  std::vector<CanFrame> said{first};
  for (const CanFrame& answer : answers) {
    EXPECT_EQ(client.state(), canopen::SdoClient::State::waiting);
    if (const auto next = client.take(answer)) said.push_back(*next);
  }
  return said;
}

TEST(CanopenGolden, SdoTransfersAreAsDocumented) {
  using State = canopen::SdoClient::State;
  using Bytes = std::vector<std::uint8_t>;
  const Golden golden("canopen.txt");
  canopen::SdoClient client;
  const auto answers = [&](const std::string& name) { return golden.frames(name + "-answer"); };
  EXPECT_EQ(transfer(client, client.read(7, {0x1018, 2}), answers("sdo-product")), golden.frames("sdo-product"));
  EXPECT_EQ(client.data(), (Bytes{0x4B, 0x4D, 0x4C, 0x46}));
  EXPECT_EQ(transfer(client, client.read(7, {0x1008, 0}), answers("sdo-name")), golden.frames("sdo-name"));
  EXPECT_EQ(client.state(), State::done);
  EXPECT_EQ(std::string(client.data().begin(), client.data().end()), "Footlight marker");
  EXPECT_EQ(transfer(client, client.write(7, {0x2104, 0}, Bytes{1}), answers("sdo-identify")),
            golden.frames("sdo-identify"));
  EXPECT_EQ(client.state(), State::done);
  const Bytes nine{'1', '2', '3', '4', '5', '6', '7', '8', '9'};
  EXPECT_EQ(transfer(client, client.write(7, {0x2200, 3}, nine), answers("sdo-write-long")),
            golden.frames("sdo-write-long"));
  EXPECT_EQ(client.state(), State::done);
  EXPECT_EQ(transfer(client, client.read(7, {0x2FFF, 0}), answers("sdo-nothing")), golden.frames("sdo-nothing"));
  EXPECT_EQ(client.state(), State::aborted);
  EXPECT_EQ(client.abort_code(), 0x06020000U);
  (void)client.read(7, {0x1018, 2});
  EXPECT_EQ(std::vector{client.give_up()}, golden.frames("sdo-give-up"));
}

/// A request as it stands in an RTU frame, without the check sum (transport tests compare that, too).
std::vector<std::uint8_t> rtu_body(const ModbusRequest& request) {
  std::vector<std::uint8_t> bytes{request.unit, request.function};
  const auto word = [&](std::uint16_t value) {
    bytes.push_back(static_cast<std::uint8_t>(value >> 8));
    bytes.push_back(static_cast<std::uint8_t>(value & 0xFF));
  };
  word(request.first_register);
  word(request.count);
  if (!request.values.empty()) bytes.push_back(static_cast<std::uint8_t>(2 * request.values.size()));
  for (const std::uint16_t value : request.values) word(value);
  return bytes;
}

TEST(ModbusGolden, EveryRequestIsAsDocumented) {
  const Golden golden("modbus.txt");
  RecordingModbus port;
  ModbusDriver driver(port, footlight_marker_profile(), {kSeven, kNine}, kPlanByte);
  EventLog log;
  const auto wire = [&](SendStatus status) {
    EXPECT_EQ(status, SendStatus::accepted);
    if (port.sent.back().unit == 0) {
      port.taken = false;
    } else {
      port.answer(ModbusReply::Outcome::ok);
    }
    driver.step(kStart, log);
    return rtu_body(port.sent.back());
  };
  const auto without_crc = [&](const std::string& name) {
    const auto bytes = golden.bytes(name);
    return std::vector<std::uint8_t>(bytes.begin(), bytes.begin() + std::max<std::ptrdiff_t>(0, std::ssize(bytes) - 2));
  };
  EXPECT_EQ(wire(driver.preload(kSeven, 17, thirty_two_looks(), kStart)), without_crc("preload-32"));
  EXPECT_EQ(wire(driver.preload(kNine, 240, kFiveLooks, kStart)), without_crc("preload-5"));
  EXPECT_EQ(wire(driver.latch(17, kStart)), without_crc("latch"));
  EXPECT_EQ(wire(driver.heartbeat(kShowTime, kStart)), without_crc("heartbeat"));
  EXPECT_EQ(wire(driver.ask(kSeven, kStart)), without_crc("ask"));
  EXPECT_EQ(wire(driver.upload_look(5, kGrass, kStart)), without_crc("look"));
  EXPECT_EQ(wire(driver.tell_plan(0x89ABCDEF, kStart)), without_crc("plan-check"));
}

TEST(ModbusGolden, WhatANodeKeepsIsWrittenAndReadAsDocumented) {
  const Golden golden("modbus.txt");
  RecordingModbus port;
  ModbusDriver driver(port, footlight_marker_profile(), {kSeven}, kPlanByte);
  EventLog log;
  const auto without_crc = [&](const std::string& name) {
    const auto bytes = golden.bytes(name);
    return std::vector<std::uint8_t>(bytes.begin(), bytes.end() - 2);
  };
  const std::vector<std::uint16_t> registers{0x89AB, 0xCDEF, 0x1234, 0x5678, 0, 0, 0, 0};
  const KeptChecks both{0x89ABCDEF, 0x12345678};
  ASSERT_EQ(driver.ask_kept(kSeven, kStart), SendStatus::accepted);
  EXPECT_EQ(rtu_body(port.sent.back()), without_crc("ask-kept"));
  port.answer(ModbusReply::Outcome::ok, registers);
  driver.step(kStart, log);
  ASSERT_EQ(log.count(Kind::keeps), 1U);
  EXPECT_EQ(log.last(Kind::keeps)->kept, both);
  ASSERT_EQ(driver.ask_patch(7, 0x12345678, kStart), SendStatus::accepted);
  EXPECT_EQ(rtu_body(port.sent.back()), without_crc("patch-check"));
  port.answer(ModbusReply::Outcome::ok);
  driver.step(kStart, log);
  EXPECT_EQ(rtu_body(port.sent.back()), without_crc("ask-kept"));
  port.answer(ModbusReply::Outcome::ok, registers);
  driver.step(kStart, log);
  ASSERT_EQ(log.answers.size(), 1U);
  EXPECT_EQ(log.answers.back().kept, both);
}

}  // namespace
}  // namespace footlight::drivers
