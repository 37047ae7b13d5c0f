// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "app/paper/canvas.hpp"
#include "core/plan.hpp"

namespace footlight::app {

/// What tells a page or a picture from last week's: on everything that is drawn.
struct Stamp {
  std::string title;
  std::string version;  ///< of the show; empty where it has none
  std::string show;     ///< first digits of the hash of the show's files
  std::string plan;     ///< first digits of the plan's own digest
  bool valid = true;

  explicit Stamp(const Plan& plan);
  /// "Ceremony   version 3   show 1a2b3c4d   plan 0123456789ab   Footlight 0.1.0"
  [[nodiscard]] std::string line() const { return name() + digits(); }
  /// The same in one line of this width: of a long title its beginning, the digits whole.
  [[nodiscard]] std::string line_of(const Canvas& canvas, double size, double width) const;

 private:
  [[nodiscard]] std::string name() const;
  [[nodiscard]] std::string digits() const;
};

}  // namespace footlight::app
