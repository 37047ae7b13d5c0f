// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "app/bus_figures.hpp"
#include "app/supply_figures.hpp"
#include "core/clock.hpp"
#include "core/plan.hpp"
#include "core/result.hpp"
#include "core/rig.hpp"
#include "core/show.hpp"
#include "sim/faults.hpp"

namespace footlight::app {

struct DryRunOptions {
  std::uint64_t seed = 1;
  sim::Faults faults;
  std::ostream* trace = nullptr;     ///< one line for each frame, or null
  std::ostream* wire_log = nullptr;  ///< a pcapng section of what goes through the ports, or null
  const Clock* pace = nullptr;       ///< runs no faster than this clock; null: as fast as it goes
  const std::atomic<bool>* stop = nullptr;
  std::function<void(double share)> progress;           ///< of show time; may be empty
  std::function<void(const std::string& line)> moment;  ///< a line for each cue and switch; may be empty
};

/// A marker that did not show what it should.
struct WrongMarker {
  std::string node;
  int channel = 0;
  int shows = 0;   ///< look
  int should = 0;  ///< look
};

struct CueReport {
  std::string number;
  std::string name;
  double end_s = 0;                ///< show time
  std::uint64_t wrong = 0;         ///< markers not right at its end
  std::uint64_t exempt = 0;        ///< not right, but restarted a moment ago
  std::vector<WrongMarker> first;  ///< at most 10 of the wrong ones
};

struct BusReport : BusFigures {
  double utilisation = 0;  ///< share of wire time since the show began, retries included
  std::uint64_t frames = 0;
};

struct DryRunReport {
  std::uint64_t markers = 0;
  std::uint64_t switches = 0;
  std::uint64_t looks = 0;
  std::uint64_t wrong_final = 0;  ///< markers not right at the end of a cue, all cues
  std::uint64_t late = 0;         ///< markers not right at the end of a switch that ends no cue
  double right_share = 0;  ///< marker-time that showed the planned look, sampled every 20 ms; dead nodes left out
  /// Markers seen to begin to show what is neither their planned look, the one before, nor NO-GUIDANCE, nor kept in
  /// HOLD.
  std::uint64_t wrong = 0;
  double wrong_s = 0;  ///< marker-time in which that was so
  /// Markers of healthy nodes not right at the end of a switch, two refresh periods after the last fault or later.
  std::uint64_t wrong_after_recovery = 0;
  double recovery_s = 0;  ///< two refresh periods: from the last fault until every marker must be right
  std::uint64_t deliveries = 0;
  std::uint64_t retries = 0;
  double duration_s = 0;  ///< of show
  double run_s = 0;       ///< of the virtual clock, with the waits for GO
  std::uint64_t confusion_before = 0;
  std::uint64_t confusion_after = 0;
  std::uint64_t reboots = 0;
  std::vector<std::string> dead;  ///< nodes that never answered, by the faults asked for
  std::vector<CueReport> cues;
  std::vector<BusReport> buses;
  std::vector<SupplyFigures> supplies;  ///< that the rig lists
};

/// Plays a show with real drivers on simulated buses in virtual time, GO pressed whenever the show waits, and compares
/// what every marker shows with what it should show. Buses with a real URL are simulated as their kind.
/// A rebooted node is exempt from wrong_final for the time in which a silent node must be noticed, and 250 ms.
/// @return ErrorKind::refused when a bus cannot carry the show, ErrorKind::interrupted when told to stop. The same
/// show, plan, rig, faults and seed give the same report and the same trace, byte for byte.
[[nodiscard]] Result<DryRunReport> dry_run(const Show& show, const Plan& plan, Rig rig, const DryRunOptions& options);

}  // namespace footlight::app
