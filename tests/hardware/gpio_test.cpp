// SPDX-License-Identifier: Apache-2.0
// libgpiod on the kernel's own GPIO simulator: edges, levels and outputs as those of any chip.
#include <gtest/gtest.h>
#include <poll.h>

#include "app/remote/panel_surface.hpp"
#include "core/clock.hpp"
#include "drivers/transports/gpio_line.hpp"
#include "drivers/transports/push_button.hpp"
#include "tests/hardware/gpio_chip.hpp"
#include "tests/hardware/guest.hpp"
#include "tests/support/small_show.hpp"

namespace footlight::hardware {
namespace {

using drivers::ButtonInput;
using drivers::GpioLine;
using drivers::GpioSettings;
using drivers::open_gpio;
using Event = drivers::PushButton::Event;

constexpr GpioSettings kInput{.direction = GpioSettings::Direction::input};

class GpioSim : public ::testing::Test {
 protected:
  std::unique_ptr<GpioLine> open(unsigned line, const GpioSettings& settings) {
    auto opened = open_gpio(chip_.name(), line, settings);
    EXPECT_TRUE(opened) << opened.error().message;
    return std::move(opened).value();
  }
  /// What a button tells until nothing more has happened.
  static std::vector<Event> all(ButtonInput& button, Instant now) {
    std::vector<Event> events;
    for (auto event = button.step(now); event && *event != Event::none; event = button.step(now)) {
      events.push_back(*event);
    }
    return events;
  }
  static bool readable(int file) {
    pollfd wanted{file, POLLIN, 0};
    return ::poll(&wanted, 1, 0) > 0;
  }

