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
      port_, footlight_marker_profile(), std::vector<NodeAddress>{kOne, kTwo}, std::uint8_t{0x77});
  EventLog log_;
  Instant now_ = instant_at(1);
};

TEST_F(ModbusDriverTest, ExceptionsOneToThreeAreRefusalsAtOnce) {
  for (const std::uint8_t code : {std::uint8_t{1}, std::uint8_t{2}, std::uint8_t{3}}) {
    ASSERT_EQ(driver_->preload(kOne, 1, kFour, now_), SendStatus::accepted);
    answer(Outcome::exception, {}, code);
    ASSERT_NE(log_.last(Kind::rejected), nullptr);
    EXPECT_EQ(log_.last(Kind::rejected)->detail, code);
    EXPECT_EQ(log_.last(Kind::rejected)->node, kOne.node);
    EXPECT_EQ(log_.last(Kind::rejected)->again, DeviceEvent::Again::never);
  }
  EXPECT_EQ(port_.sent.size(), 3U) << "no second try";
  EXPECT_EQ(log_.events.size(), 3U);
}

TEST_F(ModbusDriverTest, WhoeverIsFencedHearsWhoLeadsWithTheNextHeartbeat) {
  Leadership leadership;
  leadership.epoch = 9;
  driver_ = std::make_unique<ModbusDriver>(port_, footlight_marker_profile(), std::vector<NodeAddress>{kOne, kTwo},
                                           std::uint8_t{0x77}, &leadership);
  const auto beat = [&] {
    const std::size_t before = port_.sent.size();
    EXPECT_EQ(driver_->heartbeat({}, now_), SendStatus::accepted);
    for (int i = 0; i < 4 && !driver_->ready(); ++i) {
      port_.taken = false;
      step();
    }
    return port_.sent.size() - before;
  };
  EXPECT_EQ(beat(), 2U) << "LEAD before anything else";
  EXPECT_EQ(beat(), 1U) << "then once a second";
  ASSERT_EQ(driver_->preload(kOne, 1, kFour, now_), SendStatus::accepted);
  answer(Outcome::exception, {}, 7);
  EXPECT_EQ(log_.count(Kind::fenced), 1U);
  EXPECT_EQ(log_.count(Kind::missed), 0U);
  EXPECT_EQ(leadership.refusals, 1U);
  EXPECT_EQ(beat(), 2U);
  EXPECT_EQ(beat(), 1U);
}

TEST_F(ModbusDriverTest, ExceptionsFiveAndSixAreForLater) {
  for (const std::uint8_t code : {std::uint8_t{5}, std::uint8_t{6}}) {
    ASSERT_EQ(driver_->preload(kOne, 1, kFour, now_), SendStatus::accepted);
    answer(Outcome::exception, {}, code);
    ASSERT_NE(log_.last(Kind::rejected), nullptr);
    EXPECT_EQ(log_.last(Kind::rejected)->again, DeviceEvent::Again::later);
    EXPECT_TRUE(driver_->ready()) << "others have their turn";
  }
  EXPECT_EQ(port_.sent.size(), 2U);
}

TEST_F(ModbusDriverTest, AGatewayThatReachesNobodyIsANodeThatIsMissed) {
  for (const std::uint8_t code : {std::uint8_t{10}, std::uint8_t{11}}) {
    ASSERT_EQ(driver_->ask(kOne, now_), SendStatus::accepted);
    answer(Outcome::exception, {}, code);
  }
  EXPECT_EQ(log_.count(Kind::missed), 2U);
  EXPECT_EQ(log_.count(Kind::rejected), 0U);
}

