// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "core/time.hpp"

namespace footlight::app {

/// What of a stream of messages is carried out: in each window of 20 ms so many of each client, and no more of all than
/// half of what the cue thread's ring takes, so that one client's flood costs another one nothing until several flood
/// together. A HOLD is in nobody's budget: of each look one is carried out, and another one after anything else was.
/// Pure. One thread.
class FloodGuard {
 public:
  static constexpr Duration kWindow = milliseconds(20);
  static constexpr int kMost = 16;       ///< of a client, a window
  static constexpr int kMostOfAll = 32;  ///< of all clients, a window

  /// @return whether this message is carried out; else it is lost
  bool take(std::string_view client, Instant now);
  /// A look at what has come begins; others may have said something since the last one.
  void begin_look() { held_ = false; }
  /// @return false: the same was said in this look, and nothing since
  bool take_hold(Instant now);
  /// Whether `take` would refuse.
  [[nodiscard]] bool full(std::string_view client, Instant now);
  /// A message is lost without having been looked at.
  void lose(Instant now);
  /// More came in the last 20 ms than is carried out: nobody need be woken for it.
  [[nodiscard]] bool floods(Instant now) const { return flood_at_ != Instant::min() && now - flood_at_ < kWindow; }
  /// Since the last call.
  [[nodiscard]] std::uint64_t lost() { return std::exchange(lost_, 0); }
  [[nodiscard]] bool any_lost() const { return lost_ > 0; }

 private:
  void roll(Instant now);

  Instant window_ = Instant::min();  ///< began
  std::map<std::string, int, std::less<>> taken_;
  int of_all_ = 0;
  bool held_ = false;  ///< by the last thing that was carried out in this look
  std::uint64_t lost_ = 0;
  Instant flood_at_ = Instant::min();
};

}  // namespace footlight::app
