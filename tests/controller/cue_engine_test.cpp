// SPDX-License-Identifier: Apache-2.0
#include "controller/cue_engine.hpp"

#include <gtest/gtest.h>

#include "core/clock.hpp"
#include "tests/support/small_show.hpp"

namespace footlight::controller {
namespace {

using tests::cue_of;
using tests::random_show;
using tests::SmallShow;

/// Three sections: [0, 4], [8, 12], [16, 20] s; walks between them; no lamps, only switches.
struct Bench {
  explicit Bench(std::vector<Cue> cues, std::vector<Duration> notices = {}) {
    SmallShow small = random_show(6, 6, 4, 3, 2, 1);
    small.show.cues = std::move(cues);
    schedule.emplace(build_schedule(small.show, small.plan, {}, {}).value());
    auto plays = cue_plays(small.show, small.plan);
    notices.resize(plays.size());
    engine.emplace(*schedule, std::move(plays), std::move(notices));
  }
  /// As the program does: from event to event, never past one.
  void run_until(Instant end) {
    engine->step(clock.now());
    while (clock.now() < end) {
      clock.advance_to(std::min(end, engine->next_event()));
      engine->step(clock.now());
    }
  }
  [[nodiscard]] const Switch& lit() const { return schedule->switches()[engine->target().current]; }

