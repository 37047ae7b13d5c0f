// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/show.hpp"

namespace footlight::controller {

/// What stands against sending people walking, now, as a set of bits. Bit g, below kMostGates: gate g of the show is
/// open, or nobody knows. It concerns the cues that need it; the others concern all.
using Bars = std::uint64_t;

inline constexpr Bars kGates = (Bars{1} << kMostGates) - 1;
inline constexpr Bars kHoldPressed = Bars{1} << kMostGates;          ///< somebody keeps a hold button pressed
inline constexpr Bars kEmergencyHold = Bars{1} << (kMostGates + 1);  ///< until somebody acknowledges it
inline constexpr Bars kNotReady = Bars{1} << (kMostGates + 2);       ///< refuses GO; a cue that runs runs on

/// Those for which a cue that runs is held.
inline constexpr Bars kHolding = kGates | kHoldPressed | kEmergencyHold;

/// Those that concern a cue.
[[nodiscard]] constexpr Bars bars_of(const Cue& cue) { return ~kGates | cue.gates; }

}  // namespace footlight::controller
