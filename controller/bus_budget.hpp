// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "controller/cue_schedule.hpp"
#include "core/result.hpp"
#include "core/rig.hpp"
#include "drivers/driver.hpp"

namespace footlight::controller {

/// Share of the time between two switches that is kept for repeats.
inline constexpr double kBusReserve = 0.30;

/// What a bus has to carry so that one switch comes in time.
struct BusNeed {
  BusIndex bus;
  std::size_t k = 0;     ///< index of the switch
  int changed = 0;       ///< nodes whose looks change
  int verified = 0;      ///< nodes whose receipt of the switch before is read first
  int latches = 0;       ///< one, and its repeat where it has a sequence
  int heartbeats = 0;    ///< that fall due meanwhile
  Duration preloads{};   ///< of the changed nodes
  Duration receipts{};   ///< of the verified nodes
  Duration latching{};   ///< of the latches
  Duration beating{};    ///< of the heartbeats, and of those that nodes send by themselves meanwhile
  Duration available{};  ///< since the switch before, the reserve not yet taken off
  [[nodiscard]] Duration needed() const { return preloads + receipts + latching + beating; }
  [[nodiscard]] Duration allowed() const {
    return Duration(static_cast<Duration::rep>(static_cast<double>(available.count()) * (1 - kBusReserve)));
  }
  [[nodiscard]] bool fits() const { return changed == 0 || needed() <= allowed(); }
};

/// Time in which every bus has lit and confirmed the opening after it was switched on, with the reserve: look table,
/// preloads, latch, receipts and heartbeats.
[[nodiscard]] Duration opening_time(const CueSchedule& schedule, const Rig& rig,
                                    const std::vector<std::unique_ptr<drivers::Driver>>& drivers);

/// Longest stand before a switch that waits for GO: see kShortestHold; `gaps[c]` is the stand after cue c.
[[nodiscard]] std::vector<BusNeed> bus_needs(const CueSchedule& schedule, const Rig& rig,
                                             const std::vector<std::unique_ptr<drivers::Driver>>& drivers,
                                             std::span<const Duration> gaps);

/// A line for each overloaded bus about its worst need, with the arithmetic and what would help. At least one need must
/// not fit.
[[nodiscard]] Error over_budget(const std::vector<BusNeed>& needs, const CueSchedule& schedule, const Rig& rig,
                                const Show& show);

}  // namespace footlight::controller
