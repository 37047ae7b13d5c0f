// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "app/paper/canvas.hpp"
#include "app/paper/flow.hpp"
#include "app/paper/part.hpp"
#include "app/paper/words.hpp"
#include "core/plan.hpp"
#include "core/rig.hpp"
#include "core/show.hpp"

namespace footlight::app {

/// What a caller says into the earpieces of a group, cue after cue: standby, what the group will do, GO; and each move
/// of the cue with the count, how many walk, where to, and how far at most.
/// @param group nothing: everybody
void add_call_list(Flow& flow, const Plan& plan, const Show& show, const std::vector<Part>& parts,
                   std::optional<GroupIndex> group, Language language);

/// Buses, their nodes, and the cell or wearable of each channel.
void add_patch_list(Flow& flow, const Plan& plan, const Show& show, const Rig& rig);

}  // namespace footlight::app
