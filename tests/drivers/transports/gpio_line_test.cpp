// SPDX-License-Identifier: Apache-2.0
#include "drivers/transports/gpio_line.hpp"

#include <gtest/gtest.h>

#include "core/rng.hpp"

namespace footlight::drivers {
namespace {

TEST(PressLockout, TheFirstEdgeCountsAtOnce) {
  PressLockout button(milliseconds(30));
  EXPECT_FALSE(button.take(false, instant_at(0)));
  EXPECT_TRUE(button.take(true, instant_at(1)));
  EXPECT_FALSE(button.take(true, instant_at(2))) << "held is no second press";
}

TEST(PressLockout, OnePressForAnyBounceUpTo20Milliseconds) {
  Rng rng(9);
  for (int press = 0; press < 1'000; ++press) {
    PressLockout button(milliseconds(30));
    int presses = 0;
    Instant now = instant_at(1);
    const auto bounce = [&] {
      for (Instant end = now + milliseconds(20); now < end; now += microseconds(50)) {
        presses += button.take(rng.below(2) == 0, now) ? 1 : 0;
      }
    };
    bounce();
    for (int ms = 0; ms < 200; ++ms, now += milliseconds(1)) presses += button.take(true, now) ? 1 : 0;
    bounce();
    for (int ms = 0; ms < 200; ++ms, now += milliseconds(1)) presses += button.take(false, now) ? 1 : 0;
    ASSERT_EQ(presses, 1);
  }
}

TEST(PressLockout, CountsAgainAfterRest) {
  PressLockout button(milliseconds(30));
  EXPECT_TRUE(button.take(true, instant_at(1)));
  button.take(false, instant_at(1.1));
  EXPECT_FALSE(button.take(true, instant_at(1.11))) << "not yet at rest for long enough";
  button.take(false, instant_at(1.2));
  button.take(false, instant_at(1.23));
  EXPECT_TRUE(button.take(true, instant_at(1.24)));
}

TEST(GpioLine, AChipThatIsNotThereIsRefusedWithWhatWouldHelp) {
  const auto line = open_gpio("gpiochip99", 5, GpioDirection::output);
  ASSERT_FALSE(line);
  EXPECT_EQ(line.error().kind, ErrorKind::device);
#if FOOTLIGHT_WITH_libgpiod
  EXPECT_EQ(line.error().message,
            "GPIO line 5 of \"gpiochip99\": no such chip: No such file or directory (one that `gpiodetect` lists)");
#else
  EXPECT_EQ(line.error().message,
            "GPIO line 5 of \"gpiochip99\": this program was built without libgpiod (install libgpiod-dev and build "
            "again)");
#endif
}

}  // namespace
}  // namespace footlight::drivers
