// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/look.hpp"
#include "core/time.hpp"

namespace footlight::controller {

/// Most times that anything may light up within a second: nothing flashes above 3 Hz (trust of people with
/// photosensitive epilepsy; WCAG 2.2, 2.3.1 "three flashes").
inline constexpr int kMostFlashes = 3;

/// What one lamp shows from an instant on.
struct LampStretch {
  Instant from;  ///< of the clock, or of the show at its written tempo
  Look look;
};

/// Most times that a lamp may light up within any second, wherever its effects are in their rhythm: they run on the
/// marker by its own time, and only the switches between them follow the show's tempo. An upper bound, exact for steady
/// looks. @param stretches ascending; the last one goes on  @param percent of the written tempo  O(stretches)
[[nodiscard]] int most_flashes(std::span<const LampStretch> stretches, int percent);

}  // namespace footlight::controller
