// SPDX-License-Identifier: Apache-2.0
#include "drivers/devices/footlight_serial/serial_driver.hpp"

#include <gtest/gtest.h>

#include "tests/drivers/recording_ports.hpp"

namespace footlight::drivers {
namespace {

using footlight_serial::Command;
using footlight_serial::Direction;
using footlight_serial::Frame;
using Kind = DeviceEvent::Kind;

constexpr std::uint8_t kPlanByte = 0x42;
const NodeAddress kOne{NodeIndex(0), 1, 4};
const NodeAddress kTwo{NodeIndex(1), 2, 4};
const std::vector<LookIndex> kLooks{5, 6, 7, 8};

class SerialDriverTest : public ::testing::Test {
 protected:
  void hear(Command command, std::uint8_t address, Sequence sequence, std::vector<std::uint8_t> body) {
    port_.hear(encode(Frame{Direction::from_node, command, address, kPlanByte, sequence, std::move(body)}));
  }
  void hear_receipt(std::uint8_t address, Sequence sequence, std::uint16_t crc) {
    hear(Command::preload, address, sequence,
         {static_cast<std::uint8_t>(crc & 0xFF), static_cast<std::uint8_t>(crc >> 8)});
  }

  RecordingStream port_;
  SerialDriver driver_{port_, {kOne, kTwo}, kPlanByte};
  EventLog log_;
  Instant now_ = instant_at(1);
};

TEST_F(SerialDriverTest, WhoeverIsFencedHearsWhoLeadsWithTheNextHeartbeat) {
  Leadership leadership;
  leadership.epoch = 9;
  SerialDriver driver(port_, {kOne, kTwo}, kPlanByte, &leadership);
  const auto lead = encode(footlight_serial::lead(leading_byte(kPlanByte, 9), 9));
  const auto beats = [&] {
    now_ += kHeartbeatPeriod;
    driver.step(now_, log_);
    EXPECT_EQ(driver.heartbeat({}, now_), SendStatus::accepted);
    now_ += milliseconds(20);
    driver.step(now_, log_);
    return !std::ranges::search(port_.sent.back(), lead).empty();
  };
  EXPECT_TRUE(beats()) << "before anything else";
  EXPECT_FALSE(beats()) << "then once a second";
  ASSERT_EQ(driver.preload(kOne, 7, kLooks, now_), SendStatus::accepted);
  port_.hear(encode(Frame{Direction::from_node, Command::lead, 1, leading_byte(kPlanByte, 9), 0, {8, 0, 0, 0}}));
  driver.step(now_, log_);
  EXPECT_EQ(log_.count(Kind::fenced), 1U);
  EXPECT_EQ(log_.count(Kind::missed), 0U);
  EXPECT_EQ(leadership.refusals, 1U);
  EXPECT_TRUE(beats());
  EXPECT_FALSE(beats());
}

TEST_F(SerialDriverTest, WaitsForTheLatestPossibleAnswerAndNoLonger) {
  ASSERT_EQ(driver_.ask(kOne, now_), SendStatus::accepted);
  const Instant deadline = driver_.step(now_, log_);
  EXPECT_EQ(deadline, now_ + driver_.status_time() + milliseconds(10)) << "budget and the margin for the machine";
  driver_.step(deadline - Duration(1), log_);
  EXPECT_TRUE(log_.events.empty());
  EXPECT_EQ(driver_.step(deadline, log_), kNever);
  EXPECT_EQ(log_.count(Kind::missed), 1U);
}

TEST_F(SerialDriverTest, AnAnswerCutByTheLastStepIsPutTogether) {
  ASSERT_EQ(driver_.ask(kOne, now_), SendStatus::accepted);
  const auto bytes = encode(Frame{Direction::from_node, Command::status, 1, kPlanByte, 9, {0, 1, 2, 1, 3, 0, 0, 0}});
  for (const std::uint8_t byte : bytes) {
    port_.hear({byte});
    driver_.step(now_, log_);
  }
  ASSERT_EQ(log_.count(Kind::showing), 1U);
  EXPECT_EQ(log_.last(Kind::showing)->crc, 0x0201);
}

TEST_F(SerialDriverTest, AnAnswerOfAnotherNodeIsNotTheAnswer) {
  ASSERT_EQ(driver_.ask(kOne, now_), SendStatus::accepted);
  hear(Command::status, 2, 9, {0, 1, 2, 1, 3, 0, 0, 0});
  driver_.step(now_, log_);
  EXPECT_TRUE(log_.events.empty());
  EXPECT_FALSE(driver_.ready());
}

TEST_F(SerialDriverTest, AnOldReceiptIsNotTakenForTheNewPreload) {
  ASSERT_EQ(driver_.preload(kOne, 18, kLooks, now_), SendStatus::accepted);
  hear_receipt(1, 17, looks_crc(kLooks));
  hear_receipt(1, 18, static_cast<std::uint16_t>(looks_crc(kLooks) + 1));
  driver_.step(now_, log_);
  EXPECT_TRUE(log_.events.empty());
  hear_receipt(1, 18, looks_crc(kLooks));
  driver_.step(now_, log_);
  EXPECT_EQ(log_.count(Kind::preloaded), 1U);
}

TEST_F(SerialDriverTest, AnAnswerThatComesAfterItsTimeIsNobodys) {
  ASSERT_EQ(driver_.ask(kOne, now_), SendStatus::accepted);
  now_ += milliseconds(50);
  driver_.step(now_, log_);
  hear(Command::status, 1, 9, {0, 1, 2, 1, 3, 0, 0, 0});
  driver_.step(now_, log_);
  EXPECT_EQ(log_.count(Kind::missed), 1U);
  EXPECT_EQ(log_.count(Kind::showing), 0U);
}

TEST_F(SerialDriverTest, OurOwnEchoOnTwoWiresIsNoAnswer) {
  ASSERT_EQ(driver_.ask(kOne, now_), SendStatus::accepted);
  port_.hear(port_.sent.back());
  driver_.step(now_, log_);
  EXPECT_TRUE(log_.events.empty());
}

TEST_F(SerialDriverTest, ABroadcastTakesTheLineForItsWireTime) {
  ASSERT_EQ(driver_.latch(1, now_), SendStatus::accepted);
  const Instant free = driver_.step(now_, log_);
  EXPECT_EQ(free, now_ + port_.wire_time(port_.sent.back().size()));
  EXPECT_EQ(driver_.latch_time(), free - now_);
  EXPECT_FALSE(driver_.ready());
  EXPECT_EQ(driver_.heartbeat({}, now_), SendStatus::busy);
  driver_.step(free, log_);
  EXPECT_TRUE(driver_.ready());
  EXPECT_EQ(driver_.heartbeat({}, free), SendStatus::accepted);
}

TEST_F(SerialDriverTest, AFloodEndsEachStep) {
  for (int i = 0; i < 100'000; ++i) port_.incoming.push_back(static_cast<std::uint8_t>(i));
  EXPECT_EQ(driver_.step(now_, log_), now_) << "there is more, but others have their turn first";
  EXPECT_FALSE(port_.incoming.empty());
}

}  // namespace
}  // namespace footlight::drivers
