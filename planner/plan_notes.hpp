// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/plan.hpp"
#include "core/show.hpp"
#include "planner/schedule/chain.hpp"

namespace footlight::planner {

/// What planning knows that people should read.
struct NoteTask {
  const Show* show = nullptr;
  const Show* limits = nullptr;  ///< with the limits of speed that the walks are planned for
  const std::vector<Station>* stations = nullptr;
  const Chain* chain = nullptr;
  const std::vector<std::vector<std::uint32_t>>* slot = nullptr;  ///< of each stop and performer, place in its cells
  double clearance_m = 0;                                         ///< that the walks are planned for
};

// Each adds a sentence to the notes of every section that it concerns; the plan's transitions have their facts.

/// How many places of the drawing are not reached in time.
void note_what_gave_way(const NoteTask& task, Plan& plan);
/// Who is not where she is pinned by hand, since she cannot be there in time.
void note_late_pins(const NoteTask& task, Plan& plan);
/// Over cells, where a step cannot be as short as a count.
void note_steps(const NoteTask& task, Plan& plan);
/// Transitions that end in a section and do not tolerate the stage's lag.
void note_lag(const NoteTask& task, Plan& plan);
/// Who leaves later or is there earlier than the others.
void note_waits(const NoteTask& task, Plan& plan);
/// Where people pass each other, with how many marks and metres.
void note_marks_on_the_way(const NoteTask& task, Plan& plan);

/// Who comes too near on the way to an exact formation, and how much more time would do, one line each.
[[nodiscard]] std::vector<std::string> who_cannot_pass(const NoteTask& task);

}  // namespace footlight::planner
