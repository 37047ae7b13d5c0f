// SPDX-License-Identifier: Apache-2.0
#include "app/wire_check.hpp"

#include "drivers/leading.hpp"
#include "drivers/registry.hpp"

namespace footlight::app {

std::vector<drivers::Objection> objections_to(const std::vector<Bus>& buses) {
  std::vector<drivers::Objection> out;
  for (const Bus& bus : buses) {
    for (drivers::Objection& objection : drivers::preflight(bus)) out.push_back(std::move(objection));
  }
  return out;
}

std::string unfenced_text(const std::vector<Bus>& buses) {
  const std::vector<std::string> names = drivers::unfenced(buses);
  if (names.empty()) return {};
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return (names.size() == 1 ? "this bus cannot be fenced: " : "these buses cannot be fenced: ") + list +
         " (nothing there refuses another controller)";
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
