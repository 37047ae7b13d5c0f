// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/live/bus_thread.hpp"
#include "app/live/shared_target.hpp"
#include "controller/bus_loop.hpp"
#include "controller/cue_schedule.hpp"
#include "core/clock.hpp"
#include "core/result.hpp"
#include "core/rig.hpp"
#include "drivers/registry.hpp"
#include "sim/simulated_rig.hpp"

namespace footlight::app {

/// The lamps of a whole rig without a show: whoever has a schedule says which of its switches is lit when. On simulated
/// buses in virtual time, which goes on only inside `run_until`; on real ones by a thread for each bus.
class FloorLights {
 public:
  struct Choice {
    bool simulated = false;  ///< whatever the URLs say
    sim::Faults faults;      ///< of the simulated ones
    std::uint64_t seed = 1;
  };

  /// Errors: a port that cannot be opened, all of them in one message; addresses that a bus cannot have.
  /// @param stop ends `run_until`
  [[nodiscard]] static Result<std::unique_ptr<FloorLights>> open(const Rig& rig, const Choice& choice,
                                                                 const std::atomic<bool>* stop);
  ~FloorLights();
  FloorLights(const FloorLights&) = delete;
  FloorLights& operator=(const FloorLights&) = delete;

  [[nodiscard]] const std::vector<std::unique_ptr<drivers::Driver>>& drivers() const { return drivers_; }
  [[nodiscard]] Instant now() const;

  /// From now on switches of this schedule; switch 0 is lit at once. The look table is uploaded anew.
  void load(controller::CueSchedule schedule);
  /// Switch `k` is to be lit at `at`, or as soon as it can be.
  void light(std::size_t k, Instant at);
  /// As long before its instant a switch has to be told so that all of its lamps are preloaded.
  [[nodiscard]] Duration notice() const { return notice_; }
  /// Lets time go on. @param see called at every instant at which something may have changed, simulated buses only
  /// @return false when it was told to stop
  bool run_until(Instant until, const std::function<void(Instant)>& see = {});
  /// Until every node that answers shows what it should, or until the time is over. @return false when told to stop
  bool settle(Duration at_most);

  /// Nodes that are not confirmed to show what they should now.
  [[nodiscard]] std::size_t unconfirmed() const;
  /// The lamps themselves; null on real buses.
  [[nodiscard]] const sim::SimulatedRig* simulated() const { return simulated_.get(); }
  /// Why a bus is down, for each that is.
  [[nodiscard]] std::vector<std::string> troubles() const;

 private:
  FloorLights(Rig rig, const std::atomic<bool>* stop);
  Status<> connect(const Choice& choice);
  void stop_threads();
  [[nodiscard]] bool stopped() const;
  void publish(Instant now);
  bool run_real(Instant until);
  bool settled() const;

  Rig rig_;
  const std::atomic<bool>* stop_;
  ManualClock virtual_time_;
  SteadyClock real_time_;
  std::unique_ptr<sim::SimulatedRig> simulated_;
  std::vector<drivers::Port> ports_;
  std::vector<std::unique_ptr<drivers::Driver>> drivers_;
  std::optional<controller::CueSchedule> schedule_;
  std::vector<std::unique_ptr<controller::BusLoop>> loops_;
  std::vector<std::unique_ptr<BusThread>> threads_;
  SharedTarget shared_;
  controller::BusTarget target_;
  Instant next_at_ = kNever;
  Duration notice_{};
};

}  // namespace footlight::app
