// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "planner/plan_section.hpp"

namespace footlight::planner {

/// The formations of a section with a model of motion (`Section::motion`), from where the section before leaves people
/// to the formation of its own source, which is the last one and exact; between them, every `Motion::mark_counts` or
/// as often as people can walk to it, where the model has led them by then.
/// @param before needed, but by a painting, which brings its own beginning  @return as `plan_section`;
/// ErrorKind::input, positioned, also where the model cannot do what the section asks
[[nodiscard]] Result<SectionPlan> plan_motion(const Show& show, SectionIndex section, const std::optional<Film>& film,
                                              const Ways& ways, const Station* before, const Progress& progress);

}  // namespace footlight::planner
