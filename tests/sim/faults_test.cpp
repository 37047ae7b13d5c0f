// SPDX-License-Identifier: Apache-2.0
#include "sim/faults.hpp"

#include <gtest/gtest.h>

namespace footlight::sim {
namespace {

std::string message(std::string_view text) {
  const auto faults = Faults::parse(text);
  return faults ? "(accepted)" : faults.error().message;
}

TEST(Faults, EveryPartIsRead) {
  const auto faults =
      Faults::parse("loss=5%,corrupt=0.01,duplicate=50%,delay=3ms,late=10%,reboot=2,bus-off=3,full=4,unplug=5,dead=1");
  ASSERT_TRUE(faults.has_value());
  EXPECT_DOUBLE_EQ(faults->loss, 0.05);
  EXPECT_DOUBLE_EQ(faults->corrupt, 0.01);
  EXPECT_DOUBLE_EQ(faults->duplicate, 0.5);
  EXPECT_EQ(faults->delay, milliseconds(3));
  EXPECT_DOUBLE_EQ(faults->late, 0.1);
  EXPECT_EQ(faults->reboot, 2);
  EXPECT_EQ(faults->bus_off, 3);
  EXPECT_EQ(faults->full, 4);
  EXPECT_EQ(faults->unplug, 5);
  EXPECT_EQ(faults->dead, 1);
}

TEST(Faults, NothingMeansNone) { EXPECT_EQ(*Faults::parse(""), Faults{}); }

TEST(Faults, TheLargestSharesAreAllowed) {
  EXPECT_DOUBLE_EQ(Faults::parse("loss=30%")->loss, 0.3);
  EXPECT_EQ(Faults::parse("delay=1s")->delay, milliseconds(1000));
}

TEST(Faults, WrongPartsAreNamedWithWhatWouldBeRight) {
  EXPECT_EQ(message("lost=5%"),
            "faults: \"lost=5%\" is unknown (possible are loss=5%, corrupt=1%, duplicate=1%, delay=3ms, late=10%, "
            "reboot=2, bus-off=2, full=2, unplug=1, dead=1, until=80%, separated by commas)");
  EXPECT_EQ(message("loss=31%"), "faults: \"loss=31%\" is wrong (a share of 0 to 30%, as loss=5%)");
  EXPECT_EQ(message("corrupt=-1%"), "faults: \"corrupt=-1%\" is wrong (a share of 0 to 30%, as corrupt=1%)");
  EXPECT_EQ(message("duplicate=nan"), "faults: \"duplicate=nan\" is wrong (a share of 0 to 50%, as duplicate=1%)");
  EXPECT_EQ(message("delay=3"),
            "faults: \"delay=3\" is wrong (a time of 0 to 1 s with its unit us, ms or s, as delay=3ms)");
  EXPECT_EQ(message("delay=1e300s"),
            "faults: \"delay=1e300s\" is wrong (a time of 0 to 1 s with its unit us, ms or s, as delay=3ms)");
  EXPECT_EQ(message("reboot=2.5"), "faults: \"reboot=2.5\" is wrong (a number of restarts, 0 to 10000, as reboot=2)");
  EXPECT_EQ(message("late=101%"), "faults: \"late=101%\" is wrong (a share of 0 to 100%, as late=10%)");
  EXPECT_EQ(message("bus-off=x"), "faults: \"bus-off=x\" is wrong (a number of times, 0 to 10000, as bus-off=2)");
  EXPECT_EQ(message("dead="), "faults: \"dead=\" is wrong (a number of nodes, 0 to 10000, as dead=1)");
  EXPECT_EQ(message("loss"), "faults: \"loss\" is wrong (a share of 0 to 30%, as loss=5%)");
  EXPECT_EQ(message("loss=1%,loss=2%"), "faults: \"loss=2%\" is wrong (loss is given twice; once is right)");
  EXPECT_EQ(message("loss=1%,,dead=1"),
            "faults: \"\" is unknown (possible are loss=5%, corrupt=1%, duplicate=1%, delay=3ms, late=10%, "
            "reboot=2, bus-off=2, full=2, unplug=1, dead=1, until=80%, separated by commas)");
}

TEST(Chance, OnlyAShareOfTheAnswersIsLate) {
  Chance chance(*Faults::parse("delay=200ms,late=10%"), Rng(5));
  int late = 0;
  for (int i = 0; i < 100'000; ++i) late += chance.lateness() > Duration{} ? 1 : 0;
  EXPECT_NEAR(late, 10'000, 500);
}

TEST(Chance, SharesComeOutAsAskedFor) {
  Chance chance(*Faults::parse("loss=5%,corrupt=30%,duplicate=1%,delay=3ms"), Rng(11));
  int lost = 0;
  int corrupted = 0;
  int duplicated = 0;
  Duration latest{};
  Duration sum{};
  constexpr int kDraws = 100'000;
  for (int i = 0; i < kDraws; ++i) {
    lost += chance.lost() ? 1 : 0;
    corrupted += chance.corrupted() ? 1 : 0;
    duplicated += chance.duplicated() ? 1 : 0;
    const Duration late = chance.lateness();
    latest = std::max(latest, late);
    sum += late;
  }
  // Five standard deviations of a binomial distribution.
  EXPECT_NEAR(lost, 5'000, 345);
  EXPECT_NEAR(corrupted, 30'000, 725);
  EXPECT_NEAR(duplicated, 1'000, 158);
  EXPECT_LE(latest, milliseconds(3));
  EXPECT_GT(latest, microseconds(2990));
  EXPECT_NEAR(to_seconds(sum) / kDraws, 0.0015, 1.4e-5);
}

TEST(Chance, WithoutFaultsNothingHappens) {
  Chance chance(Faults{}, Rng(11));
  for (int i = 0; i < 1000; ++i) {
    ASSERT_FALSE(chance.lost() || chance.corrupted() || chance.duplicated());
    ASSERT_EQ(chance.lateness(), Duration{});
  }
}

}  // namespace
}  // namespace footlight::sim
