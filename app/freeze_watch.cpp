// SPDX-License-Identifier: Apache-2.0
#include "app/freeze_watch.hpp"

#include <chrono>
#include <utility>

namespace footlight::app {

FreezeWatch::~FreezeWatch() {
  abandoned_.store(true);
  for (Judging* one : {&show_, &way_}) {
    if (one->running.valid()) one->running.wait();
  }
}

bool FreezeWatch::Judging::take() {
  if (running.valid() && running.wait_for(std::chrono::seconds(0)) == std::future_status::ready) judged = running.get();
  return !running.valid();
}

void FreezeWatch::plan_taken(std::vector<Instant> waits) {
  waits_ = std::move(waits);
  ++plans_;
}

FreezeView FreezeWatch::look(const DeskView& view) {
  using Phase = controller::Rehearsal::Phase;
  const ShowState& state = view.show;
  const bool moves = state.phase == Phase::resets || state.phase == Phase::reset_held;
  // While it waits for its GO it is judged already.
  FreezeView way = look_at_way(view.way, Instant(state.target.show_time), moves);
  FreezeView show = look_at_show(state.position, state.percent);
  return moves ? way : show;
}

FreezeView FreezeWatch::look_at_show(Instant position, int percent) {
  const bool idle = show_.take();
  std::optional<Judged>& judged = show_.judged;
  if (judged && judged->plan != plans_) judged.reset();
  if (idle && (!judged || judged->percent != percent)) {
    // Copies: the plan may be exchanged before it is judged.
    show_.running =
        std::async(std::launch::async, [this, percent, plan = plan_, waits = waits_, of = plans_]() -> Judged {
          const planner::Progress progress{{}, &abandoned_};
          return {of, percent, nullptr,
                  planner::judge_freezes(plan, waits, planner::kLatestStop * percent / 100, progress)};
        });
  }
  if (!judged || judged->percent < percent) return {};
  const planner::FreezeJudgement& what = judged->what;
  return {true, what.freeze.at(position), what.freeze.none_from(position), what.resume.at(position)};
}

/// Nobody's count is a moment of it, and no end of a set comes before its own.
FreezeView FreezeWatch::look_at_way(const std::shared_ptr<const Plan>& way, Instant at, bool moves) {
  const bool idle = way_.take();
  if (!way) return {};
  if (idle && (!way_.judged || way_.judged->way != way)) {
    way_.running = std::async(std::launch::async, [this, way]() -> Judged {
      const planner::Progress progress{{}, &abandoned_};
      return {0, 100, way,
              planner::judge_freezes(*way, {}, planner::kLatestStop, progress)};  // at the tempo of its own
    });
  }
  if (!moves || !way_.judged || way_.judged->way != way) return {};
  const planner::FreezeJudgement& what = way_.judged->what;
  return {true, what.freeze.at(at), kNever, what.resume.at(at)};
}

}  // namespace footlight::app
