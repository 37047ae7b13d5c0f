// SPDX-License-Identifier: Apache-2.0
#include "controller/bus_loop.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"
#include "tests/controller/fake_driver.hpp"

namespace footlight::controller {
namespace {

using Kind = FakeDriver::Kind;

constexpr std::size_t kChannels = 4;
constexpr Duration kBeat = milliseconds(500);

/// Switch k at (k + 1) beats; a node's looks change with `period` of the switch.
CueSchedule schedule_of(std::size_t nodes, std::size_t switches,
                        const std::function<LookIndex(std::size_t, std::size_t)>& look) {
  std::vector<Look> looks{{{0, 0, 0}, Effect::steady, 0}};
  for (int i = 1; i <= 20; ++i) looks.push_back({{static_cast<std::uint8_t>(i), 0, 0}, Effect::steady, 255});
  std::vector<Switch> list;
  std::vector<LookIndex> table;
  for (std::size_t k = 0; k < switches; ++k) {
    list.push_back({kStart + static_cast<Duration::rep>(k + 1) * kBeat, "switch", false, std::nullopt});
    for (std::size_t n = 0; n < nodes; ++n) {
      for (std::size_t c = 0; c < kChannelsPerNode; ++c) table.push_back(c < kChannels ? look(k, n) : kDark);
    }
  }
  return CueSchedule(std::move(looks), std::move(list), nodes, std::move(table), 0, {});
}

LookIndex every_switch(std::size_t k, std::size_t n) { return static_cast<LookIndex>(1 + (k + n) % 20); }

/// The last switch at or before a show time; the first one before it.
std::size_t switch_at(const CueSchedule& schedule, Instant show_time) {
  const auto& switches = schedule.switches();
  const auto after = std::ranges::upper_bound(switches, show_time, {}, &Switch::time);
  return after == switches.begin() ? 0 : static_cast<std::size_t>(after - switches.begin()) - 1;
}

/// A loop on a fake bus; the show runs by the clock.
struct Bench {
  Bench(CueSchedule plan, std::size_t nodes, bool canopen, const std::vector<SwitchOn>& switch_on = {},
        bool keeps_checks = false)
      : schedule(std::move(plan)),
        driver(nodes, kChannels, canopen, keeps_checks),
        loop(schedule, addresses(nodes), driver, switch_on) {}

  static std::vector<drivers::NodeAddress> addresses(std::size_t nodes) {
    std::vector<drivers::NodeAddress> list;
    for (std::size_t n = 0; n < nodes; ++n) {
      list.push_back({NodeIndex::of(n), static_cast<std::uint8_t>(n + 1), static_cast<std::uint8_t>(kChannels)});
    }
    return list;
  }

  [[nodiscard]] BusTarget target() const {
    BusTarget target;
    target.current = stands_at.value_or(switch_at(schedule, now));
    target.next = std::min(target.current + 1, schedule.switches().size() - 1);
    if (target.next != target.current && !stands_at) target.next_at = schedule.switches()[target.next].time;
    if (next_is && target.current < *next_is) target.next = *next_is;
    if (next_at && target.next == next_is) target.next_at = *next_at;
    return target;
  }

  void run_until(Instant end) {
    while (now < end) {
      Instant next = loop.step(now, target());
      if (target().next_at > now) next = std::min(next, target().next_at);
      if (next <= now) next = now + microseconds(100);
      now = std::min(next, end);
    }
  }
  /// Just before switch k.
  void run_to_switch(std::size_t k) { run_until(schedule.switches()[k].time - milliseconds(2)); }

  [[nodiscard]] bool right(std::size_t n, std::size_t k) {
    return std::ranges::equal(driver.node(n).showing, schedule.looks_of(k, NodeIndex::of(n)).first(kChannels));
  }
  [[nodiscard]] std::vector<std::size_t> wrong(std::size_t nodes, std::size_t k) {
    std::vector<std::size_t> list;
    for (std::size_t n = 0; n < nodes; ++n) {
      if (!right(n, k)) list.push_back(n);
    }
    return list;
  }

