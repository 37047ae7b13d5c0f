// SPDX-License-Identifier: Apache-2.0
#include "planner/formation/sampling.hpp"

#include <bit>
#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "tests/support/films.hpp"

namespace footlight::planner {
namespace {

const TempoMap kTempo(120);  // two counts a second

Film still_film(int frames) {
  return tests::film_of(frames, [](int) { return tests::disc(64, 64, 20, 20, 10); });
}

TEST(AverageHash, BlankAndFullPicturesHaveNoBits) {
  EXPECT_EQ(average_hash(Mask(64, 64)), 0U);
  EXPECT_EQ(average_hash(tests::mask_where(64, 64, [](int, int) { return true; })), 0U);
}

TEST(AverageHash, OneBitForEachBlockAboveTheMean) {
  // Left half white: blocks 0..3 of each of the eight rows.
  EXPECT_EQ(average_hash(tests::mask_where(640, 480, [](int x, int) { return x < 320; })), 0x0F0F0F0F0F0F0F0FULL);
}

TEST(AverageHash, SizesThatEightDoesNotDivideAreCoveredOnce) {
  EXPECT_EQ(std::popcount(average_hash(tests::mask_where(101, 67, [](int x, int y) { return x < 3 && y < 3; }))), 1);
}

TEST(Sample, StillFilmHasAKeyFrameAtEachInterval) {
  const Film film = still_film(101);  // stretched to 10 s of show: 10 frames a second
  const auto keys = sample(film, {1, 20, &kTempo}, {milliseconds(2500), 0.1, true}, 0.5);
  ASSERT_EQ(keys.size(), 5U);
  for (std::size_t k = 0; k < keys.size(); ++k) {
    EXPECT_DOUBLE_EQ(keys[k].count, 1 + 5.0 * static_cast<double>(k));
    EXPECT_EQ(keys[k].frame, 25 * static_cast<int>(k));
  }
}

TEST(Sample, ChangeOfThePictureMakesAKeyFrameAtOnce) {
  const Film film = tests::film_of(
      101, [](int f) { return tests::mask_where(64, 64, [=](int x, int) { return f < 37 ? x < 32 : x >= 32; }); });
  const auto keys = sample(film, {1, 20, &kTempo}, {milliseconds(9000), 0.1, false}, 0.5);
  ASSERT_EQ(keys.size(), 3U);
  EXPECT_EQ(keys[1].frame, 37);
  EXPECT_EQ(keys[1].time, instant_at(3.7));
}

TEST(Sample, SnappedKeyFrameShowsWhatTheFilmShowsOnThatCount) {
  const Film film = tests::film_of(
      101, [](int f) { return tests::mask_where(64, 64, [=](int x, int) { return f < 37 ? x < 32 : x >= 32; }); });
  const auto keys = sample(film, {1, 20, &kTempo}, {milliseconds(9000), 0.1, true}, 0.5);
  ASSERT_EQ(keys.size(), 3U);
  EXPECT_DOUBLE_EQ(keys[1].count, 9);  // 3.7 s is count 8.4, which still shows the picture before
  EXPECT_EQ(keys[1].frame, 40);
}

TEST(Sample, FirstAndLastFrameAreKeyFramesWithTimeToWalkBetween) {
  EXPECT_TRUE(rc::check([] {
    const int frames = *rc::gen::inRange(2, 80);
    const double counts = *rc::gen::inRange(1, 90);
    const double shortest_s = *rc::gen::inRange(0, 40) / 10.0;
    const bool snap = *rc::gen::arbitrary<bool>();
    const int period = *rc::gen::inRange(1, 9);
    const Film film = tests::film_of(frames, [=](int f) {
      return tests::mask_where(16, 16, [=](int x, int) { return (f / period) % 2 == 0 ? x < 8 : x >= 8; });
    });
    const auto keys = sample(film, {3, counts, &kTempo}, {milliseconds(3200), 0.1, snap}, shortest_s);
    RC_ASSERT(keys.front() == (KeyFrame{0, 3, kTempo.at(3)}));
    RC_ASSERT(keys.back() == (KeyFrame{frames - 1, 3 + counts, kTempo.at(3 + counts)}));
    for (std::size_t k = 1; k < keys.size(); ++k) {
      RC_ASSERT(keys[k].time > keys[k - 1].time);
      if (keys.size() > 2) RC_ASSERT(to_seconds(keys[k].time - keys[k - 1].time) >= std::min(shortest_s, 3.2) - 1e-9);
      if (snap && k + 1 < keys.size()) RC_ASSERT(keys[k].count == std::round(keys[k].count));
    }
  }));
}

}  // namespace
}  // namespace footlight::planner
