// SPDX-License-Identifier: Apache-2.0
#include "app/simulated_buses.hpp"

#include <utility>

#include "controller/cue_list.hpp"
#include "controller/plan_check.hpp"
#include "core/clock.hpp"
#include "drivers/registry.hpp"

namespace footlight::app {
namespace {

const char* simulated_url(BusKind kind) {
  switch (kind) {
    case BusKind::serial:
      return "sim://serial";
    case BusKind::can:
      return "sim://can";
    case BusKind::modbus_tcp:
      return "sim://tcp";
    case BusKind::modbus_rtu:
      return "sim://rtu";
    case BusKind::dmx:
      return "sim://dmx";
  }
  return "sim://rtu";
}

}  // namespace

drivers::PortReference port_of(sim::SimulatedRig& simulated, const Rig& rig, BusIndex bus) {
  switch (rig.buses[bus.at()].kind) {
    case BusKind::serial:
    case BusKind::dmx:
      return &simulated.serial(bus);
    case BusKind::can:
      return &simulated.can(bus);
    case BusKind::modbus_rtu:
    case BusKind::modbus_tcp:
      return &simulated.modbus(bus);
  }
  return {};
}

Rig with_simulated_buses(Rig rig) {
  for (Bus& bus : rig.buses) {
    if (!bus.simulated()) bus.url = simulated_url(bus.kind);
  }
  return rig;
}

Result<std::vector<std::unique_ptr<drivers::Driver>>> drivers_on(sim::SimulatedRig& simulated, const Rig& rig,
                                                                 const Plan& plan, LoggedPorts* logged,
                                                                 drivers::Leadership* leadership) {
  std::vector<std::unique_ptr<drivers::Driver>> out;
  for (std::size_t b = 0; b < rig.buses.size(); ++b) {
    const auto bus = BusIndex::of(b);
    drivers::PortReference port = port_of(simulated, rig, bus);
    if (logged != nullptr) port = logged->before(b, rig.buses[b].kind, port);
    auto driver = leadership == nullptr
                      ? drivers::make_driver(rig.buses[b], drivers::node_addresses(rig, bus),
                                             controller::plan_byte_of(plan), port)
                      : drivers::make_leading_driver(rig.buses[b], drivers::node_addresses(rig, bus),
                                                     controller::plan_byte_of(plan), port, *leadership);
    if (!driver) return std::move(driver).error();
    out.push_back(std::move(driver).value());
  }
  return out;
}

Status<> with_schedule(const Show& show, const Plan& plan, const Rig& rig,
                       const std::function<void(const SimulatedSchedule&)>& use) {
  const Rig wires = with_simulated_buses(rig);
  ManualClock clock;
  sim::SimulatedRig simulated(wires, {}, 1, clock, nullptr);
  drivers::Leadership leadership;
  leadership.epoch = 1;
  const auto drivers = drivers_on(simulated, wires, plan, nullptr, &leadership);
  if (!drivers) return drivers.error();
  const auto schedule = controller::build_schedule(show, plan, wires, *drivers);
  if (!schedule) return schedule.error();
  if (use) use({wires, *drivers, *schedule});
  return Done{};
}

Result<std::vector<SupplyFigures>> check_delivery(const Show& show, const Plan& plan, const Rig& rig) {
  std::vector<SupplyFigures> supplies;
  const auto add_up = [&](const SimulatedSchedule& built) {
    supplies = supply_figures(built.schedule, built.wires, controller::cue_plays(show, plan));
  };
  if (auto built = with_schedule(show, plan, rig, add_up); !built) return std::move(built).error();
  return supplies;
}

}  // namespace footlight::app
