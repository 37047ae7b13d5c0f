// SPDX-License-Identifier: Apache-2.0
#include "app/numbers.hpp"

#include <cstdlib>
#include <limits>

#include <gtest/gtest.h>

#include "core/rng.hpp"
#include "tests/support/plan_builder.hpp"

namespace footlight::app {
namespace {

TEST(Numbers, DoublesSurviveARoundTrip) {
  Rng rng(1);
  for (int i = 0; i < 1000; ++i) {
    const double value = (rng.uniform() - 0.5) * static_cast<double>(rng.below(100'000));
    EXPECT_EQ(std::strtod(exact(value).c_str(), nullptr), value);
  }
  EXPECT_EQ(exact(-41.5), "-41.5");
  EXPECT_EQ(exact(0.1), "0.1");
}

TEST(Numbers, SecondsAreExactToTheNanosecond) {
  EXPECT_EQ(exact_seconds(kStart), "0");
  EXPECT_EQ(exact_seconds(instant_at(3.2)), "3.2");
  EXPECT_EQ(exact_seconds(Instant(Duration(1))), "0.000000001");
  EXPECT_EQ(exact_seconds(Instant(Duration(-1'500'000'000))), "-1.5");
  EXPECT_EQ(exact_seconds(Instant(Duration(std::numeric_limits<std::int64_t>::min()))), "-9223372036.854775808");
}

TEST(Numbers, CountsLoseTheNoiseOfTheirComputation) {
  EXPECT_EQ(exact(tidy_count(7.399999999999999)), "7.4");
  EXPECT_EQ(exact(tidy_count(33.000000000001)), "33");
}

TEST(SectionAt, AWalkIntoASectionBelongsToIt) {
  Plan plan;
  plan.sections.resize(2);
  plan.sections[0].start = kStart;
  plan.sections[0].end = instant_at(10);
  plan.sections[1].start = instant_at(20);
  plan.sections[1].end = instant_at(30);
  EXPECT_EQ(section_at(plan, instant_at(0)), 0U);
  EXPECT_EQ(section_at(plan, instant_at(10)), 0U);
  EXPECT_EQ(section_at(plan, instant_at(10.5)), 1U);
  EXPECT_EQ(section_at(plan, instant_at(30)), 1U);
  EXPECT_EQ(section_at(plan, instant_at(31)), 1U);
}

}  // namespace
}  // namespace footlight::app
