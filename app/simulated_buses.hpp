// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "app/supply_figures.hpp"
#include "app/wire_log/logged_ports.hpp"
#include "controller/cue_schedule.hpp"
#include "core/plan.hpp"
#include "core/result.hpp"
#include "core/rig.hpp"
#include "core/show.hpp"
#include "drivers/driver.hpp"
#include "drivers/leading.hpp"
#include "drivers/registry.hpp"
#include "sim/simulated_rig.hpp"

namespace footlight::app {

/// The rig with every bus that has a real URL simulated as its kind.
[[nodiscard]] Rig with_simulated_buses(Rig rig);

/// The port of a simulated bus, of the kind that the bus needs.
[[nodiscard]] drivers::PortReference port_of(sim::SimulatedRig& simulated, const Rig& rig, BusIndex bus);

/// The real drivers on simulated buses, one for each bus of the rig. Errors: addresses that a bus cannot have.
/// @param logged stands between drivers and buses where it is given, and outlives the drivers
/// @param leadership under which they lead, likewise; null: without an epoch, and no LEAD is on the wire
[[nodiscard]] Result<std::vector<std::unique_ptr<drivers::Driver>>> drivers_on(
    sim::SimulatedRig& simulated, const Rig& rig, const Plan& plan, LoggedPorts* logged = nullptr,
    drivers::Leadership* leadership = nullptr);

/// A show's schedule, and the simulated buses that it is built for.
struct SimulatedSchedule {
  const Rig& wires;
  const std::vector<std::unique_ptr<drivers::Driver>>& drivers;
  const controller::CueSchedule& schedule;
};

/// Builds the schedule of a valid plan on simulated buses, and lends it to `use` (which may be empty). Budgets are
/// those of a run, which leads. Nothing is played. Errors: as build_schedule.
[[nodiscard]] Status<> with_schedule(const Show& show, const Plan& plan, const Rig& rig,
                                     const std::function<void(const SimulatedSchedule&)>& use);

/// Whether the lamps of a valid plan can be lit, in time and by their supplies: an error where build_schedule has one.
/// Nothing is played. @return what the supplies have to give
[[nodiscard]] Result<std::vector<SupplyFigures>> check_delivery(const Show& show, const Plan& plan, const Rig& rig);

}  // namespace footlight::app
