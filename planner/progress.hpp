// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <string_view>

namespace footlight::planner {

/// Long work tells how far it is and can be stopped. `report` is called from the calling thread only.
struct Progress {
  std::function<void(std::string_view stage, double share)> report;  ///< share 0..1 of the stage; may be empty
  const std::atomic<bool>* stop = nullptr;                           ///< becomes true when the user has had enough

  void tell(std::string_view stage, double share) const {
    if (report) report(stage, share);
  }
  [[nodiscard]] bool stopped() const { return stop != nullptr && stop->load(std::memory_order_relaxed); }
};

}  // namespace footlight::planner
