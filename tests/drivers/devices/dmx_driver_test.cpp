// SPDX-License-Identifier: Apache-2.0
#include "drivers/devices/dmx_usb_pro/dmx_driver.hpp"

#include <gtest/gtest.h>

#include "tests/drivers/recording_ports.hpp"
#include "tests/drivers/wire_golden.hpp"

namespace footlight::drivers {
namespace {

using Octets = std::vector<std::uint8_t>;
using Kind = DeviceEvent::Kind;

const DmxFixture kRgb{"rgb", {DmxSlot::red, DmxSlot::green, DmxSlot::blue}};
const NodeAddress kNode{NodeIndex(0), 1, 2};

class DmxDriverTest : public ::testing::Test {
 protected:
  DmxDriverTest() {
    driver_.upload_look(1, {{255, 0, 0}}, now_);
    driver_.upload_look(2, {{0, 255, 0}, Effect::steady, 128}, now_);
    driver_.upload_look(3, {{0, 0, 255}, Effect::blink, 255}, now_);
  }
  void light(LookIndex first, LookIndex second, Sequence sequence) {
    ASSERT_EQ(driver_.preload(kNode, sequence, std::vector<LookIndex>{first, second}, now_), SendStatus::accepted);
    driver_.step(now_, log_);
    ASSERT_EQ(driver_.latch(sequence, now_), SendStatus::accepted);
  }
  Octets slots() { return {port_.sent.back().begin() + 5, port_.sent.back().begin() + 11}; }