TEST_F(ModbusDriverTest, AfterATimeOutNoUnitIsAskedUntilTheLineIsQuiet) {
  ASSERT_EQ(driver_->ask(kOne, now_), SendStatus::accepted);
  answer(Outcome::timeout);
  EXPECT_EQ(driver_->ask(kTwo, now_), SendStatus::busy);
  EXPECT_EQ(driver_->preload(kTwo, 1, kThree, now_), SendStatus::busy);
  port_.unread = true;  // the late answer comes
  now_ += milliseconds(20);
  const Instant again = step();
  EXPECT_EQ(again, now_ + milliseconds(20)) << "another round, for something was heard";
  EXPECT_EQ(driver_->ask(kTwo, now_), SendStatus::busy);
  now_ = again;
  EXPECT_EQ(step(), kNever);
  EXPECT_EQ(driver_->ask(kTwo, now_), SendStatus::accepted);
}

TEST_F(ModbusDriverTest, TheMomentDoesNotWaitForQuiet) {
  ASSERT_EQ(driver_->ask(kOne, now_), SendStatus::accepted);
  answer(Outcome::timeout);
  EXPECT_TRUE(driver_->ready());
  EXPECT_EQ(driver_->latch(3, now_), SendStatus::accepted);
}

TEST_F(ModbusDriverTest, ALineThatIsNeverQuietIsUsedAllTheSame) {
  ASSERT_EQ(driver_->ask(kOne, now_), SendStatus::accepted);
  answer(Outcome::garbled);
  for (int i = 0; i < 9; ++i) {
    port_.unread = true;
    now_ += milliseconds(20);
    step();
    ASSERT_EQ(driver_->ask(kTwo, now_), SendStatus::busy) << i;
  }
  port_.unread = true;
  now_ += milliseconds(20);
  step();
  EXPECT_EQ(driver_->ask(kTwo, now_), SendStatus::accepted);
}

TEST_F(ModbusDriverTest, WhatNobodyWaitsForIsThrownAwayBeforeEachRequestToAUnit) {
  ASSERT_EQ(driver_->ask(kOne, now_), SendStatus::accepted);
  EXPECT_EQ(port_.discards, 1);
  answer(Outcome::ok, {0, 0, 0, 0, 0, 0});
  ASSERT_EQ(driver_->latch(1, now_), SendStatus::accepted);
  EXPECT_EQ(port_.discards, 1) << "a broadcast hears nothing";
}

TEST_F(ModbusDriverTest, NoQuestionIsOfTheLengthOfOneThatIsOpen) {
  const auto ask = [&](const NodeAddress& node) {
    EXPECT_EQ(driver_->ask(node, now_), SendStatus::accepted);
    return int{port_.sent.back().count};
  };
  const auto leave_open = [&] {
    answer(Outcome::timeout);
    now_ += milliseconds(20);
    step();
  };
  for (int length = 6; length >= 1; --length) {
    EXPECT_EQ(ask(kOne), length);
    leave_open();
  }
  EXPECT_EQ(ask(kTwo), 6) << "each node has its own";
  answer(Outcome::ok, std::vector<std::uint16_t>(6));
  const std::size_t sent = port_.sent.size();
  ASSERT_EQ(driver_->ask(kOne, now_), SendStatus::accepted);
  step();
  EXPECT_EQ(port_.sent.size(), sent) << "no answer could be told from an old one";
  EXPECT_EQ(log_.count(Kind::missed), 7U);
  now_ += milliseconds(1000);
  EXPECT_EQ(ask(kOne), 6) << "after a second of silence nothing old will come";
  answer(Outcome::ok, std::vector<std::uint16_t>(6));
  EXPECT_EQ(log_.count(Kind::showing), 2U);
}

