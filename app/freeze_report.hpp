// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "controller/cue_list.hpp"
#include "core/plan.hpp"
#include "core/show.hpp"
#include "planner/freeze.hpp"

namespace footlight::app {

/// Show times at which the show waits for GO.
[[nodiscard]] std::vector<Instant> waits_of(const std::vector<controller::CuePlay>& plays);

/// A line for each cue: when it may be frozen, when at worst, and the same for going on.
[[nodiscard]] std::string freeze_text(const Show& show, const Plan& plan, const planner::FreezeJudgement& judged);
[[nodiscard]] std::string freeze_json(const Show& show, const Plan& plan, const planner::FreezeJudgement& judged);

/// A freeze at one instant: the pairs.
[[nodiscard]] std::string freeze_at_text(const Show& show, const Plan& plan, Instant freeze,
                                         const planner::FreezeAt& at);
[[nodiscard]] std::string freeze_at_json(const Show& show, const Plan& plan, Instant freeze,
                                         const planner::FreezeAt& at);

}  // namespace footlight::app
