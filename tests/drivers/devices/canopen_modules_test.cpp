// SPDX-License-Identifier: Apache-2.0
// A CANopen bus of output modules (CiA 401).
#include <cstdio>
#include <map>
#include <optional>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/devices/canopen/canopen_driver.hpp"
#include "tests/drivers/recording_ports.hpp"
#include "tests/drivers/wire_golden.hpp"

namespace footlight::drivers {
namespace {

using Kind = DeviceEvent::Kind;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

const NodeAddress kEleven{NodeIndex(0), 11, 16};
const NodeAddress kTwelve{NodeIndex(1), 12, 16};

OutputModule sixteen() {
  OutputModule module;
  module.name = "sixteen";
  module.outputs = 16;
  return module;
}

/// Answers SDO requests as a device that takes everything; what it refuses or forgets is set by the test.
struct Dictionary {
  std::map<std::pair<int, int>, std::uint32_t> values{{{0x1000, 0}, 0x00020191}};
  std::map<std::pair<int, int>, std::uint32_t> refused;  ///< abort code of a write
  std::pair<int, int> forgets{-1, -1};                   ///< keeps its old value
  bool silent = false;

  std::optional<CanFrame> answer(const CanFrame& request) {
    if (silent || request.id < 0x600 || request.id > 0x67F || request.data[0] == 0x80) return std::nullopt;
    const auto node = static_cast<std::uint16_t>(request.id - 0x600);
    const std::pair place(request.data[1] | (request.data[2] << 8), int{request.data[3]});
    CanFrame frame{static_cast<std::uint16_t>(0x580 + node), 8, {0, request.data[1], request.data[2], request.data[3]}};
    std::uint32_t number = 0;
    if (request.data[0] == 0x40) {
      frame.data[0] = 0x43;
      number = values[place];
    } else if (refused.contains(place)) {
      frame.data[0] = 0x80;
      number = refused[place];
    } else {
      frame.data[0] = 0x60;
      if (place != forgets) {
        for (unsigned i = 0; i < 4; ++i) number |= std::uint32_t{request.data.at(4 + i)} << (8U * i);
        values[place] = number;
      }
      number = 0;
    }
    for (unsigned i = 0; i < 4; ++i) frame.data.at(4 + i) = static_cast<std::uint8_t>((number >> (8U * i)) & 0xFFU);
    return frame;
  }
};

class CanopenModules : public ::testing::Test {
 protected:
  /// Lets the driver and the modules talk until nobody has anything to say.
  void talk() {
    for (int i = 0; i < 400; ++i) {
      port_.in_queue = 0;
      driver_.step(now_, log_);
      for (; seen_ < port_.sent.size(); ++seen_) {
        if (auto answer = device_.answer(port_.sent[seen_])) port_.incoming.push_back(*answer);
      }
      now_ += microseconds(300);
    }
    port_.in_queue = 0;
  }
  void start() {
    ASSERT_EQ(driver_.start(now_), SendStatus::accepted);
    talk();
  }
  [[nodiscard]] std::vector<CanFrame> to(std::uint16_t id) const {
    std::vector<CanFrame> out;
    for (const CanFrame& frame : port_.sent) {
      if (frame.id == id) out.push_back(frame);
    }
    return out;
  }
  SendStatus preload(const NodeAddress& node, const std::vector<LookIndex>& looks) {
    const SendStatus status = driver_.preload(node, 1, looks, now_);
    driver_.step(now_, log_);
    return status;
  }