  CueSchedule schedule;
  FakeDriver driver;
  BusLoop loop;
  Instant now = kStart;
  std::optional<std::size_t> stands_at;  ///< a switch after which the show waits for GO
  std::optional<std::size_t> next_is;    ///< a jump: not the one that follows
  std::optional<Instant> next_at;        ///< and when it comes
};

using Nobody = std::vector<std::size_t>;

class AnyBus : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Languages, AnyBus, testing::Values(false, true),
                         [](const auto& bus) { return bus.param ? "canopen" : "sequenced"; });

TEST_P(AnyBus, EveryNodeShowsEverySwitch) {
  Bench bench(schedule_of(5, 8, every_switch), 5, GetParam());
  for (std::size_t k = 1; k < 8; ++k) {
    bench.run_to_switch(k);
    EXPECT_EQ(bench.wrong(5, k - 1), Nobody{}) << "before switch " << k;
  }
  EXPECT_EQ(bench.loop.counters().retries, 0U);
  EXPECT_EQ(bench.loop.counters().deliveries, 7U * 5 * kChannels);
  EXPECT_TRUE(bench.driver.broken_rules.empty());
}

TEST_P(AnyBus, TheLatchHasItsLastBitOnTheWireAtTheInstantOfTheSwitch) {
  Bench bench(schedule_of(3, 5, every_switch), 3, GetParam());
  bench.run_to_switch(4);
  std::vector<Instant> first(5, kNever);
  for (const auto& operation : bench.driver.log) {
    if (operation.kind == Kind::latch) {
      first[operation.sequence - 1U] = std::min(first[operation.sequence - 1U], operation.at + milliseconds(1));
    }
  }
  for (std::size_t k = 1; k < 4; ++k) EXPECT_EQ(first[k], bench.schedule.switches()[k].time);
  EXPECT_EQ(bench.loop.counters().worst_lateness, Duration{});
}

TEST_P(AnyBus, OnlyWhoChangesIsPreloaded) {
  Bench bench(
      schedule_of(4, 4, [](std::size_t k, std::size_t n) { return static_cast<LookIndex>(n == 2 ? k + 1 : 1); }), 4,
      GetParam());
  bench.run_to_switch(1);
  bench.driver.log.clear();
  bench.run_to_switch(3);
  for (const auto& operation : bench.driver.log) {
    if (operation.kind == Kind::preload) {
      EXPECT_EQ(operation.node, NodeIndex(2));
    }
  }
  EXPECT_EQ(bench.wrong(4, 2), Nobody{});
}

TEST_P(AnyBus, ASwitchThatChangesNothingHereNeedsNoLatchOfItsOwn) {
  Bench bench(schedule_of(2, 4, [](std::size_t, std::size_t) { return LookIndex{3}; }), 2, GetParam());
  bench.run_until(bench.schedule.switches()[3].time + milliseconds(100));
  EXPECT_EQ(bench.loop.lit(), 3U);
  EXPECT_EQ(bench.loop.counters().latches, 0U);
  EXPECT_TRUE(bench.loop.settled());
}

TEST_P(AnyBus, ALostPreloadIsRepairedBeforeTheNextSwitch) {
  Bench bench(schedule_of(4, 6, every_switch), 4, GetParam());
  const Instant due = bench.schedule.switches()[2].time;
  bench.driver.lost = [&](Kind kind, NodeIndex node, Instant at) {
    return kind == Kind::preload && node == NodeIndex(1) && at < due && at > due - kBeat;
  };
  bench.run_to_switch(3);
  EXPECT_EQ(bench.wrong(4, 2), Nobody{});
  EXPECT_GT(bench.loop.counters().retries, 0U);
}

TEST_P(AnyBus, ALostLatchIsRepairedBeforeTheNextSwitch) {
  Bench bench(schedule_of(4, 6, every_switch), 4, GetParam());
  const Instant due = bench.schedule.switches()[2].time;
  bench.driver.lost = [&](Kind kind, NodeIndex node, Instant at) {
    return kind == Kind::latch && node == NodeIndex(3) && at >= due - milliseconds(1) && at < due + milliseconds(5);
  };
  bench.run_to_switch(3);
  EXPECT_EQ(bench.wrong(4, 2), Nobody{});
}

TEST_P(AnyBus, LostAnswersCostRepeatsAndNoLamp) {
  Bench bench(schedule_of(4, 6, every_switch), 4, GetParam());
  int n = 0;
  bench.driver.answer_lost = [&](NodeIndex, Instant) { return ++n % 3 == 0; };
  for (std::size_t k = 1; k < 6; ++k) {
    bench.run_to_switch(k);
    EXPECT_EQ(bench.wrong(4, k - 1), Nobody{});
  }
  EXPECT_GT(bench.loop.counters().misses, 0U);
  EXPECT_TRUE(bench.driver.broken_rules.empty());
}

/// Turns of nodes that all hang on one supply.
std::vector<SwitchOn> one_by_one(std::size_t nodes, Duration stagger) {
  std::vector<SwitchOn> list;
  for (std::size_t n = 0; n < nodes; ++n) list.push_back({0, static_cast<Duration::rep>(n) * stagger, stagger});
  return list;
}

/// When each node was preloaded first, from `since` on; kNever: not at all.
std::vector<Instant> first_preloads(const Bench& bench, std::size_t nodes, Instant since) {
  std::vector<Instant> first(nodes, kNever);
  for (const auto& operation : bench.driver.log) {
    if (operation.kind != Kind::preload || operation.at < since) continue;
    first[operation.node.at()] = std::min(first[operation.node.at()], operation.at);
  }
  return first;
}

TEST_P(AnyBus, NodesOfAStaggeredSupplyAreLitOneAfterTheOther) {
  Bench bench(schedule_of(4, 3, every_switch), 4, GetParam(), one_by_one(4, milliseconds(150)));
  bench.stands_at = 0;
  bench.run_until(kStart + milliseconds(1500));
  const auto first = first_preloads(bench, 4, kStart);
  for (std::size_t n = 0; n < 4; ++n) {
    const Instant turn = kStart + static_cast<Duration::rep>(n) * milliseconds(150);
    EXPECT_GE(first[n], turn) << n;
    EXPECT_LT(first[n], turn + milliseconds(120)) << n;
  }
  EXPECT_EQ(bench.wrong(4, 0), Nobody{});
  EXPECT_TRUE(bench.loop.settled());
  EXPECT_TRUE(bench.driver.broken_rules.empty());
}

TEST_P(AnyBus, ACueWhileNodesAreSwitchedOnComesToAllThatAreLitAtItsMoment) {
  // The last of the four has its turn after the second switch.
  Bench bench(schedule_of(4, 6, every_switch), 4, GetParam(), one_by_one(4, milliseconds(400)));
  bench.run_to_switch(1);
  const Instant due = bench.schedule.switches()[1].time;
  bench.run_until(due + milliseconds(2));
  EXPECT_TRUE(bench.right(0, 1));
  EXPECT_TRUE(bench.right(1, 1));
  EXPECT_TRUE(bench.right(2, 1)) << "its turn came before the switch";
  EXPECT_FALSE(bench.right(3, 1)) << "its turn has not come";
  EXPECT_EQ(bench.loop.counters().worst_lateness, Duration{});
  bench.run_to_switch(4);
  EXPECT_EQ(bench.wrong(4, 3), Nobody{});
}

TEST_P(AnyBus, ASupplyThatComesBackIsLoadedOneNodeAfterTheOther) {
  Bench bench(schedule_of(4, 3, every_switch), 4, GetParam(), one_by_one(4, milliseconds(150)));
  bench.stands_at = 0;
  bench.run_until(kStart + milliseconds(1500));
  const Instant off = bench.now;
  for (std::size_t n = 0; n < 4; ++n) bench.driver.reboot(n);
  bench.run_until(off + milliseconds(3000));
  auto first = first_preloads(bench, 4, off);
  std::ranges::sort(first);
  for (std::size_t n = 1; n < 4; ++n)
    EXPECT_GE(first[n] - first[n - 1], milliseconds(135)) << n << ": less an operation under way";
  EXPECT_EQ(bench.wrong(4, 0), Nobody{});
}

TEST_P(AnyBus, ARebootedNodeIsNoticedAndLitAgainWithItsLookTable) {
  Bench bench(schedule_of(4, 3, [](std::size_t k, std::size_t) { return static_cast<LookIndex>(k + 1); }), 4,
              GetParam());
  bench.stands_at = 0;
  bench.run_until(kStart + milliseconds(400));
  ASSERT_EQ(bench.wrong(4, 0), Nobody{});
  bench.driver.reboot(2);
  bench.driver.log.clear();
  bench.run_until(kStart + milliseconds(1400));
  EXPECT_EQ(bench.wrong(4, 0), Nobody{});
  EXPECT_EQ(bench.loop.counters().boots, 1U);
  const auto is = [](Kind kind, int sequence) {
    return [=](const auto& operation) { return operation.kind == kind && operation.sequence == sequence; };
  };
  const auto upload = std::ranges::find_if(bench.driver.log, is(Kind::upload, 1));
  const auto preload = std::ranges::find_if(bench.driver.log, [](const auto& o) {
    return o.kind == Kind::preload && o.node == NodeIndex(2) && o.sequence == 1;
  });
  ASSERT_NE(upload, bench.driver.log.end());
  ASSERT_NE(preload, bench.driver.log.end());
  EXPECT_LT(upload - bench.driver.log.begin(), preload - bench.driver.log.begin());
}

TEST_P(AnyBus, ADeadNodeIsAskedOnceASecondAndCostsTheOthersNoSwitch) {
  Bench bench(schedule_of(4, 20, every_switch), 4, GetParam());
  bench.driver.node(1).dead = true;
  for (std::size_t k = 1; k < 20; ++k) {
    bench.run_to_switch(k);
    EXPECT_EQ(bench.wrong(4, k - 1), Nobody{1});
  }
  EXPECT_EQ(bench.loop.quarantined(), std::vector{NodeIndex(1)});
  EXPECT_EQ(bench.loop.counters().quarantines, 1U);
  EXPECT_EQ(bench.loop.counters().late_latches, 0U);
  bench.driver.log.clear();
  const Instant from = bench.now;
  bench.run_until(from + std::chrono::seconds(4));
  const auto asked = std::ranges::count_if(bench.driver.log, [](const auto& o) {
    return o.node == NodeIndex(1) && (o.kind == Kind::ask || o.kind == Kind::preload);
  });
  EXPECT_LE(asked, 5);
}

TEST_P(AnyBus, ANodeThatComesBackFromTheDeadIsLit) {
  Bench bench(schedule_of(3, 3, every_switch), 3, GetParam());
  bench.stands_at = 0;
  bench.driver.node(1).dead = true;
  bench.run_until(kStart + milliseconds(400));
  bench.driver.node(1).dead = false;
  bench.stands_at.reset();
  bench.run_until(kStart + std::chrono::seconds(4));
  EXPECT_EQ(bench.wrong(3, 2), Nobody{});
  EXPECT_TRUE(bench.loop.quarantined().empty());
}

TEST_P(AnyBus, HeartbeatsAreNeverMoreThanALeaseApart) {
  Bench bench(schedule_of(10, 20, every_switch), 10, GetParam());
  bench.run_to_switch(19);
  Instant last = kStart;
  for (const auto& operation : bench.driver.log) {
    if (operation.kind != Kind::heartbeat) continue;
    EXPECT_LE(operation.at - last, milliseconds(500));
    last = operation.at;
  }
  EXPECT_GT(last, kStart + milliseconds(9000));
}

TEST_P(AnyBus, NothingIsStartedThatWouldNotEndBeforeTheLatch) {
  Bench bench(schedule_of(12, 10, every_switch), 12, GetParam());
  bench.run_to_switch(9);
  for (std::size_t i = 1; i < bench.driver.log.size(); ++i) {
    const auto& operation = bench.driver.log[i];
    const Instant due = bench.schedule.switches()[switch_at(bench.schedule, operation.at) + 1].time;
    if (operation.kind == Kind::latch || operation.at < bench.schedule.switches()[0].time) continue;
    const Duration time = operation.kind == Kind::preload ? milliseconds(4)
                          : operation.kind == Kind::ask   ? milliseconds(3)
                                                          : milliseconds(1);
    EXPECT_LE(operation.at + time, due - milliseconds(1));
  }
  EXPECT_EQ(bench.loop.counters().worst_lateness, Duration{});
}

TEST_P(AnyBus, WhileTheShowWaitsTheLampsKeep) {
  Bench bench(schedule_of(4, 3, every_switch), 4, GetParam());
  bench.stands_at = 0;
  bench.run_until(kStart + milliseconds(900));
  EXPECT_EQ(bench.wrong(4, 0), Nobody{});
  for (const auto& operation : bench.driver.log) {
    if (operation.kind == Kind::latch) {
      EXPECT_EQ(operation.sequence, 1);
    }
  }
}

TEST_P(AnyBus, AControllerThatStartsInTheMiddleLightsTheRightStateAndNothingBefore) {
  Bench bench(schedule_of(4, 10, every_switch), 4, GetParam());
  bench.now = bench.schedule.switches()[6].time + milliseconds(20);
  bench.run_to_switch(7);
  EXPECT_EQ(bench.wrong(4, 6), Nobody{});
  for (const auto& operation : bench.driver.log) {
    if (operation.kind == Kind::latch || operation.kind == Kind::preload) {
      EXPECT_GE(operation.sequence, 7);
    }
  }
}

/// Instants at which a node was preloaded.
std::vector<Instant> preloads_of(const FakeDriver& driver, std::size_t n) {
  std::vector<Instant> list;
  for (const auto& operation : driver.log) {
    if (operation.kind == Kind::preload && operation.node == NodeIndex::of(n)) list.push_back(operation.at);
  }
  return list;
}

TEST(SequencedBus, ADeviceThatSaysItIsBusyIsLeftAloneForLongerEachTime) {
  Bench bench(schedule_of(3, 3, [](std::size_t k, std::size_t n) { return every_switch(k, n); }), 3, false);
  int refusals = 0;
  bench.driver.refuses = [&](NodeIndex node) {
    const bool busy = node == NodeIndex(1) && refusals < 5;
    refusals += busy ? 1 : 0;
    return busy ? std::optional(drivers::DeviceEvent::Again::later) : std::nullopt;
  };
  bench.stands_at = 0;
  bench.run_until(instant_at(3));
  const auto tries = preloads_of(bench.driver, 1);
  ASSERT_GE(tries.size(), 6U);
  Duration rest = milliseconds(20);
  for (std::size_t i = 1; i < 6; ++i, rest *= 2) {
    EXPECT_GE(tries[i] - tries[i - 1], rest) << i;
    EXPECT_LE(tries[i] - tries[i - 1], rest + milliseconds(20)) << i;
  }
  EXPECT_TRUE(bench.right(1, 0));
  EXPECT_EQ(bench.loop.counters().quarantines, 0U) << "busy is not silent";
}

TEST(SequencedBus, ADeviceThatIsBusyForGoodIsQuarantined) {
  Bench bench(schedule_of(3, 6, every_switch), 3, false);
  bench.driver.refuses = [](NodeIndex node) {
    return node == NodeIndex(1) ? std::optional(drivers::DeviceEvent::Again::later) : std::nullopt;
  };
  for (std::size_t k = 1; k < 6; ++k) {
    bench.run_to_switch(k);
    EXPECT_TRUE(bench.right(0, k - 1) && bench.right(2, k - 1)) << "before switch " << k;
  }
  bench.run_until(instant_at(8));
  EXPECT_EQ(bench.loop.quarantined(), std::vector{NodeIndex(1)});
}

TEST(SequencedBus, WhatIsRefusedForGoodIsNotSentAgainButOnceASecond) {
  Bench bench(schedule_of(3, 6, every_switch), 3, false);
  bench.driver.refuses = [](NodeIndex node) {
    return node == NodeIndex(1) ? std::optional(drivers::DeviceEvent::Again::never) : std::nullopt;
  };
  bench.run_to_switch(5);
  EXPECT_TRUE(bench.right(0, 4) && bench.right(2, 4));
  bench.stands_at = 4;
  bench.run_until(instant_at(12));
  const auto tries = preloads_of(bench.driver, 1);
  ASSERT_GE(tries.size(), 2U);
  for (std::size_t i = 1; i < tries.size(); ++i) EXPECT_GE(tries[i] - tries[i - 1], milliseconds(990)) << i;
}

TEST(SequencedBus, ANodeThatAnswersButFollowsSomebodyElseIsOfferedItsLooksAgainAndThenLeftInQuarantine) {
  Bench bench(schedule_of(3, 6, every_switch), 3, false);
  auto& node = bench.driver.node(1);
  node.showing.assign(kChannels, 19);
  node.shown_sequence = 200;
  node.state = 1;
  bench.driver.lost = [](Kind kind, NodeIndex of, Instant) { return kind == Kind::latch && of == NodeIndex(1); };
  bench.stands_at = 0;  // and the looks of switch 1 wait for a GO
  bench.run_until(instant_at(3));
  EXPECT_GE(preloads_of(bench.driver, 1).size(), 8U);
  EXPECT_GE(bench.loop.counters().quarantines, 1U);
  EXPECT_LT(bench.driver.count(Kind::ask), 150U) << "asking alone changes nothing";
  EXPECT_GE(bench.driver.count(Kind::heartbeat), 11U);
  EXPECT_TRUE(bench.right(0, 0) && bench.right(2, 0));

  bench.driver.lost = [](Kind, NodeIndex, Instant) { return false; };
  bench.run_until(instant_at(5));
  EXPECT_TRUE(bench.right(1, 0)) << "as soon as it listens";
  EXPECT_TRUE(bench.loop.settled());
}

TEST(SequencedBus, WhoHasNotHeardWhoLeadsIsToldAtOnceAndLit) {
  Bench bench(schedule_of(3, 6, every_switch), 3, false);
  auto& node = bench.driver.node(1);
  node.showing.assign(kChannels, 19);
  node.shown_sequence = 200;
  node.state = 1;
  bench.driver.fenced = {NodeIndex(1)};
  bool first = true;
  bench.driver.lost = [&](Kind kind, NodeIndex, Instant) {
    return kind == Kind::heartbeat && std::exchange(first, false);
  };
  bench.stands_at = 0;
  bench.run_until(kStart + milliseconds(200));
  EXPECT_TRUE(bench.right(1, 0)) << "not only when the next heartbeat is due";
  EXPECT_TRUE(bench.loop.settled());
  EXPECT_EQ(bench.loop.counters().quarantines, 0U);
  const auto& log = bench.driver.log;
  const auto refused = std::ranges::find(log, Kind::preload, &FakeDriver::Operation::kind);
  const auto uploads = std::count_if(refused, log.end(), [](const auto& of) { return of.kind == Kind::upload; });
  EXPECT_GE(uploads, 20) << "it has missed the looks that were sent to everybody";
}

TEST(SequencedBus, WhoFollowsAnotherControllerForGoodIsQuarantinedAndCostsNoFlood) {
  Bench bench(schedule_of(3, 6, every_switch), 3, false);
  bench.driver.fenced = {NodeIndex(1)};
  bench.driver.lost = [](Kind kind, NodeIndex, Instant) { return kind == Kind::heartbeat; };
  bench.stands_at = 0;
  bench.run_until(instant_at(4));
  EXPECT_TRUE(bench.right(0, 0) && bench.right(2, 0));
  EXPECT_EQ(bench.loop.quarantined(), std::vector<NodeIndex>{NodeIndex(1)});
  EXPECT_LT(preloads_of(bench.driver, 1).size(), 100U);
  EXPECT_LT(bench.driver.count(Kind::ask), 150U);
}

TEST(SequencedBus, WhoShowsTheRightStateAfterARestartIsNotTouched) {
  Bench bench(schedule_of(3, 4, every_switch), 3, false);
  const CueSchedule& schedule = bench.schedule;
  for (std::size_t n = 0; n < 3; ++n) {
    auto& node = bench.driver.node(n);
    const auto looks = schedule.looks_of(2, NodeIndex::of(n)).first(kChannels);
    node.showing.assign(looks.begin(), looks.end());
    node.shown_sequence = sequence_of(2);
    node.state = 1;
  }
  bench.stands_at = 2;
  bench.now = schedule.switches()[2].time + milliseconds(1);
  bench.run_until(bench.now + milliseconds(200));
  for (const auto& operation : bench.driver.log) {
    if (operation.kind == Kind::preload) {
      EXPECT_EQ(operation.sequence, sequence_of(3));
    }
  }
  EXPECT_TRUE(bench.loop.settled());
  const auto& log = bench.driver.log;
  const auto first_upload = std::ranges::find(log, Kind::upload, &FakeDriver::Operation::kind);
  EXPECT_EQ(std::ranges::count(log.begin(), first_upload, Kind::ask, &FakeDriver::Operation::kind), 3)
      << "a question tells sooner than all looks are sent";
}

TEST(SequencedBus, SequencesGoFromOneTo240AndWrap) {
  EXPECT_EQ(sequence_of(0), 1);
  EXPECT_EQ(sequence_of(239), 240);
  EXPECT_EQ(sequence_of(240), 1);
}

TEST_P(AnyBus, ASwitchThatIsCalledOffInItsLastMillisecondIsTakenBack) {
  Bench bench(schedule_of(4, 5, every_switch), 4, GetParam());
  bench.run_until(bench.schedule.switches()[2].time - microseconds(500));
  ASSERT_EQ(bench.loop.lit(), 2U) << "its latch is on the wire";
  bench.stands_at = 1;
  bench.run_until(bench.now + milliseconds(300));
  EXPECT_EQ(bench.wrong(4, 1), Nobody{});
  EXPECT_EQ(bench.loop.unconfirmed(), 0U);
}

TEST_P(AnyBus, WhoRebootsInAHoldIsRightAgainThoughTheNextLooksWerePreloaded) {
  Bench bench(schedule_of(4, 5, every_switch), 4, GetParam());
  bench.run_until(bench.schedule.switches()[2].time - milliseconds(10));
  bench.stands_at = 1;
  bench.run_until(bench.now + milliseconds(300));
  bench.driver.reboot(3);
  bench.run_until(bench.now + milliseconds(2000));
  EXPECT_EQ(bench.wrong(4, 1), Nobody{});
  EXPECT_TRUE(bench.driver.broken_rules.empty());
}

TEST_P(AnyBus, LooksThatWaitForASwitchThatWillNotComeAreNeverLit) {
  // Only node 0 changes at switch 3; all change at switch 2, which is called off when it has been preloaded.
  const auto look = [](std::size_t k, std::size_t n) {
    return static_cast<LookIndex>(k == 2 ? 9 : k == 3 && n == 0 ? 5 : 1);
  };
  Bench bench(schedule_of(4, 5, look), 4, GetParam());
  bench.run_until(bench.schedule.switches()[2].time - milliseconds(10));
  bench.stands_at = 1;
  bench.next_is = 3;
  bench.run_until(bench.now + milliseconds(400));
  bench.next_at = bench.now + milliseconds(300);
  const Instant end = *bench.next_at + milliseconds(100);
  while (bench.now < end) {
    if (bench.now >= *bench.next_at) bench.stands_at = 3;
    bench.run_until(bench.now + milliseconds(1));
    for (std::size_t n = 1; n < 4; ++n) ASSERT_TRUE(bench.right(n, 1)) << n;
  }
  EXPECT_EQ(bench.wrong(4, 3), Nobody{});
}

TEST(SequencedBus, LooksOfTheNextSwitchWaitInTheNodesWhileTheShowWaits) {
  Bench bench(schedule_of(4, 3, every_switch), 4, false);
  bench.stands_at = 0;
  bench.run_until(kStart + milliseconds(900));
  for (std::size_t n = 0; n < 4; ++n) EXPECT_EQ(bench.driver.node(n).pending_sequence, sequence_of(1));
}

TEST(CanopenBus, NothingOfTheNextSwitchIsPreloadedWhileTheShowWaits) {
  Bench bench(schedule_of(4, 3, every_switch), 4, true);
  bench.stands_at = 0;
  bench.run_until(kStart + milliseconds(900));
  for (std::size_t n = 0; n < 4; ++n) EXPECT_EQ(bench.driver.node(n).pending_sequence, 0);
  EXPECT_GE(bench.loop.notice(bench.schedule, 1), 4 * milliseconds(4) + milliseconds(1))
      << "a GO has to be known that long before";
}

TEST(CanopenBus, WithTimeEveryPreloadIsSentTwice) {
  Bench bench(schedule_of(3, 4, every_switch), 3, true);
  bench.run_until(bench.schedule.switches()[1].time);
  bench.driver.log.clear();
  bench.run_to_switch(2);
  EXPECT_EQ(bench.driver.count(Kind::preload), 6U);
}

/// Loses a share of everything by a seed, restarts nodes.
void make_unreliable(Bench& bench, std::uint64_t seed, double share) {
  auto rng = std::make_shared<Rng>(seed);
  bench.driver.lost = [=](Kind, NodeIndex, Instant) { return rng->uniform() < share; };
  bench.driver.answer_lost = [=](NodeIndex, Instant) { return rng->uniform() < share; };
}

TEST(CanopenBus, ASyncNeverTakesLooksOfALaterSwitchWhateverIsLost) {
  EXPECT_TRUE(rc::check([] {
    const auto nodes = *rc::gen::inRange<std::size_t>(1, 9);
    const auto seed = *rc::gen::arbitrary<std::uint64_t>();
    const auto percent = *rc::gen::inRange(0, 50);
    Bench bench(schedule_of(nodes, 8, every_switch), nodes, true);
    make_unreliable(bench, seed, percent / 100.0);
    for (std::size_t k = 1; k < 8; ++k) {
      bench.run_to_switch(k);
      if (seed % 3 == 0) bench.driver.reboot(seed % nodes);
    }
    RC_ASSERT(bench.driver.broken_rules.empty());
  }));
}

TEST(SequencedBus, NoNodeEverShowsALaterSwitchWhateverIsLost) {
  EXPECT_TRUE(rc::check([] {
    const auto nodes = *rc::gen::inRange<std::size_t>(1, 9);
    const auto seed = *rc::gen::arbitrary<std::uint64_t>();
    Bench bench(schedule_of(nodes, 8, every_switch), nodes, false);
    make_unreliable(bench, seed, 0.3);
    for (std::size_t k = 1; k < 8; ++k) {
      bench.run_to_switch(k);
      for (std::size_t n = 0; n < nodes; ++n) RC_ASSERT(bench.driver.node(n).shown_sequence <= sequence_of(k - 1));
    }
  }));
}

TEST_P(AnyBus, AfterTheFaultsEveryLivingNodeIsRightWithinTwoRefreshRounds) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Bench bench(schedule_of(6, 10, every_switch), 6, GetParam());
    make_unreliable(bench, seed, 0.3);
    for (std::size_t k = 1; k < 9; ++k) {
      bench.run_to_switch(k);
      if (k % 3 == 0) bench.driver.reboot(seed % 6);
    }
    bench.driver.lost = [](Kind, NodeIndex, Instant) { return false; };
    bench.driver.answer_lost = [](NodeIndex, Instant) { return false; };
    bench.run_until(bench.schedule.switches()[9].time + std::chrono::seconds(2));
    EXPECT_EQ(bench.wrong(6, 9), Nobody{}) << "seed " << seed;
  }
}

