// SPDX-License-Identifier: Apache-2.0
#include "core/rng.hpp"

#include <array>
#include <set>

#include <gtest/gtest.h>

namespace footlight {
namespace {

TEST(Rng, GivesThePublishedNumbersOfSplitMix64) {
  Rng rng(1234567);
  EXPECT_EQ(rng.next(), 6457827717110365317ULL);
  EXPECT_EQ(rng.next(), 3203168211198807973ULL);
  EXPECT_EQ(rng.next(), 9817491932198370423ULL);
  EXPECT_EQ(rng.next(), 4593380528125082431ULL);
  EXPECT_EQ(rng.next(), 16408922859458223821ULL);
  EXPECT_EQ(Rng(0).next(), 0xE220A8397B1DCDAFULL);
}

TEST(Rng, IsTheSameForTheSameSeed) {
  Rng a(42);
  Rng b(42);
  for (int k = 0; k < 100; ++k) EXPECT_EQ(a.next(), b.next());
  EXPECT_NE(Rng(1).next(), Rng(2).next());
}

TEST(Rng, UniformLiesInTheHalfOpenUnitIntervalAndFillsIt) {
  Rng rng(7);
  std::array<int, 10> tenth{};
  for (int k = 0; k < 100'000; ++k) {
    const double u = rng.uniform();
    ASSERT_GE(u, 0.0);
    ASSERT_LT(u, 1.0);
    ++tenth.at(static_cast<std::size_t>(u * 10));
  }
  for (const int count : tenth) EXPECT_NEAR(count, 10'000, 500);
}

TEST(Rng, BelowReachesEveryNumberUnderItsBound) {
  Rng rng(7);
  std::set<std::uint64_t> seen;
  for (int k = 0; k < 1000; ++k) seen.insert(rng.below(7));
  EXPECT_EQ(seen.size(), 7U);
  EXPECT_EQ(*seen.rbegin(), 6U);
  EXPECT_EQ(rng.below(1), 0U);
}

TEST(Rng, SplitDependsOnSeedAndStreamOnly) {
  const Rng rng(99);
  EXPECT_EQ(rng.split(3).next(), Rng(99).split(3).next());
  std::set<std::uint64_t> firsts;
  for (std::uint64_t stream = 0; stream < 1000; ++stream) firsts.insert(rng.split(stream).next());
  for (std::uint64_t seed = 100; seed < 1100; ++seed) firsts.insert(Rng(seed).split(0).next());
  EXPECT_EQ(firsts.size(), 2000U);
}

TEST(RngDeathTest, NothingIsBelowZero) { EXPECT_DEATH(Rng(1).below(0), "bound > 0"); }

}  // namespace
}  // namespace footlight
