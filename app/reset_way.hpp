// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <vector>

#include "core/plan.hpp"
#include "core/result.hpp"
#include "core/show.hpp"

namespace footlight::app {

/// A proved way for everybody from where she stands at one instant of the show to where she stands at another one: a
/// plan of its own from time 0, in which people stand for the count-in and then walk, no faster than either place's
/// section allows and by the tempo of where they come from. As short as walking takes, longer where people would meet.
/// @param from, to instants at which nobody walks
/// @return ErrorKind::refused when none was found that is four times as long as the longest walk; interrupted
[[nodiscard]] Result<Plan> plan_reset_way(const Show& show, const Plan& plan, Instant from, Instant to,
                                          double count_in_counts, const std::atomic<bool>& abandoned);

/// The same from wherever people stand to where they stand at an instant of the plan.
/// @param cells one for each performer of the plan, distinct
[[nodiscard]] Result<Plan> plan_way(const Show& show, const Plan& plan, const std::vector<CellIndex>& cells, Instant to,
                                    double count_in_counts, const std::atomic<bool>& abandoned);

}  // namespace footlight::app
