// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "planner/plan_section.hpp"
#include "planner/stages.hpp"

namespace footlight::planner {

/// What the formations of a section that has a film depend on; overrides come after.
/// @param film_id names the film's bytes and how they are read
/// @param before the formation before, for a plan that begins from there; else none
[[nodiscard]] StageKey section_key(const Show& show, SectionIndex section, const std::string& film_id,
                                   const Station* before);

/// What it depends on whether people get from the formation before to the first one of a section (`can_begin`).
[[nodiscard]] StageKey begin_key(const Show& show, SectionIndex section, const Station& before, const Station& first);

[[nodiscard]] std::string encode_section(const SectionPlan& plan);
/// Fails (StageReader::whole) on anything that encode_section did not write.
[[nodiscard]] SectionPlan decode_section(StageReader& reader, SectionIndex section);

}  // namespace footlight::planner
