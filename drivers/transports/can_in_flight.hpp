// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <optional>

#include "core/time.hpp"
#include "drivers/transport.hpp"

namespace footlight::drivers {

/// Longest time in which waiting frames may get no turn before the wire counts as stalled: 70 ms, and below 360 kbit/s
/// the time of 190 frames, for the answers of 126 nodes to a SYNC and their own heartbeats go before ours.
[[nodiscard]] Duration can_stall_time(int bits_per_second);

/// Frames that an interface has taken and not yet shown to have been on the wire, by the echo of each.
///
/// Echoes come in the order of the wire, which with several transmit buffers need not be that of sending. An echo that
/// never comes (a queue emptied by bus-off) must not count for ever: what has waited a second and been overtaken is
/// lost.
class CanInFlight {
 public:
  explicit CanInFlight(Duration stall_time) : stall_time_(stall_time) {}

  void accepted(const CanFrame& frame, Instant now);
  /// The queue was full. Drivers without an echo of their own (IFF_ECHO: slcan has none) are known to be stuck by this
  /// alone: the kernel then echoes each frame before it is sent.
  void refused(Instant now);
  /// An echo of nothing that we know changes nothing. O(frames in flight), mostly O(1).
  void echoed(const CanFrame& frame, Instant now);
  /// The interface has dropped all of them.
  void forget();

  [[nodiscard]] std::size_t size() const { return waiting_.size(); }
  [[nodiscard]] bool stalled(Instant now) const;

 private:
  struct Waiting {
    CanFrame frame;
    Instant since;
  };

  Duration stall_time_;
  std::deque<Waiting> waiting_;        ///< in the order of sending
  Instant progress_{};                 ///< when a frame left last, or began to wait alone
  std::optional<Instant> full_since_;  ///< nothing has been accepted since
};

}  // namespace footlight::drivers
