// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/live/seqlock.hpp"
#include "controller/bus_loop.hpp"

namespace footlight::app {

/// Where the show stands, handed from the cue thread to the bus threads. One writer, any readers.
class SharedTarget {
 public:
  struct Told {
    controller::BusTarget target{};
    Instant at{};  ///< when the cue thread said so
  };

  void publish(const controller::BusTarget& target, Instant at) noexcept { told_.write({target, at}); }
  [[nodiscard]] Told read() const noexcept { return told_.read(); }

 private:
  SeqLock<Told> told_;
};

}  // namespace footlight::app
