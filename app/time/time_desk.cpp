// SPDX-License-Identifier: Apache-2.0
#include "app/time/time_desk.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace footlight::app {
namespace {

using controller::Command;
using controller::TimeAlarm;

constexpr std::size_t kMostFixes = 16;  // at once; the cue thread's ring takes more

}  // namespace

TimeDesk::TimeDesk(const Show& show, std::unique_ptr<TimeSource> source, const Clock& clock, OtherClocks others)
    : show_(show), source_(std::move(source)), clock_(clock), others_(std::move(others)) {}

void TimeDesk::use(const Clock& run) { run_ahead_ = run.now() - clock_.now(); }

void TimeDesk::look(const DeskView& view, RunDesk& desk) {
  const Instant now = clock_.now();
  watch(now, desk);
  tell_alarms(view, desk);
  if (!source_ || !view.roll_called) return;
  ShowState show = view.show;  // with the times of our clock
  show.at -= run_ahead_;
  if (show.goes_at != kNever) show.goes_at -= run_ahead_;
  TimeNews news = source_->read(now, show);
  for (std::string& alarm : news.alarms) desk.tell({RunEvent::Kind::alarm, std::move(alarm)});
  for (std::string& note : news.notes) desk.tell({RunEvent::Kind::note, std::move(note)});
  // Of many the last ones count.
  const std::size_t first = news.fixes.size() - std::min(news.fixes.size(), kMostFixes);
  for (std::size_t i = first; i < news.fixes.size(); ++i) {
    Command command;
    command.kind = Command::Kind::time_fix;
    command.source = controller::GoSource::clock;
    command.at = news.fixes[i].at + run_ahead_;
    command.position = Instant(news.fixes[i].position);
    desk.send(command);
  }
}

void TimeDesk::watch(Instant now, RunDesk& desk) {
  const auto news = watch_.take(now, others_.boot(), others_.wall());
  if (!news) return;
  if (news->kind == ClockWatch::Kind::stepped) {
    desk.tell({RunEvent::Kind::note,
               fmt::format("the wall clock was set by {:+.3f} s: the show does not go by it", to_seconds(news->by))});
    return;
  }
  Command hold;
  hold.kind = Command::Kind::hold;
  hold.source = controller::GoSource::clock;
  desk.send(hold);
  desk.tell({RunEvent::Kind::alarm, fmt::format("HOLD: the machine has slept for {:.1f} s; look where people are, then "
                                                "GO or jump",
                                                to_seconds(news->by))});
}

std::string TimeDesk::text_of(const controller::Chase::View& view) const {
  const std::string off = fmt::format("{:+.1f} s", to_seconds(view.alarm_off));
  switch (view.alarm) {
    case TimeAlarm::none:
      break;
    case TimeAlarm::follows:
      return "the show follows it";
    case TimeAlarm::freewheels:
      return "nothing that fits comes any more: the show goes on at its last speed";
    case TimeAlarm::lost:
      switch (show_.time.lost) {
        case TimeLoss::go_on:
          return "lost: the show goes on by its own clock";
        case TimeLoss::next_hold:
          return "lost: the show holds where everybody next stands";
        case TimeLoss::hold:
          return "lost: HOLD";
      }
      break;
    case TimeAlarm::jumped:
      return "it is " + off +
             " from the show: HOLD where everybody next stands; GO confirms the way there, or let it "
             "come back, or go on without it (\"time off\", GO)";
    case TimeAlarm::too_fast:
      return fmt::format("it runs at {:.1f} %, faster than this cue is proved for", 100 * view.rate);
  }
  return {};
}

void TimeDesk::tell_alarms(const DeskView& view, RunDesk& desk) {
  const controller::Chase::View& time = view.show.time;
  if (std::exchange(alarms_, time.alarms) == time.alarms || !source_) return;
  const bool good = time.alarm == TimeAlarm::follows;
  desk.tell({good ? RunEvent::Kind::note : RunEvent::Kind::alarm, source_->name() + ": " + text_of(time)});
}

}  // namespace footlight::app
