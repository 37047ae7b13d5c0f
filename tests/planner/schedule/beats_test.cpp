// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/beats.hpp"

#include <gtest/gtest.h>

namespace footlight::planner {
namespace {

TEST(Beats, AreTheWholeCountsBetweenTwoInstants) {
  const TempoMap tempo(120);
  const Beats beats = beats_between(tempo, tempo.at(1.4), tempo.at(5.9), 0.5);
  EXPECT_EQ(beats.at, (std::vector<Instant>{tempo.at(2), tempo.at(3), tempo.at(4), tempo.at(5)}));
  EXPECT_EQ(beats.counts, 1);
  EXPECT_EQ(beats.steps(), 3);
  EXPECT_DOUBLE_EQ(beats.step_s, 0.5);
}

TEST(Beats, BothEndsMayBeBeats) {
  const TempoMap tempo(97);
  EXPECT_EQ(beats_between(tempo, tempo.at(3), tempo.at(9), 0.3).steps(), 6);
}

TEST(Beats, AStepTakesAsManyCountsAsItMust) {
  const TempoMap tempo(120);
  const Beats beats = beats_between(tempo, tempo.at(1), tempo.at(8), 1.0 / 1.4);
  EXPECT_EQ(beats.counts, 2);
  EXPECT_EQ(beats.steps(), 3);
  EXPECT_EQ(beats.at.back(), tempo.at(7));
}

TEST(Beats, TheFastestTempoBetweenDecides) {
  const TempoMap tempo = *TempoMap::from({{1, 60}, {9, 120}, {17, 240}}, 4);
  EXPECT_EQ(beats_between(tempo, tempo.at(1), tempo.at(9), 0.75).counts, 1);
  EXPECT_EQ(beats_between(tempo, tempo.at(1), tempo.at(10), 0.75).counts, 2);
  EXPECT_EQ(beats_between(tempo, tempo.at(1), tempo.at(20), 0.75).counts, 3);
}

TEST(Beats, ThereIsNoStepBetweenTwoCounts) {
  const TempoMap tempo(60);
  EXPECT_EQ(beats_between(tempo, tempo.at(1.2), tempo.at(1.8), 0.5).steps(), 0);
  EXPECT_EQ(beats_between(tempo, tempo.at(1.2), tempo.at(2.8), 0.5).steps(), 0);
}

}  // namespace
}  // namespace footlight::planner
