// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/plan.hpp"

namespace footlight::app {

/// What tells a page or a picture from last week's: on everything that is drawn.
struct Stamp {
  std::string title;
  std::string show;  ///< first digits of the hash of the show's files: its version
  std::string plan;  ///< first digits of the plan's own digest
  bool valid = true;

  explicit Stamp(const Plan& plan);
  /// "Ceremony   show 1a2b3c4d   plan 0123456789ab   Footlight 0.1.0"
  [[nodiscard]] std::string line() const;
};

}  // namespace footlight::app
