// SPDX-License-Identifier: Apache-2.0
#include "controller/rehearsal.hpp"

#include <array>
#include <map>
#include <set>
#include <utility>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/clock.hpp"
#include "core/rng.hpp"
#include "tests/controller/fake_driver.hpp"
#include "tests/support/small_show.hpp"

namespace footlight::controller {
namespace {

using tests::cue_of;
using tests::SmallShow;
using Kind = Command::Kind;
using Phase = Rehearsal::Phase;
using ResetState = Rehearsal::ResetState;

std::vector<Cue> manual() { return {cue_of("1", 0), cue_of("2", 1), cue_of("3", 2)}; }

/// Three sections: [0, 4], [8, 12], [16, 20] s, walks of 2 s in them and of 4 s between them; 120 counts a minute. A
/// desk that plans a reset move as soon as one is wanted: people stand for the count-in, then all walk for 3 s.
struct Bench {
  explicit Bench(std::vector<Cue> cues = manual(), double count_in = 0) : small(tests::random_show(6, 6, 4, 3, 2, 1)) {
    small.show.cues = std::move(cues);
    small.rig = tests::lamps_everywhere(small.show.stage.grid, {BusKind::serial}, 115'200);
    std::vector<std::unique_ptr<drivers::Driver>> drivers;
    drivers.push_back(std::make_unique<FakeDriver>(small.rig.nodes.size(), kChannelsPerNode, false));
    schedule.emplace(build_schedule(small.show, small.plan, small.rig, drivers).value());
    auto plays = cue_plays(small.show, small.plan);
    engine.emplace(*schedule, plays, std::vector<Duration>(plays.size()));
    settings.count_in_counts = count_in;
    rehearsal.emplace(*engine, small.show.tempo, Stands(small.plan), settings,
                      [](std::size_t, std::size_t) { return Duration{}; });
  }

  Outcome tell(Kind kind, Instant position = {}, Instant until = {}, int percent = 100) {
    Command command;
    command.kind = kind;
    command.position = position;
    command.until = until;
    command.percent = percent;
    return rehearsal->apply(command, clock.now());
  }
  Outcome go() {
    clock.advance(settings.least_between_gos);
    rehearsal->step(clock.now());
    return tell(Kind::go);
  }

  void plan_what_is_wanted() {
    const Rehearsal::Reset& reset = rehearsal->reset();
    if (reset.state != ResetState::wanted) return;
    Command command;
    command.kind = Kind::reset_planned;
    command.reset = reset.id;
    auto& [first, move] = moves[{reset.from, reset.to}];
    if (!move) {
      const auto from = cells_at(small.plan, reset.from);
      const auto to = cells_at(small.plan, reset.to);
      std::vector<std::vector<Mark>> tracks;
      for (std::size_t p = 0; p < from.size(); ++p) {
        tracks.push_back({{kStart, from[p]}, {instant_at(2), from[p]}, {instant_at(5), to[p]}});
      }
      Plan way = tests::plan_of(small.plan.stage.grid, std::move(tracks));
      way.sections = {{"here", kStart, kStart, 100, {}, {}, {}},
                      {"there", instant_at(5), instant_at(5), 100, {}, {}, {}}};
      way.valid = true;
      move = build_reset(small.show, way, small.rig, *schedule);
      first = schedule->add(*move).value();
    }
    command.first = first;
    command.move = &*move;
    EXPECT_EQ(rehearsal->apply(command, clock.now()), Outcome::done);
  }

  /// As the program does: from event to event, never past one.
  void run_until(Instant end) {
    rehearsal->step(clock.now());
    while (clock.now() < end) {
      clock.advance_to(std::min(end, rehearsal->next_event()));
      rehearsal->step(clock.now());
    }
  }
  void run_for(double time_s) { run_until(clock.now() + seconds(time_s)); }

  [[nodiscard]] Instant position() const { return engine->position(); }
  [[nodiscard]] std::size_t lit() const { return rehearsal->target().current; }
  [[nodiscard]] std::string cause() const { return schedule->switches().at(lit()).cause; }
  [[nodiscard]] bool resets() const {
    return rehearsal->phase() == Phase::resets || rehearsal->phase() == Phase::reset_held;
  }

  SmallShow small;
  ManualClock clock;
  Rehearsal::Settings settings;
  std::optional<CueSchedule> schedule;
  std::optional<CueEngine> engine;
  std::optional<Rehearsal> rehearsal;
  std::map<std::pair<Instant, Instant>, std::pair<std::size_t, std::optional<ResetMove>>> moves;
};

TEST(Rehearsal, AShowThatBeginsAtAPlaceShowsWhatItWouldShowHadItBeenPlayedToThere) {
  EXPECT_TRUE(rc::check("the lamps of a place", [] {
    const Instant place = kStart + milliseconds(*rc::gen::inRange(0, 20'001));
    Bench played;
    while (played.position() < place) {
      if (played.rehearsal->phase() == Phase::stands) RC_ASSERT(played.go() == Outcome::cue_started);
      played.run_until(played.clock.now() + std::min(place - played.position(), milliseconds(500)));
    }
    played.tell(Kind::hold);
    RC_ASSERT(played.position() == place);
    Bench begun;
    begun.rehearsal->begin_at(place);
    begun.run_for(60);
    RC_ASSERT(begun.position() == place);
    const auto walks_now = [&](Instant time) { return time == place; };  // begun, or about to
    const auto& switches = begun.schedule->switches();
    if (std::ranges::none_of(switches, walks_now, &Switch::time)) RC_ASSERT(begun.lit() == played.lit());
    RC_ASSERT(begun.go() == (place == instant_at(20)              ? Outcome::nothing_left
                             : begun.rehearsal->engine().active() ? Outcome::goes_on
                                                                  : Outcome::cue_started));
    begun.run_for(20);
    RC_ASSERT(begun.position() == (place < instant_at(4)    ? instant_at(4)
                                   : place < instant_at(12) ? instant_at(12)
                                                            : instant_at(20)));
  }));
}

TEST(Rehearsal, FreezeStopsInTheMiddleOfAWalkAndGoGoesOnWithACountIn) {
  Bench bench(manual(), 4);
  EXPECT_EQ(bench.go(), Outcome::cue_started);
  EXPECT_EQ(bench.rehearsal->phase(), Phase::counts_in);
  bench.run_for(2 + 0.7);
  EXPECT_EQ(bench.position(), instant_at(0.7));
  EXPECT_EQ(bench.tell(Kind::hold), Outcome::done);
  const std::size_t lit = bench.lit();
  bench.run_for(60);
  EXPECT_EQ(bench.position(), instant_at(0.7));
  EXPECT_EQ(bench.lit(), lit);
  EXPECT_EQ(bench.rehearsal->target().next_at, kNever);
  EXPECT_EQ(bench.tell(Kind::hold), Outcome::nothing_runs);
  EXPECT_EQ(bench.go(), Outcome::goes_on);
  const Instant goes_at = bench.clock.now() + seconds(2);
  EXPECT_EQ(bench.rehearsal->goes_at(), goes_at) << "four counts";
  bench.run_until(goes_at + seconds(0.1));
  EXPECT_EQ(bench.position(), instant_at(0.8));
}

TEST(Rehearsal, AHoldInTheCountInTakesTheGoBack) {
  Bench bench(manual(), 4);
  bench.go();
  bench.run_for(1);
  EXPECT_EQ(bench.tell(Kind::hold), Outcome::done);
  EXPECT_EQ(bench.rehearsal->phase(), Phase::stands);
  EXPECT_EQ(bench.engine->standby(), 0U);
  EXPECT_EQ(bench.cause(), "opening");
}

TEST(Rehearsal, HoldAtTheEndOfTheSetStopsBeforeTheNextWalkBegins) {
  Bench bench;
  bench.go();
  bench.run_for(0.5);
  EXPECT_EQ(bench.tell(Kind::hold_at_end), Outcome::done);
  EXPECT_EQ(bench.position(), instant_at(0.5)) << "people walk on";
  bench.run_for(30);
  EXPECT_EQ(bench.position(), instant_at(2));
  EXPECT_LT(bench.schedule->switches()[bench.lit()].time, instant_at(2)) << "nobody is sent on";
  EXPECT_EQ(bench.go(), Outcome::goes_on);
  EXPECT_EQ(bench.schedule->switches()[bench.lit()].time, instant_at(2));
}

TEST(Rehearsal, HoldAtTheEndAlsoHoldsWhereTheNextCueWouldFollow) {
  Bench bench({cue_of("1", 0, ContinueMode::auto_follow), cue_of("2", 1), cue_of("3", 2)});
  bench.go();
  bench.run_for(3);
  bench.tell(Kind::hold_at_end);
  bench.run_for(30);
  EXPECT_EQ(bench.position(), instant_at(4));
  EXPECT_EQ(bench.engine->standby(), 1U);
  bench.go();
  bench.run_for(0.5);
  EXPECT_EQ(bench.engine->active(), 1U);
}

TEST(Rehearsal, AHoldAtTheEndCanBeTakenBack) {
  Bench bench;
  bench.go();
  bench.run_for(0.5);
  bench.tell(Kind::hold_at_end);
  EXPECT_EQ(bench.tell(Kind::run_on), Outcome::done);
  bench.run_for(2);
  EXPECT_EQ(bench.position(), instant_at(2.5));
}

TEST(Rehearsal, BackAsksForAResetMoveAndNothingMovesBeforeItIsConfirmed) {
  Bench bench;
  bench.go();
  bench.run_for(10);
  ASSERT_EQ(bench.position(), instant_at(4));
  const std::size_t lit = bench.lit();
  EXPECT_EQ(bench.tell(Kind::back), Outcome::done);
  EXPECT_EQ(bench.rehearsal->reset().state, ResetState::wanted);
  EXPECT_EQ(bench.rehearsal->reset().from, instant_at(4));
  EXPECT_EQ(bench.rehearsal->reset().to, instant_at(0));
  EXPECT_EQ(bench.go(), Outcome::being_planned);
  bench.plan_what_is_wanted();
  bench.run_for(10);
  EXPECT_EQ(bench.position(), instant_at(4));
  EXPECT_EQ(bench.lit(), lit);
  EXPECT_EQ(bench.go(), Outcome::reset_started);
  std::set<std::size_t> seen;
  while (bench.resets()) {
    EXPECT_EQ(bench.position(), instant_at(4)) << "people are on their way";
    seen.insert(bench.lit());
    bench.run_until(bench.rehearsal->next_event());
  }
  EXPECT_EQ(bench.position(), instant_at(0));
  EXPECT_EQ(bench.cause(), "opening");
  EXPECT_GE(seen.size(), 3U) << "the place before, announced, walking";
  EXPECT_EQ(bench.go(), Outcome::cue_started);
  bench.run_for(1);
  EXPECT_EQ(bench.position(), instant_at(1));
}

TEST(Rehearsal, TheResetMoveLightsPeoplesWayAndThenTheirPlaces) {
  Bench bench;
  bench.go();
  bench.run_for(10);
  bench.tell(Kind::back);
  bench.plan_what_is_wanted();
  bench.go();
  bench.run_for(0.3 + 4);
  const auto looks = [&](std::size_t k, CellIndex cell) {
    return bench.schedule->looks_of(k, NodeIndex::of(cell.at() / kChannelsPerNode))[cell.at() % kChannelsPerNode];
  };
  ASSERT_GE(bench.lit(), bench.schedule->switches().size()) << "a row of the reset move";
  for (const CellIndex goal : cells_at(bench.small.plan, instant_at(0))) EXPECT_NE(looks(bench.lit(), goal), kDark);
  const auto goals = cells_at(bench.small.plan, instant_at(0));
  for (const CellIndex left : cells_at(bench.small.plan, instant_at(4))) {
    if (std::ranges::find(goals, left) != goals.end()) continue;
    EXPECT_EQ(looks(bench.lit(), left), kDark);
  }
}

TEST(Rehearsal, AJumpFromAWalkLetsPeopleWalkToTheEndOfIt) {
  Bench bench;
  bench.go();
  bench.run_for(0.5);
  bench.tell(Kind::jump, instant_at(16));
  EXPECT_EQ(bench.rehearsal->reset().from, instant_at(2));
  bench.run_for(30);
  EXPECT_EQ(bench.position(), instant_at(2));
  bench.plan_what_is_wanted();
  EXPECT_EQ(bench.go(), Outcome::reset_started);
  bench.run_for(30);
  EXPECT_EQ(bench.position(), instant_at(16));
  EXPECT_EQ(bench.engine->active(), 2U) << "the cue whose play holds it";
  EXPECT_EQ(bench.go(), Outcome::goes_on);
}

TEST(Rehearsal, AWalkThatAHoldHasCutIsWalkedToItsEndBeforeTheResetMove) {
  Bench bench;
  bench.go();
  bench.run_for(0.5);
  bench.tell(Kind::hold);
  bench.tell(Kind::jump, instant_at(16));
  bench.plan_what_is_wanted();
  EXPECT_EQ(bench.go(), Outcome::walks_on);
  bench.run_for(30);
  EXPECT_EQ(bench.position(), instant_at(2));
  EXPECT_EQ(bench.go(), Outcome::reset_started);
}

TEST(Rehearsal, AJumpIntoAWalkGoesToItsBeginning) {
  Bench bench;
  bench.tell(Kind::jump, instant_at(9.3));
  EXPECT_EQ(bench.rehearsal->reset().to, instant_at(8));
}

TEST(Rehearsal, WithoutAWayTheOperatorSaysThatPeopleArePlaced) {
  Bench bench;
  bench.tell(Kind::jump, instant_at(8));
  Command command;
  command.kind = Kind::reset_impossible;
  command.reset = bench.rehearsal->reset().id;
  bench.rehearsal->apply(command, bench.clock.now());
  EXPECT_EQ(bench.go(), Outcome::no_way);
  EXPECT_EQ(bench.tell(Kind::placed), Outcome::done);
  EXPECT_EQ(bench.position(), instant_at(8));
  EXPECT_EQ(bench.lit(), lit_at(*bench.schedule, instant_at(8), true));
}

TEST(Rehearsal, APlanThatPutsPeopleElsewhereBeginsWithTheWayToItAndNothingElse) {
  Bench bench(manual(), 4);
  // The plan before left people where they stand in this one at 4 s; the show goes on at 8 s.
  const auto from = cells_at(bench.small.plan, instant_at(4));
  const auto to = cells_at(bench.small.plan, instant_at(8));
  std::vector<std::vector<Mark>> tracks;
  for (std::size_t p = 0; p < from.size(); ++p) {
    tracks.push_back({{kStart, from[p]}, {instant_at(2), from[p]}, {instant_at(5), to[p]}});
  }
  Plan way = tests::plan_of(bench.small.plan.stage.grid, std::move(tracks));
  way.sections = {{"here", kStart, kStart, 100, {}, {}, {}}, {"there", instant_at(5), instant_at(5), 100, {}, {}, {}}};
  way.valid = true;
  const std::size_t first =
      bench.schedule->add(build_reset(bench.small.show, way, bench.small.rig, *bench.schedule, true)).value();
  bench.rehearsal->begin_elsewhere(instant_at(8), first, bench.schedule->reset_of(first));
  bench.run_for(60);
  EXPECT_EQ(bench.lit(), first) << "lamps show people where they stand";
  EXPECT_EQ(bench.position(), instant_at(8));
  for (const Kind kind : {Kind::jump, Kind::back, Kind::step, Kind::cancel}) {
    EXPECT_EQ(bench.tell(kind, instant_at(0)), Outcome::reset_first);
  }
  EXPECT_EQ(bench.tell(Kind::loop, instant_at(8), instant_at(12)), Outcome::reset_first);
  EXPECT_EQ(bench.lit(), first);
  EXPECT_FALSE(bench.rehearsal->may_change_plan());
  EXPECT_EQ(bench.go(), Outcome::reset_started);
  EXPECT_EQ(bench.lit(), first);
  bench.run_for(4);
  EXPECT_GT(bench.lit(), first) << "they walk";
  bench.run_for(2);
  EXPECT_EQ(bench.rehearsal->phase(), Phase::stands);
  EXPECT_EQ(bench.lit(), lit_at(*bench.schedule, instant_at(8), true));
  EXPECT_TRUE(bench.rehearsal->may_change_plan());
  EXPECT_EQ(bench.go(), Outcome::goes_on);
}

TEST(Rehearsal, PlacedEndsTheWayToANewPlanToo) {
  Bench bench;
  ResetMove move;
  move.switches.resize(2);
  move.table.resize(2 * bench.small.rig.nodes.size() * kChannelsPerNode);
  const std::size_t first = bench.schedule->add(std::move(move)).value();
  bench.rehearsal->begin_elsewhere(instant_at(4), first, bench.schedule->reset_of(first));
  EXPECT_EQ(bench.lit(), first);
  EXPECT_EQ(bench.tell(Kind::placed), Outcome::done);
  EXPECT_EQ(bench.lit(), lit_at(*bench.schedule, instant_at(4), true));
  EXPECT_EQ(bench.go(), Outcome::cue_started);
}

TEST(Rehearsal, ThePlanMayChangeWhereEverybodyStandsAndNothingRuns) {
  Bench bench;
  EXPECT_TRUE(bench.rehearsal->may_change_plan());
  bench.go();
  bench.run_for(1);
  EXPECT_FALSE(bench.rehearsal->may_change_plan()) << "the cue runs";
  bench.tell(Kind::hold);
  EXPECT_FALSE(bench.rehearsal->may_change_plan()) << "people are in the middle of a walk";
  bench.tell(Kind::jump, instant_at(0));
  EXPECT_FALSE(bench.rehearsal->may_change_plan()) << "they are to go elsewhere";
  bench.tell(Kind::cancel);
  bench.go();
  bench.run_for(10);
  EXPECT_EQ(bench.position(), instant_at(4));
  EXPECT_TRUE(bench.rehearsal->may_change_plan());
}

TEST(Rehearsal, TempoAndTheGoGuardGoOnInANewPlan) {
  Bench before;
  before.tell(Kind::tempo, {}, {}, 80);
  EXPECT_EQ(before.go(), Outcome::cue_started);
  before.run_for(20);
  Bench now;
  now.rehearsal->begin_at(instant_at(8));
  now.clock.advance_to(before.clock.now());
  now.rehearsal->carry_on(*before.rehearsal, now.clock.now());
  EXPECT_EQ(now.engine->percent(), 80);
  const Instant at = now.clock.now();
  EXPECT_EQ(before.tell(Kind::go), Outcome::cue_started);
  now.rehearsal->carry_on(*before.rehearsal, at);
  EXPECT_EQ(now.tell(Kind::go), Outcome::too_soon) << "for the guard it is the same desk";
}

TEST(Rehearsal, TheMoveOfAJumpThatWasReplacedIsNotTaken) {
  Bench bench;
  bench.tell(Kind::jump, instant_at(8));
  Command late;
  late.kind = Kind::reset_planned;
  late.reset = bench.rehearsal->reset().id;
  const ResetMove move;
  late.move = &move;
  bench.tell(Kind::jump, instant_at(16));
  EXPECT_EQ(bench.rehearsal->apply(late, bench.clock.now()), Outcome::no_reset);
  EXPECT_EQ(bench.rehearsal->reset().state, ResetState::wanted);
}

TEST(Rehearsal, AResetMoveCanBeHeldAndGoesOn) {
  Bench bench(manual(), 2);
  bench.tell(Kind::jump, instant_at(8));
  bench.plan_what_is_wanted();
  bench.go();
  bench.run_for(0.3 + 2.5);
  EXPECT_EQ(bench.tell(Kind::hold), Outcome::done);
  const std::size_t lit = bench.lit();
  bench.run_for(100);
  EXPECT_EQ(bench.lit(), lit);
  EXPECT_EQ(bench.rehearsal->phase(), Phase::reset_held);
  EXPECT_EQ(bench.go(), Outcome::goes_on);
  bench.run_for(1 + 2.4);
  EXPECT_EQ(bench.rehearsal->phase(), Phase::resets);
  bench.run_for(0.2);
  EXPECT_EQ(bench.position(), instant_at(8));
}

TEST(Rehearsal, ALoopAsksForTheWayBackAtItsEndAgainAndAgain) {
  Bench bench({cue_of("1", 0, ContinueMode::auto_follow), cue_of("2", 1, ContinueMode::auto_follow), cue_of("3", 2)});
  EXPECT_EQ(bench.tell(Kind::loop, instant_at(8), instant_at(12)), Outcome::done);
  EXPECT_EQ(bench.rehearsal->reset().to, instant_at(8)) << "the show stands before the loop";
  for (int round = 0; round < 3; ++round) {
    bench.plan_what_is_wanted();
    EXPECT_EQ(bench.go(), Outcome::reset_started) << round;
    bench.run_for(20);
    EXPECT_EQ(bench.position(), instant_at(8));
    EXPECT_EQ(bench.go(), Outcome::goes_on);
    bench.run_for(30);
    EXPECT_EQ(bench.position(), instant_at(12)) << "and not a step further";
    EXPECT_EQ(bench.rehearsal->reset().state, ResetState::wanted);
  }
  bench.tell(Kind::cancel);
  bench.tell(Kind::loop_off);
  EXPECT_EQ(bench.go(), Outcome::cue_started);
  bench.run_for(1);
  EXPECT_EQ(bench.position(), instant_at(13));
}

TEST(Rehearsal, TheTempoIsHeldAtTheLimitOfTheCue) {
  Bench bench;
  bench.engine->set_limits({118, 200, 150});
  bench.tell(Kind::tempo, {}, {}, 200);
  EXPECT_EQ(bench.engine->percent(), 118);
  bench.go();
  bench.run_for(1);
  EXPECT_EQ(bench.position(), instant_at(1.18));
  bench.tell(Kind::tempo, {}, {}, 50);
  bench.run_for(1);
  EXPECT_EQ(bench.position(), instant_at(1.68));
  bench.tell(Kind::tempo, {}, {}, 1);
  EXPECT_EQ(bench.engine->percent(), kSlowest_percent);
}

TEST(Rehearsal, StepsCountByCount) {
  Bench bench;
  for (int count = 1; count <= 7; ++count) {
    EXPECT_EQ(bench.tell(Kind::step), count == 1 ? Outcome::cue_started : Outcome::goes_on) << count;
    bench.run_for(10);
    EXPECT_EQ(bench.position(), instant_at(0.5 * count)) << count;
  }
}

TEST(Rehearsal, AStepIsCountedInAsAGoIs) {
  Bench bench({}, 4);
  for (const double begins_at_s : {0.0, 0.5}) {
    EXPECT_FALSE(refused(bench.tell(Kind::step)));
    EXPECT_EQ(bench.rehearsal->phase(), Phase::counts_in);
    EXPECT_EQ(bench.rehearsal->goes_at() - bench.clock.now(), seconds(2)) << "four counts";
    bench.run_for(1.999);
    EXPECT_EQ(bench.position(), instant_at(begins_at_s));
    bench.run_for(0.25);
    EXPECT_GT(bench.position(), instant_at(begins_at_s));
    bench.run_for(5);
    EXPECT_EQ(bench.position(), instant_at(begins_at_s + 0.5));
  }
}

TEST(Rehearsal, AStepAndAGoPassOneGuard) {
  Bench bench;
  EXPECT_EQ(bench.tell(Kind::step), Outcome::cue_started);
  bench.run_for(0.75);
  ASSERT_EQ(bench.rehearsal->phase(), Phase::stands);
  EXPECT_EQ(bench.tell(Kind::step), Outcome::too_soon) << "one press that bounces";
  EXPECT_EQ(bench.tell(Kind::go), Outcome::too_soon);
  bench.run_for(0.25);
  EXPECT_EQ(bench.tell(Kind::go), Outcome::goes_on);
  Bench keys;
  Command held;
  held.kind = Kind::step;
  held.source = GoSource::keyboard;
  EXPECT_EQ(keys.rehearsal->apply(held, keys.clock.now()), Outcome::cue_started);
  for (int repeats = 0; repeats < 40; ++repeats) {
    keys.run_for(0.1);
    EXPECT_EQ(keys.rehearsal->apply(held, keys.clock.now()), Outcome::key_held);
  }
  EXPECT_EQ(keys.position(), instant_at(0.5)) << "a key that is held is one step";
}

TEST(Rehearsal, ARefusedGoChangesNothing) {
  Bench bench;
  bench.go();
  bench.run_for(1.5);
  const BusTarget before = bench.rehearsal->target();
  EXPECT_EQ(bench.tell(Kind::go), Outcome::cue_runs);
  EXPECT_EQ(bench.tell(Kind::go), Outcome::too_soon);
  EXPECT_EQ(bench.rehearsal->target(), before);
  EXPECT_EQ(to_text(Outcome::too_soon), "too soon after the last GO");
  EXPECT_EQ(to_text(Outcome::empty_range), "the loop has no length: nobody stands at its beginning before its end");
}

TEST(Rehearsal, BackFromTheTopIsRefused) {
  Bench bench;
  EXPECT_EQ(bench.tell(Kind::back), Outcome::at_the_top);
}

/// The second cue needs gate 0, the third one gate 1.
std::vector<Cue> gated(ContinueMode mode = ContinueMode::manual) {
  std::vector<Cue> cues{cue_of("1", 0, mode), cue_of("2", 1), cue_of("3", 2)};
  cues[1].gates = 1;
  cues[2].gates = 2;
  return cues;
}

TEST(Rehearsal, GoIsRefusedWhileAGateOfTheCueIsOpen) {
  Bench bench(gated());
  bench.rehearsal->set_bars(1, bench.clock.now());
  EXPECT_EQ(bench.rehearsal->barred(), 0U) << "the first cue needs none";
  EXPECT_EQ(bench.go(), Outcome::cue_started);
  bench.run_for(10);
  ASSERT_EQ(bench.position(), instant_at(4));
  EXPECT_EQ(bench.rehearsal->barred(), 1U);
  EXPECT_EQ(bench.go(), Outcome::gate_open);
  bench.run_for(1);
  EXPECT_EQ(bench.tell(Kind::step), Outcome::gate_open);
  bench.rehearsal->set_bars(2, bench.clock.now());
  bench.run_for(10);
  EXPECT_EQ(bench.position(), instant_at(4)) << "a gate that closes is no GO";
  EXPECT_EQ(bench.go(), Outcome::cue_started);
  EXPECT_EQ(bench.rehearsal->phase(), Phase::runs) << "the third cue's gate is none of its concern";
}

TEST(Rehearsal, AGateThatIsLostHoldsTheCueAtOnceUntilSomebodyPressesGo) {
  Bench bench(gated());
  bench.go();
  bench.run_for(10);
  bench.go();
  bench.run_for(1);
  ASSERT_EQ(bench.position(), instant_at(5));
  bench.rehearsal->set_bars(1, bench.clock.now());
  EXPECT_EQ(bench.rehearsal->phase(), Phase::stands);
  EXPECT_EQ(bench.position(), instant_at(5));
  EXPECT_EQ(bench.go(), Outcome::gate_open);
  bench.rehearsal->set_bars(0, bench.clock.now());
  bench.run_for(10);
  EXPECT_EQ(bench.position(), instant_at(5));
  EXPECT_EQ(bench.go(), Outcome::goes_on);
}

TEST(Rehearsal, ACueThatWouldFollowAndMayNotIsNotBegun) {
  for (const bool early : {false, true}) {
    Bench bench(gated(ContinueMode::auto_follow));
    if (early) bench.rehearsal->set_bars(1, bench.clock.now());
    bench.go();
    bench.run_for(3);
    if (!early) bench.rehearsal->set_bars(1, bench.clock.now());
    EXPECT_EQ(bench.rehearsal->phase(), Phase::runs) << "this cue does not need it";
    bench.run_for(20);
    EXPECT_EQ(bench.position(), instant_at(4));
    EXPECT_EQ(bench.engine->standby(), 1U);
    EXPECT_LT(bench.schedule->switches()[bench.lit()].time, instant_at(4)) << "nobody is sent on";
    EXPECT_EQ(bench.go(), Outcome::gate_open);
    bench.rehearsal->set_bars(0, bench.clock.now());
    EXPECT_EQ(bench.go(), Outcome::cue_started);
  }
}

TEST(Rehearsal, AGateThatClosesInTimeLetsTheNextCueFollow) {
  Bench bench(gated(ContinueMode::auto_follow));
  bench.rehearsal->set_bars(1, bench.clock.now());
  bench.go();
  bench.run_for(3);
  bench.rehearsal->set_bars(0, bench.clock.now());
  bench.run_for(3);
  EXPECT_EQ(bench.engine->active(), 1U);
}

TEST(Rehearsal, AHoldButtonHoldsWhateverRunsAlsoAResetMove) {
  Bench bench;
  bench.go();
  bench.run_for(10);
  bench.tell(Kind::back);
  bench.plan_what_is_wanted();
  ASSERT_EQ(bench.go(), Outcome::reset_started);
  bench.run_for(1);
  bench.rehearsal->set_bars(kHoldPressed, bench.clock.now());
  EXPECT_EQ(bench.rehearsal->phase(), Phase::reset_held);
  EXPECT_EQ(bench.go(), Outcome::hold_pressed);
  bench.rehearsal->set_bars(kEmergencyHold | kHoldPressed, bench.clock.now());
  EXPECT_EQ(bench.go(), Outcome::emergency_hold);
  bench.rehearsal->set_bars(0, bench.clock.now());
  EXPECT_EQ(bench.go(), Outcome::goes_on);
}

TEST(Rehearsal, AShowThatIsNotReadyRefusesGoAndStopsNothing) {
  Bench bench;
  bench.rehearsal->set_bars(kNotReady, bench.clock.now());
  EXPECT_EQ(bench.go(), Outcome::not_ready);
  EXPECT_EQ(bench.rehearsal->phase(), Phase::stands);
  bench.rehearsal->set_bars(0, bench.clock.now());
  bench.go();
  bench.run_for(1);
  bench.rehearsal->set_bars(kNotReady, bench.clock.now());
  EXPECT_EQ(bench.rehearsal->phase(), Phase::runs);
  EXPECT_EQ(bench.go(), Outcome::cue_runs);
}

// ---- any sequence of commands

/// Sees every step that is made, by rules of its own: nothing here asks the rehearsal why it does something.
class Watch {
 public:
  explicit Watch(Bench& bench) : bench_(bench), last_(bench.rehearsal->target()), position_(bench.position()) {}

  /// @param placed the operator has said that people are placed
  void look(Instant now, bool placed) {
    const BusTarget target = bench_.rehearsal->target();
    const bool resets = bench_.resets();
    if (!resets) {
      // The state function: what is lit follows from the position alone.
      RC_ASSERT(target.current == lit_at(*bench_.schedule, bench_.position(), bench_.engine->waits()));
    }
    RC_ASSERT(target.next_at > now);
    const Duration moved = bench_.position() - position_;
    const bool arrived = was_resetting_ && !resets;
    if (!placed && !arrived) {
      RC_ASSERT(moved >= Duration{});
      RC_ASSERT(moved <= 2 * (now - at_) + Duration(1));
    }
    if (resets) RC_ASSERT(moved == Duration{} || !was_resetting_);
    if (target.current != last_.current && !placed) {
      // Nobody is shown anything that the buses were not told of before, at its very instant.
      RC_ASSERT(target.current == last_.next);
      RC_ASSERT((last_.next_at == now || told_at_ == now));
    }
    if (target.current != last_.current && target.current < bench_.schedule->switches().size()) ++lit_;
    last_ = target;
    position_ = bench_.position();
    was_resetting_ = resets;
    at_ = now;
  }
  void told(Instant now) { told_at_ = now; }
  [[nodiscard]] std::size_t lit() const { return lit_; }

 private:
  Bench& bench_;
  BusTarget last_;
  Instant position_;
  bool was_resetting_ = false;
  Instant at_{};
  Instant told_at_{};
  std::size_t lit_ = 0;
};

void run_watched(Bench& bench, Watch& watch, Instant end) {
  while (bench.clock.now() < end) {
    bench.clock.advance_to(std::min(end, bench.rehearsal->next_event()));
    bench.rehearsal->step(bench.clock.now());
    watch.look(bench.clock.now(), false);
  }
}

Command any_command(Rng& rng) {
  Command command;
  // GO and time come more often than the rest.
  static constexpr std::array kKinds{Kind::go,     Kind::go,          Kind::go,     Kind::go,
                                     Kind::hold,   Kind::hold_at_end, Kind::back,   Kind::jump,
                                     Kind::loop,   Kind::loop_off,    Kind::tempo,  Kind::step,
                                     Kind::run_on, Kind::placed,      Kind::cancel, Kind::acknowledge};
  command.kind = kKinds[rng.below(kKinds.size())];
  command.source = rng.below(2) == 0 ? GoSource::keyboard : GoSource::lines;
  command.position = instant_at(static_cast<double>(rng.below(44)) / 2 - 1);
  command.until = instant_at(static_cast<double>(rng.below(44)) / 2 - 1);
  command.percent = static_cast<int>(rng.below(300));
  return command;
}

std::vector<Cue> any_cues(Rng& rng) {
  std::vector<Cue> cues = manual();
  for (Cue& cue : cues) {
    cue.continue_mode = static_cast<ContinueMode>(rng.below(3));
    cue.pre_wait = milliseconds(static_cast<std::int64_t>(rng.below(3)) * 700);
    cue.post_wait = milliseconds(static_cast<std::int64_t>(rng.below(3)) * 2500);
  }
  return cues;
}

TEST(RehearsalProperty, WhateverIsPressedTheLampsAreAFunctionOfThePositionAndNobodyIsTakenElsewhere) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint64_t>());
    Bench bench(any_cues(rng), static_cast<double>(rng.below(3)) * 2);
    bench.engine->set_limits({118, 200, 130});
    Watch watch(bench);
    for (int i = 0; i < 150; ++i) {
      const Command command = any_command(rng);
      const Rehearsal::Phase before = bench.rehearsal->phase();
      const Outcome outcome = bench.rehearsal->apply(command, bench.clock.now());
      watch.told(bench.clock.now());
      watch.look(bench.clock.now(), command.kind == Kind::placed && !refused(outcome));
      if (command.kind == Kind::go && refused(outcome)) RC_ASSERT(bench.rehearsal->phase() == before);
      if (rng.below(3) > 0) bench.plan_what_is_wanted();
      run_watched(bench, watch, bench.clock.now() + milliseconds(static_cast<std::int64_t>(rng.below(3000))));
    }
    // However it was left: GO and GO again plays the show to its end.
    (void)bench.tell(Kind::acknowledge);
    (void)bench.tell(Kind::loop_off);
    (void)bench.tell(Kind::tempo);
    watch.look(bench.clock.now(), false);
    for (int i = 0; i < 20 && bench.rehearsal->phase() != Phase::finished; ++i) {
      bench.plan_what_is_wanted();
      run_watched(bench, watch, bench.clock.now() + seconds(60));
      (void)bench.tell(Kind::go);
      watch.told(bench.clock.now());
      watch.look(bench.clock.now(), false);
      run_watched(bench, watch, bench.clock.now() + seconds(60));
    }
    RC_ASSERT(bench.position() == instant_at(20));
  }));
}

