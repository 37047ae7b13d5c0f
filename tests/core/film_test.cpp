// SPDX-License-Identifier: Apache-2.0
#include "core/film.hpp"

#include <bit>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "core/rng.hpp"

namespace footlight {
namespace {

TEST(Mask, IsDarkAtFirst) {
  const Mask mask(130, 3);
  for (const std::uint64_t word : mask.words()) EXPECT_EQ(word, 0U);
  EXPECT_EQ(mask.row_words(), 3);
  EXPECT_EQ(mask.words().size(), 9U);
  EXPECT_FALSE(mask.at(129, 2));
}

TEST(Mask, KnowsExactlyThePixelsThatWereSet) {
  for (const int width : {1, 63, 64, 65, 128, 200}) {
    Rng rng(static_cast<std::uint64_t>(width));
    Mask mask(width, 7);
    std::set<std::pair<int, int>> expected;
    for (int k = 0; k < 100; ++k) {
      const int x = static_cast<int>(rng.below(static_cast<std::uint64_t>(width)));
      const int y = static_cast<int>(rng.below(7));
      mask.set(x, y);
      expected.emplace(x, y);
    }
    std::size_t bits = 0;
    for (const std::uint64_t word : mask.words()) bits += static_cast<std::size_t>(std::popcount(word));
    EXPECT_EQ(bits, expected.size()) << "unused bits stay 0, width " << width;
    for (int y = 0; y < 7; ++y) {
      for (int x = 0; x < width; ++x) ASSERT_EQ(mask.at(x, y), expected.contains({x, y})) << x << ' ' << y;
    }
  }
}

TEST(Mask, KeepsPixelXInBitXModulo64OfItsWord) {
  Mask mask(100, 2);
  mask.set(70, 1);
  EXPECT_EQ(mask.words().at(3), std::uint64_t{1} << 6U);
}

TEST(Mask, EqualsAnotherOfTheSameSizeAndPixels) {
  Mask a(10, 2);
  Mask b(10, 2);
  EXPECT_EQ(a, b);
  a.set(3, 1);
  EXPECT_NE(a, b);
  b.set(3, 1);
  EXPECT_EQ(a, b);
  EXPECT_NE(Mask(10, 2), Mask(20, 1));
}

TEST(MaskDeathTest, APixelBesideThePictureIsAProgrammerError) {
  Mask mask(10, 2);
  EXPECT_DEATH(mask.set(10, 0), "x < width_");
  EXPECT_DEATH(static_cast<void>(mask.at(0, 2)), "y < height_");
  EXPECT_DEATH(static_cast<void>(mask.at(-1, 0)), "x >= 0");
}

}  // namespace
}  // namespace footlight
