// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/result.hpp"

namespace footlight::config {

/// What stands at the lines of a measure.
struct MeasureTurn {
  bool forward = false;            ///< a repeat begins before it
  bool backward = false;           ///< and ends behind it
  int times = 0;                   ///< how often it is played in all; 0: as often as endings say, at least twice
  std::uint64_t ending_start = 0;  ///< an ending begins with it: bit n for the nth time
  bool ending_stop = false;        ///< and stops behind it
};

/// The numbers of the measures, from 0, in the order in which they are played. Errors: more than
/// `kMostPlayedMeasures`, as repeats of many times make them.
[[nodiscard]] Result<std::vector<std::size_t>> played_order(const std::vector<MeasureTurn>& measures);
inline constexpr std::size_t kMostPlayedMeasures = 100'000;

}  // namespace footlight::config
