// SPDX-License-Identifier: Apache-2.0
#include "sim/markers/serial_marker.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "serial_frame.hpp"

namespace footlight::sim {
namespace {

/// Node 7 with three channels, switched on. The frames in hexadecimal were made by another program from the document.
struct SerialMarkerTest : ::testing::Test {
  SerialMarkerTest() {
    model.power_on(kStart);
    marker.power_on();
  }
  Octets hear(const Octets& bytes) { return marker.receive(bytes, now); }
  Octets ask(Octets payload) { return hear(serial_frame(std::move(payload))); }
  Instant now = kStart;
  NodeModel model{3, true};
  SerialMarker marker{7, model};

  const Octets preload{0x00, 0x06, 0x01, 0x01, 0x07, 0xAB, 0x05, 0x02, 0x01, 0x06, 0x03, 0x2D, 0x6B, 0x8F, 0xDB, 0x00};
  const Octets receipt{0x00, 0x0C, 0x81, 0x01, 0x07, 0xAB, 0x05, 0xCF, 0xCB, 0xDB, 0xBD, 0x04, 0x16, 0x00};
  const Octets latch{0x00, 0x03, 0x01, 0x02, 0x0B, 0xAB, 0x05, 0x5F, 0x5F, 0x5F, 0x5F, 0x4A, 0x12, 0x15, 0x3A, 0x00};
  const Octets ask_status{0x00, 0x05, 0x01, 0x04, 0x07, 0xAB, 0x05, 0x5D, 0x3A, 0x9C, 0x3C, 0x00};
  const Octets status{0x00, 0x06, 0x81, 0x04, 0x07, 0xAB, 0x05, 0x05, 0xCF, 0xCB,
                      0x01, 0x01, 0x01, 0x01, 0x05, 0x45, 0x6F, 0x3C, 0x87, 0x00};
};

TEST_F(SerialMarkerTest, PreloadLatchAndStatusAreTheBytesOfTheDocument) {
  EXPECT_EQ(hear(preload), receipt);
  EXPECT_EQ(model.shown(0), 255);
  EXPECT_TRUE(hear(latch).empty()) << "nobody answers a latch";
  EXPECT_EQ(model.shown(0), 1);
  EXPECT_EQ(model.shown(1), 0);
  EXPECT_EQ(model.shown(2), 3);
  EXPECT_EQ(hear(ask_status), status);
}

TEST_F(SerialMarkerTest, ALatchNeedsItsGuardItsPlanAndItsSequence) {
  hear(preload);
  ask({1, 2, 0, 0xAB, 5, 0x5F, 0x5F, 0x5F, 0x5E});
  ask({1, 2, 0, 0xAC, 5, 0x5F, 0x5F, 0x5F, 0x5F});
  ask({1, 2, 0, 0xAB, 4, 0x5E, 0x5E, 0x5E, 0x5E});
  EXPECT_EQ(model.shown(0), 255);
  hear(latch);
  EXPECT_EQ(model.shown(0), 1);
}

TEST_F(SerialMarkerTest, ItIsInStepAgainAfterTheNextZero) {
  Octets noise{0x12, 0x34, 0x00, 0x05, 0xFF};
  noise.insert(noise.end(), preload.begin(), preload.end());
  EXPECT_EQ(hear(noise), receipt);
  EXPECT_EQ(marker.dropped(), 2);
}

TEST_F(SerialMarkerTest, FramesMayComeInPiecesAndShareADelimiter) {
  Octets both(preload.begin(), preload.end() - 1);
  both.insert(both.end(), latch.begin(), latch.end());
  for (const std::uint8_t byte : both) hear({byte});
  EXPECT_EQ(model.shown(0), 1);
  EXPECT_EQ(marker.dropped(), 0);
}

TEST_F(SerialMarkerTest, AnyFlippedBitIsNoticed) {
  for (std::size_t bit = 8; bit < 8 * (preload.size() - 1); ++bit) {
    Octets broken = preload;
    broken[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
    EXPECT_TRUE(hear(broken).empty()) << "bit " << bit;
    EXPECT_EQ(model.pending_sequence(), 0) << "bit " << bit;
  }
}

TEST_F(SerialMarkerTest, WhatIsWrongIsDroppedAndCounted) {
  ask({1, 4, 7, 0xAB, 0, 99});       // a status request has no body
  ask({2, 4, 7, 0xAB, 0});           // version
  ask({1, 3, 0, 0xAB, 0, 1, 2, 3});  // heartbeat of three bytes
  ask({1, 1, 7, 0xAB, 1, 0});        // a preload without looks
  hear(Octets(70, 0x11));            // longer than any frame
  hear({0x00});
  EXPECT_EQ(marker.dropped(), 5);
  EXPECT_TRUE(ask({1, 1, 7, 0xAB, 1, 1, 9, 9, 9}).empty()) << "channels 1 to 3 of 0 to 2";
  EXPECT_TRUE(ask({1, 1, 7, 0xAB, 0, 0, 9}).empty()) << "sequence 0";
  EXPECT_TRUE(ask({1, 1, 7, 0xAB, 241, 0, 9}).empty()) << "sequence 241";
  EXPECT_EQ(model.pending_sequence(), 0);
  const auto answer = serial_payload(ask({1, 4, 7, 0xAB, 0}));
  ASSERT_TRUE(answer.has_value());
  EXPECT_EQ((*answer)[11], 5) << "dropped frames in the status";
}

TEST_F(SerialMarkerTest, WhatOthersAskAndAnswerIsLeftAlone) {
  EXPECT_TRUE(ask({1, 4, 8, 0xAB, 0}).empty());
  EXPECT_TRUE(ask({0x81, 4, 7, 0xAB, 5, 0, 0, 0, 1, 1, 0, 0, 0}).empty());
  EXPECT_EQ(marker.dropped(), 0);
}

TEST_F(SerialMarkerTest, NobodyAnswersAFrameToAll) {
  EXPECT_TRUE(ask({1, 4, 0, 0xAB, 0}).empty());
  EXPECT_TRUE(ask({1, 1, 0, 0xAB, 9, 0, 4}).empty());
  EXPECT_EQ(model.pending_sequence(), 9) << "but it is obeyed";
}

TEST_F(SerialMarkerTest, AnswersRepeatThePlanByteOfTheirRequest) {
  EXPECT_EQ(serial_payload(ask({1, 4, 7, 0x3C, 0}))->at(3), 0x3C);
}

TEST_F(SerialMarkerTest, LooksAndIdentifyAreObeyed) {
  ask({1, 5, 0, 0xAB, 0, 9, 10, 20, 30, 40, 2});
  EXPECT_EQ(model.look(9), (Look{{10, 20, 30}, Effect::pulse, 40}));
  ask({1, 5, 0, 0xAB, 0, 9, 11, 20, 30, 40, 5});
  EXPECT_EQ(model.look(9).colour.red, 10) << "there is no effect 5";
  const auto answer = serial_payload(ask({1, 6, 7, 0xAB, 0, 1}));
  ASSERT_TRUE(answer.has_value());
  EXPECT_EQ((*answer)[1], 0x04) << "answered as a status";
  EXPECT_TRUE(model.identifying(now));
  ask({1, 6, 7, 0xAB, 0, 0});
  EXPECT_FALSE(model.identifying(now));
}

TEST_F(SerialMarkerTest, AHeartbeatToAllRenewsTheLease) {
  hear(preload);
  hear(latch);
  now += milliseconds(1200);
  hear({0x00, 0x03, 0x01, 0x03, 0x02, 0xAB, 0x03, 0x10, 0x27, 0x01, 0x05, 0xD9, 0xE1, 0x3D, 0x61, 0x00});
  EXPECT_EQ(model.state(), NodeState::showing);
}

TEST(SerialMarkerProperty, NoBytesBreakItAndOnlyWholeFramesAreAnswered) {
  EXPECT_TRUE(rc::check([] {
    NodeModel model(*rc::gen::inRange(1, 33), true);
    model.power_on(kStart);
    SerialMarker marker(7, model);
    const auto pieces = *rc::gen::inRange(0, 20);
    for (int i = 0; i < pieces; ++i) {
      Octets bytes = *rc::gen::arbitrary<Octets>();
      if (*rc::gen::arbitrary<bool>()) {  // a sound frame around anything
        Octets payload{1, *rc::gen::inRange<std::uint8_t>(0, 9), *rc::gen::element<std::uint8_t>(0, 7, 8)};
        payload.insert(payload.end(), bytes.begin(), bytes.begin() + std::min<std::ptrdiff_t>(45, std::ssize(bytes)));
        bytes = serial_frame(payload);
      }
      const Octets answer = marker.receive(bytes, kStart + milliseconds(i * 300));
      if (!answer.empty()) RC_ASSERT(serial_payload(answer).has_value());
      RC_ASSERT(model.pending_sequence() <= kHighestSequence);
    }
  }));
}

TEST_F(SerialMarkerTest, ContentWaitsForItsLatch) {
  const Octets walk{0x01, 9, 7, 0xA3, 17, 3, 1, 64, 250, 0, 0x70, 0xE0, 0x37, 0, 0xF4, 0x01};
  NodeModel wide(4, true);
  SerialMarker wearable(7, wide);
  wide.power_on(kStart);
  const auto hear = [&](const Octets& payload) { return wearable.receive(serial_frame(payload), kStart); };
  ASSERT_FALSE(hear(walk).empty());
  EXPECT_FALSE(wide.content(3).walks);
  hear({0x01, 1, 7, 0xA3, 17, 0, 5});
  hear({0x01, 2, 0, 0xA3, 17, 0x4B, 0x4B, 0x4B, 0x4B});
  EXPECT_EQ(wide.content(3), (NodeContent{true, 64, 250, 3'661'936, 500}));
  EXPECT_TRUE(hear({0x01, 9, 7, 0xA3, 17, 4, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0}).empty()) << "it has no channel 4";
  Octets nothing = walk;
  nothing[6] = 0;
  ASSERT_FALSE(hear(nothing).empty());
  EXPECT_FALSE(wide.content(3).walks) << "at once: latch 17 is shown";
}

TEST_F(SerialMarkerTest, AWearableCountsDownByTheShowsTime) {
  NodeModel wide(1, true);
  SerialMarker wearable(7, wide);
  wide.power_on(kStart);
  wide.set_content(0, 0, {true, 0, 100, 10'000, 500});
  EXPECT_EQ(wide.counts_left(0, kStart), std::nullopt) << "it has no time yet";
  // 8,500 ms of show time, at full rate.
  wearable.receive(serial_frame({0x01, 7, 0, 0xA3, 0, 0x20, 0xB3, 0x81, 0, 0, 0x00, 0x80}), kStart);
  EXPECT_EQ(wide.show_time(kStart), milliseconds(8500));
  EXPECT_EQ(wide.counts_left(0, kStart), 3);
  EXPECT_EQ(wide.counts_left(0, kStart + milliseconds(499)), 3);
  EXPECT_EQ(wide.counts_left(0, kStart + milliseconds(500)), 2);
  EXPECT_EQ(wide.counts_left(0, kStart + milliseconds(1499)), 1);
  EXPECT_EQ(wide.counts_left(0, kStart + milliseconds(1500)), 0);
  EXPECT_EQ(wide.counts_left(0, kStart + milliseconds(5000)), 0);
  wearable.receive(serial_frame({0x01, 7, 0, 0xA3, 0, 0x20, 0xB3, 0x81, 0, 0, 0x00, 0x00}), kStart);
  EXPECT_EQ(wide.counts_left(0, kStart + milliseconds(5000)), 3) << "time stands";
  const auto clock = serial_payload(wearable.receive(serial_frame({0x01, 8, 7, 0, 0}), kStart));
  ASSERT_TRUE(clock);
  EXPECT_EQ(*clock, (Octets{0x81, 8, 7, 0, 0, 0x20, 0xB3, 0x81, 0, 0, 1, 2}));
}

TEST_F(SerialMarkerTest, AnswersWhoInASlotOfItsOwn) {
  SerialMarker one(7, model, 0x12345678);
  SerialMarker other(7, model, 0x12345679);
  int apart = 0;
  for (std::uint8_t round = 1; round <= 16; ++round) {
    const auto answer = serial_payload(one.receive(serial_frame({0x01, 10, 7, 0xA3, 0, round}), now));
    ASSERT_TRUE(answer);
    EXPECT_EQ(*answer,
              (Octets{0x81, 10, 7, 0xA3, 0, 0x78, 0x56, 0x34, 0x12, 1, static_cast<std::uint8_t>(model.channels())}));
    other.receive(serial_frame({0x01, 10, 7, 0xA3, 0, round}), now);
    ASSERT_LT(one.answer_slot(), SerialMarker::kSlots);
    apart += one.answer_slot() != other.answer_slot() ? 1 : 0;
  }
  EXPECT_GE(apart, 10);
  one.receive(serial_frame({0x01, 4, 7, 0xA3, 0}), now);
  EXPECT_EQ(one.answer_slot(), 0) << "other answers come at once";
}

TEST_F(SerialMarkerTest, TakesAnAddressOnlyUnderItsOwnIdAndWithItsGuard) {
  SerialMarker one(7, model, 0x12345678);
  const auto move = [&](int id, int to, int guard) {
    return one.receive(serial_frame({0x01, 11, 7, 0xA3, 0, static_cast<std::uint8_t>(id), 0x56, 0x34, 0x12,
                                     static_cast<std::uint8_t>(to), static_cast<std::uint8_t>(guard)}),
                       now);
  };
  EXPECT_TRUE(move(0x79, 9, 9 ^ 0x5A).empty());
  EXPECT_TRUE(move(0x78, 9, 9).empty());
  EXPECT_TRUE(move(0x78, 0, 0x5A).empty());
  EXPECT_TRUE(move(0x78, 255, 255 ^ 0x5A).empty());
  EXPECT_EQ(one.address(), 7);
  const auto answer = serial_payload(move(0x78, 9, 9 ^ 0x5A));
  ASSERT_TRUE(answer);
  EXPECT_EQ((*answer)[2], 7) << "from the old address";
  EXPECT_EQ(one.address(), 9);
}

TEST_F(SerialMarkerTest, TellsItsHealth) {
  model.health = {87, 23'456, -4};
  const auto health = serial_payload(marker.receive(serial_frame({0x01, 12, 7, 0xA3, 0}), now + seconds(100)));
  ASSERT_TRUE(health);
  EXPECT_EQ((Octets{health->begin() + 5, health->begin() + 9}), (Octets{87, 0xA0, 0x5B, 96}));
  EXPECT_EQ((*health)[9], 100);
}

TEST_F(SerialMarkerTest, AFencedControllerIsToldAndNothingElseHappens) {
  ask({1, 13, 0, 0x11, 0, 9, 0, 0, 0});  // LEAD, epoch 9
  const Octets fenced = serial_frame({0x81, 13, 7, 0xAB, 0, 9, 0, 0, 0});
  EXPECT_EQ(hear(preload), fenced);
  EXPECT_EQ(hear(ask_status), fenced);
  EXPECT_EQ(model.pending_sequence(), 0);
  ask({1, 13, 0, 0xAB, 0, 8, 0, 0, 0});  // an older epoch
  EXPECT_EQ(hear(preload), fenced);
  ask({1, 5, 0, 0xAB, 0, 3, 1, 2, 3, 4, 0});
  EXPECT_EQ(model.look(3).colour, (Colour{255, 255, 255})) << "nor does it change a look";
  EXPECT_FALSE(ask({1, 4, 7, 0, 0}).empty());
  EXPECT_NE(ask({1, 4, 7, 0, 0}), serial_frame({0x81, 13, 7, 0, 0, 9, 0, 0, 0})) << "a technician may ask";
  ask({1, 13, 0, 0xAB, 0, 10, 0, 0, 0});
  EXPECT_EQ(hear(preload), receipt);
  hear(latch);
  EXPECT_EQ(model.shown(0), 1);
}

}  // namespace
}  // namespace footlight::sim
