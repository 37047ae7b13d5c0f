// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <optional>

namespace footlight::app {

/// Values from one thread to another one in order, without a lock. A full ring takes nothing: what floods it is lost,
/// and nobody waits.
template <class T, std::size_t kPlaces>
class SpscRing {
  static_assert((kPlaces & (kPlaces - 1)) == 0, "a power of two");

 public:
  /// The writing thread. @return false when there is no room
  bool push(const T& value) noexcept {
    const std::size_t end = end_.load(std::memory_order_relaxed);
    if (end - begin_.load(std::memory_order_acquire) == kPlaces) return false;
    places_[end % kPlaces] = value;
    end_.store(end + 1, std::memory_order_release);
    return true;
  }
  /// The reading thread.
  std::optional<T> pop() noexcept {
    const std::size_t begin = begin_.load(std::memory_order_relaxed);
    if (begin == end_.load(std::memory_order_acquire)) return std::nullopt;
    const T value = places_[begin % kPlaces];
    begin_.store(begin + 1, std::memory_order_release);
    return value;
  }

 private:
  std::array<T, kPlaces> places_{};
  std::atomic<std::size_t> begin_{0};
  std::atomic<std::size_t> end_{0};
};

}  // namespace footlight::app
