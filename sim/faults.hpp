// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "core/result.hpp"
#include "core/rng.hpp"
#include "core/time.hpp"

namespace footlight::sim {

/// Faults drawn from a seed.
/// "loss=5%,corrupt=1%,duplicate=1%,delay=3ms,late=10%,reboot=2,bus-off=2,full=2,unplug=1,dead=1,until=80%"
struct Faults {
  double loss = 0;       ///< share of frames that a receiver does not hear, 0..0.3
  double corrupt = 0;    ///< share of frames with a flipped bit, 0..0.3
  double duplicate = 0;  ///< share of frames heard twice, 0..0.5
  Duration delay{};      ///< most that an answer is late, on top of the turnaround; 0..1 s
  double late = 1;       ///< share of answers that the delay strikes, 0..1
  int reboot = 0;        ///< restarts of random nodes at random instants of the show, 0..10,000
  int bus_off = 0;       ///< times that the controller of a random CAN bus goes bus-off, for 100 ms; 0..10,000
  int full = 0;          ///< times that for 50..500 ms nothing leaves the queue of a random CAN bus; 0..10,000
  int unplug = 0;        ///< times that the controller's adapter of a random CAN bus is gone for 1 s; 0..10,000
  int dead = 0;          ///< nodes that never answer and never light, 0..10,000
  double until = 1;      ///< share of the show after which nothing is drawn any more, 0..1; the dead stay dead
  /// Shares are "5%" or "0.05", times carry us, ms or s. Errors name the part that is wrong and what is possible.
  static Result<Faults> parse(std::string_view text);

  friend bool operator==(const Faults&, const Faults&) = default;
};

/// What happens to the controller's end of a whole bus.
enum class LineFault {
  bus_off,  ///< its error counter has passed 255; it restarts after 100 ms
  full,     ///< nothing leaves its queue, as when something shouts on the bus
  unplug,   ///< its adapter is pulled out
};

/// The faults of one bus, from its own generator: what happens on one bus does not change the faults of another.
class Chance {
 public:
  Chance(const Faults& faults, Rng rng) : faults_(faults), rng_(rng) {}

  /// From here on nothing goes wrong.
  void end() { faults_ = Faults{}; }
  bool lost() { return happens(faults_.loss); }
  bool corrupted() { return happens(faults_.corrupt); }
  bool duplicated() { return happens(faults_.duplicate); }
  /// How late an answer is: not at all, or uniform in [0, delay].
  Duration lateness() {
    if (faults_.delay.count() == 0 || (faults_.late < 1 && !happens(faults_.late))) return {};
    return up_to(faults_.delay);
  }
  std::uint64_t below(std::uint64_t bound) { return rng_.below(bound); }
  /// Uniform in [0, most].
  Duration up_to(Duration most) {
    return Duration(static_cast<Duration::rep>(rng_.below(static_cast<std::uint64_t>(most.count()) + 1)));
  }

 private:
  bool happens(double share) { return share > 0 && rng_.uniform() < share; }

  Faults faults_;
  Rng rng_;
};

}  // namespace footlight::sim
