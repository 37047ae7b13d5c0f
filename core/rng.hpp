// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/check.hpp"

namespace footlight {

/// SplitMix64 (Steele, Lea, Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014): the same numbers on
/// every machine and with every standard library. Passed in wherever chance is wanted; not for secrets.
class Rng {
 public:
  explicit Rng(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ULL);
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31U);
  }
  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(next() >> 11U) * 0x1.0p-53; }
  /// Uniform in [0, bound); bound > 0. The bias is below bound / 2^64.
  std::uint64_t below(std::uint64_t bound) {
    FL_CHECK(bound > 0);
    return next() % bound;
  }
  /// An independent generator for part `stream` of the work, so that results do not depend on the order of the parts.
  [[nodiscard]] Rng split(std::uint64_t stream) const {
    Rng child(state_ ^ (0xD1B54A32D192ED03ULL * (stream + 1)));
    return Rng(child.next());
  }

 private:
  std::uint64_t state_;
};

}  // namespace footlight
