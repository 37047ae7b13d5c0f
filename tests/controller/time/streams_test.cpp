// SPDX-License-Identifier: Apache-2.0
//
// What the show does with timecode that runs, jumps, fails and lies: the table of docs/time.md, which this prints
// (FOOTLIGHT_PRINT=1).
#include <cstdio>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "controller/time/ltc.hpp"
#include "controller/time/mtc.hpp"
#include "tests/controller/time/led_show.hpp"
#include "tests/controller/time/tape.hpp"

namespace footlight::controller {
namespace {

using Kind = tests::TapePiece::Kind;
using Phase = Rehearsal::Phase;
using tests::Tape;
using tests::TapePiece;

constexpr double kHour_s = 3600;
constexpr double kPreRoll_s = 4;
constexpr int kSampleRate = 48'000;

struct Heard {
  Instant at;
  Duration position;  ///< in the show's time
};

std::vector<Heard> by_ltc(const Tape& tape, FrameRate expected) {
  LtcDecoder decoder(kSampleRate, expected);
  std::vector<Heard> out;
  decoder.take(tests::sound_of(tape, kSampleRate, 0.03, 5), kStart, [&](const TimeFix& fix) {
    out.push_back({fix.at, fix.position - seconds(kHour_s)});
  });
  return out;
}

std::vector<Heard> by_mtc(const Tape& tape, FrameRate /*told by the stream*/) {
  MtcDecoder decoder;
  Rng rng(5);
  std::vector<Heard> out;
  const auto take = [&](std::span<const std::uint8_t> message, double at_s) {
    const auto fix = decoder.take(message, instant_at(at_s));
    if (fix) out.push_back({fix->at, fix->position - seconds(kHour_s)});
  };
  std::optional<std::int64_t> pair;  // of frames that the quarter frames under way name
  tests::play(
      tape,
      [&](double at_s, std::int64_t number, double speed) {
        const bool second = pair && number == *pair + 1;
        if (!second) pair = number;
        const double quarter_s = to_seconds(frame_time(tape.rate)) / speed / 4;
        for (int q = 0; q < 4; ++q) {
          take(mtc_quarter(code_of(*pair, tape.rate), q + (second ? 4 : 0)), at_s + q * quarter_s);
        }
        if (second) pair.reset();
      },
      [&](double at_s, bool garbage) {
        pair.reset();
        for (int i = 0; garbage && i < 4; ++i) {
          const std::array<std::uint8_t, 2> message{0xF1, static_cast<std::uint8_t>(rng.below(128))};
          take(message, at_s);
        }
      });
  return out;
}

struct Row {
  std::string stream;
  std::string says;  ///< the written rule
  std::vector<TapePiece> pieces;
  Phase phase = Phase::finished;  ///< at the end
  double position_s = 20;         ///< at the end
  std::vector<TimeAlarm> alarms{TimeAlarm::follows};
  std::vector<TimeAlarm> alarms_by_mtc{};  ///< where the eight messages of a code tell it later; empty: the same
  double worst_off_ms = 30;                ///< while it follows and the tape runs as written
  TimeLoss lost = TimeLoss::next_hold;
  FrameRate rate = FrameRate::fps25;
  int limit_percent = 200;
};

/// So far into the show the tape plays as it should.
TapePiece until(double show_s) { return {.lasts_s = kPreRoll_s + show_s}; }
TapePiece rest(double show_s) { return {.lasts_s = 20.6 - show_s}; }

std::vector<Row> rows() {
  using enum TimeAlarm;
  const auto silent = [](double lasts_s) {
    return std::vector<TapePiece>{until(4.5), {.kind = Kind::silent, .lasts_s = lasts_s}, rest(4.5 + lasts_s)};
  };
  const auto jump = [](double by_s) {
    return std::vector<TapePiece>{until(4.5), {.lasts_s = 16.1 - std::max(by_s, 0.0), .jumps_s = by_s}};
  };
  const std::string hold = "goes on to the next hold point, holds, asks for a reset move";
  return {
      {.stream = "steady", .says = "follows", .pieces = {until(20.6)}},
      {.stream = "varispeed 94 to 106 %",
       .says = "follows",
       .pieces = {{.lasts_s = 14, .speed = 0.94, .speed_at_end = 1.06},
                  {.lasts_s = 12, .speed = 1.06, .speed_at_end = 0.94}}},
      {.stream = "silent for 0.1 s",
       .says = "freewheels, alarm",
       .pieces = silent(0.1),
       .alarms = {follows, freewheels, follows}},
      {.stream = "silent for 1 s",
       .says = "freewheels, alarm",
       .pieces = silent(1),
       .alarms = {follows, freewheels, follows}},
      {.stream = "silent for 5 s, continue",
       .says = "by its own clock, and follows again",
       .pieces = silent(5),
       .alarms = {follows, freewheels, lost, follows},
       .lost = TimeLoss::go_on},
      {.stream = "silent for 5 s, next-hold-point",
       .says = "to the next hold point; there the source takes it up if it comes in time",
       .pieces = silent(5),
       .phase = Phase::stands,
       .position_s = 8,
       .alarms = {follows, freewheels, lost}},
      {.stream = "silent for 5 s, hold",
       .says = "at once, in the middle of a walk",
       .pieces = silent(5),
       .phase = Phase::stands,
       .position_s = 6.5,
       .alarms = {follows, freewheels, lost},
       .lost = TimeLoss::hold},
      {.stream = "jumps by +70 ms",
       .says = "slews",
       .pieces = jump(0.07),
       .alarms_by_mtc = {follows, freewheels, follows},
       .worst_off_ms = 100},
      {.stream = "jumps by -70 ms",
       .says = "slews",
       .pieces = jump(-0.07),
       .alarms_by_mtc = {follows, freewheels, follows},
       .worst_off_ms = 100},
      {.stream = "jumps by +0.3 s",
       .says = "one step at the next boundary",
       .pieces = jump(0.3),
       .alarms_by_mtc = {follows, freewheels, follows},
       .worst_off_ms = 330},
      {.stream = "jumps by -0.3 s",
       .says = "waits at the next boundary",
       .pieces = jump(-0.3),
       .alarms_by_mtc = {follows, freewheels, follows},
       .worst_off_ms = 330},
      {.stream = "jumps by +8 s",
       .says = hold,
       .pieces = jump(8),
       .phase = Phase::stands,
       .position_s = 8,
       .alarms = {follows, jumped},
       .alarms_by_mtc = {follows, freewheels, jumped}},
      {.stream = "jumps by -3 s",
       .says = hold,
       .pieces = jump(-3),
       .phase = Phase::stands,
       .position_s = 8,
       .alarms = {follows, jumped},
       .alarms_by_mtc = {follows, freewheels, jumped}},
      {.stream = "30 frames, the show says 25",
       .says = "follows: the stream tells",
       .pieces = {until(20.6)},
       .rate = FrameRate::fps30},
      {.stream = "29.97 drop-frame, the show says 25",
       .says = "follows: the stream tells",
       .pieces = {until(20.6)},
       .worst_off_ms = 60,
       .rate = FrameRate::fps2997_drop},
      {.stream = "25 frames played at 24",
       .says = "follows",
       .pieces = {{.lasts_s = 25.8, .speed = 0.96, .speed_at_end = 0.96}}},
      {.stream = "played at 117 %, proved to 105 %",
       .says = "no faster than proved, alarm; then holds and asks",
       .pieces = {{.lasts_s = 20, .speed = 1.17, .speed_at_end = 1.17}},
       .phase = Phase::stands,
       .position_s = 8,
       .alarms = {follows, too_fast, jumped},
       .worst_off_ms = 600,
       .limit_percent = 105},
      {.stream = "garbage for 1 s",
       .says = "freewheels, alarm",
       .pieces = {until(4.5), {.kind = Kind::garbage, .lasts_s = 1}, rest(5.5)},
       .alarms = {follows, freewheels, follows}},
      {.stream = "garbage alone",
       .says = "nothing moves",
       .pieces = {{.kind = Kind::garbage, .lasts_s = 20}},
       .phase = Phase::stands,
       .position_s = 0,
       .alarms = {}},
  };
}

struct Happened {
  Phase phase{};
  double position_s = 0;
  double worst_off_ms = 0;
  double alarm_s = -1;  ///< from the first thing that went wrong
  std::string text;
};

Happened lead(const Row& row, const std::vector<Heard>& heard, tests::LedShow& show) {
  show.engine->set_limits(std::vector<int>(3, row.limit_percent));
  Happened out;
  double end_s = 0;
  for (const TapePiece& piece : row.pieces) end_s += piece.lasts_s;
  std::size_t next = 0;
  while (to_seconds(show.clock.now()) < end_s + 0.5) {
    while (next < heard.size() && heard[next].at <= show.clock.now()) {
      show.hear(heard[next].at, heard[next].position);
      ++next;
    }
    show.step();
    const Chase::View& view = show.chase->view();
    if (view.follows && show.phase() == Phase::runs && view.state == TimeFollower::State::locked) {
      out.worst_off_ms = std::max(out.worst_off_ms, std::abs(to_seconds(view.off)) * 1e3);
    }
    show.clock.advance(milliseconds(10));
  }
  out.phase = show.phase();
  out.position_s = to_seconds(show.engine->position());
  if (show.alarms.size() > 1) {
    out.alarm_s = to_seconds(show.alarms_at[1]) - row.pieces[0].lasts_s;
  }
  return out;
}

std::string words(const Happened& what, const tests::LedShow& show) {
  std::string alarms;
  for (const TimeAlarm alarm : show.alarms) {
    if (alarm != TimeAlarm::none) alarms += (alarms.empty() ? "" : ", ") + std::string(to_text(alarm));
  }
  char text[200];
  const std::string end = what.phase == Phase::finished ? "played to the end"
                          : what.position_s == 0        ? "stands at the top"
                                                 : "holds at " + std::to_string(what.position_s).substr(0, 4) + " s";
  (void)std::snprintf(text, sizeof text, "%s; at most %.0f ms off", end.c_str(), what.worst_off_ms);
  std::string out = text;
  if (what.alarm_s >= 0) {
    (void)std::snprintf(text, sizeof text, "; first alarm after %.2f s", what.alarm_s);
    out += text;
  }
  return out + (alarms.empty() ? "" : "; " + alarms);
}

TEST(Streams, WhatTheRulesSayAndWhatHappens) {
  const bool print = std::getenv("FOOTLIGHT_PRINT") != nullptr;
  if (print) std::printf("| stream | the rule | LTC | MTC |\n|---|---|---|---|\n");
  for (const Row& row : rows()) {
    std::string cells;
    for (const auto& decode : {&by_ltc, &by_mtc}) {
      const std::string where = row.stream + (decode == &by_ltc ? ", LTC" : ", MTC");
      const Tape tape{row.rate, to_seconds(time_of({1, 0, 0, 0, row.rate})) - kPreRoll_s, row.pieces};
      std::vector<Heard> heard = decode(tape, FrameRate::fps25);
      const Duration begin = time_of({1, 0, 0, 0, row.rate}) - seconds(kHour_s);
      for (Heard& one : heard) one.position -= begin;  // the show's `start` is written in the tape's frames
      tests::LedShow show(row.lost);
      const Happened what = lead(row, heard, show);
      EXPECT_EQ(what.phase, row.phase) << where << " at " << what.position_s;
      EXPECT_NEAR(what.position_s, row.position_s, 0.15) << where;
      const bool later = decode == &by_mtc && !row.alarms_by_mtc.empty();
      EXPECT_EQ(show.alarms, later ? row.alarms_by_mtc : row.alarms) << where;
      EXPECT_LE(what.worst_off_ms, row.worst_off_ms) << where;
      EXPECT_FALSE(show.backwards) << where << ": nothing is played again";
      EXPECT_LE(show.burst, 2U) << where << ": no burst";
      const bool silence = row.alarms.size() > 1 && row.alarms[1] == TimeAlarm::freewheels;
      if (silence) {
        EXPECT_LE(what.alarm_s, 0.2) << where;
      }
      cells += " | " + words(what, show);
    }
    if (print) std::printf("| %s | %s%s |\n", row.stream.c_str(), row.says.c_str(), cells.c_str());
  }
}

}  // namespace
}  // namespace footlight::controller
