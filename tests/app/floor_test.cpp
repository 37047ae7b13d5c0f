// SPDX-License-Identifier: Apache-2.0
#include "app/floor.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "core/clock.hpp"
#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

class FloorTest : public ::testing::Test {
 protected:
  FloorTest() {
    show_.stage.grid = Grid::make(GridKind::square, 2, 3, 1).value();
    rig_ = tests::lamps_everywhere(show_.stage.grid, {BusKind::serial}, 115'200, 4);
    rig_.nodes[1].channels[1].kind = Channel::Kind::unused;  // no lamp on B3
  }

  Show show_;
  Rig rig_;
};

TEST_F(FloorTest, TellsWhatHasChangedOnce) {
  ManualClock clock;
  const sim::SimulatedRig simulated(rig_, {}, 1, clock, nullptr);
  Floor floor(show_, rig_);
  const auto changes = floor.look_at(simulated, instant_at(1.5));
  ASSERT_EQ(changes.size(), 5U) << "five lamps, all in NO-GUIDANCE";
  EXPECT_EQ(
      floor.json(changes[4]),
      R"({"t":1.5,"node":"bus1/2","channel":0,"cell":"A3","look":255,"colour":"#FFBF00","brightness":40,"effect":"steady"})");
  EXPECT_TRUE(floor.look_at(simulated, instant_at(2)).empty());
  EXPECT_EQ(floor.json(instant_at(2)),
            R"({"t":2.0,"floor":[{"node":"bus1/1","looks":{"0":255,"1":255,"2":255,"3":255}},)"
            R"({"node":"bus1/2","looks":{"0":255}}]})");
}

TEST_F(FloorTest, UpstageIsAtTheTopAndTwoRowsShareALine) {
  ManualClock clock;
  const sim::SimulatedRig simulated(rig_, {}, 1, clock, nullptr);
  Floor floor(show_, rig_);
  floor.look_at(simulated, kStart);
  const std::string amber = "40;30;0";  // #FFBF00 at 40 of 255
  const std::string none = "28;28;32";
  EXPECT_EQ(floor.picture(kStart, 80), "\x1B[38;2;" + amber + ";48;2;" + amber + "m\u2580\x1B[38;2;" + none + ";48;2;" +
                                           amber + "m\u2580\x1B[0m\n\x1B[38;2;" + amber + ";49m\u2580\x1B[38;2;" +
                                           amber + ";49m\u2580\x1B[0m\n");
}

TEST_F(FloorTest, ANarrowTerminalSeesTheMiddle) {
  Floor floor(show_, rig_);
  const std::string picture = floor.picture(kStart, 1);
  EXPECT_EQ(std::count(picture.begin(), picture.end(), '\n'), 2);
  std::size_t blocks = 0;
  for (std::size_t at = picture.find("\u2580"); at != std::string::npos; at = picture.find("\u2580", at + 1)) ++blocks;
  EXPECT_EQ(blocks, 2U);
}

TEST(EffectLevel, FollowsTheDocument) {
  EXPECT_EQ(effect_level(Effect::steady, instant_at(0.7)), 1);
  EXPECT_EQ(effect_level(Effect::blink, instant_at(3.4)), 1);
  EXPECT_EQ(effect_level(Effect::blink, instant_at(3.6)), 0);
  EXPECT_EQ(effect_level(Effect::double_blink, instant_at(0.1)), 1);
  EXPECT_EQ(effect_level(Effect::double_blink, instant_at(0.3)), 0);
  EXPECT_EQ(effect_level(Effect::double_blink, instant_at(0.5)), 1);
  EXPECT_EQ(effect_level(Effect::double_blink, instant_at(1.1)), 0);
  EXPECT_NEAR(effect_level(Effect::pulse, instant_at(0.5)), 1, 1e-9);
  EXPECT_NEAR(effect_level(Effect::pulse, instant_at(1.5)), 0, 1e-9);
}

}  // namespace
}  // namespace footlight::app
