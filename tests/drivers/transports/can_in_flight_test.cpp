// SPDX-License-Identifier: Apache-2.0
#include "drivers/transports/can_in_flight.hpp"

#include <gtest/gtest.h>

namespace footlight::drivers {
namespace {

constexpr Duration kStall = milliseconds(70);

CanFrame frame(int id) { return {.id = static_cast<std::uint16_t>(id), .length = 1, .data = {7}}; }

TEST(CanInFlight, AFrameIsWaitingUntilItsEchoCame) {
  CanInFlight frames(kStall);
  frames.accepted(frame(1), instant_at(0));
  frames.accepted(frame(2), instant_at(0));
  frames.echoed(frame(1), instant_at(0.001));
  EXPECT_EQ(frames.size(), 1U);
  frames.echoed(frame(2), instant_at(0.002));
  EXPECT_EQ(frames.size(), 0U);
}

TEST(CanInFlight, EchoesInAnotherOrderConfirmTheirOwnFrames) {
  CanInFlight frames(kStall);
  for (const int id : {1, 2, 3}) frames.accepted(frame(id), instant_at(0));
  for (const int id : {3, 1, 2}) frames.echoed(frame(id), instant_at(0.001));
  EXPECT_EQ(frames.size(), 0U);
}

TEST(CanInFlight, AnEchoComingTwiceOrOfNothingConfirmsNothingElse) {
  CanInFlight frames(kStall);
  frames.accepted(frame(1), instant_at(0));
  frames.accepted(frame(2), instant_at(0));
  for (int i = 0; i < 3; ++i) frames.echoed(frame(1), instant_at(0.001));
  frames.echoed(frame(9), instant_at(0.001));
  EXPECT_EQ(frames.size(), 1U);
}

TEST(CanInFlight, EqualFramesAreConfirmedOneByOne) {
  CanInFlight frames(kStall);
  frames.accepted(frame(1), instant_at(0));
  frames.accepted(frame(1), instant_at(0));
  frames.echoed(frame(1), instant_at(0.001));
  EXPECT_EQ(frames.size(), 1U);
}

TEST(CanInFlight, AQueueThatDoesNotMoveIsStalled) {
  CanInFlight frames(kStall);
  EXPECT_FALSE(frames.stalled(instant_at(100))) << "nothing waits";
  frames.accepted(frame(1), instant_at(1));
  frames.accepted(frame(2), instant_at(1.06));
  EXPECT_FALSE(frames.stalled(instant_at(1.069)));
  EXPECT_TRUE(frames.stalled(instant_at(1.07))) << "what is added to a waiting queue is no progress";
  frames.echoed(frame(1), instant_at(1.08));
  EXPECT_FALSE(frames.stalled(instant_at(1.149)));
  EXPECT_TRUE(frames.stalled(instant_at(1.15)));
}

TEST(CanInFlight, AQueueThatStaysFullIsStalledThoughAllIsEchoed) {
  CanInFlight frames(kStall);
  frames.accepted(frame(1), instant_at(1));
  frames.echoed(frame(1), instant_at(1));
  frames.refused(instant_at(1));
  frames.refused(instant_at(1.05));
  EXPECT_FALSE(frames.stalled(instant_at(1.069)));
  EXPECT_TRUE(frames.stalled(instant_at(1.07)));
  frames.accepted(frame(2), instant_at(1.08));
  frames.echoed(frame(2), instant_at(1.08));
  EXPECT_FALSE(frames.stalled(instant_at(2)));
}

TEST(CanInFlight, WhatWaitedASecondAndWasOvertakenIsLost) {
  CanInFlight frames(kStall);
  frames.accepted(frame(1), instant_at(0));
  frames.accepted(frame(2), instant_at(0.5));
  frames.accepted(frame(3), instant_at(1.01));
  frames.echoed(frame(3), instant_at(1.02));
  EXPECT_EQ(frames.size(), 1U) << "the first is lost, the second may have waited in another buffer";
  EXPECT_FALSE(frames.stalled(instant_at(1.03)));
}

TEST(CanInFlight, TheStallTimeAllowsAllNodesToAnswerFirst) {
  EXPECT_EQ(can_stall_time(1'000'000), milliseconds(70));
  EXPECT_EQ(can_stall_time(500'000), milliseconds(70));
  EXPECT_EQ(can_stall_time(250'000), microseconds(102'600));
  EXPECT_EQ(can_stall_time(125'000), microseconds(205'200));
}

}  // namespace
}  // namespace footlight::drivers
