// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "planner/joint/joint_plan.hpp"
#include "planner/plan_section.hpp"

namespace footlight::planner {

/// Instants are so far apart that everybody could walk this many pitches in between: as often as a walk can follow.
inline constexpr double kJointInterval = 2.0;

struct JointSection {
  const Show* show = nullptr;
  SectionIndex index;
  const Station* before = nullptr;  ///< the last formation of the section before, if any
  JointTask task;                   ///< of the film alone, one instant for each station of the plan
};

/// Puts the cells of the joint plan in place of the drawings. People begin where it is best for the whole film, unless
/// the formation before cannot be left for there in time: then the way there is planned with the film.
/// @return why the drawings stay; empty when they do not, or when stopped
[[nodiscard]] std::string draw_and_walk(JointSection section, SectionPlan& plan, const Progress& progress);

/// Whether people get from the formation before to the first one of a section in time and clear of each other.
[[nodiscard]] bool can_begin(const Show& show, SectionIndex section, const Ways& ways, const Station& before,
                             const Station& first);

}  // namespace footlight::planner
