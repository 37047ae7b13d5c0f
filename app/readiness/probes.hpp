// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "app/commission/lamps.hpp"
#include "core/stage.hpp"

namespace footlight::app {

/// Three lamps that show whether the floor lies where the plan thinks: those nearest to three corners of the floor,
/// which no turn, shift or mirror leaves where they are. Fewer where there are not so many with a cell.
/// @return positions in `lamps`  O(lamps)
[[nodiscard]] std::vector<std::size_t> probe_lamps(const std::vector<FloorLamp>& lamps, const Grid& grid);

/// What somebody says of a lamp.
enum class ProbeAnswer { yes, no, skip, unclear };
/// "yes", "y"; "no", "n"; "skip". Anything else, also nothing, is unclear: nobody confirms by accident.
[[nodiscard]] ProbeAnswer probe_answer(std::string_view line);

}  // namespace footlight::app
