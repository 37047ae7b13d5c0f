// SPDX-License-Identifier: Apache-2.0
#include "app/freeze_watch.hpp"

#include <chrono>

namespace footlight::app {

FreezeWatch::~FreezeWatch() {
  abandoned_.store(true);
  if (judging_.valid()) judging_.wait();
}

void FreezeWatch::plan_taken(std::vector<Instant> waits) {
  waits_ = std::move(waits);
  ++plans_;
  judged_.reset();
}

FreezeView FreezeWatch::look(Instant position, int percent) {
  if (judging_.valid() && judging_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    Judged judged = judging_.get();
    if (judged.plan == plans_) judged_ = std::move(judged);
  }
  if (!judging_.valid() && (!judged_ || judged_->percent != percent)) {
    // Copies: the plan may be exchanged before it is judged.
    judging_ = std::async(std::launch::async, [this, percent, plan = plan_, waits = waits_, of = plans_]() -> Judged {
      const planner::Progress progress{{}, &abandoned_};
      return {of, percent, planner::judge_freezes(plan, waits, planner::kLatestStop * percent / 100, progress)};
    });
  }
  if (!judged_ || judged_->percent < percent) return {};
  const planner::FreezeJudgement& what = judged_->what;
  return {true, what.freeze.at(position), what.freeze.none_from(position), what.resume.at(position)};
}

}  // namespace footlight::app
