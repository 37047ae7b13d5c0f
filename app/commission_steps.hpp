// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "app/commissioning.hpp"
#include "app/session.hpp"

namespace footlight::app {

/// How somebody on the floor is asked.
struct StepChoice {
  std::string order = "floor";  ///< of a walk: floor or bus
  std::string session;          ///< file of a walk's answers; empty: beside the output
  std::string wipe_step = "700 ms";
};

/// Lights lamp after lamp and takes the answers from stdin. @return the exit status
int walk_lamps(Session& session, const CommissionChoice& choice, const StepChoice& steps);

/// Lights row after row, then column after column, and asks after each round. @return the exit status
int wipe_floor(Session& session, const CommissionChoice& choice, const StepChoice& steps);

}  // namespace footlight::app
