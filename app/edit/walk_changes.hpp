// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/plan.hpp"

namespace footlight::app {

/// Whose walks another plan changes, and in how many transitions.
struct WalkChanges {
  std::vector<std::string> people;  ///< ids of the new plan, in natural order; who is new counts
  std::vector<std::string> left;    ///< ids of who is not in the new plan
  std::size_t transitions = 0;      ///< of the new plan, in which somebody walks otherwise or at another time

  /// "2 transitions, 14 people"
  [[nodiscard]] std::string text() const;
};

/// People are the same when their ids are. O(marks + changed people x transitions)
[[nodiscard]] WalkChanges walk_changes(const Plan& before, const Plan& now);

}  // namespace footlight::app
