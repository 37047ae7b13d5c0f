// SPDX-License-Identifier: Apache-2.0
#include "app/wire_check.hpp"

#include "drivers/registry.hpp"

namespace footlight::app {

std::vector<drivers::Objection> objections_to(const std::vector<Bus>& buses) {
  std::vector<drivers::Objection> out;
  for (const Bus& bus : buses) {
    for (drivers::Objection& objection : drivers::preflight(bus)) out.push_back(std::move(objection));
  }
  return out;
}

Status<> check_wires(Session& session, const std::vector<Bus>& buses) {
  std::string stopping;
  for (const drivers::Objection& objection : objections_to(buses)) {
    if (objection.stops) {
      stopping += (stopping.empty() ? "" : "\n") + objection.text;
    } else {
      session.note(objection.text);
    }
  }
  if (!stopping.empty()) return device_error(stopping);
  return Done{};
}

}  // namespace footlight::app
