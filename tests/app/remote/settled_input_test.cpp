// SPDX-License-Identifier: Apache-2.0
#include "app/remote/settled_input.hpp"

#include <gtest/gtest.h>

#include "tests/app/remote/fake_line.hpp"

namespace footlight::app {
namespace {

TEST(SettledInput, AHoldCountsAtOnceAndIsOutAfterARest) {
  FakeLine::Wire wire;
  SettledInput hold(std::make_unique<FakeLine>(wire), true, false);
  EXPECT_FALSE(hold.step(instant_at(1)).value());
  wire.go(true);
  EXPECT_TRUE(hold.step(instant_at(1.01)).value());
  wire.go(false);
  EXPECT_TRUE(hold.step(instant_at(2)).value());
  wire.go(true);  // it bounces
  wire.go(false);
  EXPECT_TRUE(hold.step(instant_at(2.09)).value());
  EXPECT_TRUE(hold.step(instant_at(2.18)).value());
  EXPECT_FALSE(hold.step(instant_at(2.2)).value());
}

TEST(SettledInput, AHoldThatWasOverBeforeAnybodyLookedCounts) {
  FakeLine::Wire wire;
  SettledInput hold(std::make_unique<FakeLine>(wire), true, false);
  wire.go(true);
  wire.go(false);
  EXPECT_TRUE(hold.step(instant_at(1)).value());
}

TEST(SettledInput, AGateIsOpenAtOnceAndClosedAfterARest) {
  FakeLine::Wire wire;
  wire.level = true;
  SettledInput gate(std::make_unique<FakeLine>(wire), false, false);
  EXPECT_FALSE(gate.step(instant_at(1)).value()) << "it has not rested";
  EXPECT_TRUE(gate.step(instant_at(1.1)).value());
  wire.level = false;  // and no edge of it
  EXPECT_FALSE(gate.step(instant_at(1.2)).value());
}

TEST(SettledInput, ALineThatIsGoneSaysSo) {
  FakeLine::Wire wire;
  wire.gone = true;
  SettledInput gate(std::make_unique<FakeLine>(wire), false, false);
  EXPECT_EQ(gate.step(instant_at(1)).error().message, "gone");
}

}  // namespace
}  // namespace footlight::app
