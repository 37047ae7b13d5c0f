// SPDX-License-Identifier: Apache-2.0
#include "app/stage_times.hpp"

#include <gtest/gtest.h>

namespace footlight::app {
namespace {

TEST(StageTimes, AddUpAndKeepTheOrderInWhichStagesCame) {
  ManualClock clock;
  StageTimes times(clock);
  clock.advance(seconds(7));  // before the first stage: nobody's
  times.enter("decoding");
  clock.advance(seconds(1.5));
  times.enter("pairing");
  clock.advance(seconds(0.25));
  times.enter("decoding");
  times.enter("decoding");
  clock.advance(seconds(2));
  const std::vector<std::pair<std::string, double>> expected{{"decoding", 3.5}, {"pairing", 0.25}};
  EXPECT_EQ(times.finish(), expected);
  EXPECT_EQ(times.finish(), expected);
  EXPECT_EQ(to_text(times.finish(), 96.4), "decoding 3.50 s, pairing 0.25 s, all 3.75 s, 96 MB at most");
  EXPECT_GT(peak_memory_mb(), 1);
}

}  // namespace
}  // namespace footlight::app
