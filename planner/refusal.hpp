// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "planner/schedule/chain.hpp"
#include "planner/validate.hpp"

namespace footlight::planner {

/// Why a plan is refused, one line for each section that cannot be walked: the worst walk and what would help, then the
/// worst conflict, then whatever else the judge found. Empty for a valid plan.
[[nodiscard]] std::vector<std::string> refusal_texts(const Show& show, const Plan& plan, const Verdict& verdict);

}  // namespace footlight::planner
