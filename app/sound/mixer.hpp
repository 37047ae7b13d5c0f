// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "app/sound/samples.hpp"
#include "core/time.hpp"

namespace footlight::app {

/// A sound that begins at an instant of the clock.
struct Sounding {
  Instant at;
  std::shared_ptr<const Samples> sound;
};

/// Sounds at their instants, to a stream of samples, exact to the sample. Whatever the samples go to: a device in
/// blocks of its own, or a file. One thread plans, another one renders.
class Mixer {
 public:
  /// What is late by no more than this still sounds, at once; else it is left out, for a late count is a wrong one.
  static constexpr Duration kLate = milliseconds(30);

  /// All that has not begun yet is replaced. What sounds already goes on.
  void plan(std::vector<Sounding> sounds);
  /// @param from clock time at which the first sample of the block sounds; a block follows the one before it
  void render(Instant from, std::span<float> block);

 private:
  struct Playing {
    std::shared_ptr<const Samples> sound;
    std::size_t next = 0;
  };
  std::mutex mutex_;
  std::vector<Sounding> planned_;
  std::vector<Playing> playing_;
  Instant begun_ = Instant::min();  ///< the last sound that has; what was planned for then or before is not new
};

}  // namespace footlight::app
