// SPDX-License-Identifier: Apache-2.0
#include "controller/cue_list.hpp"

#include <gtest/gtest.h>

#include "tests/support/small_show.hpp"

namespace footlight::controller {
namespace {

using tests::cue_of;
using tests::random_show;
using tests::SmallShow;

// Three sections of 4 s, walks of 4 s between them: [0, 4], [8, 12], [16, 20].
SmallShow three_sections() { return random_show(6, 6, 4, 3, 2, 1); }

TEST(CueList, TheWalkIntoASectionBelongsToItsOwnCue) {
  const SmallShow small = three_sections();
  const auto plays = cue_plays(small.show, small.plan);
  ASSERT_EQ(plays.size(), 3U);
  EXPECT_EQ(plays[0].from, instant_at(0));
  EXPECT_EQ(plays[0].to, instant_at(4));
  EXPECT_EQ(plays[1].from, instant_at(4));
  EXPECT_EQ(plays[1].to, instant_at(12));
  EXPECT_EQ(plays[2].from, instant_at(12));
  EXPECT_EQ(plays[2].to, instant_at(20));
}

TEST(CueList, AutoFollowRunsStraightOnAndManualWaits) {
  SmallShow small = three_sections();
  small.show.cues = {cue_of("1", 0, ContinueMode::auto_follow), cue_of("2", 1), cue_of("3", 2)};
  const auto plays = cue_plays(small.show, small.plan);
  EXPECT_FALSE(plays[0].stands_after());
  EXPECT_EQ(plays[0].gap_after, Duration{});
  EXPECT_TRUE(plays[1].stands_after());
  EXPECT_EQ(plays[1].gap_after, std::nullopt);
}

TEST(CueList, WaitsOfAnAutoFollowMakeAStand) {
  SmallShow small = three_sections();
  small.show.cues = {cue_of("1", 0, ContinueMode::auto_follow), cue_of("2", 1), cue_of("3", 2)};
  small.show.cues[0].post_wait = milliseconds(1500);
  small.show.cues[1].pre_wait = milliseconds(500);
  const auto plays = cue_plays(small.show, small.plan);
  EXPECT_EQ(plays[0].gap_after, milliseconds(2000));
  EXPECT_TRUE(plays[0].stands_after());
}

TEST(CueList, AutoContinueCountsItsPostWaitFromItsOwnStartButNeverCutsTheSection) {
  SmallShow small = three_sections();
  small.show.cues = {cue_of("1", 0, ContinueMode::auto_continue), cue_of("2", 1, ContinueMode::auto_continue),
                     cue_of("3", 2)};
  small.show.cues[0].post_wait = milliseconds(5500);
  small.show.cues[1].post_wait = milliseconds(1000);
  const auto plays = cue_plays(small.show, small.plan);
  EXPECT_EQ(plays[0].gap_after, milliseconds(1500));
  EXPECT_EQ(plays[1].gap_after, Duration{});
}

TEST(CueList, SectionsWithoutACueArePlayedByTheNextOneAndTheLastCuePlaysToTheEnd) {
  SmallShow small = three_sections();
  small.show.cues = {cue_of("5", 1)};
  const auto plays = cue_plays(small.show, small.plan);
  ASSERT_EQ(plays.size(), 1U);
  EXPECT_EQ(plays[0].from, instant_at(0));
  EXPECT_EQ(plays[0].to, instant_at(20));
}

TEST(CueList, WithoutCuesEverySectionFollowsByItself) {
  SmallShow small = three_sections();
  small.show.cues.clear();
  const auto plays = cue_plays(small.show, small.plan);
  ASSERT_EQ(plays.size(), 3U);
  EXPECT_EQ(plays[2].cue.number.to_text(), "3");
  EXPECT_EQ(plays[0].gap_after, Duration{});
}

}  // namespace
}  // namespace footlight::controller
