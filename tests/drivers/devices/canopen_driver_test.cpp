// SPDX-License-Identifier: Apache-2.0
#include "drivers/devices/canopen/canopen_driver.hpp"

#include <array>
#include <map>
#include <numeric>

#include <gtest/gtest.h>

#include "tests/drivers/recording_ports.hpp"

namespace footlight::drivers {
namespace {

using Kind = DeviceEvent::Kind;

const NodeAddress kOne{NodeIndex(0), 1, 32};
const NodeAddress kTwo{NodeIndex(1), 2, 32};

class CanopenDriverTest : public ::testing::Test {
 protected:
  void hear(std::uint16_t id, std::initializer_list<std::uint8_t> data) {
    CanFrame frame;
    frame.id = id;
    frame.length = static_cast<std::uint8_t>(data.size());
    std::copy(data.begin(), data.end(), frame.data.begin());
    port_.incoming.push_back(frame);
  }
  void hear_status(std::uint8_t node, Sequence sequence) { hear(0x180U + node, {sequence, 1, 0, 0, 1, 0, 0, 0}); }
  Instant step() { return driver_.step(now_, log_); }
  SendStatus preload(const NodeAddress& node, Sequence sequence) {
    return driver_.preload(node, sequence, std::vector<LookIndex>(32, 9), now_);
  }
  void start() {
    ASSERT_EQ(driver_.start(now_), SendStatus::accepted);
    port_.in_queue = 0;
    port_.sent.clear();
  }

