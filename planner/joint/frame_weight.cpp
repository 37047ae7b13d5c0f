// SPDX-License-Identifier: Apache-2.0
#include "planner/joint/frame_weight.hpp"

#include <algorithm>

namespace footlight::planner {

FrameWeight frame_weight(double people, double covered, double area) {
  const double n = std::max(people, 1.0);
  const double either = std::max(area + n - covered, 1.0);
  return {1 / n + kIouWeight * (area + n) / (either * either),
          covered / (n * n) + kIouWeight * covered / (either * either)};
}

}  // namespace footlight::planner
