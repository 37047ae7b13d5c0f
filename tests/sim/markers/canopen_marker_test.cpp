// SPDX-License-Identifier: Apache-2.0
#include "sim/markers/canopen_marker.hpp"

#include <initializer_list>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "can_frame.hpp"

namespace footlight::sim {
namespace {

using drivers::CanFrame;
using Reaction = CanopenMarker::Reaction;

/// Node 5 with ten channels, switched on.
struct CanopenMarkerTest : ::testing::Test {
  CanopenMarkerTest() {
    model.power_on(kStart);
    marker.power_on();
  }
  Reaction hear(int id, std::initializer_list<int> bytes) { return marker.receive(frame(id, bytes), now); }
  void start() { hear(0x000, {0x01, 0}); }
  Instant now = kStart;
  NodeModel model{10, true};
  CanopenMarker marker{5, model};
};

TEST_F(CanopenMarkerTest, BeforeNmtStartItTakesNeitherPdosNorSync) {
  EXPECT_EQ(marker.heartbeat(), frame(0x705, {127}));
  hear(0x205, {1, 2, 3, 4, 5, 6, 7, 8});
  EXPECT_EQ(hear(0x080, {1}), Reaction::none);
  EXPECT_EQ(model.shown(0), 255);
  start();
  EXPECT_EQ(marker.heartbeat(), frame(0x705, {5}));
  EXPECT_EQ(hear(0x080, {1}), Reaction::status);
  EXPECT_EQ(model.shown(0), 255) << "the RPDO came too early";
}

TEST_F(CanopenMarkerTest, ASyncTakesWhateverIsPendingAndIsAnswered) {
  start();
  hear(0x205, {1, 2, 3, 4, 5, 6, 7, 8});
  hear(0x305, {9, 10});
  EXPECT_EQ(hear(0x080, {200}), Reaction::status);
  EXPECT_EQ(model.shown(0), 1);
  EXPECT_EQ(model.shown(7), 8);
  EXPECT_EQ(model.shown(9), 10);
  const CanFrame status = marker.status();
  EXPECT_EQ(status, frame(0x185, {200, 1, 0x72, 0x2C, 1, 0, 0, 0})) << "the CRC of 01 .. 0A is 0x2C72";
}

TEST_F(CanopenMarkerTest, ASyncWithNothingPendingIsAnsweredAndChangesNoLook) {
  start();
  hear(0x205, {1, 2, 3, 4, 5, 6, 7, 8});
  hear(0x080, {10});
  EXPECT_EQ(hear(0x080, {11}), Reaction::status);
  EXPECT_EQ(marker.status().data[0], 11);
  EXPECT_EQ(model.shown(0), 1);
}

TEST_F(CanopenMarkerTest, ACounterThatIsNoSequenceIsNotTaken) {
  start();
  hear(0x205, {1, 2, 3, 4, 5, 6, 7, 8});
  EXPECT_EQ(hear(0x080, {0}), Reaction::none);
  EXPECT_EQ(hear(0x080, {241}), Reaction::none);
  EXPECT_EQ(hear(0x080, {}), Reaction::none);
  EXPECT_EQ(hear(0x080, {1, 2}), Reaction::none);
  EXPECT_EQ(model.shown(0), 255);
}

TEST_F(CanopenMarkerTest, PdosOfOthersAndBeyondItsChannelsAreNotItsOwn) {
  start();
  hear(0x206, {1, 2, 3, 4, 5, 6, 7, 8});
  EXPECT_EQ(hear(0x405, {1, 2, 3, 4, 5, 6, 7, 8}), Reaction::none);
  hear(0x080, {1});
  EXPECT_EQ(model.shown(0), 255);
  EXPECT_EQ(model.state(), NodeState::boot);
}

TEST_F(CanopenMarkerTest, AShortPdoIsAnEmergencyAndALongOneCountsFromTheFront) {
  start();
  EXPECT_EQ(hear(0x205, {1, 2, 3, 4, 5, 6, 7}), Reaction::emergency);
  EXPECT_EQ(marker.emergency(), frame(0x085, {0x10, 0x82, 0x11, 0, 0, 0, 0, 0}));
  EXPECT_EQ(hear(0x605, {0x40, 0x01, 0x10, 0, 0, 0, 0, 0}), Reaction::sdo);
  EXPECT_EQ(marker.sdo_answer().data[4], 0x11) << "the error register";
  EXPECT_EQ(hear(0x305, {9, 10, 11}), Reaction::emergency);
  EXPECT_EQ(marker.emergency(), frame(0x085, {0, 0, 0, 0, 0, 0, 0, 0})) << "the error is over";
  EXPECT_EQ(hear(0x305, {9, 10, 11}), Reaction::none);
  hear(0x080, {1});
  EXPECT_EQ(model.shown(0), 255);
  EXPECT_EQ(model.shown(8), 9);
  EXPECT_EQ(model.shown(9), 10);
}

TEST_F(CanopenMarkerTest, NmtStopsAndResets) {
  start();
  hear(0x000, {0x02, 5});
  EXPECT_EQ(marker.heartbeat(), frame(0x705, {4}));
  EXPECT_EQ(hear(0x080, {1}), Reaction::none);
  hear(0x1FF, {0x80, 0x00, 0x21, 7, 1, 2, 3, 0});
  EXPECT_EQ(model.look(7).colour, (Colour{255, 255, 255})) << "stopped nodes take no MPDO";
  hear(0x000, {0x80, 6});
  EXPECT_EQ(marker.heartbeat(), frame(0x705, {4})) << "meant for another";
  hear(0x000, {0x80, 0});
  EXPECT_EQ(marker.heartbeat(), frame(0x705, {127}));
  EXPECT_EQ(hear(0x000, {0x82, 5}), Reaction::boot_up);
  EXPECT_EQ(model.boots(), 1);
  EXPECT_EQ(hear(0x000, {0x81, 5}), Reaction::boot_up);
  EXPECT_EQ(model.boots(), 2);
  EXPECT_EQ(marker.boot_up(), frame(0x705, {0}));
}

TEST_F(CanopenMarkerTest, MpdosFillTheLookTable) {
  hear(0x1FF, {0x80, 0x00, 0x21, 7, 0x03, 0x02, 0x01, 0});
  hear(0x1FF, {0x80, 0x01, 0x21, 7, 3, 90, 0, 0});
  EXPECT_EQ(model.look(7), (Look{{1, 2, 3}, Effect::double_blink, 90}));
  hear(0x1FF, {0x86, 0x00, 0x21, 8, 3, 2, 1, 0});
  EXPECT_EQ(model.look(8).colour, (Colour{255, 255, 255})) << "addressed to node 6";
  hear(0x1FF, {0x80, 0x00, 0x21, 255, 3, 2, 1, 0});
  EXPECT_EQ(model.look(255), no_guidance_look());
}

TEST_F(CanopenMarkerTest, TheHeartbeatOfTheControllerRenewsTheLease) {
  start();
  hear(0x205, {1, 2, 3, 4, 5, 6, 7, 8});
  hear(0x080, {1});
  now += milliseconds(900);
  hear(0x77F, {5});
  now += milliseconds(900);
  hear(0x77F, {4});
  model.settle(now);
  EXPECT_EQ(model.state(), NodeState::showing);
  now += milliseconds(100);
  model.settle(now);
  EXPECT_EQ(model.state(), NodeState::hold) << "a controller that is not operational renews nothing";
}

TEST_F(CanopenMarkerTest, ErrorFramesAreCountedInTheStatus) {
  marker.count_error();
  marker.count_error();
  EXPECT_EQ(marker.status().data[6], 2);
}

TEST(CanopenMarkerProperty, NoSequenceOfFramesBreaksIt) {
  EXPECT_TRUE(rc::check([] {
    NodeModel model(*rc::gen::inRange(1, 33), true);
    model.power_on(kStart);
    CanopenMarker marker(5, model);
    Instant now = kStart;
    const auto count = *rc::gen::inRange(0, 60);
    for (int i = 0; i < count; ++i) {
      CanFrame frame;
      frame.id = *rc::gen::oneOf(rc::gen::inRange<std::uint16_t>(0, 0x800),
                                 rc::gen::element<std::uint16_t>(0x000, 0x080, 0x1FF, 0x205, 0x305, 0x505, 0x77F));
      frame.length = *rc::gen::inRange<std::uint8_t>(0, 10);
      for (auto& byte : frame.data)
        byte = *rc::gen::oneOf(rc::gen::arbitrary<std::uint8_t>(), rc::gen::element<std::uint8_t>(0, 1, 5, 0x80, 0x81));
      now += milliseconds(*rc::gen::inRange(0, 700));
      marker.receive(frame, now);
      RC_ASSERT(model.shown_sequence() <= kHighestSequence);
      if (model.state() == NodeState::no_guidance) RC_ASSERT(model.shown(0) == kNoGuidance);
    }
  }));
}

}  // namespace
}  // namespace footlight::sim
