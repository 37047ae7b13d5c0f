// SPDX-License-Identifier: Apache-2.0
#include "app/live/reset_moves.hpp"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "core/check.hpp"

namespace footlight::app {
std::string way_text(const Plan& way) {
  std::size_t walkers = 0;
  double longest_m = 0;
  for (const auto& track : way.tracks) {
    const double walk_m = distance(way.stage.grid.centre(track.front().cell), way.stage.grid.centre(track.back().cell));
    walkers += track.front().cell != track.back().cell ? 1 : 0;
    longest_m = std::max(longest_m, walk_m);
  }
  if (walkers == 0) return "reset: nobody has to walk";
  double clearance_m = std::numeric_limits<double>::infinity();
  for (const TransitionFacts& facts : way.transitions) clearance_m = std::min(clearance_m, facts.clearance_m);
  const Duration time = way.tracks.front().back().time - way.tracks.front().front().time;
  return fmt::format("reset: {} {}, at most {:.1f} m, in {:.1f} s with the count-in, never nearer than {:.2f} m",
                     walkers, walkers == 1 ? "person walks" : "people walk", longest_m, to_seconds(time), clearance_m);
}

ResetMoves::ResetMoves(const Show& show, const Rig& rig, controller::CueSchedule& schedule, PlanWay plan_way)
    : show_(show), rig_(rig), schedule_(schedule), plan_way_(std::move(plan_way)) {}

ResetMoves::~ResetMoves() {
  abandoned_.store(true);
  if (made_.valid()) made_.wait();
}

std::optional<ResetMoves::News> ResetMoves::look(const controller::Rehearsal::Reset& asked) {
  if (planning_ && made_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    Made made = made_.get();
    // What was given up may be asked for again.
    if (made.move || !abandoned_.load()) known_.insert_or_assign(*planning_, keep(std::move(made)));
    planning_.reset();
  }
  if (asked.state != controller::Rehearsal::ResetState::wanted || asked.id == answered_) return std::nullopt;
  const Key key{asked.from, asked.to};
  const auto found = known_.find(key);
  if (found == known_.end()) {
    if (!planning_) plan(key);
    if (planning_ && *planning_ != key) abandoned_.store(true);
    return std::nullopt;
  }
  answered_ = asked.id;
  News news;
  news.text = found->second.text;
  news.way = found->second.way;
  news.command.reset = asked.id;
  news.command.kind = controller::Command::Kind::reset_impossible;
  if (found->second.first) {
    news.command.kind = controller::Command::Kind::reset_planned;
    news.command.first = *found->second.first;
    news.command.move = &schedule_.reset_of(*found->second.first);
  }
  return news;
}

void ResetMoves::plan(const Key& key) {
  planning_ = key;
  abandoned_.store(false);
  made_ = std::async(std::launch::async, [this, key]() -> Made {
    if (!plan_way_) return {Error{ErrorKind::refused, "nobody plans ways here"}, {}};
    auto way = plan_way_(key.first, key.second, abandoned_);
    if (!way) return {std::move(way).error(), {}};
    return {controller::build_reset(show_, *way, rig_, schedule_), way_text(*way),
            std::make_shared<const Plan>(*std::move(way))};
  });
}

ResetMoves::Known ResetMoves::keep(Made made) {
  if (!made.move) return {std::nullopt, "no reset move: " + made.move.error().message};
  const auto first = schedule_.add(std::move(made.move).value());
  if (!first) return {std::nullopt, "no reset move: there have been too many in this run, or it has too many steps"};
  return {first, std::move(made.text), std::move(made.way)};
}

}  // namespace footlight::app
