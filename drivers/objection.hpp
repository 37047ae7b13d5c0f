// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace footlight::drivers {

/// What a real wire's settings on this machine would spoil in a show: one sentence, with the command that mends it.
struct Objection {
  std::string text;
  bool stops = false;  ///< nothing can be sent, or nobody understands it: the show must not begin

  friend bool operator==(const Objection&, const Objection&) = default;
};

}  // namespace footlight::drivers
