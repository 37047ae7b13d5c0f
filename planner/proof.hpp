// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/plan.hpp"
#include "planner/progress.hpp"
#include "planner/schedule/chain.hpp"
#include "planner/stages.hpp"

namespace footlight::planner {

/// Fills the facts of every transition of a plan and judges each by `validate`: what one says depends on the marks from
/// its start until two seconds after its end, which are the stage's key. People are ordered by their cells meanwhile,
/// so that it does not depend on their names either.
/// @param plan tracks in which everybody stands at every stop, formations and sections; in: everything else, out:
/// transitions  @param stages nothing: everything anew
/// @return whether every transition is sound, which is what `validate` says of the whole plan; nothing when stopped
[[nodiscard]] std::optional<bool> prove(const Chain& chain, Plan& plan, Stages* stages, StageCount* count,
                                        const Progress& progress);

}  // namespace footlight::planner
