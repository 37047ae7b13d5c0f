// SPDX-License-Identifier: Apache-2.0
#include "controller/time/chase.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"
#include "tests/controller/time/led_show.hpp"

namespace footlight::controller {
namespace {

using Kind = Command::Kind;
using Phase = Rehearsal::Phase;
using ResetState = Rehearsal::ResetState;
using State = TimeFollower::State;
using Alarms = std::vector<TimeAlarm>;

/// A source that says every 40 ms where it is.
struct Bench : tests::LedShow {
  using LedShow::LedShow;

  void tick() {
    if (clock.now() >= next_fix) {
      if (speaks) hear(clock.now(), source);
      next_fix += milliseconds(40);
    }
    step();
    clock.advance(milliseconds(10));
    source += seconds(0.01 * rate);
  }
  void run(double time_s) {
    for (const Instant end = clock.now() + seconds(time_s); clock.now() < end;) tick();
  }
  /// The source begins four seconds before the show, and plays so far into it.
  void play_into(double time_s) {
    source = seconds(-4);
    run((4 + time_s) / rate);
  }
  [[nodiscard]] double off_ms() const { return to_seconds(source - engine->position().time_since_epoch()) * 1e3; }
  [[nodiscard]] double position_s() const { return to_seconds(engine->position()); }