  RecordingCan port_;
  Dictionary device_;
  CanopenDriver driver_{port_, {kEleven}, sixteen()};
  EventLog log_;
  Instant now_ = instant_at(1);
  std::size_t seen_ = 0;
};

TEST_F(CanopenModules, AModuleIsConfiguredReadBackAndStartedInTheOrderOfTheStandard) {
  start();
  const Golden golden("cia401.txt");
  ASSERT_GE(port_.sent.size(), 2U);
  EXPECT_EQ(port_.sent.front(), (CanFrame{0x000, 2, {0x80, 0}})) << "pre-operational first";
  EXPECT_EQ(to(0x60B), golden.frames("setup"));
  EXPECT_EQ(port_.sent.back(), (CanFrame{0x000, 2, {0x01, 11}}));
  EXPECT_THAT(driver_.complaints(), IsEmpty());
}

TEST_F(CanopenModules, TheFramesOfAMappingAreThoseOfAMakersManual) {
  // EAO, series 09 rugged keypads, CANopen manual, "Changing the PDO mapping", node 0x0B: RPDO2 made invalid, count
  // cleared, 0x2207:0 mapped as eight bits, count 1.
  canopen::SdoClient client;
  const auto bytes = [&](canopen::ObjectPlace place, const std::vector<std::uint8_t>& value) {
    const CanFrame frame = client.write(0x0B, place, value);
    EXPECT_EQ(frame.id, 0x60B);
    return std::vector<int>(frame.data.begin(), frame.data.begin() + 8);
  };
  EXPECT_THAT(bytes({0x1401, 1}, {0, 0, 0, 0x80}), ElementsAre(0x23, 0x01, 0x14, 0x01, 0x00, 0x00, 0x00, 0x80));
  EXPECT_THAT(bytes({0x1601, 0}, {0}), ElementsAre(0x2F, 0x01, 0x16, 0x00, 0x00, 0x00, 0x00, 0x00));
  EXPECT_THAT(bytes({0x1601, 1}, {0x08, 0x00, 0x07, 0x22}),
              ElementsAre(0x23, 0x01, 0x16, 0x01, 0x08, 0x00, 0x07, 0x22));
  EXPECT_THAT(bytes({0x1601, 0}, {1}), ElementsAre(0x2F, 0x01, 0x16, 0x00, 0x01, 0x00, 0x00, 0x00));
}

TEST_F(CanopenModules, LooksAreLitOutputsAndASyncWithoutCounterTakesThem) {
  start();
  ASSERT_EQ(driver_.upload_look(3, Look{{0, 0, 0}, Effect::steady, 255}, now_), SendStatus::accepted);
  ASSERT_EQ(driver_.upload_look(4, Look{{255, 0, 0}, Effect::blink, 9}, now_), SendStatus::accepted);
  port_.sent.clear();
  std::vector<LookIndex> looks(16, kDark);
  looks[0] = 4;
  looks[3] = 7;
  looks[5] = 3;  // black is dark
  looks[9] = 4;
  ASSERT_EQ(preload(kEleven, looks), SendStatus::accepted);
  const Golden golden("cia401.txt");
  EXPECT_EQ(port_.sent, golden.frames("preload"));
  port_.in_queue = 0;
  driver_.step(now_, log_);
  EXPECT_EQ(log_.count(Kind::preloaded), 1U);
  port_.sent.clear();
  ASSERT_EQ(driver_.latch(17, now_), SendStatus::accepted);
  EXPECT_EQ(port_.sent, golden.frames("latch"));
}

TEST_F(CanopenModules, BeforeItIsSetUpPreloadsAreRejectedForLater) {
  device_.silent = true;
  start();
  ASSERT_EQ(preload(kEleven, std::vector<LookIndex>(16, 1)), SendStatus::accepted);
  ASSERT_EQ(log_.count(Kind::rejected), 1U);
  EXPECT_EQ(log_.last(Kind::rejected)->again, DeviceEvent::Again::later);
  EXPECT_THAT(to(0x20B), IsEmpty());
  EXPECT_EQ(log_.count(Kind::missed), 1U) << "50 ms without an answer";
  const auto asked = to(0x60B).size();
  now_ += milliseconds(1000);
  device_.silent = false;
  talk();
  EXPECT_GT(to(0x60B).size(), asked) << "asked again a second later";
  EXPECT_EQ(port_.sent.back(), (CanFrame{0x000, 2, {0x01, 11}}));
}

TEST_F(CanopenModules, ANodeThatRefusesIsNamedWithObjectAndMeaningAndNeverUsed) {
  device_.refused[{0x1600, 1}] = 0x06040041;
  start();
  EXPECT_THAT(
      driver_.complaints(),
      ElementsAre("node 11: object 0x1600:1 does not take 0x62000108: 0x06040041, the object cannot be mapped to "
                  "the PDO"));
  ASSERT_EQ(preload(kEleven, std::vector<LookIndex>(16, 1)), SendStatus::accepted);
  EXPECT_EQ(log_.last(Kind::rejected)->again, DeviceEvent::Again::never);
  EXPECT_EQ(to(0x000).size(), 1U) << "it is not started";
}

TEST_F(CanopenModules, AValueThatIsNotKeptIsNamed) {
  device_.values[{0x1017, 0}] = 500;
  device_.forgets = {0x1017, 0};
  start();
  EXPECT_THAT(driver_.complaints(), ElementsAre("node 11: object 0x1017:0 is 0x000001F4 and should be 0x000003E8"));
}

TEST_F(CanopenModules, AnotherKindOfDeviceIsNamed) {
  device_.values[{0x1000, 0}] = 0x00010191;
  start();
  EXPECT_THAT(driver_.complaints(), ElementsAre("node 11: object 0x1000:0 is 0x00010191: no module of digital outputs "
                                                "(CiA 401: 0x....0191, bit 17 set)"));
}

TEST_F(CanopenModules, AModuleThatHasBootedIsSetUpAnew) {
  start();
  port_.sent.clear();
  seen_ = 0;
  port_.incoming.push_back({0x70B, 1, {0}});
  talk();
  EXPECT_EQ(log_.count(Kind::booted), 1U);
  EXPECT_EQ(to(0x60B), Golden("cia401.txt").frames("setup"));
  EXPECT_EQ(port_.sent.back(), (CanFrame{0x000, 2, {0x01, 11}}));
}

TEST_F(CanopenModules, AModuleWhoseStartWasLostIsStartedAgainAndCountsAsMissed) {
  start();
  port_.sent.clear();
  seen_ = 0;
  port_.incoming.push_back({0x70B, 1, {127}});
  talk();
  EXPECT_THAT(port_.sent, ElementsAre(CanFrame{0x000, 2, {0x01, 11}}));
  EXPECT_EQ(log_.count(Kind::missed), 1U);
}

TEST(ModuleSetup, TheProfileSaysSafeStateHeartbeatsIdentityAndMore) {
  OutputModule module = sixteen();
  module.outputs = 5;
  module.on_failure = OutputModule::OnFailure::keep;
  module.vendor = 0x195;
  module.heartbeat = milliseconds(500);
  module.silence = milliseconds(2000);
  module.objects = {{0x2000, 3, 2, 0x1234}};
  std::vector<std::string> told;
  for (const canopen::SetupStep& step : canopen::setup_steps(module, 5)) {
    char text[40];
    std::snprintf(text, sizeof text, "%04X:%d %s%X", unsigned{step.place.index}, int{step.place.sub},
                  step.reads() ? "= " : "< ", step.value);
    told.emplace_back(text);
  }
  EXPECT_THAT(
      told, ElementsAre("1000:0 = 20191", "1018:1 = 195", "1400:1 < 80000205", "1600:0 < 0", "1600:1 < 62000108",
                        "1600:0 < 1", "1400:2 < 1", "1400:1 < 205", "6206:1 < 0", "1016:1 < 7F07D0", "1017:0 < 1F4",
                        "2000:3 < 1234", "1600:1 = 62000108", "1600:0 = 1", "1400:2 = 1", "1400:1 = 205", "6206:1 = 0",
                        "1016:1 = 7F07D0", "1017:0 = 1F4", "2000:3 = 1234"));
}

TEST(ModuleSetup, OneModuleAfterTheOther) {
  canopen::ModuleSetup setup(sixteen(), {kEleven, kTwelve});
  std::deque<CanFrame> outbox;
  setup.want(11, kStart);
  setup.want(12, kStart);
  EXPECT_EQ(setup.next(), kStart);
  setup.step(kStart, false, outbox);
  EXPECT_TRUE(outbox.empty()) << "a technician's work goes first";
  setup.step(kStart, true, outbox);
  setup.step(kStart, true, outbox);
  EXPECT_EQ(outbox.size(), 1U) << "one transfer at a time";
  EXPECT_EQ(outbox[0].id, 0x60B);
  const auto outcome = setup.step(kStart + milliseconds(50), true, outbox);
  EXPECT_EQ(outcome.silent, 11);
  outbox.clear();
  setup.step(kStart + milliseconds(50), true, outbox);
  ASSERT_EQ(outbox.size(), 1U);
  EXPECT_EQ(outbox[0].id, 0x60C);
}

}  // namespace
}  // namespace footlight::drivers
