// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/time.hpp"

namespace footlight::controller {

/// How late things were: counts in buckets of 1 us below 16 us, then eight buckets an octave (12 % wide) up to two
/// minutes. Does not allocate. One thread.
class Lateness {
 public:
  /// What is early counts as on time.
  void add(Duration late) noexcept;
  void add(const Lateness& other) noexcept;

  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  [[nodiscard]] Duration worst() const noexcept { return worst_; }
  /// Upper edge of the bucket in which the share lies, at most the worst; zero without a sample. @param share 0..1
  [[nodiscard]] Duration quantile(double share) const noexcept;

 private:
  static constexpr std::size_t kLinear = 16;
  static constexpr std::size_t kPerOctave = 8;
  static constexpr std::size_t kBuckets = kLinear + 23 * kPerOctave;
  [[nodiscard]] static std::size_t bucket_of(std::uint64_t us) noexcept;
  [[nodiscard]] static std::uint64_t upper_us(std::size_t bucket) noexcept;

  std::array<std::uint32_t, kBuckets> counts_{};
  std::uint64_t count_ = 0;
  Duration worst_{};
};

}  // namespace footlight::controller