// ---- another schedule

/// The same nodes, other looks: those of the table's upper half are new.
CueSchedule other_schedule(std::size_t nodes, std::size_t switches, std::uint8_t plan_byte) {
  CueSchedule schedule = schedule_of(
      nodes, switches, [](std::size_t k, std::size_t n) { return static_cast<LookIndex>(1 + (3 * k + 2 * n) % 20); });
  std::vector<Look> looks = schedule.looks();
  std::vector<LookIndex> same(looks.size());
  for (std::size_t i = 0; i < looks.size(); ++i) {
    same[i] = static_cast<LookIndex>(i);
    if (i > 10) looks[i].colour.green = 200;
  }
  schedule.renumber(std::move(looks), same, plan_byte);
  return schedule;
}

TEST_P(AnyBus, GoingOverToAnotherScheduleUploadsItsNewLooksAndLightsIt) {
  Bench bench(schedule_of(4, 6, every_switch), 4, GetParam());
  bench.stands_at = 0;
  bench.run_until(kStart + milliseconds(2000));
  ASSERT_EQ(bench.wrong(4, 0), Nobody{});
  const CueSchedule other = other_schedule(4, 8, 1);
  const auto part = bench.loop.part_of(other, bench.schedule);
  bench.driver.log.clear();
  bench.loop.take(*part);
  bench.run_until(kStart + milliseconds(4000));
  ASSERT_EQ(&bench.loop.schedule(), &other);
  for (std::size_t n = 0; n < 4; ++n) {
    EXPECT_TRUE(std::ranges::equal(bench.driver.node(n).showing, other.looks_of(0, NodeIndex::of(n)).first(kChannels)));
  }
  EXPECT_TRUE(bench.loop.settled());
  EXPECT_TRUE(bench.driver.broken_rules.empty());
  std::size_t fresh = 0;
  for (const auto& operation : bench.driver.log) {
    if (operation.kind == Kind::preload) break;
    fresh += operation.kind == Kind::upload && operation.sequence > 10 ? 1 : 0;
  }
  EXPECT_EQ(fresh, 20U) << "new looks are uploaded, twice each, before a lamp shows one";
}

