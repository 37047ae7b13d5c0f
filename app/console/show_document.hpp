// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "controller/cue_schedule.hpp"
#include "controller/tempo_limit.hpp"
#include "core/plan.hpp"
#include "core/rig.hpp"
#include "core/show.hpp"

namespace footlight::app {

/// What the console tells of a show. Borrows all.
struct ShownShow {
  const Show& show;
  const Plan& plan;
  const Rig* rig = nullptr;                           ///< null: it is looked at without buses
  const controller::CueSchedule* schedule = nullptr;  ///< of the rig
  const std::vector<controller::TempoLimit>* limits = nullptr;
  std::uint32_t epoch = 1;
};

// The documents of docs/console.md.

/// GET /api/show. O(performers + cells of the rig + switches)
[[nodiscard]] std::string show_json(const ShownShow& shown);
/// GET /api/plan.bin and /api/way.bin. O(marks)
[[nodiscard]] std::string plan_bytes(const Plan& plan, std::uint32_t epoch);
/// GET /api/looks/K.bin; nothing when there is no such switch. O(nodes)
[[nodiscard]] std::optional<std::string> looks_bytes(const controller::CueSchedule& schedule, std::size_t nodes,
                                                     std::size_t k, std::uint32_t epoch);

}  // namespace footlight::app
