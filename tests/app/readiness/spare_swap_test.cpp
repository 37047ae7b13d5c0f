// SPDX-License-Identifier: Apache-2.0
#include "app/readiness/spare_swap.hpp"

#include <gtest/gtest.h>

namespace footlight::app {
namespace {

using Step = SpareSwap::Step;

TEST(SpareSwap, GoesFromUnpluggingToAnAnswerOfTheSpare) {
  SpareSwap swap("left-3", 3, "left");
  EXPECT_EQ(swap.text(), "swap left-3, 1 of 2: unplug it from bus left. The others go on.");
  EXPECT_FALSE(swap.look(false, true)) << "it is still there";
  EXPECT_TRUE(swap.look(true, false));
  EXPECT_EQ(swap.text(),
            "swap left-3, 2 of 2: give the spare address 3 (`footlight devices set-address`, on a port that is not of "
            "this show), then plug it into bus left in its place.");
  EXPECT_FALSE(swap.look(true, false));
  EXPECT_FALSE(swap.look(false, false)) << "it answers and does not show yet what it should";
  EXPECT_TRUE(swap.look(false, true));
  EXPECT_EQ(swap.step(), Step::done);
  EXPECT_TRUE(swap.over());
  EXPECT_EQ(swap.text(), "swap left-3: the spare answers at address 3 and shows what it should.");
}

TEST(SpareSwap, ADeadNodeIsUnpluggedAlready) {
  SpareSwap swap("left-3", 3, "left");
  EXPECT_TRUE(swap.look(true, false));
  EXPECT_EQ(swap.step(), Step::plug_in);
}

TEST(SpareSwap, CanBeGivenUp) {
  SpareSwap swap("left-3", 3, "left");
  swap.give_up();
  EXPECT_TRUE(swap.over());
  EXPECT_FALSE(swap.look(true, false));
}

}  // namespace
}  // namespace footlight::app
