// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "controller/dark_nodes.hpp"
#include "core/plan.hpp"
#include "core/show.hpp"

namespace footlight::app {

/// Units, and cues of each, that are told.
inline constexpr std::size_t kDarkKept = 10;

/// The worst units with the worst cue of each, and how many units there are at all. @param units worst first
[[nodiscard]] std::string dark_text(const Show& show, const Plan& plan, const std::vector<controller::DarkUnit>& units);
/// The same with the worst cues of each unit.
[[nodiscard]] std::string dark_json(const Show& show, const Plan& plan, const std::vector<controller::DarkUnit>& units);

}  // namespace footlight::app