  GpioChip chip_;
};

TEST_F(GpioSim, AnOutputBeginsOffAndIsWhatItIsSetTo) {
  const auto cue_light = open(3, {});
  EXPECT_FALSE(chip_.value(3));
  ASSERT_TRUE(cue_light->set(true));
  EXPECT_TRUE(chip_.value(3));
  ASSERT_TRUE(cue_light->set(false));
  EXPECT_FALSE(chip_.value(3));
  EXPECT_EQ(cue_light->poll_handle(), -1);
}

TEST_F(GpioSim, WhatIsActiveLowIsOnWhenItIsLow) {
  const auto tally = open(4, {.active_low = true});
  EXPECT_TRUE(chip_.value(4)) << "off";
  ASSERT_TRUE(tally->set(true));
  EXPECT_FALSE(chip_.value(4));
  chip_.pull(5, true);
  const auto input = open(5, {.direction = GpioSettings::Direction::input, .active_low = true});
  EXPECT_FALSE(input->read().value());
  chip_.pull(5, false);
  EXPECT_TRUE(input->read().value());
}

TEST_F(GpioSim, AnEdgeMakesTheHandleReadableAndAPressIsToldOnce) {
  chip_.pull(0, false);
  ButtonInput go(open(0, kInput));
  EXPECT_FALSE(readable(go.poll_handle()));
  EXPECT_TRUE(all(go, instant_at(1)).empty());
  for (const bool bounce : {true, false, true, false, true}) chip_.pull(0, bounce);
  EXPECT_TRUE(readable(go.poll_handle()));
  EXPECT_EQ(all(go, instant_at(1.001)), std::vector{Event::pressed});
  EXPECT_FALSE(readable(go.poll_handle()));
}

TEST_F(GpioSim, APressBetweenTwoLooksIsNotMissed) {
  chip_.pull(0, false);
  ButtonInput go(open(0, kInput));
  chip_.pull(0, true);
  chip_.pull(0, false);
  EXPECT_EQ(all(go, instant_at(1)), std::vector{Event::pressed});
}

TEST_F(GpioSim, MoreEdgesThanTheKernelKeepsEndAtTheLevelThatIs) {
  chip_.pull(0, false);
  ButtonInput go(open(0, kInput));
  for (int i = 0; i < 40; ++i) chip_.pull(0, i % 2 == 0);  // the last one is down to up to down
  EXPECT_EQ(all(go, instant_at(1)), std::vector{Event::pressed});
  for (double now_s = 1.05; now_s < 1.2; now_s += 0.05) EXPECT_TRUE(all(go, instant_at(now_s)).empty());
  chip_.pull(0, true);
  EXPECT_EQ(all(go, instant_at(1.3)), std::vector{Event::pressed})
      << "it has been at rest, though that edge was dropped";
}

TEST_F(GpioSim, AStuckGoIsOffAndTheOtherInputsLive) {
  chip_.pull(0, false);
  chip_.pull(1, false);
  ButtonInput stuck(open(0, kInput));
  ButtonInput other(open(1, kInput));
  chip_.pull(0, true);
  EXPECT_EQ(all(stuck, instant_at(1)), std::vector{Event::pressed});
  EXPECT_EQ(all(stuck, instant_at(6.05)), std::vector{Event::stuck});
  EXPECT_TRUE(stuck.stuck());
  chip_.pull(1, true);
  EXPECT_EQ(all(other, instant_at(6.1)), std::vector{Event::pressed});
}

TEST_F(GpioSim, ALineThatSomebodyUsesIsRefusedAndSoIsOneThatIsNotThere) {
  const auto first = open(2, {});
  const auto second = open_gpio(chip_.name(), 2, {});
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().message, "GPIO line 2 of \"" + chip_.name() +
                                        "\": not given to us: Device or resource busy (a line that nobody uses, see "
                                        "`gpioinfo`)");
  EXPECT_EQ(open_gpio(chip_.name(), 8, {}).error().message,
            "GPIO line 8 of \"" + chip_.name() + "\": no such line (0..7)");
}

/// The panel of a run: GO on line 0, a spotter's hold on 1, a gate on 2, a cue light on 3 and 4.
TEST_F(GpioSim, ThePanelOfARunIsThatOfTheChip) {
  using Does = config::RemoteButton::Does;
  for (const unsigned line : {0U, 1U, 2U}) chip_.pull(line, false);
  const auto place = [&](unsigned line) { return config::GpioPlace{chip_.name(), line, false, {}}; };
  config::Remote remote;
  remote.buttons = {{"GO", Does::go, "", "", {place(0), {}}}, {"left", Does::hold, "", "", {place(1), {}}}};
  remote.gates = {{0, {place(2), {}}}};
  remote.cue_lights = {{"flies", place(3), place(4)}};
  ManualClock clock;
  app::Interlocks interlocks({"trap"}, remote, clock.now());
  app::Panel panel(remote, interlocks);
  const tests::SmallShow small = tests::random_show(6, 6, 4, 3, 2, 1);
  app::RunDesk desk(small.show, small.plan);
  auto opened = app::PanelSurface::open(remote, interlocks, panel, clock, true,
                                        [](const config::GpioPlace& at, const GpioSettings& settings) {
                                          return open_gpio(at.chip, at.offset, settings);
                                        });
  ASSERT_TRUE(opened) << opened.error().message;
  desk.add(**opened);
  const auto look = [&] {
    clock.advance(milliseconds(50));
    return desk.look(app::DeskView{});
  };
  EXPECT_EQ(look().bars, 1U) << "the gate is open";
  EXPECT_FALSE(readable((*opened)->file()));
  for (const bool bounce : {true, false, true, false, true}) chip_.pull(0, bounce);
  EXPECT_TRUE(readable((*opened)->file())) << "an edge wakes the desk";
  EXPECT_EQ(look().commands.size(), 1U);
  chip_.pull(1, true);
  chip_.pull(1, false);
  EXPECT_NE(look().bars & controller::kHoldPressed, 0U) << "over before anybody looked";
  chip_.pull(2, true);
  for (int i = 0; i < 4; ++i) (void)look();
  EXPECT_EQ(look().bars, 0U);
  ASSERT_TRUE(panel.standby({}));
  (void)look();
  EXPECT_TRUE(chip_.value(3));
  EXPECT_FALSE(chip_.value(4));
}

}  // namespace
}  // namespace footlight::hardware