TEST_F(ModbusDriverTest, AnAnswerThatOnlyShowsThatTheNodeIsBackIsFollowedByTheWholeQuestion) {
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(driver_->ask(kOne, now_), SendStatus::accepted);
    answer(Outcome::timeout);
    now_ += milliseconds(20);
    step();
  }
  ASSERT_EQ(driver_->ask(kOne, now_), SendStatus::accepted);
  ASSERT_EQ(port_.sent.back().count, 3);
  answer(Outcome::ok, {0x0500, 1, 1});
  EXPECT_EQ(log_.count(Kind::showing), 0U);
  ASSERT_EQ(port_.sent.size(), 5U);
  EXPECT_EQ(port_.sent.back().count, 6);
  answer(Outcome::ok, {0x0500, 1, 1, 1, 1, 1});
  EXPECT_EQ(log_.count(Kind::showing), 1U);
  EXPECT_TRUE(driver_->ready());
}

TEST_F(ModbusDriverTest, AReceiptFromANodeThatOwesAnAnswerIsReadBack) {
  const auto read_back = [&](std::uint16_t sequences) {
    ASSERT_EQ(driver_->preload(kOne, 9, kFour, now_), SendStatus::accepted);
    answer(Outcome::timeout);
    now_ += milliseconds(20);
    step();
    ASSERT_EQ(driver_->preload(kOne, 9, kFour, now_), SendStatus::accepted);
    answer(Outcome::ok);
    EXPECT_EQ(log_.count(Kind::preloaded), 0U) << "it may be the receipt of the one before";
    EXPECT_FALSE(driver_->ready());
    ASSERT_EQ(port_.sent.back().function, 3);
    std::vector<std::uint16_t> status(port_.sent.back().count);
    status[0] = sequences;
    answer(Outcome::ok, status);
  };
  read_back(0x0508);
  EXPECT_EQ(log_.count(Kind::preloaded), 0U) << "8 is pending";
  EXPECT_EQ(log_.count(Kind::missed), 2U);
  read_back(0x0509);
  ASSERT_EQ(log_.count(Kind::preloaded), 1U);
  EXPECT_EQ(log_.last(Kind::preloaded)->sequence, 9);
  EXPECT_EQ(log_.count(Kind::showing), 0U);
  ASSERT_EQ(driver_->preload(kOne, 10, kFour, now_), SendStatus::accepted);
  answer(Outcome::ok);
  EXPECT_EQ(log_.count(Kind::preloaded), 2U) << "nothing is owed any more";
}

TEST_F(ModbusDriverTest, ARefusalByANodeThatOwesAnAnswerMayBeOfSomethingElse) {
  ASSERT_EQ(driver_->ask(kOne, now_), SendStatus::accepted);
  answer(Outcome::timeout);
  now_ += milliseconds(20);
  step();
  ASSERT_EQ(driver_->ask(kOne, now_), SendStatus::accepted);
  answer(Outcome::exception, {}, 3);
  EXPECT_EQ(log_.count(Kind::rejected), 0U);
  EXPECT_EQ(log_.count(Kind::missed), 2U);
}

TEST_F(ModbusDriverTest, WithoutASequenceAReceiptIsTakenForWhatItIs) {
  ModbusProfile profile = footlight_marker_profile();
  profile.has_preload_sequence = false;
  use(profile);
  ASSERT_EQ(driver_->preload(kOne, 9, kFour, now_), SendStatus::accepted);
  answer(Outcome::timeout);
  now_ += milliseconds(20);
  step();
  ASSERT_EQ(driver_->preload(kOne, 9, kFour, now_), SendStatus::accepted);
  answer(Outcome::ok);
  EXPECT_EQ(log_.count(Kind::preloaded), 1U);
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
    now_ += milliseconds(20);
    step();
  };
  const std::vector<std::uint16_t> status{0x0100, 2, 1, 4, 5, 6};
  ask_and_hear({Outcome::ok, 2, 3, 0, status});
  ask_and_hear({Outcome::ok, 1, 16, 0, status});
  ask_and_hear({Outcome::ok, 1, 3, 0, status});
  EXPECT_EQ(log_.count(Kind::missed), 3U) << "of the length of a question before";
  ask_and_hear({Outcome::ok, 1, 3, 0, {}});
  ask_and_hear({Outcome::garbled, 1, 3, 0, {}});
  EXPECT_EQ(log_.count(Kind::missed), 5U);
  EXPECT_EQ(log_.events.size(), 5U);
  now_ += milliseconds(1000);
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
  ModbusProfile profile = footlight_marker_profile();
  profile.looks_per_register = 1;
  profile.look_register = 6'300;
  use(profile);
  ASSERT_EQ(driver_->preload(kTwo, 3, kThree, now_), SendStatus::accepted);
  EXPECT_EQ(port_.sent[0].first_register, 6'300);
  EXPECT_EQ(port_.sent[0].values, (std::vector<std::uint16_t>{0x7703, 5, 6, 7}));
}