TEST(RehearsalProperty, NothingRunsPastABarThatConcernsIt) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint64_t>());
    std::vector<Cue> cues = any_cues(rng);
    for (Cue& cue : cues) cue.gates = static_cast<std::uint32_t>(rng.below(4));
    Bench bench(cues);
    for (int i = 0; i < 100; ++i) {
      if (rng.below(2) == 0) {
        bench.rehearsal->set_bars(rng.below(4) | (rng.below(8) == 0 ? kHoldPressed : 0), bench.clock.now());
      } else {
        (void)bench.rehearsal->apply(any_command(rng), bench.clock.now());
      }
      if (rng.below(3) > 0) bench.plan_what_is_wanted();
      const Instant end = bench.clock.now() + milliseconds(static_cast<std::int64_t>(rng.below(3000)));
      do {
        if ((bench.rehearsal->barred() & kHolding) != 0) {
          const Phase phase = bench.rehearsal->phase();
          RC_ASSERT(phase == Phase::stands || phase == Phase::reset_held || phase == Phase::finished);
        }
        bench.clock.advance_to(std::min(end, bench.rehearsal->next_event()));
        bench.rehearsal->step(bench.clock.now());
      } while (bench.clock.now() < end);
    }
  }));
}

TEST(RehearsalProperty, WhoeverTakesAShowUpLightsWhatItWouldHaveLit) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint64_t>());
    const auto cues = any_cues(rng);
    Bench first(cues, static_cast<double>(rng.below(3)) * 2);
    for (int i = 0; i < 30; ++i) {
      (void)first.rehearsal->apply(any_command(rng), first.clock.now());
      if (rng.below(3) > 0) first.plan_what_is_wanted();
      first.run_for(static_cast<double>(rng.below(3000)) / 1000);
    }
    // What is wanted of the future only is lost: a jump. A reset move is followed by its end.
    (void)first.tell(Kind::acknowledge);
    while (first.resets()) {
      if (first.rehearsal->phase() == Phase::reset_held) (void)first.go();
      first.run_for(1);
    }
    (void)first.tell(Kind::cancel);
    Bench second(cues);
    const auto where = first.rehearsal->whereabouts();
    const double gap_s = static_cast<double>(rng.below(6000)) / 1000;
    first.run_for(gap_s);
    second.clock.advance_to(first.clock.now());
    second.rehearsal->take_up(where, second.clock.now());
    for (int i = 0; i < 40; ++i) {
      if (first.rehearsal->reset().state != ResetState::none) break;
      RC_ASSERT(second.rehearsal->target().current == first.rehearsal->target().current);
      RC_ASSERT(std::abs((second.position() - first.position()).count()) <= 4);  // rounded at the hand-over
      RC_ASSERT(second.rehearsal->phase() == first.rehearsal->phase());
      RC_ASSERT(std::abs((second.rehearsal->goes_at() - first.rehearsal->goes_at()).count()) <= 4);
      RC_ASSERT(second.rehearsal->holds_at_end() == first.rehearsal->holds_at_end());
      first.run_for(0.25);
      second.run_until(first.clock.now());
    }
  }));
}

