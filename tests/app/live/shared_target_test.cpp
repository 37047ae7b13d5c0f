// SPDX-License-Identifier: Apache-2.0
#include "app/live/shared_target.hpp"

#include <thread>

#include <gtest/gtest.h>

namespace footlight::app {
namespace {

controller::BusTarget target_of(std::size_t i) {
  return {i, i + 1, instant_at(static_cast<double>(i) + 2), seconds(static_cast<double>(i) + 3)};
}

TEST(SharedTarget, GivesWhatWasToldLast) {
  SharedTarget shared;
  shared.publish(target_of(7), instant_at(4));
  EXPECT_EQ(shared.read().target, target_of(7));
  EXPECT_EQ(shared.read().at, instant_at(4));
}

TEST(SharedTarget, AReaderNeverSeesHalfOfTwoTargetsNorAnOlderOne) {
  SharedTarget shared;
  shared.publish(target_of(0), instant_at(0));
  constexpr std::size_t kTold = 20'000;
  std::thread writer([&] {
    for (std::size_t i = 1; i <= kTold; ++i) shared.publish(target_of(i), instant_at(static_cast<double>(i)));
  });
  std::size_t last = 0;
  while (last < kTold) {
    const SharedTarget::Told told = shared.read();
    const std::size_t i = told.target.current;
    ASSERT_GE(i, last);
    ASSERT_EQ(told.target, target_of(i));
    ASSERT_EQ(told.at, instant_at(static_cast<double>(i)));
    last = i;
  }
  writer.join();
}

}  // namespace
}  // namespace footlight::app