TEST_F(ModbusDriverTest, AProfileWithoutSequenceHasLooksAloneAndAPlainLatch) {
  ModbusProfile profile = footlight_marker_profile();
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
  ModbusProfile profile = footlight_marker_profile();
  profile.latch_register.reset();
  use(profile);
  EXPECT_TRUE(driver_->capabilities().sequenced_latch) << "the driver itself holds looks back until their own latch";
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
  EXPECT_FALSE(can.proves_looks);
  EXPECT_FALSE(can.lease);
  EXPECT_FALSE(can.pushes_status);
  EXPECT_EQ(driver_->heartbeat({}, now_), SendStatus::accepted);
  EXPECT_EQ(driver_->ask(kOne, now_), SendStatus::accepted);
  EXPECT_EQ(driver_->upload_look(1, {}, now_), SendStatus::accepted);
  EXPECT_TRUE(port_.sent.empty());
  EXPECT_EQ(driver_->status_time(), Duration{});
  EXPECT_EQ(step(), kNever);
  EXPECT_TRUE(log_.events.empty());
}

ModbusProfile relays() {
  ModbusProfile profile;
  profile.name = "relay-16";
  profile.channels = 16;
  profile.coils = true;
  profile.has_preload_sequence = false;
  profile.readable_looks = true;
  profile.has_broadcast = false;
  return profile;
}

TEST_F(ModbusDriverTest, CoilsAreOnForEveryLookThatIsLit) {
  use(relays());
  ASSERT_EQ(driver_->upload_look(2, {{255, 0, 0}, Effect::blink, 0}, now_), SendStatus::accepted);
  ASSERT_EQ(driver_->preload(kOne, 3, std::vector<LookIndex>{1, 0, 2, 9}, now_), SendStatus::accepted);
  step();
  ASSERT_EQ(driver_->latch(3, now_), SendStatus::accepted);
  ASSERT_EQ(port_.sent.size(), 1U) << "the look table stays here";
  EXPECT_EQ(port_.sent[0].unit, 1);
  EXPECT_EQ(port_.sent[0].function, 0x0F);
  EXPECT_EQ(port_.sent[0].first_register, 0);
  EXPECT_EQ(port_.sent[0].values, (std::vector<std::uint16_t>{1, 0, 0, 1})) << "look 2 has no brightness";
}

