// SPDX-License-Identifier: Apache-2.0
#include "controller/lateness.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

namespace footlight::controller {
namespace {

TEST(Lateness, WithoutASampleEverythingIsZero) {
  const Lateness lateness;
  EXPECT_EQ(lateness.count(), 0U);
  EXPECT_EQ(lateness.quantile(0.99), Duration{});
}

TEST(Lateness, WhatIsEarlyCountsAsOnTime) {
  Lateness lateness;
  lateness.add(milliseconds(-5));
  EXPECT_EQ(lateness.count(), 1U);
  EXPECT_EQ(lateness.worst(), Duration{});
  EXPECT_EQ(lateness.quantile(1), Duration{});
}

TEST(Lateness, AQuantileIsAtMostAnEighthAboveTheTrueOneAndNeverBelow) {
  EXPECT_TRUE(rc::check([](const std::vector<std::uint32_t>& raw) {
    RC_PRE(!raw.empty());
    Lateness lateness;
    std::vector<Duration> all;
    for (const std::uint32_t value : raw) {
      all.push_back(Duration(value % 100'000'000));
      lateness.add(all.back());
    }
    std::sort(all.begin(), all.end());
    for (const double share : {0.1, 0.5, 0.99, 1.0}) {
      const auto rank = static_cast<std::size_t>(std::max(1.0, std::ceil(share * static_cast<double>(all.size()))));
      const Duration truth = all[rank - 1];
      RC_ASSERT(lateness.quantile(share) >= truth);
      RC_ASSERT(lateness.quantile(share) <= truth + truth / 8 + microseconds(1));
    }
    RC_ASSERT(lateness.quantile(1) == all.back());
  }));
}

TEST(Lateness, SumsOfTwoAreThoseOfBoth) {
  Lateness a;
  Lateness b;
  a.add(milliseconds(1));
  b.add(milliseconds(9));
  a.add(b);
  EXPECT_EQ(a.count(), 2U);
  EXPECT_EQ(a.worst(), milliseconds(9));
}

TEST(Lateness, HoursFallIntoTheLastBucket) {
  Lateness lateness;
  lateness.add(std::chrono::hours(5));
  EXPECT_GT(lateness.quantile(0.5), std::chrono::seconds(60));
}

}  // namespace
}  // namespace footlight::controller
