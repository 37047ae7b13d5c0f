// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace footlight::app {

/// One channel, -1..1.
using Samples = std::vector<float>;

/// Of all sounds here.
inline constexpr int kSampleRate = 48'000;

/// A short tone that falls off, its loudest sample in the first millisecond. @param accented higher and louder
[[nodiscard]] Samples click(bool accented);

/// The same sound at kSampleRate. Band-limited by a windowed sinc of 32 taps (Smith, "Digital Audio Resampling", 2.1:
/// the cutoff is the lower one of the two Nyquist frequencies). @param rate of `sound`, 1/s
[[nodiscard]] Samples resampled(const Samples& sound, int rate);

/// Without what is silent before and after it, so that it begins on the count. @param most_s longer is faded out
[[nodiscard]] Samples trimmed(const Samples& sound, double most_s);

}  // namespace footlight::app
