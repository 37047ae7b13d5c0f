// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/timecode.hpp"

namespace footlight::controller {

/// Where a source of time is, from what it says now and then: locks on when it makes sense, goes on by itself through
/// gaps, and takes no single wrong word for a jump. Speed and place are those of the straight line through what it said
/// in the last second and a half (least squares). Pure; allocates nothing; O(kKept) a fix. One thread.
class TimeFollower {
 public:
  enum class State : std::uint8_t {
    none,        ///< nothing that makes sense has come yet
    locked,      ///<
    freewheels,  ///< nothing for kSilent: goes on at the last speed
    lost,        ///< nothing for longer than it may freewheel
  };
  static constexpr Duration kSilent = milliseconds(150);
  static constexpr double kSlowest = 0.24;  ///< speed of a source that can be followed
  static constexpr double kFastest = 2.1;

  /// @param freewheel silence until it is lost
  explicit TimeFollower(Duration freewheel) : freewheel_(freewheel) {}

  void take(const TimeFix& fix) noexcept;
  [[nodiscard]] State state(Instant now) const noexcept;
  /// Of the source; nothing when it never locked.
  [[nodiscard]] std::optional<Duration> position(Instant now) const noexcept;
  /// Of the source's time against the clock; 1 until it is known.
  [[nodiscard]] double rate() const noexcept { return rate_; }
  /// Times that it was found somewhere else than it had been followed to.
  [[nodiscard]] std::uint64_t jumps() const noexcept { return jumps_; }

 private:
  static constexpr std::size_t kKept = 32;
  /// Fixes that follow each other as a source that runs forwards does.
  struct Run {
    std::array<TimeFix, kKept> fixes{};
    std::size_t count = 0;  ///< all; the last ones are kept
    [[nodiscard]] bool continues(const TimeFix& fix) const noexcept;
    void add(const TimeFix& fix) noexcept { fixes[count++ % kKept] = fix; }
    [[nodiscard]] const TimeFix& last() const noexcept { return fixes[(count - 1) % kKept]; }
    /// How far it got over all that is kept, against the clock; nothing before it is long enough.
    [[nodiscard]] std::optional<double> progress() const noexcept;
  };
  void fit() noexcept;

  Duration freewheel_;
  Run followed_;
  Run other_;  ///< that does not fit: a jump, or garbage
  bool locked_ = false;
  TimeFix mean_{};  ///< of the line
  double rate_ = 1;
  std::uint64_t jumps_ = 0;
};

[[nodiscard]] std::string_view to_text(TimeFollower::State state);

}  // namespace footlight::controller
