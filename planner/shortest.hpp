// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "planner/plan_show.hpp"
#include "planner/schedule/chain.hpp"

namespace footlight::planner {

/// The shortest duration of a film section in which nobody in the picture has to give way, with the formations that it
/// has now: each move from one place in the picture to the next, and each way from the reserve since the last place in
/// the picture (or the section's first formation), must be walkable. Nothing for sections without a film or walks.
[[nodiscard]] std::optional<Planned::Shortest> shortest_duration(const Show& show, const Chain& chain,
                                                                 SectionIndex section, const Plan& plan);

}  // namespace footlight::planner
