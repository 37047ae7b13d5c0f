// SPDX-License-Identifier: Apache-2.0
#include "core/tempo_map.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"

namespace footlight {
namespace {

TempoMap changing() { return *TempoMap::from({{1, 120}, {9, 60}, {11, 240}}, 4); }

TEST(TempoMap, PutsCountOneAtTimeZero) {
  EXPECT_EQ(TempoMap(120).at(1), kStart);
  EXPECT_EQ(changing().at(1), kStart);
}

TEST(TempoMap, PutsCountNAtNMinusOneBeats) {
  EXPECT_EQ(TempoMap(120).at(5), instant_at(2));
  EXPECT_EQ(TempoMap(90).at(2), instant_at(2.0 / 3));
  EXPECT_EQ(TempoMap(120).at(1.5), instant_at(0.25));
}

TEST(TempoMap, GoesOnBeforeCountOneWithTheFirstTempo) {
  EXPECT_EQ(changing().at(-1), instant_at(-1));
  EXPECT_DOUBLE_EQ(changing().count_at(instant_at(-1)), -1);
  EXPECT_EQ(changing().bpm_at(-100), 120);
}

TEST(TempoMap, AddsUpStretchesOfDifferentTempo) {
  const TempoMap map = changing();
  EXPECT_EQ(map.at(9), instant_at(4));
  EXPECT_EQ(map.at(10), instant_at(5));
  EXPECT_EQ(map.at(11), instant_at(6));
  EXPECT_EQ(map.at(15), instant_at(7));
}

TEST(TempoMap, HasTheNewTempoFromItsCountOn) {
  const TempoMap map = changing();
  EXPECT_EQ(map.bpm_at(8.999), 120);
  EXPECT_EQ(map.bpm_at(9), 60);
  EXPECT_EQ(map.bpm_at(11), 240);
  EXPECT_EQ(map.bpm_at(1e6), 240);
}

TEST(TempoMap, SpansAreTimesBetweenCounts) {
  EXPECT_EQ(changing().span(7, 4), seconds(1 + 2));
  EXPECT_EQ(changing().span(11, 0), Duration(0));
}

TEST(TempoMap, RoundsToTheNearestNanosecond) {
  EXPECT_EQ(TempoMap(90).at(2).time_since_epoch(), Duration(666'666'667));
  EXPECT_EQ(TempoMap(70).at(2).time_since_epoch(), Duration(857'142'857));
}

TEST(TempoMapProperty, CountOfATimeOfACountIsTheCount) {
  const bool held = rc::check([](std::uint64_t seed) {
    Rng rng(seed);
    std::vector<TempoChange> changes{{1, 1 + 299 * rng.uniform()}};
    for (std::uint64_t k = rng.below(6); k > 0; --k) {
      changes.push_back({changes.back().count + 0.5 + 20 * rng.uniform(), 30 + 299 * rng.uniform()});
    }
    const TempoMap map = *TempoMap::from(changes, 3);
    const double count = -5 + 200 * rng.uniform();
    RC_ASSERT(std::abs(map.count_at(map.at(count)) - count) < 1e-7);
    RC_ASSERT(map.at(count) < map.at(count + 1e-3));
  });
  EXPECT_TRUE(held);
}

TEST(TempoMap, TellsMeasureAndBeatFromOne) {
  const TempoMap map(120, 4);
  EXPECT_EQ(map.measure_beat(1), "1:1");
  EXPECT_EQ(map.measure_beat(4), "1:4");
  EXPECT_EQ(map.measure_beat(5), "2:1");
  EXPECT_EQ(map.measure_beat(67), "17:3");
  EXPECT_EQ(map.measure_beat(67.5), "17:3.5");
  EXPECT_EQ(map.measure_beat(0), "0:4");
  EXPECT_EQ(TempoMap(120, 3).measure_beat(4), "2:1");
}

TEST(TempoMap, NeverTellsABeatThatTheMeasureHasNot) {
  // Counts that come from times may lie a rounding below a whole count.
  EXPECT_EQ(TempoMap(120, 4).measure_beat(5 - 1e-10), "2:1");
  EXPECT_EQ(TempoMap(120, 4).measure_beat(3 - 1e-10), "1:3");
}

TEST(TempoMap, CountsAPickUpAsTheEndOfMeasureZero) {
  const TempoMap map = *TempoMap::from({{1, 120}}, 4, 1);
  EXPECT_EQ(map.measure_beat(1), "0:4");
  EXPECT_EQ(map.measure_beat(2), "1:1");
  EXPECT_EQ(map.measure_beat(6), "2:1");
  EXPECT_EQ(map.pickup_counts(), 1);
  EXPECT_EQ(map.at(2), instant_at(0.5)) << "measures are for print alone";
}

TEST(TempoMap, NumbersMeasuresOnThroughChangesOfMeter) {
  TempoMap map = *TempoMap::from({{1, 120}}, 4, 2);
  ASSERT_TRUE(map.change_meter(11, 3));
  ASSERT_TRUE(map.change_meter(17, 5));
  EXPECT_EQ(map.measure_beat(10), "2:4");
  EXPECT_EQ(map.measure_beat(11), "3:1");
  EXPECT_EQ(map.measure_beat(16), "4:3");
  EXPECT_EQ(map.measure_beat(17), "5:1");
  EXPECT_EQ(map.measure_beat(17 - 1e-10), "5:1");
  EXPECT_EQ(map.measure_beat(22.5), "6:1.5");
  EXPECT_EQ(map.change_meter(23, 4).error(), input_error("no measure begins here; the next one does at count 27"));
  EXPECT_EQ(map.change_meter(17, 4).error(), input_error("the counts of meter changes increase"));
}

TEST(TempoMap, RefusesWhatIsNoTempoMap) {
  EXPECT_EQ(TempoMap::from({{1, 120}}, 4, 4).error(), input_error("a pick-up is shorter than a measure"));

  const auto message = [](std::vector<TempoChange> changes, int beats) {
    return TempoMap::from(std::move(changes), beats).error();
  };
  EXPECT_EQ(message({{1, 120}}, 0), input_error("a measure has at least one beat"));
  EXPECT_EQ(message({}, 4), input_error("the first tempo begins at count 1"));
  EXPECT_EQ(message({{2, 120}}, 4), input_error("the first tempo begins at count 1"));
  EXPECT_EQ(message({{1, 0.5}}, 4), input_error("a tempo lies between 1 and 1000 counts a minute"));
  EXPECT_EQ(message({{1, 120}, {5, 1001}}, 4), input_error("a tempo lies between 1 and 1000 counts a minute"));
  EXPECT_EQ(message({{1, std::nan("")}}, 4), input_error("a tempo lies between 1 and 1000 counts a minute"));
  EXPECT_EQ(message({{1, 120}, {5, 90}, {5, 80}}, 4), input_error("the counts of tempo changes increase"));
  EXPECT_EQ(message({{1, 120}, {std::nan(""), 90}}, 4), input_error("the counts of tempo changes increase"));
}

TEST(TempoMap, WholeCountsComeBackWhole) {
  const auto map = TempoMap::from({{1, 97}, {33, 113}, {101, 131}}, 4);
  ASSERT_TRUE(map);
  for (int count = 1; count < 2000; ++count) EXPECT_EQ(map->count_at(map->at(count)), count);
  EXPECT_EQ(map->count_at(map->at(17.25)), 17.25);
}

TEST(TempoMapDeathTest, ATempoOfZeroIsAProgrammerError) { EXPECT_DEATH(TempoMap(0.0), "bpm > 0"); }

}  // namespace
}  // namespace footlight
