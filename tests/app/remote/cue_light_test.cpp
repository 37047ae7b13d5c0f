// SPDX-License-Identifier: Apache-2.0
#include "app/remote/cue_light.hpp"

#include <gtest/gtest.h>

namespace footlight::app {
namespace {

using Lamps = CueLight::Lamps;

/// Times at which a lamp goes on, within a second, a second after `from_s`.
int flashes_per_second(CueLight& light, bool Lamps::*lamp, double from_s) {
  int flashes = 0;
  bool before = light.lamps(instant_at(from_s + 1 - 0.001)).*lamp;
  for (int ms = 0; ms < 1000; ++ms) {
    const bool now = light.lamps(instant_at(from_s + 1 + ms / 1000.0)).*lamp;
    flashes += now && !before ? 1 : 0;
    before = now;
  }
  return flashes;
}

TEST(CueLight, RedFlashesForStandbyIsSteadyWhenAcknowledgedAndGreenMeansGo) {
  CueLight light;
  EXPECT_EQ(light.lamps(instant_at(1)), Lamps{});
  EXPECT_FALSE(light.acknowledge()) << "nobody has said standby";
  light.standby(instant_at(2));
  EXPECT_EQ(light.lamps(instant_at(2)), (Lamps{true, false}));
  EXPECT_EQ(light.lamps(instant_at(2.6)), (Lamps{false, false}));
  EXPECT_TRUE(light.acknowledge());
  for (int ms = 0; ms < 3000; ms += 10) ASSERT_EQ(light.lamps(instant_at(3 + ms / 1e3)), (Lamps{true, false}));
  light.go(instant_at(6));
  EXPECT_EQ(light.lamps(instant_at(6)), (Lamps{false, true}));
  EXPECT_EQ(light.lamps(instant_at(10)), Lamps{}) << "then off";
}

TEST(CueLight, EachStateHasAPatternOfItsOwnForThoseWhoCannotTellRedFromGreen) {
  CueLight light;
  light.standby(instant_at(1));
  EXPECT_EQ(flashes_per_second(light, &Lamps::red, 1), 1);
  light.go(instant_at(5));
  EXPECT_EQ(flashes_per_second(light, &Lamps::green, 5), 2);
}

TEST(CueLight, NothingFlashesMoreThanThreeTimesASecond) {
  CueLight light;
  light.go(instant_at(5));
  Instant on = Instant::min();
  bool before = false;
  for (int ms = 0; ms < 5000; ++ms) {
    const Instant now = instant_at(5 + ms / 1000.0);
    const bool lit = light.lamps(now).green;
    if (lit && !before) {
      EXPECT_TRUE(on == Instant::min() || now - on >= milliseconds(334)) << ms;
      on = now;
    }
    before = lit;
  }
}

TEST(CueLight, OffIsOff) {
  CueLight light;
  light.standby(instant_at(1));
  light.off();
  EXPECT_EQ(light.lamps(instant_at(1)), Lamps{});
}

}  // namespace
}  // namespace footlight::app