TEST_F(ModbusDriverTest, LooksReadBackAreComparedWithThoseLatched) {
  use(relays());
  EXPECT_TRUE(driver_->capabilities().readback);
  EXPECT_FALSE(driver_->capabilities().proves_looks);
  EXPECT_EQ(driver_->assumption(),
            "looks are read back without a sequence: an answer later than its time-out is taken for lost; without a "
            "latch its lamps change one node after the other; it keeps its looks when the controller is silent");
  const std::vector<LookIndex> looks{1, 0, 2, 0};
  ASSERT_EQ(driver_->preload(kOne, 3, looks, now_), SendStatus::accepted);
  step();
  ASSERT_EQ(driver_->ask(kOne, now_), SendStatus::accepted);
  EXPECT_EQ(port_.sent.back().function, 0x01);
  answer(Outcome::ok, {1, 0, 1, 0});
  ASSERT_EQ(log_.count(Kind::showing), 1U);
  EXPECT_EQ(log_.last(Kind::showing)->sequence, 0) << "nothing has been latched";
  EXPECT_NE(log_.last(Kind::showing)->crc, looks_crc(looks));
  ASSERT_EQ(driver_->latch(3, now_), SendStatus::accepted);
  answer(Outcome::ok);
  ASSERT_EQ(driver_->ask(kOne, now_), SendStatus::accepted);
  answer(Outcome::ok, {1, 0, 1, 0});
  EXPECT_EQ(log_.last(Kind::showing)->sequence, 3);
  EXPECT_EQ(log_.last(Kind::showing)->crc, looks_crc(looks));
  ASSERT_EQ(driver_->ask(kOne, now_), SendStatus::accepted);
  answer(Outcome::ok, {1, 0, 0, 0});
  EXPECT_NE(log_.last(Kind::showing)->crc, looks_crc(looks)) << "it has been switched by somebody else";
  ASSERT_EQ(driver_->ask(kOne, now_), SendStatus::accepted);
  answer(Outcome::ok, {1, 0});
  EXPECT_EQ(log_.count(Kind::missed), 1U) << "too few coils";
}

TEST_F(ModbusDriverTest, ALatchTakesOnlyTheLooksOfItsSequence) {
  use(relays());
  ASSERT_EQ(driver_->preload(kOne, 3, kFour, now_), SendStatus::accepted);
  step();
  ASSERT_EQ(driver_->preload(kTwo, 4, kThree, now_), SendStatus::accepted);
  step();
  ASSERT_EQ(driver_->latch(3, now_), SendStatus::accepted);
  answer(Outcome::ok);
  ASSERT_EQ(port_.sent.size(), 1U);
  EXPECT_EQ(port_.sent[0].unit, 1);
}

TEST_F(ModbusDriverTest, OneByOneTheRestOfAFailedWriteIsDropped) {
  ModbusProfile profile = relays();
  profile.writes_one_by_one = true;
  use(profile);
  ASSERT_EQ(driver_->preload(kOne, 3, std::vector<LookIndex>{1, 0, 1, 1}, now_), SendStatus::accepted);
  step();
  ASSERT_EQ(driver_->preload(kTwo, 3, std::vector<LookIndex>{0, 0, 1}, now_), SendStatus::accepted);
  step();
  ASSERT_EQ(driver_->latch(3, now_), SendStatus::accepted);
  EXPECT_EQ(port_.sent[0].function, 0x05);
  EXPECT_EQ(port_.sent[0].values, (std::vector<std::uint16_t>{0xFF00}));
  answer(Outcome::ok);
  EXPECT_EQ(port_.sent[1].first_register, 1);
  EXPECT_EQ(port_.sent[1].values, (std::vector<std::uint16_t>{0}));
  answer(Outcome::timeout);
  ASSERT_EQ(log_.count(Kind::missed), 1U);
  ASSERT_EQ(port_.sent.size(), 3U);
  EXPECT_EQ(port_.sent[2].unit, 2) << "the next node goes on";
}

TEST_F(ModbusDriverTest, APauseAfterAWriteHoldsTheNextOperationBack) {
  ModbusProfile profile = relays();
  profile.pause_after_write = milliseconds(20);
  use(profile);
  ASSERT_EQ(driver_->preload(kOne, 3, kFour, now_), SendStatus::accepted);
  step();
  ASSERT_EQ(driver_->latch(3, now_), SendStatus::accepted);
  port_.answer(Outcome::ok);
  EXPECT_EQ(step(), now_ + milliseconds(20));
  EXPECT_FALSE(driver_->ready());
  EXPECT_EQ(driver_->ask(kOne, now_), SendStatus::busy);
  now_ += milliseconds(20);
  step();
  EXPECT_TRUE(driver_->ready());
  EXPECT_EQ(driver_->ask(kOne, now_), SendStatus::accepted);
}

