// SPDX-License-Identifier: Apache-2.0
#include "core/timecode.hpp"

#include <gtest/gtest.h>

namespace footlight {
namespace {

TEST(Timecode, FramesAreCountedAndDropFrameSkipsTwoNumbersAMinuteButNotEveryTenth) {
  EXPECT_EQ(frame_number({0, 0, 1, 0, FrameRate::fps25}), 25);
  EXPECT_EQ(frame_number({0, 0, 59, 29, FrameRate::fps2997_drop}), 1799);
  EXPECT_EQ(frame_number({0, 1, 0, 2, FrameRate::fps2997_drop}), 1800);
  EXPECT_EQ(frame_number({0, 10, 0, 0, FrameRate::fps2997_drop}), 17982);
  EXPECT_EQ(frame_number({1, 0, 0, 0, FrameRate::fps2997_drop}), 107892);
}

TEST(Timecode, AnHourOfDropFrameIsAnHourWithinATenthOfASecond) {
  EXPECT_NEAR(to_seconds(time_of({1, 0, 0, 0, FrameRate::fps2997_drop})), 3600, 0.01);
  EXPECT_EQ(time_of({1, 0, 0, 12, FrameRate::fps24}), seconds(3600.5));
}

TEST(Timecode, NothingIsValidThatNoClockShows) {
  EXPECT_TRUE(valid({23, 59, 59, 29, FrameRate::fps30}));
  EXPECT_FALSE(valid({24, 0, 0, 0, FrameRate::fps30}));
  EXPECT_FALSE(valid({0, 0, 0, 25, FrameRate::fps25}));
  EXPECT_FALSE(valid({0, 1, 0, 1, FrameRate::fps2997_drop}));
  EXPECT_TRUE(valid({0, 10, 0, 1, FrameRate::fps2997_drop}));
}

TEST(Timecode, EveryFrameOfADayHasOneCodeAtEveryRate) {
  for (const FrameRate rate : {FrameRate::fps24, FrameRate::fps25, FrameRate::fps2997_drop, FrameRate::fps30}) {
    const std::int64_t day = frame_number({23, 59, 59, frames_counted(rate) - 1, rate}) + 1;
    for (std::int64_t frame = 0; frame < day; frame += frame < 40'000 ? 1 : 997) {
      const Timecode code = code_of(frame, rate);
      ASSERT_TRUE(valid(code)) << to_text(code);
      ASSERT_EQ(frame_number(code), frame) << to_text(code);
      ASSERT_EQ(code_at(time_of(code), rate), code);
      ASSERT_EQ(parse_timecode(to_text(code), rate), code);
    }
    EXPECT_EQ(code_of(day, rate), (Timecode{0, 0, 0, 0, rate})) << "after a day it begins again";
  }
}

TEST(Timecode, NothingElseIsATimecode) {
  for (const char* text : {"", "1:00:00:00", "01:00:00", "01:00:00:0", "01:00:00:000", "01-00-00-00", "24:00:00:00",
                           "01;00:00:00", "-1:00:00:00", "01:00:0 :00", "01:60:00:00"}) {
    EXPECT_FALSE(parse_timecode(text, FrameRate::fps25)) << text;
  }
  EXPECT_EQ(parse_timecode("01:02:03.04", FrameRate::fps25), (Timecode{1, 2, 3, 4, FrameRate::fps25}));
}

TEST(Timecode, IsWrittenAsPeopleDo) {
  EXPECT_EQ(to_text({1, 2, 3, 4, FrameRate::fps25}), "01:02:03:04");
  EXPECT_EQ(to_text({1, 2, 3, 4, FrameRate::fps2997_drop}), "01:02:03;04");
}

}  // namespace
}  // namespace footlight
