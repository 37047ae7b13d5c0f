// SPDX-License-Identifier: Apache-2.0
#include "app/remote/interlocks.hpp"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace footlight::app {
namespace {

using controller::kEmergencyHold;
using controller::kHoldPressed;
using Does = config::RemoteButton::Does;
using State = GateView::State;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Gate 0 is wired, gate 1 comes by OSC, gate 2 has no input; a wired hold, one by OSC, an emergency hold, a GO.
class InterlocksTest : public ::testing::Test {
 protected:
  static config::Remote remote() {
    config::Remote out;
    const config::RemoteInput wired{config::GpioPlace{"c", 1, false, {}}, {}};
    out.gates = {{1, {std::nullopt, milliseconds(2500)}}, {0, wired}};
    out.buttons = {{"left", Does::hold, "", "", wired},
                   {"right", Does::hold, "", "", {std::nullopt, milliseconds(1000)}},
                   {"red", Does::emergency_hold, "", "", wired},
                   {"GO", Does::go, "", "", wired}};
    return out;
  }
  std::vector<std::string> news() {
    std::vector<std::string> texts;
    for (const Interlocks::News& one : locks_.news()) texts.push_back((one.alarm ? "ALARM " : "") + one.text);
    return texts;
  }

  Interlocks locks_{{"trap", "lift", "door"}, remote(), instant_at(0)};
};

constexpr std::size_t kLift = 0;  // of remote.gates
constexpr std::size_t kTrap = 1;

TEST_F(InterlocksTest, NobodyKnowsHowAGateIsUntilItsInputSaysSo) {
  EXPECT_EQ(locks_.bars(), 7U);
  EXPECT_THAT(locks_.text_of(7),
              ElementsAre("trap: lost, nobody knows", "lift: lost, nobody knows", "door: lost, nobody knows"));
  locks_.tell_gate(kTrap, true, instant_at(1));
  EXPECT_EQ(locks_.bars(), 6U);
  EXPECT_TRUE(locks_.tell_gate("lift", true, instant_at(1)));
  EXPECT_EQ(locks_.bars(), 4U);
  EXPECT_THAT(news(), ElementsAre("trap: closed", "lift: closed"));
}

TEST_F(InterlocksTest, AnEmergencyHoldFromBeforeStaysUntilItIsAcknowledgedWithEveryButtonOut) {
  EXPECT_FALSE(locks_.emergency_hold());
  locks_.take_up_emergency_hold();
  EXPECT_TRUE(locks_.emergency_hold());
  EXPECT_EQ(locks_.bars(), 7U | kEmergencyHold);
  EXPECT_THAT(locks_.text_of(kEmergencyHold), ElementsAre("emergency hold from before this program was begun again"));
  EXPECT_THAT(news(),
              ElementsAre("ALARM EMERGENCY HOLD from before this program was begun again. HOLD changes lamps and "
                          "stops no machine"));
  locks_.tell_button(2, true, instant_at(1));  // it is still in
  locks_.acknowledge();
  EXPECT_THAT(locks_.text_of(kEmergencyHold), ElementsAre("emergency hold by button red, which is still in"));
  locks_.tell_button(2, false, instant_at(2));
  EXPECT_TRUE(locks_.emergency_hold());
  locks_.acknowledge();
  EXPECT_FALSE(locks_.emergency_hold());
}

TEST_F(InterlocksTest, OnlyWhatIsToldByOscCanBeToldByOsc) {
  EXPECT_FALSE(locks_.tell_gate("trap", true, instant_at(1)));
  EXPECT_FALSE(locks_.tell_gate("door", true, instant_at(1)));
  EXPECT_FALSE(locks_.tell_gate("window", true, instant_at(1)));
  EXPECT_EQ(locks_.bars(), 7U);
}

TEST_F(InterlocksTest, AGateThatOpensIsAnAlarmOnce) {
  locks_.tell_gate(kTrap, true, instant_at(1));
  (void)news();
  locks_.tell_gate(kTrap, false, instant_at(2));
  locks_.tell_gate(kTrap, false, instant_at(3));
  EXPECT_THAT(news(), ElementsAre("ALARM trap: open"));
  EXPECT_THAT(locks_.text_of(1), ElementsAre("trap: open"));
}

TEST_F(InterlocksTest, WhatIsSilentForTooLongIsLost) {
  locks_.tell_gate("lift", true, instant_at(1));
  locks_.tell_gate(kTrap, true, instant_at(1));
  locks_.tell_button(1, false, instant_at(1));
  (void)news();
  locks_.step(instant_at(2));
  EXPECT_THAT(news(), IsEmpty());
  locks_.step(instant_at(3.4));
  EXPECT_THAT(news(), ElementsAre("ALARM button right: lost: nothing is heard of it. It holds nothing any more"));
  locks_.step(instant_at(3.6));
  locks_.step(instant_at(60));
  EXPECT_THAT(news(), ElementsAre("ALARM lift: lost: nothing is heard of it")) << "a wire does not fall silent";
  EXPECT_EQ(locks_.bars(), 4U | 2U);
  EXPECT_EQ(locks_.gates()[1].state, State::lost);
  locks_.tell_gate("lift", true, instant_at(61));
  locks_.tell_button(1, false, instant_at(61));
  EXPECT_THAT(news(), ElementsAre("lift: closed", "button right: heard again"));
}

TEST_F(InterlocksTest, ALineThatIsGoneIsAsGoodAsOpen) {
  locks_.tell_gate(kTrap, true, instant_at(1));
  (void)news();
  locks_.lose_gate(kTrap, "No such device");
  locks_.lose_gate(kTrap, "No such device");
  EXPECT_THAT(news(), ElementsAre("ALARM trap: lost: No such device"));
  EXPECT_NE(locks_.bars() & 1U, 0U);
}

TEST_F(InterlocksTest, TheOperatorCanAnswerForAGateAndTakeThatBack) {
  EXPECT_EQ(locks_.by_word("door", true).value(), "door: closed by the operator's word");
  EXPECT_EQ(locks_.bars(), 3U);
  EXPECT_EQ(locks_.gates()[2].state, State::by_word);
  EXPECT_EQ(locks_.by_word("door", false).value(), "door: lost, nobody knows");
  EXPECT_EQ(locks_.bars(), 7U);
  EXPECT_EQ(locks_.by_word("dor", true).error().message, "gate: no gate \"dor\" (there are trap, lift, door)");
}

TEST_F(InterlocksTest, AnyNumberOfHoldButtonsRefusesGoWhileOneIsPressed) {
  const auto holds = [&] { return locks_.bars() & controller::kHolding & ~controller::kGates; };
  locks_.tell_button(0, true, instant_at(1));
  locks_.tell_button(1, true, instant_at(1));
  locks_.tell_button(0, false, instant_at(2));
  EXPECT_EQ(holds(), kHoldPressed);
  EXPECT_THAT(locks_.text_of(kHoldPressed), ElementsAre("button right is pressed"));
  locks_.tell_button(1, false, instant_at(3));
  EXPECT_EQ(holds(), 0U);
  EXPECT_THAT(news(), ElementsAre("ALARM HOLD by button left. HOLD changes lamps and stops no machine",
                                  "ALARM HOLD by button right. HOLD changes lamps and stops no machine",
                                  "button left: out", "button right: out"));
}

TEST_F(InterlocksTest, AnEmergencyHoldStaysUntilItIsAcknowledgedWithItsButtonOut) {
  locks_.tell_button(2, true, instant_at(1));
  EXPECT_NE(locks_.bars() & kEmergencyHold, 0U);
  locks_.acknowledge();
  EXPECT_NE(locks_.bars() & kEmergencyHold, 0U) << "it is still in";
  EXPECT_THAT(locks_.text_of(locks_.bars() & kEmergencyHold),
              ElementsAre("emergency hold by button red, which is still in"));
  locks_.tell_button(2, false, instant_at(2));
  EXPECT_EQ(locks_.bars() & (kEmergencyHold | kHoldPressed), kEmergencyHold);
  locks_.acknowledge();
  EXPECT_EQ(locks_.bars() & (kEmergencyHold | kHoldPressed), 0U);
}

TEST_F(InterlocksTest, AGoButtonHoldsNothing) {
  locks_.tell_button(3, true, instant_at(1));
  EXPECT_EQ(locks_.bars(), 7U);
}

}  // namespace
}  // namespace footlight::app
