// SPDX-License-Identifier: Apache-2.0
#include "app/remote/flood_guard.hpp"

#include <string>

#include <gtest/gtest.h>

namespace footlight::app {
namespace {

TEST(FloodGuard, OneClientsFloodCostsAnotherOneNothing) {
  FloodGuard guard;
  int carried_out = 0;
  for (int i = 0; i < 1000; ++i) carried_out += guard.take("loud", instant_at(1)) ? 1 : 0;
  EXPECT_EQ(carried_out, FloodGuard::kMost);
  EXPECT_TRUE(guard.full("loud", instant_at(1)));
  EXPECT_FALSE(guard.full("quiet", instant_at(1)));
  EXPECT_TRUE(guard.take("quiet", instant_at(1)));
  EXPECT_EQ(guard.lost(), 1000U - FloodGuard::kMost);
  EXPECT_EQ(guard.lost(), 0U);
}

TEST(FloodGuard, AllTogetherNeverFillTheCueThreadsRing) {
  FloodGuard guard;
  int carried_out = 0;
  for (int i = 0; i < 1000; ++i) carried_out += guard.take(std::to_string(i % 10), instant_at(1)) ? 1 : 0;
  EXPECT_EQ(carried_out, FloodGuard::kMostOfAll);
}

TEST(FloodGuard, AWindowLaterItHearsEverybodyAgain) {
  FloodGuard guard;
  for (int i = 0; i < 100; ++i) (void)guard.take("loud", instant_at(1));
  EXPECT_TRUE(guard.floods(instant_at(1)));
  EXPECT_FALSE(guard.take("loud", instant_at(1) + FloodGuard::kWindow - Duration(1)));
  EXPECT_TRUE(guard.take("loud", instant_at(1) + FloodGuard::kWindow));
  EXPECT_FALSE(guard.floods(instant_at(1) + 2 * FloodGuard::kWindow));
}

TEST(FloodGuard, AHoldIsCarriedOutWhateverElseWas) {
  FloodGuard guard;
  guard.begin_look();
  for (int i = 0; i < 100; ++i) (void)guard.take("loud", instant_at(1));
  EXPECT_TRUE(guard.take_hold(instant_at(1)));
  EXPECT_FALSE(guard.take_hold(instant_at(1))) << "the same again";
  EXPECT_FALSE(guard.take("loud", instant_at(1)));
  EXPECT_FALSE(guard.take_hold(instant_at(1))) << "what was lost has changed nothing";
  EXPECT_TRUE(guard.take("quiet", instant_at(1)));
  EXPECT_TRUE(guard.take_hold(instant_at(1)));
  guard.begin_look();
  EXPECT_TRUE(guard.take_hold(instant_at(1))) << "somebody else may have said GO meanwhile";
}

}  // namespace
}  // namespace footlight::app
