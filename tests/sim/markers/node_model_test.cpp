// SPDX-License-Identifier: Apache-2.0
#include "sim/markers/node_model.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace footlight::sim {
namespace {

constexpr std::uint8_t kPlan = 0xAB;

Instant at_ms(std::int64_t ms) { return kStart + milliseconds(ms); }

/// Three channels, switched on at 0.
struct NodeModelTest : ::testing::Test {
  NodeModelTest() { node.power_on(kStart); }
  void preload(std::uint8_t sequence, std::vector<LookIndex> looks, int first = 0) {
    node.preload(sequence, kPlan, first, looks);
  }
  [[nodiscard]] std::vector<int> shown() const { return {node.shown(0), node.shown(1), node.shown(2)}; }
  NodeModel node{3, true};
};

using Looks = std::vector<int>;

TEST_F(NodeModelTest, AtPowerOnItShowsNoGuidanceAndKnowsNothing) {
  EXPECT_EQ(shown(), (Looks{255, 255, 255}));
  EXPECT_EQ(node.shown_sequence(), 0);
  EXPECT_EQ(node.pending_sequence(), 0);
  EXPECT_EQ(node.state(), NodeState::boot);
  EXPECT_EQ(node.boots(), 1);
  EXPECT_EQ(node.lease_end(), kNever);
}

TEST_F(NodeModelTest, APreloadChangesNothingThatIsSeen) {
  preload(5, {1, 2, 3});
  EXPECT_EQ(shown(), (Looks{255, 255, 255}));
  EXPECT_EQ(node.pending_sequence(), 5);
}

TEST_F(NodeModelTest, ALatchTakesThePreloadOfItsOwnSequence) {
  preload(5, {1, 2, 3});
  EXPECT_FALSE(node.latch(4, kPlan, at_ms(1)));
  EXPECT_FALSE(node.latch(6, kPlan, at_ms(1)));
  EXPECT_EQ(shown(), (Looks{255, 255, 255}));
  EXPECT_EQ(node.pending_sequence(), 5) << "a wrong latch leaves the preload alone";
  EXPECT_TRUE(node.latch(5, kPlan, at_ms(1)));
  EXPECT_EQ(shown(), (Looks{1, 2, 3}));
  EXPECT_EQ(node.shown_sequence(), 5);
  EXPECT_EQ(node.pending_sequence(), 0);
  EXPECT_EQ(node.state(), NodeState::showing);
}

TEST_F(NodeModelTest, ARepeatedLatchIsHarmless) {
  preload(5, {1, 2, 3});
  node.latch(5, kPlan, at_ms(1));
  EXPECT_FALSE(node.latch(5, kPlan, at_ms(2)));
  EXPECT_EQ(shown(), (Looks{1, 2, 3}));
  EXPECT_EQ(node.latches(), 1U);
}

TEST_F(NodeModelTest, ALatchOfAnotherPlanIsIgnored) {
  preload(5, {1, 2, 3});
  EXPECT_FALSE(node.latch(5, std::uint8_t{kPlan + 1}, at_ms(1)));
  EXPECT_EQ(shown(), (Looks{255, 255, 255}));
}

TEST_F(NodeModelTest, SequenceZeroNeverLatches) {
  EXPECT_FALSE(node.latch(0, std::uint8_t{0}, at_ms(1)));
  EXPECT_EQ(node.state(), NodeState::boot);
}

TEST_F(NodeModelTest, ANewerPreloadTakesThePlaceOfAnOlderOne) {
  preload(5, {1, 2, 3});
  preload(6, {9}, 1);
  EXPECT_FALSE(node.latch(5, kPlan, at_ms(1)));
  EXPECT_TRUE(node.latch(6, kPlan, at_ms(1)));
  EXPECT_EQ(shown(), (Looks{255, 9, 255})) << "channels that are not named keep what they show";
}

TEST_F(NodeModelTest, TheLeaseHoldsAfterOneSecondAndEndsAfterTwoAndAHalf) {
  preload(5, {1, 2, 3});
  node.latch(5, kPlan, at_ms(100));
  node.heartbeat(at_ms(200));
  EXPECT_EQ(node.lease_end(), at_ms(1200));
  node.settle(at_ms(1200) - Duration(1));
  EXPECT_EQ(node.state(), NodeState::showing);
  node.settle(at_ms(1200));
  EXPECT_EQ(node.state(), NodeState::hold);
  EXPECT_EQ(shown(), (Looks{1, 2, 3}));
  preload(6, {4, 5, 6});
  EXPECT_EQ(node.lease_end(), at_ms(2700));
  node.settle(at_ms(2700) - Duration(1));
  EXPECT_EQ(node.state(), NodeState::hold);
  node.settle(at_ms(2700));
  EXPECT_EQ(node.state(), NodeState::no_guidance);
  EXPECT_EQ(shown(), (Looks{255, 255, 255}));
  EXPECT_EQ(node.pending_sequence(), 0);
  EXPECT_FALSE(node.latch(6, kPlan, at_ms(2800))) << "what was pending is gone";
  EXPECT_EQ(node.lease_end(), kNever);
}

TEST_F(NodeModelTest, AHeartbeatEndsHoldButNotNoGuidance) {
  preload(5, {1, 2, 3});
  node.latch(5, kPlan, at_ms(0));
  node.heartbeat(at_ms(1500));
  EXPECT_EQ(node.state(), NodeState::showing);
  node.heartbeat(at_ms(4000));
  EXPECT_EQ(node.state(), NodeState::no_guidance);
  preload(6, {4, 5, 6});
  EXPECT_TRUE(node.latch(6, kPlan, at_ms(4010)));
  EXPECT_EQ(node.state(), NodeState::showing);
  EXPECT_EQ(shown(), (Looks{4, 5, 6}));
}

TEST_F(NodeModelTest, ALatchInHoldIsTakenAndHoldStays) {
  preload(5, {1, 2, 3});
  node.latch(5, kPlan, at_ms(0));
  preload(6, {4, 5, 6});
  EXPECT_TRUE(node.latch(6, kPlan, at_ms(1100)));
  EXPECT_EQ(node.state(), NodeState::hold);
  EXPECT_EQ(shown(), (Looks{4, 5, 6}));
  node.settle(at_ms(2500));
  EXPECT_EQ(node.state(), NodeState::no_guidance) << "latches do not renew the lease";
}

TEST_F(NodeModelTest, GuidanceNeverOutlivesAControllerThatNeverSentAHeartbeat) {
  preload(5, {1, 2, 3});
  node.latch(5, kPlan, at_ms(60'000));
  EXPECT_EQ(node.state(), NodeState::showing);
  EXPECT_EQ(node.lease_end(), at_ms(61'000));
  node.settle(at_ms(62'500));
  EXPECT_EQ(shown(), (Looks{255, 255, 255}));
}

TEST(NodeModel, WithoutALeaseLooksStay) {
  NodeModel node(1, false);
  node.power_on(kStart);
  const std::vector<LookIndex> looks{9};
  node.preload(1, kPlan, 0, looks);
  node.latch(1, kPlan, at_ms(0));
  node.settle(at_ms(1'000'000));
  EXPECT_EQ(node.shown(0), 9);
  EXPECT_EQ(node.state(), NodeState::showing);
}

TEST_F(NodeModelTest, StagedLooksGatherUntilTheyAreTakenWhateverTheSequence) {
  node.stage(0, std::vector<LookIndex>{1});
  node.stage(2, std::vector<LookIndex>{3});
  EXPECT_TRUE(node.take_staged(77, at_ms(1)));
  EXPECT_EQ(shown(), (Looks{1, 255, 3}));
  EXPECT_FALSE(node.take_staged(78, at_ms(2)));
  EXPECT_EQ(node.shown_sequence(), 78) << "the counter shows even when nothing was staged";
  EXPECT_EQ(shown(), (Looks{1, 255, 3}));
}

TEST_F(NodeModelTest, PowerOnForgetsAllButTheCountOfBoots) {
  preload(5, {1, 2, 3});
  node.latch(5, kPlan, at_ms(1));
  preload(6, {4, 5, 6});
  node.set_look(7, Look{{1, 2, 3}, Effect::blink, 9});
  node.power_on(at_ms(500));
  EXPECT_EQ(shown(), (Looks{255, 255, 255}));
  EXPECT_EQ(node.boots(), 2);
  EXPECT_EQ(node.state(), NodeState::boot);
  EXPECT_FALSE(node.latch(6, kPlan, at_ms(501)));
  EXPECT_EQ(node.look(7), (Look{{255, 255, 255}, Effect::steady, 255}));
}

TEST_F(NodeModelTest, DarkAndNoGuidanceCannotBeChanged) {
  EXPECT_FALSE(node.set_look(0, Look{{1, 2, 3}, Effect::steady, 255}));
  EXPECT_FALSE(node.set_look(255, Look{{1, 2, 3}, Effect::steady, 255}));
  EXPECT_EQ(node.look(0).brightness, 0);
  EXPECT_EQ(node.look(255), no_guidance_look());
  EXPECT_FALSE(node.set_effect(9, 5, 255)) << "there is no effect 5";
  EXPECT_TRUE(node.set_look(9, Look{{1, 2, 3}, Effect::count_down, 200}));
  EXPECT_EQ(node.look(9), (Look{{1, 2, 3}, Effect::count_down, 200}));
}

TEST_F(NodeModelTest, IdentifyLastsTenSecondsAndDoesNotTouchTheLooks) {
  node.identify(true, at_ms(0));
  EXPECT_TRUE(node.identifying(at_ms(9'999)));
  EXPECT_FALSE(node.identifying(at_ms(10'000)));
  node.identify(true, at_ms(20'000));
  node.identify(false, at_ms(21'000));
  EXPECT_FALSE(node.identifying(at_ms(21'000)));
  EXPECT_EQ(shown(), (Looks{255, 255, 255}));
}

TEST_F(NodeModelTest, TheCheckSumCoversTheChannelsThatTheNodeHas) {
  preload(1, {7, 8, 9});
  node.latch(1, kPlan, at_ms(0));
  EXPECT_EQ(node.crc(), 0x518C);  // of 07 08 09
}

TEST_F(NodeModelTest, WhoeverLeadsUnderTheNewestEpochFencesTheOthersAsLongAsALeaseRuns) {
  EXPECT_FALSE(node.fenced(1, at_ms(0))) << "nobody leads";
  EXPECT_TRUE(node.lead(7, 1, at_ms(0)));
  EXPECT_FALSE(node.fenced(1, at_ms(100)));
  EXPECT_TRUE(node.fenced(2, at_ms(100)));
  EXPECT_TRUE(node.lead(8, 2, at_ms(200))) << "a newer epoch takes over";
  EXPECT_TRUE(node.fenced(1, at_ms(300)));
  EXPECT_FALSE(node.lead(7, 1, at_ms(300))) << "and the older one does not come back";
  EXPECT_EQ(node.epoch(at_ms(2699)), 8U);
  EXPECT_TRUE(node.fenced(1, at_ms(2699)));
  EXPECT_FALSE(node.fenced(1, at_ms(2700))) << "but nobody has to know the epoch of a controller that has gone";
  EXPECT_TRUE(node.lead(3, 3, at_ms(2700)));
  node.power_on(at_ms(2800));
  EXPECT_EQ(node.epoch(at_ms(2800)), 0U);
}

}  // namespace
}  // namespace footlight::sim
