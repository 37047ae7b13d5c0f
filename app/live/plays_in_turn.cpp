// SPDX-License-Identifier: Apache-2.0
#include "app/live/plays_in_turn.hpp"

#include <algorithm>
#include <utility>

namespace footlight::app {

struct PlaysInTurn::Playing {
  std::uint32_t number = 0;
  std::unique_ptr<ComingPlan> coming{};  ///< of the first plan: none
  ShowOnWires* show = nullptr;           ///< its plays, schedule and engine
  std::unique_ptr<controller::Rehearsal> rehearsal{};
  CueThread::Next cue{};
  std::vector<BusThread::Next> buses{};
};

PlaysInTurn::PlaysInTurn(ShowOnWires& wires, const TempoMap& tempo, controller::Stands stands,
                         const controller::Rehearsal::Settings& settings)
    : wires_(wires), settings_(settings), playing_(std::make_unique<Playing>()) {
  playing_->show = &wires;
  playing_->rehearsal = rehearsal_of(wires, tempo, std::move(stands));
}

PlaysInTurn::~PlaysInTurn() = default;

ShowOnWires& PlaysInTurn::show() const { return *playing_->show; }
controller::Rehearsal& PlaysInTurn::rehearsal() const { return *playing_->rehearsal; }
std::uint32_t PlaysInTurn::number() const { return playing_->number; }
std::shared_ptr<const Plan> PlaysInTurn::way() const { return playing_->coming ? playing_->coming->walks : nullptr; }

std::unique_ptr<controller::Rehearsal> PlaysInTurn::rehearsal_of(ShowOnWires& show, const TempoMap& tempo,
                                                                 controller::Stands stands) const {
  const auto notice = [&loops = wires_.loops, &schedule = *show.schedule](std::size_t from, std::size_t to) {
    Duration longest{};
    for (const auto& loop : loops) longest = std::max(longest, loop->notice(schedule, from, to));
    return longest;
  };
  return std::make_unique<controller::Rehearsal>(*show.engine, tempo, std::move(stands), settings_, notice);
}

bool PlaysInTurn::look(PlanChanges& changes, const ShowState& state, CueThread& cue, const Buses& buses,
                       const Over& over) {
  if (before_) {
    const auto gone_over = [&](const auto& bus) { return bus->plan() == playing_->number; };
    if (!std::ranges::all_of(buses, gone_over)) return false;
    over(before_->show->schedule->switches().size(),
         [&](std::size_t b) -> const std::vector<SwitchTimes>& { return playing_->buses[b].times; });
    before_.reset();
  }
  if (!next_) {
    if (auto coming = changes.wanted(state)) go_over_to(std::move(coming), cue, buses);
    return false;
  }
  const CueThread::Handed handed = cue.handed();
  if (handed == CueThread::Handed::refused) {
    next_.reset();
    changes.not_taken();
    return false;
  }
  gone_over_ = gone_over_ || handed == CueThread::Handed::done;
  // From then on no bus tells of switches of the plan before.
  const auto knows = [&](const auto& bus) { return bus->told() == next_->number; };
  if (!gone_over_ || !std::ranges::all_of(buses, knows)) return false;
  gone_over_ = false;
  before_ = std::move(playing_);
  playing_ = std::move(next_);
  return true;
}

void PlaysInTurn::go_over_to(std::unique_ptr<ComingPlan> coming, CueThread& cue, const Buses& buses) {
  next_ = std::make_unique<Playing>();
  next_->number = playing_->number + 1;
  next_->coming = std::move(coming);
  ComingPlan& plan = *next_->coming;
  const controller::CueSchedule& schedule = *plan.wires->schedule;
  next_->show = plan.wires.get();
  next_->rehearsal = rehearsal_of(*plan.wires, plan.tempo, std::move(plan.stands));
  if (plan.way) {
    next_->rehearsal->begin_elsewhere(plan.to, *plan.way, schedule.reset_of(*plan.way));
  } else {
    next_->rehearsal->begin_at(plan.to);
  }
  for (std::size_t b = 0; b < buses.size(); ++b) {
    next_->buses.push_back({next_->number, wires_.loops[b]->part_of(schedule, *playing_->show->schedule),
                            std::vector<SwitchTimes>(schedule.switches().size())});
  }
  for (std::size_t b = 0; b < buses.size(); ++b) buses[b]->prepare(next_->buses[b]);
  next_->cue = {next_->number, next_->rehearsal.get(), std::vector<Instant>(plan.wires->plays.size(), kNever),
                plan.from};
  cue.hand_over(next_->cue);
}

}  // namespace footlight::app
