// SPDX-License-Identifier: Apache-2.0
#include "config/otsu.hpp"

#include <cstddef>

namespace footlight::config {

int otsu_threshold(const GreyHistogram& histogram) {
  std::uint64_t pixels = 0;
  std::uint64_t sum = 0;
  for (std::size_t grey = 0; grey < histogram.size(); ++grey) {
    pixels += histogram[grey];
    sum += histogram[grey] * grey;
  }
  // Counts and sums are integers, so thresholds that part the same pixels get the very same double.
  std::uint64_t dark = 0;
  std::uint64_t dark_sum = 0;
  double best = -1;
  int first = 0;
  int last = 0;
  for (int t = 0; t < 255; ++t) {
    const auto at = static_cast<std::size_t>(t);
    dark += histogram[at];
    dark_sum += histogram[at] * at;
    double variance = 0;
    if (dark > 0 && dark < pixels) {
      const auto d = static_cast<double>(dark);
      const auto b = static_cast<double>(pixels - dark);
      const double means_apart = static_cast<double>(sum - dark_sum) / b - static_cast<double>(dark_sum) / d;
      variance = d * b * means_apart * means_apart;
    }
    if (variance > best) {
      best = variance;
      first = t;
      last = t;
    } else if (variance == best && last == t - 1) {
      last = t;
    }
  }
  return (first + last) / 2;
}

}  // namespace footlight::config