/// Four nodes that stand still, and what they have to keep.
struct KeepingBench : Bench {
  using Keeps = BusLoop::Keeps;
  static CueSchedule wanting(std::uint32_t plan) {
    CueSchedule schedule = schedule_of(4, 1, every_switch);
    schedule.set_checks({plan, {11, 12, 13, 14}});
    return schedule;
  }
  explicit KeepingBench(bool canopen) : Bench(wanting(0xABCD), 4, canopen, {}, true) {
    for (std::size_t n = 0; n < 4; ++n) driver.node(n).kept = {7, static_cast<std::uint32_t>(11 + n)};
  }
  [[nodiscard]] std::vector<Keeps> keeps() const {
    std::vector<Keeps> list;
    for (std::size_t n = 0; n < 4; ++n) list.push_back(loop.standing(n).keeps);
    return list;
  }
  void run_for(Duration time) { run_until(now + time); }
};

TEST_P(AnyBus, EveryNodeIsToldThePlanAndAskedOnceWhatItKeeps) {
  using enum BusLoop::Keeps;
  KeepingBench bench(GetParam());
  bench.driver.node(1).kept.patch = 11;  // exchanged with its neighbour
  bench.driver.node(2).kept.patch = 0;
  bench.driver.node(3).tells_kept = false;
  EXPECT_EQ(bench.keeps(), std::vector(4, unknown));
  bench.run_for(milliseconds(6000));
  EXPECT_EQ(bench.keeps(), (std::vector{same, other_patch, no_patch, untold}));
  EXPECT_EQ(bench.driver.count(Kind::tell_plan), 1U);
  EXPECT_TRUE(bench.loop.settled()) << "no lamp waits for it";
  EXPECT_EQ(bench.loop.counters().quarantines, 0U) << "who does not tell is not missed";
  for (std::size_t n = 0; n < 4; ++n) EXPECT_EQ(bench.driver.node(n).kept.plan, 0xABCDU);
  bench.driver.node(1).kept.patch = 12;
  bench.driver.node(2).kept.patch = 13;
  bench.run_for(milliseconds(3000));
  EXPECT_EQ(bench.keeps(), (std::vector{same, same, same, untold})) << "who was wrong is asked again";
  bench.driver.log.clear();
  bench.run_for(milliseconds(3000));
  EXPECT_EQ(bench.driver.count(Kind::ask_kept), 0U) << "who is right is not";
}

