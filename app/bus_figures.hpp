// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "controller/bus_loop.hpp"
#include "core/rig.hpp"
#include "drivers/driver.hpp"

namespace footlight::app {

/// What a dry run and a run tell of a bus alike.
struct BusFigures : controller::BusCounters {
  std::string name;
  std::string kind;
  std::string assumes;  ///< what is taken for granted of its devices; empty: they prove what they show
  std::uint64_t nodes = 0;
  std::vector<std::string> complaints;  ///< why nodes cannot be used, as they have said
};

[[nodiscard]] BusFigures figures_of(const Rig& rig, BusIndex bus, const controller::BusCounters& counters,
                                    const drivers::Driver& driver);
/// An object that reports add to.
[[nodiscard]] nlohmann::ordered_json figures_json(const BusFigures& figures);

/// Lines for people where the devices of a bus do not prove what they show, or cannot be used; else empty.
[[nodiscard]] std::string assumption_line(const BusFigures& figures);

}  // namespace footlight::app
