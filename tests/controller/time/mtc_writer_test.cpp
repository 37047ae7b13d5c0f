// SPDX-License-Identifier: Apache-2.0
#include "controller/time/mtc_writer.hpp"

#include <gtest/gtest.h>

#include "controller/time/mtc.hpp"

namespace footlight::controller {
namespace {

/// A writer whose messages a decoder hears in the moment in which they are due.
struct Wire {
  explicit Wire(FrameRate rate) : writer(rate) {}
  void run(const RunningTime& time, Instant from, double time_s) {
    const Instant end = from + seconds(time_s);
    for (Instant now = from; now < end; now = std::min(end, std::max(now + Duration(1), writer.next_event(time)))) {
      for (auto message = writer.take(time, now); !message.empty(); message = writer.take(time, now)) {
        ++(message.size() == 2 ? quarters : fulls);
        if (const auto fix = decoder.take(message, now)) fixes.push_back(*fix);
        if (message.size() == 10) fixes.pop_back();
      }
      if (writer.next_event(time) == kNever) return;
    }
  }
  MtcWriter writer;
  MtcDecoder decoder;
  std::vector<TimeFix> fixes;
  int quarters = 0;
  int fulls = 0;
};

TEST(MtcWriter, WhatItSaysIsWhereTheTimeIs) {
  for (const FrameRate rate : {FrameRate::fps24, FrameRate::fps25, FrameRate::fps2997_drop, FrameRate::fps30}) {
    for (const double speed : {1.0, 0.8, 1.3}) {
      Wire wire(rate);
      const RunningTime time{true, instant_at(7), seconds(3599.5), speed};
      wire.run(time, instant_at(7), 70 / speed);
      const double expected = 70 * 4 / to_seconds(frame_time(rate));
      EXPECT_NEAR(wire.quarters, expected, 10);
      EXPECT_EQ(wire.fulls, 1);
      EXPECT_NEAR(static_cast<double>(wire.fixes.size()), expected / 8, 2);
      for (const TimeFix& fix : wire.fixes) {
        ASSERT_NEAR(to_seconds(fix.position), to_seconds(time.position_at(fix.at)), 1e-6) << to_text(rate);
      }
    }
  }
}

TEST(MtcWriter, WhereItStandsItSaysSoOnceAndAJumpIsAPlace) {
  Wire wire(FrameRate::fps25);
  const RunningTime stands{false, instant_at(0), seconds(60), 0};
  wire.run(stands, instant_at(1), 5);
  EXPECT_EQ(wire.fulls, 1);
  EXPECT_EQ(wire.quarters, 0);
  EXPECT_EQ(wire.decoder.last(), (Timecode{0, 1, 0, 0, FrameRate::fps25}));
  wire.run({true, instant_at(10), seconds(60), 1}, instant_at(10), 1);
  EXPECT_EQ(wire.fulls, 2);
  wire.run({true, instant_at(11), seconds(200), 1}, instant_at(11), 1);
  EXPECT_EQ(wire.fulls, 3);
  EXPECT_NEAR(to_seconds(wire.fixes.back().position), 201, 0.1);
  wire.run({false, instant_at(12), seconds(201), 0}, instant_at(12), 1);
  EXPECT_EQ(wire.fulls, 4);
}

TEST(MtcWriter, ATimeThatIsLedALittleBackAndForthLosesNoPiece) {
  Wire wire(FrameRate::fps25);
  RunningTime time{true, instant_at(0), seconds(60), 1};
  for (int i = 0; i < 500; ++i) {
    const Instant now = instant_at(0) + i * milliseconds(20);
    time = {true, now, time.position_at(now) + milliseconds(i % 2 == 0 ? 3 : -3), 1};
    wire.run(time, now, 0.02);
  }
  EXPECT_EQ(wire.fulls, 1);
  EXPECT_NEAR(static_cast<double>(wire.fixes.size()), 125, 2);
}

TEST(MtcWriter, BeforeMidnightItIsTheDayBefore) {
  Wire wire(FrameRate::fps25);
  wire.run({true, instant_at(0), seconds(-2), 1}, instant_at(0), 1);
  EXPECT_EQ(wire.decoder.last()->hours, 23);
  EXPECT_EQ(wire.decoder.last()->seconds, 58);
}

}  // namespace
}  // namespace footlight::controller