TEST_F(ModbusDriverTest, WithoutBroadcastALatchGoesFromNodeToNode) {
  ModbusProfile profile = footlight_marker_profile();
  profile.has_broadcast = false;
  use(profile);
  ASSERT_EQ(driver_->latch(1, now_), SendStatus::accepted);
  answer(Outcome::ok);
  answer(Outcome::ok);
  ASSERT_EQ(port_.sent.size(), 2U);
  EXPECT_EQ(port_.sent[0].unit, 1);
  EXPECT_EQ(port_.sent[1].unit, 2);
  EXPECT_TRUE(driver_->ready());
  EXPECT_TRUE(log_.events.empty());
}

TEST_F(ModbusDriverTest, AStateIsWrittenByTheDevicesOwnNumbers) {
  ModbusProfile profile;
  profile.has_preload_sequence = false;
  profile.look_register = 8700;
  profile.looks_per_register = 1;
  profile.states = StateTable{6300,
                              11,
                              2,
                              0,
                              1,
                              6,
                              {{1, Effect::steady}, {2, Effect::blink}},
                              {{0, {0, 255, 0}}, {1, {255, 0, 0}}},
                              {{0, 255}, {2, 64}}};
  use(profile);
  EXPECT_EQ(driver_->capabilities().looks, 2);
  ASSERT_EQ(driver_->upload_look(2, {{250, 20, 0}, Effect::blink, 90}, now_), SendStatus::accepted);
  port_.taken = false;
  step();
  port_.taken = false;
  step();
  ASSERT_EQ(port_.sent.size(), 2U);
  EXPECT_EQ(port_.sent[0].first_register, 6311) << "effect and colour are neighbours";
  EXPECT_EQ(port_.sent[0].values, (std::vector<std::uint16_t>{2, 1}));
  EXPECT_EQ(port_.sent[1].first_register, 6317);
  EXPECT_EQ(port_.sent[1].values, (std::vector<std::uint16_t>{2}));
  ASSERT_TRUE(driver_->ready());
  ASSERT_EQ(driver_->upload_look(3, {}, now_), SendStatus::accepted);
  EXPECT_EQ(port_.sent.size(), 2U) << "the device has no third state";
}

TEST(ModbusPalette, TheNearestColourOfTheSameEffectIsTakenAndDarkStaysDark) {
  ModbusProfile profile;
  profile.palette = {{0, {{0, 0, 0}}}, {1, {{255, 0, 0}}}, {2, {{0, 0, 255}}}, {3, {{255, 0, 0}, Effect::blink}}};
  const auto value = [&](Look look) { return int{modbus::value_of(profile, 7, look)}; };
  EXPECT_EQ(value({{200, 40, 0}}), 1);
  EXPECT_EQ(value({{20, 40, 200}}), 2);
  EXPECT_EQ(value({{200, 40, 0}, Effect::blink}), 3);
  EXPECT_EQ(value({{20, 40, 200}, Effect::blink}), 3) << "who blinks has to move: the effect tells more";
  EXPECT_EQ(value({{10, 0, 0}}), 1) << "lit, though nearer to dark";
  EXPECT_EQ(value({{255, 0, 0}, Effect::steady, 0}), 0);
  EXPECT_EQ(int{modbus::value_of(profile, kDark, {{0, 0, 0}, Effect::steady, 0})}, 0);
}

TEST_F(ModbusDriverTest, ThirtyTwoLooksAt115200BdTakeTheirArithmetic) {
  // 43 + 8 characters of 11 bits, two silences of 1.75 ms, 5 ms turnaround.
  const Duration characters = Duration(51 * 11 * 1'000'000'000LL / 115'200);
  EXPECT_NEAR(static_cast<double>(driver_->preload_time(32).count()),
              static_cast<double>((characters + milliseconds(8) + microseconds(500)).count()), 10);
}

}  // namespace
}  // namespace footlight::drivers
