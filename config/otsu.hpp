// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace footlight::config {

/// Pixels of each grey value.
using GreyHistogram = std::array<std::uint64_t, 256>;

/// The grey value that parts dark (<= t) from bright (> t) pixels best: largest variance between the two classes.
/// Source: N. Otsu, "A threshold selection method from gray-level histograms", IEEE SMC 9 (1979). Deviation: where
/// several thresholds part the same pixels in the same way, as between the black and the white of a drawing, the middle
/// one is taken, so that noise of a codec on either side changes nothing.
/// @return 0..254; 127 when all pixels have one value
[[nodiscard]] int otsu_threshold(const GreyHistogram& histogram);

}  // namespace footlight::config
