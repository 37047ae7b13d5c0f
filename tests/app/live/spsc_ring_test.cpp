// SPDX-License-Identifier: Apache-2.0
#include "app/live/spsc_ring.hpp"

#include <thread>

#include <gtest/gtest.h>

namespace footlight::app {
namespace {

TEST(SpscRing, GivesInOrderAndLosesWhatDoesNotFit) {
  SpscRing<int, 4> ring;
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(ring.push(i));
  EXPECT_FALSE(ring.push(4));
  for (int i = 0; i < 4; ++i) EXPECT_EQ(ring.pop(), i);
  EXPECT_EQ(ring.pop(), std::nullopt);
  EXPECT_TRUE(ring.push(5));
  EXPECT_EQ(ring.pop(), 5);
}

TEST(SpscRing, NothingIsTornOrTurnedRoundBetweenTwoThreads) {
  SpscRing<std::pair<int, int>, 64> ring;
  constexpr int kSent = 100'000;
  std::thread writer([&] {
    for (int i = 0; i < kSent; ++i) {
      while (!ring.push({i, -i})) std::this_thread::yield();
    }
  });
  for (int i = 0; i < kSent; ++i) {
    auto value = ring.pop();
    while (!value) {
      std::this_thread::yield();
      value = ring.pop();
    }
    ASSERT_EQ(*value, std::pair(i, -i));
  }
  writer.join();
}

}  // namespace
}  // namespace footlight::app
