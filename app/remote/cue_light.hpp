// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/time.hpp"

namespace footlight::app {

/// A cue light as in British theatres: red flashes for standby, is steady when whoever stands there has acknowledged
/// it, and green means GO. So that nobody has to tell red from green, each has a pattern of its own: standby flashes
/// evenly once a second, acknowledged is steady, GO flashes in pairs; nothing flashes more than three times a second.
/// Pure.
class CueLight {
 public:
  struct Lamps {
    bool red = false;
    bool green = false;
    friend bool operator==(const Lamps&, const Lamps&) = default;
  };
  void standby(Instant now);
  /// @return false: nobody has said standby
  bool acknowledge();
  void go(Instant now);
  void off() { state_ = State::off; }
  [[nodiscard]] bool waits() const { return state_ == State::standby; }
  [[nodiscard]] Lamps lamps(Instant now);

  static constexpr Duration kGreen = milliseconds(4000);

 private:
  enum class State { off, standby, acknowledged, go };
  State state_ = State::off;
  Instant since_{};
};

}  // namespace footlight::app
