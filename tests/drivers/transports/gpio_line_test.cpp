// SPDX-License-Identifier: Apache-2.0
#include "drivers/transports/gpio_line.hpp"

#include <gtest/gtest.h>

namespace footlight::drivers {
namespace {

TEST(GpioLine, AChipThatIsNotThereIsRefusedWithWhatWouldHelp) {
  const auto line = open_gpio("gpiochip99", 5, {});
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

TEST(GpioLine, WhatIsNoChipIsSaid) {
  const auto chip = read_gpio_chip("/dev/null");
  ASSERT_FALSE(chip);
  EXPECT_EQ(chip.error().kind, ErrorKind::device);
#if FOOTLIGHT_WITH_libgpiod
  EXPECT_TRUE(chip.error().message.starts_with("GPIO chip \"/dev/null\": not opened: ")) << chip.error().message;
#else
  EXPECT_EQ(chip.error().message,
            "GPIO chip \"/dev/null\": this program was built without libgpiod (install libgpiod-dev and build again)");
#endif
}

}  // namespace
}  // namespace footlight::drivers
