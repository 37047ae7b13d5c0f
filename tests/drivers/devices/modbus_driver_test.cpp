// SPDX-License-Identifier: Apache-2.0
#include "drivers/devices/modbus/modbus_driver.hpp"

#include <gtest/gtest.h>

#include "tests/drivers/recording_ports.hpp"

namespace footlight::drivers {
namespace {

using Kind = DeviceEvent::Kind;
using Outcome = ModbusReply::Outcome;

const NodeAddress kOne{NodeIndex(0), 1, 4};
const NodeAddress kTwo{NodeIndex(1), 2, 3};
const std::vector<LookIndex> kFour{1, 2, 3, 4};
const std::vector<LookIndex> kThree{5, 6, 7};

class ModbusDriverTest : public ::testing::Test {
 protected:
  void use(const ModbusProfile& profile) {
    driver_ = std::make_unique<ModbusDriver>(port_, profile, std::vector<NodeAddress>{kOne, kTwo}, std::uint8_t{0x77});
  }
  Instant step() { return driver_->step(now_, log_); }
  void answer(Outcome outcome, std::vector<std::uint16_t> values = {}, std::uint8_t exception = 0) {
    port_.answer(outcome, std::move(values), exception);
    step();
  }

  RecordingModbus port_;
  std::unique_ptr<ModbusDriver> driver_ = std::make_unique<ModbusDriver>(
      port_, modbus::footlight_marker(), std::vector<NodeAddress>{kOne, kTwo}, std::uint8_t{0x77});
  EventLog log_;
  Instant now_ = instant_at(1);
};

TEST_F(ModbusDriverTest, ExceptionsOneToThreeAreRefusalsAtOnce) {
  for (const std::uint8_t code :
       {std::uint8_t{1}, std::uint8_t{2}, std::uint8_t{3}, std::uint8_t{5}, std::uint8_t{6}}) {
    ASSERT_EQ(driver_->preload(kOne, 1, kFour, now_), SendStatus::accepted);
    answer(Outcome::exception, {}, code);
    ASSERT_NE(log_.last(Kind::rejected), nullptr);
    EXPECT_EQ(log_.last(Kind::rejected)->detail, code);
    EXPECT_EQ(log_.last(Kind::rejected)->node, kOne.node);
  }
  EXPECT_EQ(port_.sent.size(), 5U) << "no second try";
  EXPECT_EQ(log_.events.size(), 5U);
}

TEST_F(ModbusDriverTest, ExceptionFourIsTriedOnceMore) {
  ASSERT_EQ(driver_->preload(kOne, 1, kFour, now_), SendStatus::accepted);
  answer(Outcome::exception, {}, 4);
  EXPECT_TRUE(log_.events.empty());
  ASSERT_EQ(port_.sent.size(), 2U);
  EXPECT_EQ(port_.sent[0].values, port_.sent[1].values);
  EXPECT_FALSE(driver_->ready());
  answer(Outcome::exception, {}, 4);
  EXPECT_EQ(port_.sent.size(), 2U);
  EXPECT_EQ(log_.count(Kind::rejected), 1U);
  EXPECT_TRUE(driver_->ready());
}

TEST_F(ModbusDriverTest, ASecondTryThatSucceedsIsAPreload) {
  ASSERT_EQ(driver_->preload(kOne, 9, kFour, now_), SendStatus::accepted);
  answer(Outcome::exception, {}, 4);
  answer(Outcome::ok);
  ASSERT_EQ(log_.events.size(), 1U);
  EXPECT_EQ(log_.events[0].kind, Kind::preloaded);
  EXPECT_EQ(log_.events[0].sequence, 9);
}

TEST_F(ModbusDriverTest, WrongUnitFunctionOrLengthIsMissed) {
  const auto ask_and_hear = [&](ModbusReply reply) {
    ASSERT_EQ(driver_->ask(kOne, now_), SendStatus::accepted);
    port_.reply = std::move(reply);
    step();
  };
  const std::vector<std::uint16_t> status{0x0100, 2, 1, 4, 5, 6};
  ask_and_hear({Outcome::ok, 2, 3, 0, status});
  ask_and_hear({Outcome::ok, 1, 16, 0, status});
  ask_and_hear({Outcome::ok, 1, 3, 0, {0x0100, 2, 1, 4, 5}});
  ask_and_hear({Outcome::ok, 1, 3, 0, {}});
  ask_and_hear({Outcome::garbled, 1, 3, 0, {}});
  EXPECT_EQ(log_.count(Kind::missed), 5U);
  EXPECT_EQ(log_.events.size(), 5U);
  ask_and_hear({Outcome::ok, 1, 3, 0, status});
  EXPECT_EQ(log_.count(Kind::showing), 1U);
}

TEST_F(ModbusDriverTest, LatchHeartbeatAndLooksAreBroadcasts) {
  ASSERT_EQ(driver_->latch(1, now_), SendStatus::accepted);
  EXPECT_FALSE(driver_->ready());
  EXPECT_EQ(driver_->heartbeat({}, now_), SendStatus::busy) << "one at a time";
  port_.taken = false;
  step();
  ASSERT_EQ(driver_->heartbeat({}, now_), SendStatus::accepted);
  port_.taken = false;
  step();
  ASSERT_EQ(driver_->upload_look(1, {}, now_), SendStatus::accepted);
  for (const ModbusRequest& request : port_.sent) EXPECT_EQ(request.unit, 0);
  EXPECT_EQ(driver_->latch_time(), port_.wire_time(port_.sent[0]));
}

TEST_F(ModbusDriverTest, OneLookARegisterStandsInTheLowByte) {
  ModbusProfile profile = modbus::footlight_marker();
  profile.looks_per_register = 1;
  profile.look_register = 6'300;
  use(profile);
  ASSERT_EQ(driver_->preload(kTwo, 3, kThree, now_), SendStatus::accepted);
  EXPECT_EQ(port_.sent[0].first_register, 6'300);
  EXPECT_EQ(port_.sent[0].values, (std::vector<std::uint16_t>{0x7703, 5, 6, 7}));
}

TEST_F(ModbusDriverTest, AProfileWithoutSequenceHasLooksAloneAndAPlainLatch) {
  ModbusProfile profile = modbus::footlight_marker();
  profile.has_preload_sequence = false;
  use(profile);
  EXPECT_FALSE(driver_->capabilities().sequenced_latch);
  ASSERT_EQ(driver_->preload(kTwo, 3, kThree, now_), SendStatus::accepted);
  EXPECT_EQ(port_.sent[0].values, (std::vector<std::uint16_t>{0x0506, 0x0700}));
  answer(Outcome::ok);
  ASSERT_EQ(driver_->latch(3, now_), SendStatus::accepted);
  EXPECT_EQ(port_.sent[1].values, (std::vector<std::uint16_t>{3}));
}

TEST_F(ModbusDriverTest, WithoutALatchTheLooksWaitHereForTheMoment) {
  ModbusProfile profile = modbus::footlight_marker();
  profile.latch_register.reset();
  use(profile);
  EXPECT_FALSE(driver_->capabilities().sequenced_latch);
  ASSERT_EQ(driver_->preload(kOne, 3, kFour, now_), SendStatus::accepted);
  ASSERT_EQ(driver_->preload(kTwo, 3, kThree, now_), SendStatus::accepted);
  step();
  EXPECT_EQ(log_.count(Kind::preloaded), 2U);
  EXPECT_TRUE(port_.sent.empty()) << "they would be seen at once";
  ASSERT_EQ(driver_->latch(3, now_), SendStatus::accepted);
  answer(Outcome::timeout);
  answer(Outcome::ok);
  ASSERT_EQ(port_.sent.size(), 2U);
  EXPECT_EQ(port_.sent[0].unit, 1);
  EXPECT_EQ(port_.sent[1].unit, 2);
  ASSERT_EQ(log_.count(Kind::missed), 1U);
  EXPECT_EQ(log_.last(Kind::missed)->node, kOne.node);
  EXPECT_TRUE(driver_->ready());
  EXPECT_EQ(driver_->latch_time(), driver_->preload_time(4) + driver_->preload_time(3));
  EXPECT_EQ(driver_->latch(3, now_), SendStatus::accepted) << "a repeated latch has nothing left to do";
  EXPECT_EQ(port_.sent.size(), 2U);
}

TEST_F(ModbusDriverTest, WhatAProfileLacksIsNotSent) {
  ModbusProfile profile;
  profile.look_register = 10;
  use(profile);
  const Capabilities can = driver_->capabilities();
  EXPECT_FALSE(can.readback);
  EXPECT_FALSE(can.lease);
  EXPECT_FALSE(can.sequenced_latch);
  EXPECT_FALSE(can.pushes_status);
  EXPECT_EQ(driver_->heartbeat({}, now_), SendStatus::accepted);
  EXPECT_EQ(driver_->ask(kOne, now_), SendStatus::accepted);
  EXPECT_EQ(driver_->upload_look(1, {}, now_), SendStatus::accepted);
  EXPECT_TRUE(port_.sent.empty());
  EXPECT_EQ(driver_->status_time(), Duration{});
  EXPECT_EQ(step(), kNever);
  EXPECT_TRUE(log_.events.empty());
}

TEST_F(ModbusDriverTest, ThirtyTwoLooksAt115200BdTakeTheirArithmetic) {
  // 43 + 8 characters of 11 bits, two silences of 1.75 ms, 5 ms turnaround.
  const Duration characters = Duration(51 * 11 * 1'000'000'000LL / 115'200);
  EXPECT_NEAR(static_cast<double>(driver_->preload_time(32).count()),
              static_cast<double>((characters + milliseconds(8) + microseconds(500)).count()), 10);
}

}  // namespace
}  // namespace footlight::drivers