  RecordingCan port_;
  CanopenDriver driver_{port_, {kOne, kTwo}};
  EventLog log_;
  Instant now_ = instant_at(1);
};

TEST_F(CanopenDriverTest, AShortQueueStillTakesAPreloadAsAWhole) {
  port_.capacity = 1;
  ASSERT_EQ(preload(kOne, 1), SendStatus::accepted);
  EXPECT_EQ(port_.sent.size(), 1U);
  EXPECT_EQ(preload(kTwo, 1), SendStatus::busy);
  EXPECT_EQ(driver_.latch(1, now_), SendStatus::busy) << "three frames of the preload have not left yet";
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(log_.count(Kind::preloaded), 0U);
    port_.in_queue = 0;
    EXPECT_LT(step(), kNever);
  }
  EXPECT_EQ(port_.sent.size(), 4U);
  port_.in_queue = 0;
  step();
  EXPECT_EQ(log_.count(Kind::preloaded), 1U);
  EXPECT_EQ(driver_.latch(1, now_), SendStatus::accepted);
  EXPECT_EQ(port_.sent.back().id, 0x080);
}

TEST_F(CanopenDriverTest, LeavesPlacesInTheQueueForAHeartbeat) {
  while (preload(kOne, 1) == SendStatus::accepted) {
  }
  EXPECT_LE(port_.in_queue, 8U);
  EXPECT_EQ(driver_.heartbeat({}, now_), SendStatus::accepted);
}

TEST_F(CanopenDriverTest, ANodeThatBootsIsStartedAndTold) {
  start();
  hear(0x702, {0});
  step();
  ASSERT_EQ(log_.count(Kind::booted), 1U);
  EXPECT_EQ(log_.last(Kind::booted)->node, kTwo.node);
  ASSERT_EQ(port_.sent.size(), 1U);
  EXPECT_EQ(port_.sent[0].id, 0x000);
  EXPECT_EQ(port_.sent[0].data[0], 0x01);
  EXPECT_EQ(port_.sent[0].data[1], 2);
}

TEST_F(CanopenDriverTest, NothingIsStartedBeforeTheBusIs) {
  hear(0x702, {0});
  step();
  EXPECT_EQ(log_.count(Kind::booted), 1U);
  EXPECT_TRUE(port_.sent.empty());
}

TEST_F(CanopenDriverTest, ALostBootUpMessageIsSeenByTheNextHeartbeat) {
  start();
  hear(0x701, {5});
  step();
  EXPECT_TRUE(log_.events.empty());
  hear(0x701, {127});
  step();
  EXPECT_EQ(log_.count(Kind::booted), 1U);
  EXPECT_EQ(port_.sent.size(), 1U);
  hear(0x701, {127});
  step();
  EXPECT_EQ(log_.count(Kind::booted), 1U) << "told once";
  EXPECT_EQ(port_.sent.size(), 2U) << "but started until it runs";
}

TEST_F(CanopenDriverTest, ARestartIsToldOnceThoughMessageAndBootsBothShowIt) {
  start();
  hear_status(1, 1);
  hear(0x701, {0});
  hear(0x181, {1, 1, 0, 0, 2, 0, 0, 0});
  step();
  EXPECT_EQ(log_.count(Kind::booted), 1U);
}

TEST_F(CanopenDriverTest, SilenceOf2500MsIsAMissAndEachFurtherOneToo) {
  start();
  now_ += milliseconds(1'000);
  hear(0x701, {5});
  step();
  now_ += milliseconds(1'499);
  step();
  EXPECT_EQ(log_.count(Kind::missed), 0U);
  now_ += milliseconds(1);
  EXPECT_EQ(step(), now_ + milliseconds(1'000)) << "node 1 is due then";
  ASSERT_EQ(log_.count(Kind::missed), 1U);
  EXPECT_EQ(log_.last(Kind::missed)->node, kTwo.node);
  now_ += milliseconds(1'000);
  step();
  EXPECT_EQ(log_.count(Kind::missed), 2U);
  now_ += milliseconds(1'500);
  step();
  EXPECT_EQ(log_.count(Kind::missed), 3U);
}

TEST_F(CanopenDriverTest, WhoOwesTheStatusOfALatchIsMissed) {
  ASSERT_EQ(driver_.latch(5, now_), SendStatus::accepted);
  hear_status(1, 5);
  hear_status(2, 4);  // of the latch before, late
  const Instant deadline = step();
  EXPECT_GE(deadline, now_ + milliseconds(5) + 2 * driver_.status_time());
  now_ = deadline;
  step();
  ASSERT_EQ(log_.count(Kind::missed), 1U);
  EXPECT_EQ(log_.last(Kind::missed)->node, kTwo.node);
  EXPECT_EQ(log_.last(Kind::missed)->sequence, 5);
  EXPECT_EQ(log_.count(Kind::showing), 2U);
}

TEST_F(CanopenDriverTest, AskingSendsTheLastSyncAgainAndOnceForAll) {
  ASSERT_EQ(driver_.latch(5, now_), SendStatus::accepted);
  hear_status(1, 5);
  hear_status(2, 5);
  step();
  port_.sent.clear();
  EXPECT_EQ(driver_.ask(kOne, now_), SendStatus::accepted);
  EXPECT_EQ(driver_.ask(kTwo, now_), SendStatus::accepted);
  ASSERT_EQ(port_.sent.size(), 1U);
  EXPECT_EQ(port_.sent[0].id, 0x080);
  EXPECT_EQ(port_.sent[0].data[0], 5);
}

TEST_F(CanopenDriverTest, AskingNeverLatchesAPreload) {
  ASSERT_EQ(preload(kOne, 6), SendStatus::accepted);
  port_.in_queue = 0;
  step();
  port_.sent.clear();
  EXPECT_EQ(driver_.ask(kTwo, now_), SendStatus::busy);
  EXPECT_TRUE(port_.sent.empty());
  EXPECT_EQ(driver_.latch(6, now_), SendStatus::accepted);
  hear_status(1, 6);
  hear_status(2, 6);
  step();
  EXPECT_EQ(driver_.ask(kTwo, now_), SendStatus::accepted);
}

TEST_F(CanopenDriverTest, AnEmergencyIsARefusalAndItsEndIsNot) {
  hear(0x081, {0x10, 0x82, 0x11, 0, 0, 0, 0, 0});
  hear(0x081, {0, 0, 0, 0, 0, 0, 0, 0});
  step();
  ASSERT_EQ(log_.events.size(), 1U);
  EXPECT_EQ(log_.events[0].kind, Kind::rejected);
  EXPECT_EQ(log_.events[0].detail, 0x8210);
}

TEST_F(CanopenDriverTest, FramesOfTheWrongLengthOrOfStrangersAreNothing) {
  start();
  hear(0x181, {1, 1, 0, 0, 1, 0, 0});
  hear(0x701, {0, 0});
  hear(0x701, {});
  hear(0x081, {1, 2});
  hear(0x183, {1, 1, 0, 0, 1, 0, 0, 0});
  hear(0x77F, {5});
  hear(0x080, {1});
  hear(0x000, {0x81, 0});
  CanFrame out_of_range{.id = 0xFFFF, .length = 8, .data = {}};
  port_.incoming.push_back(out_of_range);
  step();
  EXPECT_TRUE(log_.events.empty());
  EXPECT_TRUE(port_.sent.empty());
}

TEST_F(CanopenDriverTest, AnErrorFrameIsNoAnswerThoughItsClassesLookLikeAnIdentifier) {
  start();
  for (const auto kind : {CanFrame::Kind::error, CanFrame::Kind::fd}) {
    port_.incoming.push_back({.id = 0x181, .length = 8, .data = {1, 1, 0, 0, 1}, .kind = kind});
  }
  step();
  EXPECT_TRUE(log_.events.empty());
}

TEST_F(CanopenDriverTest, APreloadThatTheWireLostIsMissed) {
  port_.capacity = 2;
  ASSERT_EQ(preload(kOne, 1), SendStatus::accepted);
  port_.status = SendStatus::down;
  step();
  ASSERT_EQ(log_.count(Kind::missed), 1U);
  EXPECT_EQ(log_.last(Kind::missed)->node, kOne.node);
  EXPECT_EQ(log_.count(Kind::bus_down), 1U);
  port_.status = SendStatus::accepted;
  port_.in_queue = 0;
  port_.sent.clear();
  EXPECT_EQ(driver_.heartbeat({}, now_), SendStatus::accepted);
  step();
  EXPECT_EQ(port_.sent.size(), 1U) << "nothing old comes after the wire is back";
}

TEST_F(CanopenDriverTest, ABusOnWhichNothingLeavesIsDownAndGetsHeartbeatsAlone) {
  for (const CanState state : {CanState::stalled, CanState::bus_off, CanState::down}) {
    port_.bus = CanState::active;
    step();
    log_.events.clear();
    port_.sent.clear();
    port_.in_queue = 9;
    port_.bus = state;
    EXPECT_EQ(step(), now_ + milliseconds(20)) << "nobody tells when it is back";
    ASSERT_EQ(log_.count(Kind::bus_down), 1U);
    EXPECT_EQ(log_.last(Kind::bus_down)->detail, static_cast<int>(state));
    EXPECT_TRUE(driver_.ready()) << "to say so";
    EXPECT_EQ(preload(kOne, 1), SendStatus::down);
    EXPECT_EQ(driver_.latch(1, now_), SendStatus::down);
    EXPECT_EQ(driver_.ask(kOne, now_), SendStatus::down);
    EXPECT_EQ(driver_.start(now_), SendStatus::down);
    EXPECT_EQ(driver_.upload_look(3, Look{}, now_), SendStatus::down);
    EXPECT_TRUE(port_.sent.empty());
    EXPECT_EQ(driver_.heartbeat({}, now_), SendStatus::down);
    ASSERT_EQ(port_.sent.size(), 1U);
    EXPECT_EQ(port_.sent[0].id, 0x77F);
  }
}

TEST_F(CanopenDriverTest, AWarningIsNoEndOfTheBus) {
  for (const CanState state : {CanState::warning, CanState::passive}) {
    port_.bus = state;
    EXPECT_EQ(preload(kOne, 1), SendStatus::accepted);
    port_.in_queue = 0;
    step();
  }
  EXPECT_EQ(log_.count(Kind::bus_down), 0U);
}

TEST_F(CanopenDriverTest, WhileFramesWaitTheBusIsLookedAt) {
  ASSERT_EQ(driver_.heartbeat({}, now_), SendStatus::accepted);
  EXPECT_EQ(step(), now_ + milliseconds(20));
  port_.in_queue = 0;
  EXPECT_EQ(step(), kNever);
}

class CanopenServiceTest : public CanopenDriverTest {
 protected:
  /// Answers each request by what the node's objects hold; an object that is not there is an abort.
  void answer_all() {
    while (!port_.sent.empty()) {
      const CanFrame request = port_.sent.front();
      port_.sent.erase(port_.sent.begin());
      port_.in_queue = 0;
      if ((request.id & 0x780U) != 0x600) continue;
      CanFrame answer{static_cast<std::uint16_t>(0x580 + (request.id & 0x7F)), 8, request.data};
      const auto found = objects_.find(request.data[1] | (request.data[2] << 8) | (request.data[3] << 16));
      if (request.data[0] == 0x40 && found != objects_.end()) {
        answer.data[0] = 0x43;
        for (unsigned i = 0; i < 4; ++i) answer.data.at(4 + i) = static_cast<std::uint8_t>(found->second >> (8 * i));
      } else if (request.data[0] == 0x2F && found != objects_.end()) {
        found->second = request.data[4];
        answer.data[0] = 0x60;
      } else {
        const std::array<std::uint8_t, 8> abort{0x80, request.data[1], request.data[2], request.data[3], 0, 0, 2, 6};
        std::copy(abort.begin(), abort.end(), answer.data.begin());
      }
      port_.incoming.push_back(answer);
      step();
    }
  }
  std::map<int, std::uint32_t> objects_;
};

TEST_F(CanopenServiceTest, AProbeTellsWhoIsThere) {
  objects_ = {{0x011018, 0}, {0x021018, 0x464C4D4B}, {0x031018, 0x10001}, {0x041018, 0xCAFE0102}, {0x002103, 16}};
  ASSERT_EQ(driver_.probe(77, 0, now_), SendStatus::accepted) << "no node of the rig";
  EXPECT_FALSE(driver_.ready());
  EXPECT_EQ(driver_.probe(78, 0, now_), SendStatus::busy);
  answer_all();
  ASSERT_EQ(log_.answers.size(), 1U);
  const ServiceAnswer& answer = log_.answers[0];
  EXPECT_EQ(answer.kind, ServiceAnswer::Kind::found);
  EXPECT_EQ(answer.address, 77);
  EXPECT_EQ(answer.identity, (Identity{0xCAFE0102, "CANopen vendor 0x00000000 product 0x464C4D4B", 0x10001, 16}));
  EXPECT_TRUE(driver_.ready());
}

TEST_F(CanopenServiceTest, ANodeThatRefusesEveryObjectIsThereAllTheSame) {
  ASSERT_EQ(driver_.probe(77, 0, now_), SendStatus::accepted);
  answer_all();
  ASSERT_EQ(log_.answers.size(), 1U);
  EXPECT_EQ(log_.answers[0].kind, ServiceAnswer::Kind::found);
  EXPECT_EQ(log_.answers[0].identity, Identity{});
}

TEST_F(CanopenServiceTest, NobodyIsSilentAfter50Milliseconds) {
  ASSERT_EQ(driver_.probe(77, 0, now_), SendStatus::accepted);
  port_.in_queue = 0;
  EXPECT_EQ(step(), now_ + milliseconds(50));
  now_ += milliseconds(50);
  port_.sent.clear();
  step();
  ASSERT_EQ(log_.answers.size(), 1U);
  EXPECT_EQ(log_.answers[0].kind, ServiceAnswer::Kind::silent);
  ASSERT_EQ(port_.sent.size(), 1U);
  EXPECT_EQ(port_.sent[0].data[0], 0x80) << "and is told that we have given up";
  port_.in_queue = 0;
  step();
  EXPECT_TRUE(driver_.ready());
}

TEST_F(CanopenServiceTest, IdentifyIsWrittenAndARefusalToldWithItsCode) {
  objects_ = {{0x002104, 0}};
  ASSERT_EQ(driver_.identify(1, true, now_), SendStatus::accepted);
  answer_all();
  EXPECT_EQ(objects_.at(0x002104), 1U);
  ASSERT_EQ(log_.answers.size(), 1U);
  EXPECT_EQ(log_.answers[0].kind, ServiceAnswer::Kind::done);
  objects_.clear();
  ASSERT_EQ(driver_.identify(1, false, now_), SendStatus::accepted);
  answer_all();
  ASSERT_EQ(log_.answers.size(), 2U);
  EXPECT_EQ(log_.answers[1].kind, ServiceAnswer::Kind::refused);
  EXPECT_EQ(log_.answers[1].detail, 0x06020000);
}

TEST_F(CanopenServiceTest, HealthIsErrorsAndBoots) {
  objects_ = {{0x001001, 0x11}, {0x052102, 3}, {0x042102, 258}};
  ASSERT_EQ(driver_.ask_health(2, now_), SendStatus::accepted);
  answer_all();
  ASSERT_EQ(log_.answers.size(), 1U);
  ASSERT_EQ(log_.answers[0].health.size(), 3U);
  EXPECT_EQ(log_.answers[0].health[0].name, "error register");
  EXPECT_EQ(log_.answers[0].health[0].value, 0x11);
  EXPECT_EQ(log_.answers[0].health[1].value, 3);
  EXPECT_EQ(log_.answers[0].health[2].value, 258);
}

TEST_F(CanopenServiceTest, ABusThatGoesDownEndsIt) {
  ASSERT_EQ(driver_.probe(77, 0, now_), SendStatus::accepted);
  port_.bus = CanState::bus_off;
  step();
  ASSERT_EQ(log_.answers.size(), 1U);
  EXPECT_EQ(log_.answers[0].kind, ServiceAnswer::Kind::silent);
}

TEST_F(CanopenServiceTest, AddressesAreNotSetByWire) {
  EXPECT_EQ(driver_.refusal(Task::set_address), "the id of a CANopen node is set on the device");
  EXPECT_EQ(driver_.refusal(Task::probe), "");
}

TEST_F(CanopenDriverTest, A32ChannelPreloadAt500KbitIs1080MicrosecondsAtWorst) {
  EXPECT_EQ(driver_.preload_time(32), 4 * microseconds(270));
  EXPECT_EQ(driver_.preload_time(5), microseconds(2 * (47 + 40 + 73 / 4)));
  EXPECT_EQ(driver_.latch_time(), microseconds(2 * (55 + 41 / 4)));
}

}  // namespace
}  // namespace footlight::drivers
