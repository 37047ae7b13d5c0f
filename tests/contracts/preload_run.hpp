// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/rig.hpp"
#include "core/time.hpp"

namespace footlight::contracts {

/// The next looks of all nodes of one simulated bus, preloaded by its loop while the show waits for GO, heartbeats and
/// all, in virtual time.
struct PreloadRun {
  int receipts = 0;    ///< nodes that have taken theirs
  Duration elapsed{};  ///< from the first byte until the last receipt
  Duration on_wire{};  ///< characters of preloads and receipts
  Duration allowed{};  ///< those, and the silences and turnarounds as they happened: nobody could do it in less
  /// Share of the time that nobody could have saved.
  [[nodiscard]] double efficiency() const { return seconds_in(allowed) / seconds_in(elapsed); }
  /// Share of the time in which there were bits of them on the line.
  [[nodiscard]] double of_line_rate() const { return seconds_in(on_wire) / seconds_in(elapsed); }

 private:
  static double seconds_in(Duration duration) { return static_cast<double>(duration.count()) * 1e-9; }
};

/// Nodes have 32 channels, and every look changes.
/// @param kind serial, modbus_rtu or can (where a receipt is the last frame of a node's preload)  @param nodes as many
/// as the bus has addresses at most
[[nodiscard]] PreloadRun preload_all(BusKind kind, int bits_per_second, int nodes);

}  // namespace footlight::contracts
