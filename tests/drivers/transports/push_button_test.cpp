// SPDX-License-Identifier: Apache-2.0
#include "drivers/transports/push_button.hpp"

#include <deque>

#include <gtest/gtest.h>

#include "core/rng.hpp"

namespace footlight::drivers {
namespace {

using Event = PushButton::Event;

TEST(PushButton, TheFirstEdgeCountsAtOnce) {
  PushButton button(milliseconds(30));
  EXPECT_EQ(button.take(false, instant_at(0)), Event::none);
  EXPECT_EQ(button.take(true, instant_at(1)), Event::pressed);
  EXPECT_EQ(button.take(true, instant_at(2)), Event::none) << "held is no second press";
}

TEST(PushButton, GoBounceIsOnePressForAnyBounceUpTo20Milliseconds) {
  Rng rng(9);
  for (int press = 0; press < 1'000; ++press) {
    PushButton button;
    int presses = 0;
    Instant now = instant_at(1);
    const auto hear = [&](bool down) { presses += button.take(down, now) == Event::pressed ? 1 : 0; };
    const auto bounce = [&] {
      for (Instant end = now + milliseconds(20); now < end; now += microseconds(50)) hear(rng.below(2) == 0);
    };
    bounce();
    for (int ms = 0; ms < 200; ++ms, now += milliseconds(1)) hear(true);
    bounce();
    for (int ms = 0; ms < 200; ++ms, now += milliseconds(1)) hear(false);
    ASSERT_EQ(presses, 1);
  }
}

TEST(PushButton, CountsAgainAfterRest) {
  PushButton button(milliseconds(30));
  EXPECT_EQ(button.take(true, instant_at(1)), Event::pressed);
  button.take(false, instant_at(1.1));
  EXPECT_EQ(button.take(true, instant_at(1.11)), Event::none) << "not yet at rest for long enough";
  button.take(false, instant_at(1.2));
  button.take(false, instant_at(1.23));
  EXPECT_EQ(button.take(true, instant_at(1.24)), Event::pressed);
}

/// What happens while the input is polled every 50 ms, up to and including `until`.
std::vector<Event> poll(PushButton& button, bool down, double from_s, double until_s) {
  std::vector<Event> events;
  for (Instant now = instant_at(from_s); now <= instant_at(until_s); now += PushButton::kPollPeriod) {
    if (const Event event = button.take(down, now); event != Event::none) events.push_back(event);
  }
  return events;
}

TEST(PushButton, AStuckGoIsToldOnceAndIsOffUntilItHasBeenFreeForAsLong) {
  PushButton button;
  EXPECT_EQ(poll(button, true, 10, 15), std::vector{Event::pressed}) << "five seconds may be meant";
  EXPECT_EQ(poll(button, true, 15.05, 60), std::vector{Event::stuck});
  EXPECT_TRUE(button.stuck());
  EXPECT_TRUE(poll(button, false, 60.05, 62).empty());
  EXPECT_TRUE(poll(button, true, 62.05, 62.2).empty()) << "no press of an input that is off";
  EXPECT_TRUE(poll(button, false, 62.25, 67.2).empty());
  EXPECT_EQ(poll(button, false, 67.25, 70), std::vector{Event::freed});
  EXPECT_FALSE(button.stuck());
  EXPECT_EQ(poll(button, true, 70.05, 71), std::vector{Event::pressed});
}

TEST(PushButton, AContactThatChattersWithoutEndIsStuckToo) {
  PushButton button;
  std::vector<Event> events;
  for (Instant now = instant_at(1); now < instant_at(8); now += milliseconds(10)) {
    const bool down = (now.time_since_epoch() / milliseconds(10)) % 2 == 0;
    if (const Event event = button.take(down, now); event != Event::none) events.push_back(event);
  }
  EXPECT_EQ(events, (std::vector{Event::pressed, Event::stuck}));
}

TEST(PushButton, OneInputThatIsStuckLeavesTheOthersAlone) {
  PushButton stuck;
  PushButton other;
  poll(stuck, true, 1, 20);
  EXPECT_TRUE(stuck.stuck());
  EXPECT_EQ(other.take(true, instant_at(20)), Event::pressed);
}

/// A line whose kernel keeps two edges and drops the newest.
class ShortMemory final : public GpioLine {
 public:
  struct Wire {
    bool level = false;
    std::deque<bool> edges;
    bool gone = false;
    void go(bool to) {
      level = to;
      if (edges.size() < 2) edges.push_back(to);
    }
  };
  explicit ShortMemory(Wire& wire) : wire_(wire) {}
  Status<> set(bool /*on*/) override { return Done{}; }
  Result<bool> read() override {
    if (wire_.gone) return device_error("gone");
    return wire_.level;
  }
  Result<std::optional<bool>> take_edge() override {
    if (wire_.edges.empty()) return std::optional<bool>{};
    const bool edge = wire_.edges.front();
    wire_.edges.pop_front();
    return std::optional<bool>(edge);
  }
  [[nodiscard]] int poll_handle() const override { return 5; }

 private:
  Wire& wire_;
};

TEST(ButtonInput, APressThatIsOverBeforeAnybodyLooksCounts) {
  ShortMemory::Wire wire;
  ButtonInput input(std::make_unique<ShortMemory>(wire));
  wire.go(true);
  wire.go(false);
  EXPECT_EQ(input.step(instant_at(1)).value(), Event::pressed);
  EXPECT_EQ(input.step(instant_at(1)).value(), Event::none);
}

TEST(ButtonInput, AnEdgeThatTheKernelDroppedIsFoundByTheLevel) {
  ShortMemory::Wire wire;
  ButtonInput input(std::make_unique<ShortMemory>(wire));
  for (const bool level : {true, false, true, false}) wire.go(level);  // the last two edges are lost
  EXPECT_EQ(input.step(instant_at(1)).value(), Event::pressed);
  EXPECT_EQ(input.step(instant_at(1)).value(), Event::none);
  EXPECT_EQ(input.step(instant_at(1.05)).value(), Event::none) << "at rest, as the level says";
  wire.level = true;  // no edge at all
  EXPECT_EQ(input.step(instant_at(1.1)).value(), Event::pressed);
}

TEST(ButtonInput, ALineThatIsGoneSaysSo) {
  ShortMemory::Wire wire;
  wire.gone = true;
  ButtonInput input(std::make_unique<ShortMemory>(wire));
  EXPECT_EQ(input.step(instant_at(1)).error().message, "gone");
  EXPECT_EQ(input.poll_handle(), 5);
}

}  // namespace
}  // namespace footlight::drivers
