// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "app/live/seqlock.hpp"
#include "controller/bus_loop.hpp"

namespace footlight::app {

/// Where the show stands, handed from the cue thread to the bus threads. One writer, any readers.
class SharedTarget {
 public:
  struct Told {
    controller::BusTarget target{};
    Instant at{};            ///< when the cue thread said so
    std::uint32_t plan = 0;  ///< whose switches it means: 0 is the first of the run, then one more for each taken
  };

  void publish(const controller::BusTarget& target, Instant at, std::uint32_t plan = 0) noexcept {
    told_.write({target, at, plan});
  }
  [[nodiscard]] Told read() const noexcept { return told_.read(); }

 private:
  SeqLock<Told> told_;
};

}  // namespace footlight::app
