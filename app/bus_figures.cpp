// SPDX-License-Identifier: Apache-2.0
#include "app/bus_figures.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace footlight::app {

BusFigures figures_of(const Rig& rig, BusIndex bus, const controller::BusCounters& counters,
                      const drivers::Driver& driver) {
  BusFigures figures{counters, {}, {}, {}, 0, {}};
  figures.name = rig.buses[bus.at()].name;
  figures.kind = std::string(to_text(rig.buses[bus.at()].kind));
  figures.assumes = driver.assumption();
  figures.complaints = driver.complaints();
  figures.nodes = static_cast<std::uint64_t>(std::ranges::count(rig.nodes, bus, &Node::bus));
  return figures;
}

nlohmann::ordered_json figures_json(const BusFigures& figures) {
  return {{"name", figures.name},
          {"kind", figures.kind},
          {"assumes", figures.assumes},
          {"complaints", figures.complaints},
          {"nodes", figures.nodes},
          {"deliveries", figures.deliveries},
          {"unverified", figures.unverified},
          {"retries", figures.retries},
          {"misses", figures.misses},
          {"quarantines", figures.quarantines},
          {"boots", figures.boots},
          {"latches", figures.latches},
          {"late_latches", figures.late_latches}};
}

std::string assumption_line(const BusFigures& figures) {
  std::string lines;
  if (!figures.assumes.empty()) lines = "  unverified on " + figures.name + ": " + figures.assumes + "\n";
  for (const std::string& complaint : figures.complaints) {
    lines += "  not used on " + figures.name + ": " + complaint + "\n";
  }
  return lines;
}

}  // namespace footlight::app
