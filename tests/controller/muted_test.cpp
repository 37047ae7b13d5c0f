// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "controller/crowd.hpp"
#include "controller/cue_list.hpp"
#include "controller/cue_schedule.hpp"
#include "controller/lamp.hpp"
#include "controller/rehearsal.hpp"
#include "core/clock.hpp"
#include "tests/controller/fake_driver.hpp"
#include "tests/support/small_show.hpp"

namespace footlight::controller {
namespace {

using tests::SmallShow;

/// Two groups in three sections, a lamp on every cell, one worn lamp for each of the first two people.
struct Stage {
  explicit Stage(std::uint64_t seed = 1, std::size_t people = 6) : small(tests::random_show(5, 5, people, 3, 2, seed)) {
    small.rig = tests::lamps_everywhere(small.show.stage.grid, {BusKind::serial}, 115'200, 25);
    small.rig.nodes[0].channels.push_back({Channel::Kind::wearable, {}, PerformerIndex(0)});
    small.rig.nodes[0].channels.push_back({Channel::Kind::wearable, {}, PerformerIndex(1)});
    std::vector<std::unique_ptr<drivers::Driver>> drivers;
    drivers.push_back(std::make_unique<FakeDriver>(small.rig.nodes.size(), kChannelsPerNode, false));
    schedule.emplace(build_schedule(small.show, small.plan, small.rig, drivers).value());
    schedule->add_quiet(254);
  }
  std::size_t mute(std::vector<bool> muted) {
    return schedule->add(build_muted(small.show, small.plan, small.rig, *schedule, muted)).value();
  }
  [[nodiscard]] LookIndex look(std::size_t k, std::size_t channel) const {
    return schedule->looks_of(k, NodeIndex(0))[channel];
  }
  SmallShow small;
  std::optional<CueSchedule> schedule;
};

TEST(Muted, ALookOfItsOwnTellsWhoIsNotConcerned) {
  Stage stage;
  const LookNumbers& numbers = stage.schedule->numbers();
  ASSERT_NE(numbers.quiet, kDark);
  EXPECT_EQ(stage.schedule->looks()[numbers.quiet], kQuiet);
  EXPECT_NE(kQuiet, no_guidance_look());
}

TEST(Muted, WhereTheMarkersHaveNoRoomForOneMoreLookNobodyCanBe) {
  Stage stage;
  CueSchedule full(std::vector<Look>(254, Look{}), stage.schedule->switches(), 0, {}, 0, {});
  full.add_quiet(254);
  EXPECT_EQ(full.numbers().quiet, kDark);
  CueSchedule small(std::vector<Look>(5, Look{}), stage.schedule->switches(), 0, {}, 0, {});
  small.add_quiet(4);
  EXPECT_EQ(small.numbers().quiet, kDark) << "a device that knows four looks has them all";
  small.add_quiet(5);
  EXPECT_EQ(small.numbers().quiet, 5);
}

/// The table of docs/looks.md, "Solo and mute", by another way: each cell from the people who have to do with it.
TEST(MutedProperty, ALampTellsOfTheConcernedAloneAndIsNeverDarkBecauseOfIt) {
  int quiet = 0;
  int changed = 0;
  EXPECT_TRUE(rc::check([&](std::uint64_t seed) {
    Stage stage(seed);
    Rng rng(seed);
    const std::vector<bool> muted{rng.below(2) == 0, rng.below(2) == 0, rng.below(2) == 0};
    const std::size_t first = stage.mute(muted);
    const auto plays = cue_plays(stage.small.show, stage.small.plan);
    for (std::size_t k = 0; k < stage.schedule->switches().size(); ++k) {
      RC_ASSERT(stage.schedule->plain(first + k) == k);
      RC_ASSERT(sequence_of(first + k) != sequence_of(k));
      Crowd crowd(stage.small.show, stage.small.plan, plays);
      std::vector<Doing> doing;
      for (std::size_t m = 0; m <= k; ++m) crowd.look_at(m, doing);
      for (std::size_t c = 0; c < 25; ++c) {
        bool concerned = false;
        bool not_concerned = false;
        for (std::size_t p = 0; p < doing.size(); ++p) {
          const bool uses = (!doing[p].goal && doing[p].cell == CellIndex::of(c)) ||
                            doing[p].goal == CellIndex::of(c) || doing[p].next == CellIndex::of(c);
          (muted[p % 2] ? not_concerned : concerned) |= uses;
        }
        const LookIndex now = stage.look(first + k, c);
        const LookIndex all = stage.look(k, c);
        if (!concerned) RC_ASSERT(now == (not_concerned ? stage.schedule->numbers().quiet : kDark));
        if (concerned) RC_ASSERT(now != kDark && now != stage.schedule->numbers().quiet);
        if (!not_concerned) RC_ASSERT(now == all);
        RC_ASSERT((now == kDark) == (all == kDark));
        quiet += now == stage.schedule->numbers().quiet ? 1 : 0;
        changed += concerned && now != all ? 1 : 0;
      }
      for (std::size_t w = 0; w < 2; ++w) {
        const LookIndex all = stage.look(k, 25 + w);
        RC_ASSERT(stage.look(first + k, 25 + w) == (muted[w] && all != kDark ? stage.schedule->numbers().quiet : all));
        RC_ASSERT(stage.schedule->content(first + k, w) ==
                  (muted[w] ? drivers::WearableContent{} : stage.schedule->content(k, w)));
      }
    }
  }));
  EXPECT_GT(quiet, 100);
  EXPECT_GT(changed, 10) << "cells that a concerned one shares with somebody who is muted";
}

struct Bench : Stage {
  Bench() {
    auto plays = cue_plays(small.show, small.plan);
    engine.emplace(*schedule, plays, std::vector<Duration>(plays.size()));
    rehearsal.emplace(*engine, small.show.tempo, Stands(small.plan), Rehearsal::Settings{0, milliseconds(1)},
                      [](std::size_t, std::size_t) { return milliseconds(300); });
    rehearsal->step(clock.now());
  }
  void tell(Command::Kind kind, std::size_t first = 0) {
    Command command;
    command.kind = kind;
    command.first = first;
    EXPECT_FALSE(refused(rehearsal->apply(command, clock.now())));
  }
  void run_for(double time_s) {
    const Instant end = clock.now() + seconds(time_s);
    while (clock.now() < end) {
      clock.advance_to(std::min(end, rehearsal->next_event()));
      rehearsal->step(clock.now());
    }
  }
  ManualClock clock;
  std::optional<CueEngine> engine;
  std::optional<Rehearsal> rehearsal;
};

TEST(Muted, TakesEffectAsSoonAsAllBusesKnow) {
  Bench bench;
  const std::size_t first = bench.mute({true, false, false});
  bench.tell(Command::Kind::mute, first);
  EXPECT_EQ(bench.rehearsal->target().current, 0U);
  EXPECT_EQ(bench.rehearsal->target().next, first);
  EXPECT_EQ(bench.rehearsal->target().next_at, bench.clock.now() + milliseconds(300));
  bench.run_for(0.3);
  EXPECT_EQ(bench.rehearsal->target().current, first);
  EXPECT_EQ(bench.rehearsal->target().next, first + 1);
  bench.tell(Command::Kind::mute, 0);
  bench.run_for(0.3);
  EXPECT_EQ(bench.rehearsal->target().current, 0U);
}

TEST(Muted, ALampIsAFunctionOfThePositionAndOfWhoIsMuted) {
  Bench plain;
  Bench muted;
  const std::size_t first = muted.mute({false, true, false});
  plain.tell(Command::Kind::go);
  muted.tell(Command::Kind::go);
  muted.tell(Command::Kind::mute, first);
  plain.run_for(0.3);
  muted.run_for(0.3);
  for (int i = 0; i < 40; ++i) {
    plain.run_for(0.11);
    muted.run_for(0.11);
    const BusTarget a = plain.rehearsal->target();
    const BusTarget b = muted.rehearsal->target();
    EXPECT_EQ(b.current, first + a.current);
    EXPECT_EQ(b.next, first + a.next);
    EXPECT_EQ(b.next_at, a.next_at);
    EXPECT_EQ(b.show_time, a.show_time);
  }
}

TEST(Muted, TheSwitchThatIsDueBeforeComesFirst) {
  Bench bench;
  const std::size_t first = bench.mute({true, false, false});
  bench.tell(Command::Kind::go);
  bench.run_for(0.2);
  const BusTarget before = bench.rehearsal->target();
  ASSERT_NE(before.next_at, kNever);
  bench.run_for(to_seconds(before.next_at - bench.clock.now()) - 0.1);
  bench.tell(Command::Kind::mute, first);
  EXPECT_EQ(bench.rehearsal->target().next, before.next) << "0.1 s before it, and the buses want 0.3 s";
  bench.run_for(0.1);
  EXPECT_EQ(bench.rehearsal->target().current, before.next);
  bench.run_for(0.2);
  EXPECT_EQ(bench.rehearsal->target().current, first + before.next);
}

}  // namespace
}  // namespace footlight::controller
