// SPDX-License-Identifier: Apache-2.0
#include "controller/lateness.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace footlight::controller {

std::size_t Lateness::bucket_of(std::uint64_t us) noexcept {
  if (us < kLinear) return us;
  const auto octave = static_cast<std::size_t>(std::bit_width(us)) - 5;  // 16..31: 0
  const auto part = static_cast<std::size_t>((us >> (octave + 1)) & (kPerOctave - 1));
  return std::min(kLinear + octave * kPerOctave + part, kBuckets - 1);
}

std::uint64_t Lateness::upper_us(std::size_t bucket) noexcept {
  if (bucket < kLinear) return bucket + 1;
  const std::size_t octave = (bucket - kLinear) / kPerOctave;
  const std::size_t part = (bucket - kLinear) % kPerOctave;
  return static_cast<std::uint64_t>(kPerOctave + part + 1) << (octave + 1);
}

void Lateness::add(Duration late) noexcept {
  late = std::max(late, Duration{});
  ++counts_[bucket_of(static_cast<std::uint64_t>(late / microseconds(1)))];
  ++count_;
  worst_ = std::max(worst_, late);
}

void Lateness::add(const Lateness& other) noexcept {
  for (std::size_t i = 0; i < kBuckets; ++i) counts_[i] += other.counts_[i];
  count_ += other.count_;
  worst_ = std::max(worst_, other.worst_);
}

Duration Lateness::quantile(double share) const noexcept {
  if (count_ == 0) return {};
  const auto wanted = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count_)));
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < kBuckets; ++i) {
    sum += counts_[i];
    if (sum >= std::max<std::uint64_t>(wanted, 1)) {
      return std::min(worst_, microseconds(static_cast<std::int64_t>(upper_us(i))));
    }
  }
  return worst_;
}

}  // namespace footlight::controller
