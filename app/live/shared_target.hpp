// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "controller/bus_loop.hpp"

namespace footlight::app {

/// Where the show stands, handed from the cue thread to the bus threads. The writer never waits; a reader that meets
/// the writer reads again. One writer, any readers.
class SharedTarget {
 public:
  struct Told {
    controller::BusTarget target;
    Instant at;  ///< when the cue thread said so
  };

  void publish(const controller::BusTarget& target, Instant at) noexcept {
    const std::array<std::int64_t, 5> words{
        static_cast<std::int64_t>(target.current), static_cast<std::int64_t>(target.next),
        target.next_at.time_since_epoch().count(), target.show_time.count(), at.time_since_epoch().count()};
    const std::uint64_t version = version_.load(std::memory_order_relaxed);
    version_.store(version + 1, std::memory_order_seq_cst);  // odd: being written
    for (std::size_t i = 0; i < words.size(); ++i) words_[i].store(words[i], std::memory_order_seq_cst);
    version_.store(version + 2, std::memory_order_seq_cst);
  }

  [[nodiscard]] Told read() const noexcept {
    while (true) {
      const std::uint64_t version = version_.load(std::memory_order_seq_cst);
      std::array<std::int64_t, 5> words{};
      for (std::size_t i = 0; i < words.size(); ++i) words[i] = words_[i].load(std::memory_order_seq_cst);
      if (version % 2 != 0 || version != version_.load(std::memory_order_seq_cst)) continue;
      return {{static_cast<std::size_t>(words[0]), static_cast<std::size_t>(words[1]), Instant(Duration(words[2])),
               Duration(words[3])},
              Instant(Duration(words[4]))};
    }
  }

 private:
  std::atomic<std::uint64_t> version_{0};
  std::array<std::atomic<std::int64_t>, 5> words_{};
};

}  // namespace footlight::app