  Instant next_fix = kStart;
  Duration source = seconds(-100);
  double rate = 1;
  bool speaks = true;
};

TEST(Chase, TheFirstCueIsCountedInToTheMomentAtWhichTheSourcePassesItsBeginning) {
  Bench bench;
  bench.play_into(-3.5);
  EXPECT_EQ(bench.phase(), Phase::stands);
  bench.play_into(-1);
  EXPECT_EQ(bench.phase(), Phase::counts_in);
  EXPECT_NEAR(to_seconds(bench.rehearsal->goes_at() - bench.clock.now()), 1, 0.02);
  bench.run(1.05);
  EXPECT_EQ(bench.phase(), Phase::runs);
  EXPECT_TRUE(bench.chase->view().follows);
  EXPECT_LT(std::abs(bench.off_ms()), 25);
  bench.run(12);
  EXPECT_EQ(bench.engine->active(), 2U) << "the source brings the next cues";
  EXPECT_LT(std::abs(bench.off_ms()), 12);
  bench.run(8);
  EXPECT_EQ(bench.phase(), Phase::finished);
  EXPECT_EQ(bench.alarms, Alarms{TimeAlarm::follows});
}

TEST(Chase, ASourceThatHasPassedByLessThanHalfASecondBeginsAtOnceAndOneInTheMiddleBeginsNothing) {
  Bench late;
  late.source = seconds(0.1);
  late.run(1);
  EXPECT_EQ(late.phase(), Phase::runs);
  Bench middle;
  middle.source = seconds(5);
  middle.run(10);
  EXPECT_EQ(middle.phase(), Phase::stands);
  EXPECT_EQ(middle.position_s(), 0);
}

TEST(Chase, ASourceThatIsLostWhileItIsCountedInBeginsNothing) {
  Bench bench;
  bench.play_into(-2.5);
  EXPECT_EQ(bench.phase(), Phase::counts_in);
  bench.source -= seconds(10);
  bench.run(3);
  EXPECT_EQ(bench.phase(), Phase::stands);
  EXPECT_EQ(bench.position_s(), 0);
  EXPECT_EQ(bench.alarms, (Alarms{TimeAlarm::follows, TimeAlarm::jumped}));
}

TEST(Chase, WhatTheOperatorHoldsTheSourceDoesNotBegin) {
  Bench bench;
  bench.play_into(3);
  EXPECT_EQ(bench.say(Kind::hold), Outcome::done);
  const double held_s = bench.position_s();
  bench.run(1);
  EXPECT_FALSE(bench.chase->view().follows);
  bench.play_into(3.2);
  EXPECT_EQ(bench.position_s(), held_s) << "the source has passed the place once more";
  EXPECT_EQ(bench.say(Kind::go), Outcome::goes_on);
  bench.run(2);
  EXPECT_EQ(bench.phase(), Phase::counts_in) << "four counts";
}

TEST(Chase, WhatWasHeldUnderAnotherProgramTheSourceDoesNotBeginEither) {
  for (const Chase::Word word : {Chase::Word{true, false}, {false, true}}) {
    Bench bench;
    bench.chase->take_up(word);
    bench.play_into(5);
    EXPECT_EQ(bench.phase(), Phase::stands);
    EXPECT_EQ(bench.position_s(), 0);
    EXPECT_EQ(bench.say(Kind::follow), Outcome::done);
    bench.play_into(5);
    EXPECT_TRUE(bench.chase->view().follows);
  }
}

TEST(Chase, HoldCountsForWhatStandsToo) {
  Bench bench;
  bench.play_into(-3.5);
  EXPECT_EQ(bench.say(Kind::hold), Outcome::nothing_runs);
  bench.play_into(5);
  EXPECT_EQ(bench.phase(), Phase::stands) << "nobody has said GO since";
}

TEST(Chase, AfterAHoldAtTheEndOfTheSetFollowLetsTheSourceGoOn) {
  Bench bench;
  bench.play_into(3);
  EXPECT_EQ(bench.say(Kind::hold_at_end), Outcome::done);
  bench.run(2);
  EXPECT_EQ(bench.position_s(), 4);
  bench.play_into(-1);
  EXPECT_EQ(bench.say(Kind::follow), Outcome::done);
  bench.run(7);
  EXPECT_TRUE(bench.chase->view().follows);
  EXPECT_LT(std::abs(bench.off_ms()), 25);
}

TEST(Chase, WhatABarHasHeldTheSourceDoesNotBeginWhenTheBarGoes) {
  Bench bench;
  bench.play_into(3);
  bench.rehearsal->set_bars(kHoldPressed, bench.clock.now());
  bench.run(0.5);
  EXPECT_EQ(bench.phase(), Phase::stands);
  bench.rehearsal->set_bars(0, bench.clock.now());
  bench.play_into(3.5);
  EXPECT_EQ(bench.phase(), Phase::stands);
  Bench unready;
  unready.rehearsal->set_bars(kNotReady, unready.clock.now());
  unready.play_into(1);
  EXPECT_EQ(unready.phase(), Phase::stands);
  unready.rehearsal->set_bars(0, unready.clock.now());
  unready.play_into(1);
  EXPECT_EQ(unready.phase(), Phase::runs);
}

TEST(Chase, ACueWhoseGateIsOpenDoesNotFollowASourceByItself) {
  Bench bench(TimeLoss::next_hold, 1);
  bench.play_into(3);
  bench.rehearsal->set_bars(1, bench.clock.now());
  bench.run(3);
  EXPECT_EQ(bench.position_s(), 4);
  EXPECT_EQ(bench.phase(), Phase::stands);
}

TEST(Chase, UnfollowedTheShowGoesByItsOwnClockAndItsOwnCueList) {
  Bench bench;
  bench.rate = 0.9;
  bench.play_into(3);
  EXPECT_EQ(bench.say(Kind::unfollow), Outcome::done);
  EXPECT_EQ(bench.engine->percent(), 100);
  bench.run(5);
  EXPECT_EQ(bench.position_s(), 4) << "cue 2 waits for GO again";
  EXPECT_EQ(bench.phase(), Phase::stands);
}

TEST(Chase, JoinAsksForTheWayToWherePeopleNextStandAfterTheSource) {
  Bench bench;
  EXPECT_EQ(bench.say(Kind::join), Outcome::no_source);
  bench.source = seconds(8.5);
  bench.run(0.4);
  EXPECT_EQ(bench.say(Kind::join), Outcome::done);
  EXPECT_EQ(bench.rehearsal->reset().state, ResetState::wanted);
  EXPECT_EQ(bench.rehearsal->reset().to, instant_at(10));
  EXPECT_EQ(bench.say(Kind::placed), Outcome::done) << "people are there, by the operator's word";
  bench.run(2);
  EXPECT_TRUE(bench.chase->view().follows);
  EXPECT_LT(std::abs(bench.off_ms()), 25);
}

TEST(Chase, AStepAheadIsNoFasterThanTheWalksBehindItAreProvedFor) {
  Bench proved;
  proved.engine->set_limits({100, 105, 105});
  proved.play_into(4.5);
  proved.source += seconds(0.3);
  proved.run(4.2);
  // At 8 s: a walk of two seconds at 105 % may begin 0.095 s later.
  EXPECT_GT(proved.off_ms(), 150);
  EXPECT_LT(proved.off_ms(), 250);
  EXPECT_FALSE(proved.backwards);
}

TEST(Chase, NoneOfWhatSourcesSayMovesAnybodyWhoWasNotToMove) {
  EXPECT_TRUE(rc::check("random sources and orders", [] {
    Rng rng(*rc::gen::arbitrary<std::uint64_t>());
    Bench bench(static_cast<TimeLoss>(rng.below(3)));
    bench.engine->set_limits({110, 130, 103});
    bench.play_into(0.5);
    bench.fastest = 0;
    constexpr std::array kOrders{Kind::hold,     Kind::go,   Kind::hold_at_end, Kind::run_on, Kind::follow,
                                 Kind::unfollow, Kind::join, Kind::cancel,      Kind::tempo};
    for (int i = 0; i < 60; ++i) {
      switch (rng.below(8)) {
        case 0:
          bench.source += seconds(4 * rng.uniform() - 2);
          break;
        case 1:
          bench.rate = 0.3 + 1.6 * rng.uniform();
          break;
        case 2:
          bench.speaks = !bench.speaks;
          break;
        case 3:
          (void)bench.say(kOrders.at(rng.below(kOrders.size())));
          break;
        case 4:
          for (int k = 0; k < 20; ++k) bench.hear(bench.clock.now(), seconds(40 * rng.uniform() - 10));
          break;
        default:
          break;
      }
      const Duration before = bench.position.time_since_epoch();
      bench.run(0.3);
      const Duration moved = bench.engine->position().time_since_epoch() - before;
      RC_ASSERT(moved >= Duration{});
      // At the fastest proved speed, and one step.
      RC_ASSERT(moved <= seconds(0.31 * 1.3) + Chase::kStepped);
      RC_ASSERT(!bench.backwards);
    }
  }));
}

}  // namespace
}  // namespace footlight::controller