TEST(RehearsalProperty, NoFloodOfCommandsDelaysOrLosesASwitch) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint64_t>());
    const auto cues = any_cues(rng);
    Bench quiet(cues);
    Bench flooded(cues);
    quiet.go();
    flooded.go();
    // Nothing of this is for a show that runs; a thousand a second of it.
    static constexpr std::array kNoise{Kind::go, Kind::step, Kind::placed, Kind::cancel, Kind::run_on, Kind::loop_off};
    for (int ms = 0; ms < 3900; ++ms) {
      if (quiet.rehearsal->phase() != Phase::runs) {
        quiet.run_for(0.001);
        flooded.run_until(quiet.clock.now());
        continue;
      }
      Command command;
      command.kind = kNoise[rng.below(kNoise.size())];
      RC_ASSERT(refused(flooded.rehearsal->apply(command, flooded.clock.now())) || command.kind == Kind::run_on ||
                command.kind == Kind::loop_off);
      quiet.run_for(0.001);
      flooded.run_until(quiet.clock.now());
      RC_ASSERT(quiet.rehearsal->target() == flooded.rehearsal->target());
    }
  }));
}

TEST(RehearsalProperty, OneLongStepLightsWhatManyShortOnesLight) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint64_t>());
    const auto cues = any_cues(rng);
    Bench one(cues, 2);
    Bench many(cues, 2);
    for (int i = 0; i < 12; ++i) {
      const Command command = any_command(rng);
      RC_ASSERT(one.rehearsal->apply(command, one.clock.now()) == many.rehearsal->apply(command, many.clock.now()));
      one.plan_what_is_wanted();
      many.plan_what_is_wanted();
      const Duration dt = milliseconds(static_cast<std::int64_t>(rng.below(6000)));
      one.clock.advance(dt);
      one.rehearsal->step(one.clock.now());
      many.run_until(one.clock.now());
      RC_ASSERT(one.rehearsal->target() == many.rehearsal->target());
    }
  }));
}

}  // namespace
}  // namespace footlight::controller