TEST_P(AnyBus, ANodeThatMissesTheWordOfThePlanIsToldAgain) {
  using enum BusLoop::Keeps;
  KeepingBench bench(GetParam());
  int heard = 0;
  bench.driver.lost = [&](Kind kind, NodeIndex node, Instant) {
    return kind == Kind::tell_plan && node == NodeIndex(2) && ++heard < 3;
  };
  bench.run_for(milliseconds(3000));
  EXPECT_EQ(bench.keeps(), std::vector(4, same));
  EXPECT_EQ(bench.driver.count(Kind::tell_plan), 3U);
}

TEST_P(AnyBus, ANodeThatKeepsAnotherPlanAllTheTimeIsToldSoAndOthersAreNotKeptBusy) {
  using enum BusLoop::Keeps;
  KeepingBench bench(GetParam());
  bench.driver.lost = [](Kind kind, NodeIndex node, Instant) {
    return kind == Kind::tell_plan && node == NodeIndex(0);
  };
  bench.run_for(milliseconds(3000));
  EXPECT_EQ(bench.keeps(), (std::vector{other_plan, same, same, same}));
  bench.driver.log.clear();
  bench.run_for(milliseconds(10'000));
  EXPECT_LE(bench.driver.count(Kind::ask_kept), 6U);
  EXPECT_LE(bench.driver.count(Kind::tell_plan), 6U);
}

TEST_P(AnyBus, ANodeThatHasRestartedAndAnotherPlanAreAskedAnew) {
  using enum BusLoop::Keeps;
  KeepingBench bench(GetParam());
  bench.run_for(milliseconds(3000));
  bench.driver.node(3).kept.patch = 99;  // another piece in its place
  bench.driver.reboot(3);
  bench.run_for(milliseconds(3000));
  EXPECT_EQ(bench.keeps(), (std::vector{same, same, same, other_patch}));
  const CueSchedule other = KeepingBench::wanting(0x1234);
  const auto part = bench.loop.part_of(other, bench.schedule);
  bench.loop.take(*part);
  (void)bench.loop.step(bench.now, bench.target());
  EXPECT_EQ(bench.keeps(), std::vector(4, unknown));
  bench.run_for(milliseconds(3000));
  EXPECT_EQ(bench.keeps(), (std::vector{same, same, same, other_patch}));
  EXPECT_EQ(bench.driver.node(0).kept.plan, 0x1234U);
}

TEST_P(AnyBus, WhoShowsTheSameInTheOtherScheduleIsLeftAlone) {
  const auto same = [](std::size_t, std::size_t n) { return static_cast<LookIndex>(1 + n); };
  Bench bench(schedule_of(4, 1, same), 4, GetParam());
  bench.run_until(kStart + milliseconds(2000));
  ASSERT_TRUE(bench.loop.settled());
  const CueSchedule other = schedule_of(4, 1, same);
  const auto part = bench.loop.part_of(other, bench.schedule);
  bench.driver.log.clear();
  bench.loop.take(*part);
  (void)bench.loop.step(bench.now, bench.target());
  EXPECT_EQ(&bench.loop.schedule(), &other);
  EXPECT_TRUE(bench.loop.settled());
  bench.run_until(kStart + milliseconds(3000));
  EXPECT_EQ(bench.driver.count(Kind::preload), 0U);
  EXPECT_EQ(bench.wrong(4, 0), Nobody{});
}

TEST(BusLoop, WhateverWasUnderWayNoLampIsLitByAPlanThatHasGone) {
  EXPECT_TRUE(rc::check("every lamp is of its schedule", [] {
    const bool canopen = *rc::gen::arbitrary<bool>();
    Bench bench(schedule_of(5, 12, every_switch), 5, canopen);
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    bench.driver.lost = [&](Kind, NodeIndex, Instant) { return rng.below(20) == 0; };
    bench.driver.answer_lost = [&](NodeIndex, Instant) { return rng.below(20) == 0; };
    std::vector<std::unique_ptr<CueSchedule>> schedules;
    std::vector<std::unique_ptr<BusLoop::Part>> parts;
    const CueSchedule* now = &bench.schedule;
    // What may be shown: a row of the schedule that plays, from the one that was lit when it was taken on.
    for (int change = 0; change < 4; ++change) {
      bench.run_until(bench.now + microseconds(*rc::gen::inRange(0, 1'500'000)));
      bench.stands_at = bench.stands_at ? std::optional<std::size_t>() : bench.target().current;
      const auto byte = static_cast<std::uint8_t>(change + 1);
      schedules.push_back(std::make_unique<CueSchedule>(other_schedule(5, 12, byte)));
      parts.push_back(bench.loop.part_of(*schedules.back(), *now));
      now = schedules.back().get();
      bench.loop.take(*parts.back());
    }
    bench.driver.lost = [](Kind, NodeIndex, Instant) { return false; };
    bench.driver.answer_lost = [](NodeIndex, Instant) { return false; };
    bench.stands_at = bench.target().current;
    bench.run_until(bench.now + milliseconds(6000));
    RC_ASSERT(&bench.loop.schedule() == now);
    for (std::size_t n = 0; n < 5; ++n) {
      const auto looks = now->looks_of(*bench.stands_at, NodeIndex::of(n)).first(kChannels);
      RC_ASSERT(std::ranges::equal(bench.driver.node(n).showing, looks));
    }
    RC_ASSERT(bench.loop.settled());
  }));
}

}  // namespace
}  // namespace footlight::controller
