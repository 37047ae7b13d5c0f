// SPDX-License-Identifier: Apache-2.0
#include "app/show_on_wires.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "controller/bus_budget.hpp"
#include "controller/look_table.hpp"
#include "drivers/registry.hpp"

namespace footlight::app {
namespace {

Duration roll_call(const Rig& rig) {
  std::vector<std::size_t> nodes(rig.buses.size(), 0);
  for (const Node& node : rig.nodes) ++nodes[node.bus.at()];
  const std::size_t most = nodes.empty() ? 0 : *std::ranges::max_element(nodes);
  return milliseconds(5000) + static_cast<Duration::rep>(most) * milliseconds(250);
}

/// How long before the first switch of each cue the slowest bus has to know of it.
std::vector<Duration> notices_of(const ShowOnWires& show, const ShowOnWires& wires) {
  std::vector<Duration> notices(show.plays.size());
  const auto& switches = show.schedule->switches();
  for (std::size_t k = 1; k < switches.size(); ++k) {
    if (!switches[k].cue || switches[k].cue == switches[k - 1].cue) continue;
    Duration& notice = notices[*switches[k].cue];
    for (const auto& loop : wires.loops) notice = std::max(notice, loop->notice(*show.schedule, k));
  }
  return notices;
}

/// Besides dark, that the markers of every bus know.
std::size_t most_looks(const ShowOnWires& wires) {
  std::size_t most = 254;
  for (const auto& driver : wires.drivers) {
    most = std::min(most, static_cast<std::size_t>(std::max(0, driver->capabilities().looks)));
  }
  return most;
}

}  // namespace

Duration run_length(const std::vector<controller::CuePlay>& plays) {
  Duration sum{};
  for (const auto& play : plays) sum += (play.to - play.from) + play.gap_after.value_or(controller::kShortestHold);
  return sum;
}

Result<std::unique_ptr<ShowOnWires>> put_on_wires(const Show& show, const Plan& plan, const Rig& rig,
                                                  std::vector<std::unique_ptr<drivers::Driver>> drivers, bool mutes) {
  if (!plan.valid) return refusal("the plan is not valid and never lights a marker");
  auto out = std::make_unique<ShowOnWires>();
  out->drivers = std::move(drivers);
  out->plays = controller::cue_plays(show, plan);
  auto schedule = controller::build_schedule(show, plan, rig, out->drivers);
  if (!schedule) return std::move(schedule).error();
  out->schedule = std::move(schedule).value();
  if (mutes && !show.groups.empty()) out->schedule->add_quiet(most_looks(*out));
  for (const auto& driver : out->drivers) out->latch_ahead = std::max(out->latch_ahead, driver->latch_time());
  out->opening = std::max(roll_call(rig), controller::opening_time(*out->schedule, rig, out->drivers));
  const auto switch_on = controller::switch_on_of(rig);
  Duration last_turn{};
  for (const controller::SwitchOn& one : switch_on) last_turn = std::max(last_turn, one.turn);
  out->opening += last_turn;
  for (std::size_t b = 0; b < rig.buses.size(); ++b) {
    out->loops.push_back(std::make_unique<controller::BusLoop>(
        *out->schedule, drivers::node_addresses(rig, BusIndex::of(b)), *out->drivers[b], switch_on));
  }
  out->engine.emplace(*out->schedule, out->plays, notices_of(*out, *out));
  return out;
}

Result<std::unique_ptr<ShowOnWires>> put_beside(const Show& show, const Plan& plan, const Rig& rig,
                                                const ShowOnWires& wires, const controller::CueSchedule& before) {
  if (!plan.valid) return refusal("the plan is not valid and never lights a marker");
  auto out = std::make_unique<ShowOnWires>();
  out->plays = controller::cue_plays(show, plan);
  auto schedule = controller::build_schedule(show, plan, rig, wires.drivers);
  if (!schedule) return std::move(schedule).error();
  if (before.numbers().quiet != kDark) schedule->add_quiet(most_looks(wires));
  int most = std::numeric_limits<int>::max();
  for (const auto& driver : wires.drivers) most = std::min(most, driver->capabilities().looks);
  schedule = controller::numbered_after(std::move(schedule).value(), before, most);
  if (!schedule) return std::move(schedule).error();
  out->schedule = std::move(schedule).value();
  out->engine.emplace(*out->schedule, out->plays, notices_of(*out, wires));
  return out;
}

std::vector<controller::TempoLimit> limit_tempo(const Show& content, const Plan& plan, const Rig& rig,
                                                ShowOnWires& show, const ShowOnWires& wires) {
  std::vector<Duration> gaps;
  for (const controller::CuePlay& play : show.plays) gaps.push_back(play.gap_after.value_or(controller::kShortestHold));
  auto limits = controller::tempo_limits(plan, content.tempo, show.plays, *show.schedule,
                                         controller::bus_needs(*show.schedule, rig, wires.drivers, gaps), rig);
  std::vector<int> percent;
  for (const controller::TempoLimit& limit : limits) percent.push_back(limit.percent);
  show.engine->set_limits(std::move(percent));
  return limits;
}

bool GoWhenWaiting::due(const controller::CueEngine& engine, Instant now) noexcept {
  if (engine.finished() || engine.active()) {
    at_ = kNever;
    return false;
  }
  if (at_ == kNever) at_ = now + controller::kShortestHold;
  if (now < at_) return false;
  at_ = kNever;
  return true;
}

bool GoWhenWaiting::step(controller::CueEngine& engine, Instant now) noexcept {
  return due(engine, now) && engine.go(now) == controller::GoAnswer::started;
}

}  // namespace footlight::app
