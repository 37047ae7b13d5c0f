// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/clock.hpp"
#include "core/time.hpp"

namespace footlight::sim {

/// Somebody to whom things happen at instants.
class Actor {
 public:
  Actor() = default;
  Actor(const Actor&) = delete;
  Actor& operator=(const Actor&) = delete;
  virtual ~Actor() = default;
  /// @param token what was given to World::schedule; an event cannot be taken back, so it says whether it still counts
  virtual void act(std::uint64_t token) = 0;
};

/// Virtual time: what is due is done in the order (instant, order of scheduling), and the clock stands at that instant
/// meanwhile. Scheduling and taking are O(log of the events outstanding).
class World {
 public:
  /// @param clock borrowed; moved by this world alone
  explicit World(ManualClock& clock) : clock_(clock) {}

  [[nodiscard]] Instant now() const { return clock_.now(); }
  /// @param at not before now(); @param actor must live until then
  void schedule(Instant at, Actor& actor, std::uint64_t token = 0);
  /// Instant of the next event; kNever when there is none.
  [[nodiscard]] Instant next() const { return events_.empty() ? kNever : events_.front().at; }
  /// Does everything due up to and including `instant`, also what that brings about, and leaves the clock there.
  void advance_to(Instant instant);

 private:
  struct Event {
    Instant at;
    std::uint64_t order;
    Actor* actor;
    std::uint64_t token;
  };
  static bool later(const Event& a, const Event& b) { return a.at != b.at ? a.at > b.at : a.order > b.order; }

  ManualClock& clock_;
  std::vector<Event> events_;  ///< heap, the soonest in front
  std::uint64_t order_ = 0;
};

}  // namespace footlight::sim