  RecordingStream port_;
  DmxDriver driver_{port_, kRgb, {kNode}};
  EventLog log_;
  Instant now_ = instant_at(10);
};

TEST_F(DmxDriverTest, APacketIsAsTheWidgetsMakerDescribesIt) {
  light(1, 2, 1);
  ASSERT_EQ(port_.sent.size(), 1U);
  EXPECT_EQ(port_.sent[0], Golden("dmx.txt").bytes("packet"));
}

TEST_F(DmxDriverTest, LooksWaitForTheirOwnLatch) {
  light(1, 1, 1);
  now_ += milliseconds(50);
  driver_.step(now_, log_);
  ASSERT_EQ(driver_.preload(kNode, 2, std::vector<LookIndex>{2, 2}, now_), SendStatus::accepted);
  driver_.step(now_, log_);
  ASSERT_EQ(driver_.latch(3, now_), SendStatus::accepted);
  EXPECT_EQ(slots(), (Octets{255, 0, 0, 255, 0, 0})) << "latch 3 is not theirs";
  now_ += milliseconds(50);
  driver_.step(now_, log_);
  ASSERT_EQ(driver_.latch(2, now_), SendStatus::accepted);
  EXPECT_EQ(slots(), (Octets{0, 128, 0, 0, 128, 0}));
  EXPECT_EQ(log_.count(Kind::preloaded), 2U);
}

TEST_F(DmxDriverTest, EffectsArePlayedHereAndSteadyLightIsLeftToTheWidget) {
  light(1, 1, 1);
  const std::size_t before = port_.sent.size();
  for (int ms = 0; ms < 900; ++ms) driver_.step(now_ += milliseconds(1), log_);
  EXPECT_EQ(port_.sent.size(), before);
  for (int ms = 0; ms < 200; ++ms) driver_.step(now_ += milliseconds(1), log_);
  EXPECT_EQ(port_.sent.size(), before + 1) << "once a second: the widget may have been switched off and on";
  light(3, 1, 2);
  int lit = 0;
  int dark = 0;
  for (int ms = 0; ms < 2000; ++ms) {
    const std::size_t sent = port_.sent.size();
    driver_.step(now_ += milliseconds(1), log_);
    if (port_.sent.size() == sent) continue;
    (slots()[2] == 255 ? lit : dark) += 1;
    EXPECT_EQ(slots()[3], 255) << "the other lamp is steady";
  }
  EXPECT_NEAR(lit, 38, 4) << "40 packets a second at most, half of them lit";
  EXPECT_NEAR(dark, 38, 4);
}

TEST_F(DmxDriverTest, IdentifyBlinksWhiteForTenSecondsAlsoWhereTheRigHasNoLamp) {
  light(1, 1, 1);
  now_ += milliseconds(50);
  driver_.step(now_, log_);
  ASSERT_EQ(driver_.identify(22, true, now_), SendStatus::accepted);
  driver_.step(now_, log_);
  ASSERT_EQ(log_.answers.size(), 1U);
  EXPECT_EQ(log_.answers[0].kind, ServiceAnswer::Kind::done);
  const auto at_22 = [&] { return Octets{port_.sent.back().begin() + 26, port_.sent.back().begin() + 29}; };
  EXPECT_EQ(at_22(), (Octets{255, 255, 255}));
  EXPECT_EQ(slots(), (Octets{255, 0, 0, 255, 0, 0})) << "the others stay as they are";
  for (int ms = 0; ms < 12'000; ++ms) driver_.step(now_ += milliseconds(1), log_);
  EXPECT_EQ(at_22(), (Octets{0, 0, 0}));
}

TEST_F(DmxDriverTest, WhatDmxCannotDoIsRefused) {
  EXPECT_EQ(driver_.refusal(Task::probe), "DMX goes one way, nobody answers (identify lights a lamp)");
  EXPECT_EQ(driver_.refusal(Task::set_address), "DMX goes one way: addresses are set at the lamps");
  EXPECT_EQ(driver_.refusal(Task::identify), "");
}

TEST(DmxLevels, WhiteTakesWhatColoursShareAndADimmerTheBrightness) {
  const DmxFixture rgbw{
      "rgbw",
      {DmxSlot::dimmer, DmxSlot::red, DmxSlot::green, DmxSlot::blue, DmxSlot::white, DmxSlot::zero, DmxSlot::full}};
  EXPECT_EQ(dmx::levels(rgbw, {{255, 200, 100}, Effect::steady, 51}, 1), (Octets{51, 155, 100, 0, 100, 0, 255}));
  const DmxFixture dimmer{"dimmer", {DmxSlot::dimmer}};
  EXPECT_EQ(dmx::levels(dimmer, {{10, 200, 30}, Effect::steady, 255}, 1), (Octets{200}));
  EXPECT_EQ(dmx::levels(dimmer, {{10, 200, 30}, Effect::steady, 255}, 0.5), (Octets{100}));
  EXPECT_EQ(dmx::levels(dimmer, {{0, 0, 0}, Effect::steady, 255}, 1), (Octets{0}));
}

TEST(DmxLevels, TellWhetherALampMayShowALook) {
  const Look steady{{255, 0, 0}};
  const Look blink{{255, 0, 0}, Effect::blink};
  const Look pulse{{255, 0, 0}, Effect::pulse};
  const auto may = [](const Look& look, Octets levels) { return dmx::may_show(kRgb, look, levels); };
  EXPECT_TRUE(may(steady, {255, 0, 0}));
  EXPECT_FALSE(may(steady, {0, 0, 0}));
  EXPECT_TRUE(may(blink, {0, 0, 0}));
  EXPECT_FALSE(may(blink, {128, 0, 0}));
  EXPECT_TRUE(may(pulse, {128, 0, 0}));
  EXPECT_FALSE(may(pulse, {128, 1, 0}));
}

TEST(DmxEffects, FlashNoFasterThanThreeTimesASecond) {
  for (const Effect effect : {Effect::blink, Effect::pulse, Effect::double_blink, Effect::count_down}) {
    int rises = 0;
    bool lit = dmx::share_of(effect, kStart) > 0.5;
    for (int ms = 1; ms <= 12'000; ++ms) {
      const bool now_lit = dmx::share_of(effect, kStart + milliseconds(ms)) > 0.5;
      rises += now_lit && !lit ? 1 : 0;
      lit = now_lit;
    }
    EXPECT_LE(rises, 36) << to_text(effect);
    EXPECT_GE(rises, 6) << to_text(effect);
  }
}

}  // namespace
}  // namespace footlight::drivers
