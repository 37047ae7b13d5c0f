// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/live/live_run.hpp"
#include "app/readiness/readiness.hpp"

namespace footlight::app {

/// For whoever looks at the desk.
[[nodiscard]] inline ReadinessView view_of(const Readiness& readiness) {
  ReadinessView view;
  view.scope = to_text(readiness.scope());
  view.armed = !readiness.refuses_go();
  view.outlives = readiness.outlives();
  for (const Readiness::Report& stage : readiness.report()) {
    view.stages.push_back({stage.name, to_text(stage.state), stage.text});
  }
  return view;
}

}  // namespace footlight::app
