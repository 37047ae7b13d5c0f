// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "controller/time/chase.hpp"
#include "core/clock.hpp"
#include "tests/support/small_show.hpp"

namespace footlight::tests {

/// A show of 20 s that a source of time leads: sections [0, 4], [8, 12], [16, 20] s, walks of 2 s in them and of 4 s
/// between them, so that everybody stands for an instant at 0, 2, 4, 8, 10, 12, 16, 18 and 20 s. All cues wait for GO.
struct LedShow {
  /// @param gates that cue 2 needs
  explicit LedShow(TimeLoss lost = TimeLoss::next_hold, std::uint32_t gates = 0) {
    auto small = random_show(6, 6, 4, 3, 2, 1);
    small.show.cues = {cue_of("1", 0), cue_of("2", 1), cue_of("3", 2)};
    small.show.cues[1].gates = gates;
    TimeRules rules;
    rules.lost = lost;
    schedule.emplace(controller::build_schedule(small.show, small.plan, {}, {}).value());
    auto plays = controller::cue_plays(small.show, small.plan);
    engine.emplace(*schedule, plays, std::vector<Duration>(plays.size()));
    rehearsal.emplace(*engine, small.show.tempo, controller::Stands(small.plan), controller::Rehearsal::Settings{},
                      [](std::size_t, std::size_t) { return Duration{}; });
    chase.emplace(*rehearsal, rules);
  }

  /// @param source where it is, in the show's time
  void hear(Instant at, Duration source) {
    controller::Command command;
    command.kind = controller::Command::Kind::time_fix;
    command.at = at;
    command.position = Instant(source);
    chase->hear(command);
  }
  controller::Outcome say(controller::Command::Kind kind) {
    controller::Command command;
    command.kind = kind;
    return chase->take(command, clock.now());
  }
  /// What happens now.
  void step() {
    rehearsal->step(clock.now());
    chase->step(clock.now());
    const controller::Chase::View& view = chase->view();
    if (view.alarms != std::exchange(alarms_seen, view.alarms)) {
      alarms.push_back(view.alarm);
      alarms_at.push_back(clock.now());
    }
    const std::size_t now_lit = rehearsal->target().current;
    backwards = backwards || now_lit < lit;
    burst = std::max(burst, now_lit - std::min(now_lit, lit));
    lit = now_lit;
    fastest = std::max(fastest, to_seconds(engine->position() - position) / to_seconds(clock.now() - stepped_at));
    position = engine->position();
    stepped_at = clock.now();
  }
  [[nodiscard]] controller::Rehearsal::Phase phase() const { return rehearsal->phase(); }

  ManualClock clock;
  std::optional<controller::CueSchedule> schedule;
  std::optional<controller::CueEngine> engine;
  std::optional<controller::Rehearsal> rehearsal;
  std::optional<controller::Chase> chase;
  std::vector<controller::TimeAlarm> alarms;
  std::vector<Instant> alarms_at;
  std::uint32_t alarms_seen = 0;
  std::size_t lit = 0;
  bool backwards = false;  ///< something was lit again
  std::size_t burst = 0;   ///< switches at once
  double fastest = 0;      ///< speed of the show from step to step
  Instant position{};
  Instant stepped_at = Instant(Duration(-1));
};

}  // namespace footlight::tests