  ManualClock clock;
  std::optional<CueSchedule> schedule;
  std::optional<CueEngine> engine;
};

std::vector<Cue> manual() { return {cue_of("1", 0), cue_of("2", 1), cue_of("3", 2)}; }
std::vector<Cue> following() {
  return {cue_of("1", 0, ContinueMode::auto_follow), cue_of("2", 1, ContinueMode::auto_follow), cue_of("3", 2)};
}

TEST(CueEngine, BeforeTheFirstGoTheOpeningIsLitAndNothingIsDue) {
  Bench bench(manual());
  bench.run_until(instant_at(60));
  EXPECT_EQ(bench.engine->target().current, 0U);
  EXPECT_EQ(bench.lit().cause, "opening");
  EXPECT_EQ(bench.engine->target().next_at, kNever);
  EXPECT_EQ(bench.engine->next_event(), kNever);
  EXPECT_EQ(bench.engine->standby(), 0U);
}

TEST(CueEngine, GoStartsTheStandbyCueAtOnce) {
  Bench bench(manual());
  bench.run_until(instant_at(7));
  EXPECT_EQ(bench.engine->go(bench.clock.now()), GoAnswer::started);
  EXPECT_EQ(bench.lit().cause, "s1/1");
  EXPECT_EQ(bench.engine->state(0), CueState::running);
  EXPECT_EQ(bench.engine->standby(), 1U);
  bench.run_until(instant_at(8.5));
  EXPECT_EQ(bench.engine->position(), instant_at(1.5));
}

TEST(CueEngine, TheNextSwitchIsToldWithItsClockTime) {
  Bench bench(manual());
  bench.run_until(instant_at(7));
  bench.engine->go(bench.clock.now());
  EXPECT_EQ(bench.engine->target().next_at, instant_at(8)) << "the second walk is announced a second before 2 s";
}

TEST(CueEngine, AGoOnARunningCueDoesNothing) {
  Bench bench(manual());
  bench.engine->go(bench.clock.now());
  bench.run_until(instant_at(2.5));
  const BusTarget before = bench.engine->target();
  EXPECT_EQ(bench.engine->go(bench.clock.now()), GoAnswer::running);
  EXPECT_EQ(bench.engine->target(), before);
  EXPECT_EQ(bench.engine->standby(), 1U);
}

TEST(CueEngine, WithoutFollowOnTheShowStandsAtTheEndOfTheSet) {
  Bench bench(manual());
  bench.engine->go(bench.clock.now());
  bench.run_until(instant_at(100));
  EXPECT_EQ(bench.engine->position(), instant_at(4));
  EXPECT_EQ(bench.lit().cause, "end of cue 1");
  EXPECT_TRUE(bench.lit().settled);
  EXPECT_EQ(bench.engine->target().next_at, kNever);
  EXPECT_EQ(bench.engine->state(0), CueState::done);
  EXPECT_EQ(bench.engine->active(), std::nullopt);
}

TEST(CueEngine, ALaterSectionsCueBeginsWithTheWalkIntoIt) {
  Bench bench(manual());
  bench.engine->go(bench.clock.now());
  bench.run_until(instant_at(100));
  bench.engine->go(bench.clock.now());
  EXPECT_EQ(bench.engine->position(), instant_at(4));
  EXPECT_EQ(bench.lit().cause, "s1/3") << "the mark at which the walk into s2 begins";
  bench.run_until(instant_at(104));
  EXPECT_EQ(bench.engine->position(), instant_at(8));
  EXPECT_EQ(bench.lit().cause, "s2/1");
}

TEST(CueEngine, PreWaitDelaysTheFirstSwitch) {
  auto cues = manual();
  cues[0].pre_wait = milliseconds(3000);
  Bench bench(cues);
  bench.engine->go(bench.clock.now());
  EXPECT_EQ(bench.engine->state(0), CueState::pre_wait);
  EXPECT_EQ(bench.engine->target().next_at, instant_at(3));
  EXPECT_EQ(bench.engine->go(bench.clock.now()), GoAnswer::running);
  bench.run_until(instant_at(2.999));
  EXPECT_EQ(bench.lit().cause, "opening");
  bench.run_until(instant_at(3));
  EXPECT_EQ(bench.lit().cause, "s1/1");
}

TEST(CueEngine, AGoComesNoSoonerThanTheBusesCanCarryIt) {
  Bench bench(manual(), {milliseconds(250)});
  bench.engine->go(bench.clock.now());
  EXPECT_EQ(bench.engine->target().next_at, instant_at(0.25));
}

TEST(CueEngine, AutoFollowRunsStraightIntoTheNextCue) {
  Bench bench(following());
  bench.engine->go(bench.clock.now());
  bench.run_until(instant_at(3.9));
  EXPECT_EQ(bench.engine->target().next_at, instant_at(4)) << "the buses know the next cue's first switch before it";
  bench.run_until(instant_at(4));
  EXPECT_EQ(bench.engine->active(), 1U);
  EXPECT_EQ(bench.engine->position(), instant_at(4));
  bench.run_until(instant_at(13));
  EXPECT_EQ(bench.engine->position(), instant_at(13));
  for (const Switch& s : bench.schedule->switches()) EXPECT_TRUE(!s.settled || !s.cue) << s.cause;
}

TEST(CueEngine, PostWaitStandsAtTheEndOfTheSetBeforeTheNextCue) {
  auto cues = following();
  cues[0].post_wait = milliseconds(5000);
  Bench bench(cues);
  bench.engine->go(bench.clock.now());
  bench.run_until(instant_at(4));
  EXPECT_EQ(bench.lit().cause, "end of cue 1");
  EXPECT_EQ(bench.engine->state(0), CueState::post_wait);
  EXPECT_EQ(bench.engine->target().next_at, instant_at(9));
  bench.run_until(instant_at(8.9));
  EXPECT_EQ(bench.engine->position(), instant_at(4));
  bench.run_until(instant_at(10));
  EXPECT_EQ(bench.engine->position(), instant_at(5));
  EXPECT_EQ(bench.engine->state(0), CueState::done);
}

TEST(CueEngine, AutoContinueCountsItsPostWaitFromTheStartOfTheCue) {
  auto cues = following();
  cues[0].continue_mode = ContinueMode::auto_continue;
  cues[0].post_wait = milliseconds(5000);
  Bench bench(cues);
  bench.engine->go(bench.clock.now());
  bench.run_until(instant_at(4));
  EXPECT_EQ(bench.engine->target().next_at, instant_at(5)) << "5 s after the start, 1 s after the end of the section";
  cues[0].post_wait = milliseconds(1000);
  Bench early(cues);
  early.engine->go(early.clock.now());
  early.run_until(instant_at(3.9));
  EXPECT_EQ(early.engine->target().next_at, instant_at(4)) << "nobody leaves a section that is not over";
}

TEST(CueEngine, AfterTheLastCueThereIsNothingLeft) {
  Bench bench(following());
  bench.engine->go(bench.clock.now());
  bench.run_until(instant_at(60));
  EXPECT_TRUE(bench.engine->finished());
  EXPECT_EQ(bench.engine->position(), instant_at(20));
  EXPECT_EQ(bench.lit().cause, "s3/3");
  EXPECT_EQ(bench.engine->go(bench.clock.now()), GoAnswer::nothing_left);
}

TEST(CueEngine, OneLongStepLightsWhatManyShortOnesLight) {
  for (double time_s = 0; time_s < 25; time_s += 0.37) {
    Bench one(following());
    one.engine->go(kStart);
    one.engine->step(instant_at(time_s));
    Bench many(following());
    many.engine->go(kStart);
    many.run_until(instant_at(time_s));
    EXPECT_EQ(one.engine->target(), many.engine->target()) << time_s;
  }
}

TEST(CueEngine, LedByASourceOfTimeItGoesAtItsSpeedAndCuesFollowEachOther) {
  Bench bench(manual());
  bench.engine->set_limits({100, 200, 110});
  bench.engine->lead(bench.clock.now(), 1'250'000);
  EXPECT_EQ(bench.engine->start(bench.clock.now(), instant_at(1)), GoAnswer::started);
  bench.run_until(instant_at(5));
  EXPECT_EQ(bench.engine->position(), instant_at(4)) << "cue 1 is proved for 100 % and no more";
  bench.run_until(instant_at(9));
  EXPECT_EQ(bench.engine->position(), instant_at(9)) << "cue 2 has followed by itself, at 125 %";
  bench.engine->lead(bench.clock.now(), std::nullopt);
  EXPECT_EQ(bench.engine->position(), instant_at(9));
  bench.run_until(instant_at(60));
  EXPECT_EQ(bench.engine->position(), instant_at(12)) << "by itself it waits for GO again";
}

TEST(CueEngine, AStepAheadLightsWhereItGetsToAndDoesNotLeaveTheCue) {
  Bench bench(manual());
  EXPECT_EQ(bench.engine->go(bench.clock.now()), GoAnswer::started);
  bench.run_until(instant_at(1.8));
  bench.engine->make_up(bench.clock.now(), milliseconds(500));
  EXPECT_EQ(bench.engine->position(), instant_at(2.3));
  EXPECT_EQ(bench.lit().time, instant_at(2));
  bench.engine->make_up(bench.clock.now(), seconds(9));
  EXPECT_EQ(bench.engine->position(), instant_at(4));
  bench.run_until(instant_at(60));
  EXPECT_EQ(bench.engine->standby(), 1U);
}

TEST(CueEngine, AStartCanBeMovedUntilItHasHappened) {
  Bench bench(manual());
  EXPECT_EQ(bench.engine->start(bench.clock.now(), instant_at(3)), GoAnswer::started);
  bench.engine->move_start(bench.clock.now(), instant_at(2));
  EXPECT_EQ(bench.engine->goes_at(), instant_at(2));
  bench.run_until(instant_at(2.5));
  bench.engine->move_start(bench.clock.now(), instant_at(9));
  EXPECT_EQ(bench.engine->position(), instant_at(0.5));
}

TEST(CueEngine, NamesItsStates) {
  EXPECT_EQ(to_text(CueState::pre_wait), "pre-wait");
  EXPECT_EQ(to_text(CueState::done), "done");
}

}  // namespace
}  // namespace footlight::controller
