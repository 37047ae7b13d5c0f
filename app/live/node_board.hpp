// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "core/index.hpp"

namespace footlight::app {

/// What is known of every node of the rig, from the threads of the buses to whoever looks. Each node is one word:
/// nobody waits, nobody sees half of it. One writer for each node, any readers.
class NodeBoard {
 public:
  static constexpr std::uint32_t kNothingYet = 0xffff'ffff;
  enum Flag : std::uint32_t {
    kRight = 1,        ///< confirmed to show what it should now
    kSilent = 2,       ///< it has not answered what it was asked last
    kQuarantined = 4,  ///< asked only from time to time
    kUnverified = 8,   ///< such a device cannot be read back
    kSameChecks = 16,  ///< it keeps the checks of this plan and patch
    kOtherPlan = 32,
    kOtherPatch = 64,
    kNoPatch = 128,   ///< it was never commissioned
    kNoChecks = 256,  ///< such a device keeps none, or does not know the question
  };
  struct View {
    std::uint32_t shown = kNothingYet;  ///< switch whose looks it has confirmed last
    std::uint32_t flags = 0;
    friend bool operator==(const View&, const View&) = default;
  };

  explicit NodeBoard(std::size_t nodes) : words_(nodes), boots_(nodes) {}

  [[nodiscard]] std::size_t size() const { return words_.size(); }
  [[nodiscard]] View at(std::size_t node) const noexcept {
    const std::uint64_t word = words_[node].load(std::memory_order_relaxed);
    // Stored upside down, so that a board begins with nothing known.
    return {~static_cast<std::uint32_t>(word), static_cast<std::uint32_t>(word >> 32)};
  }
  void put(std::size_t node, View view) noexcept {
    const std::uint64_t word = std::uint64_t{view.flags} << 32 | static_cast<std::uint32_t>(~view.shown);
    if (words_[node].load(std::memory_order_relaxed) != word) words_[node].store(word, std::memory_order_relaxed);
  }

  /// Restarts that were noticed, modulo 256.
  [[nodiscard]] std::uint8_t boots(std::size_t node) const noexcept {
    return boots_[node].load(std::memory_order_relaxed);
  }
  void put_boots(std::size_t node, std::uint8_t boots) noexcept {
    boots_[node].store(boots, std::memory_order_relaxed);
  }

 private:
  std::vector<std::atomic<std::uint64_t>> words_;
  std::vector<std::atomic<std::uint8_t>> boots_;
};

}  // namespace footlight::app
