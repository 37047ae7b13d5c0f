// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "core/time.hpp"

namespace footlight::app {

/// Sees what happens to the machine's clocks beside the one that shows go by, which stands still while the machine
/// sleeps and knows no steps: people have gone on with the music, lamps have not. Pure. One thread.
class ClockWatch {
 public:
  enum class Kind { slept, stepped };
  struct News {
    Kind kind;
    Duration by;  ///< slept for so long; stepped so far
  };
  static constexpr Duration kSlept = milliseconds(100);
  static constexpr Duration kStepped = milliseconds(500);

  /// @param steady the clock of the show  @param boot the one that goes on through a sleep  @param wall what people
  /// call the time; all taken at once, again and again
  std::optional<News> take(Instant steady, Duration boot, Duration wall);

 private:
  std::optional<Duration> asleep_;
  std::optional<Duration> wall_ahead_;
};

}  // namespace footlight::app
