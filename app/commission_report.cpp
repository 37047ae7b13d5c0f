// SPDX-License-Identifier: Apache-2.0
#include "app/commission_report.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace footlight::app {
namespace {

using Json = nlohmann::ordered_json;

/// Names of what a report speaks of.
class Names {
 public:
  explicit Names(const CommissionReport& report) : report_(report) {}
  [[nodiscard]] std::string lamp(std::size_t i) const { return lamp_name(report_.rig, report_.lamps[i].place); }
  [[nodiscard]] std::string node(NodeIndex node) const { return report_.rig.nodes[node.at()].name; }
  [[nodiscard]] std::string cell(CellIndex cell) const { return report_.stage.grid.name(cell); }
  /// Where the rig has it.
  [[nodiscard]] std::string planned(std::size_t i) const {
    return report_.lamps[i].cell ? cell(*report_.lamps[i].cell) : "-";
  }

 private:
  const CommissionReport& report_;
};

std::string line(const char* what, const std::string& text) { return fmt::format("{:<11}{}\n", what, text); }

std::string film_text(const FilmReport& film) {
  return line("film",
              fmt::format("{} x {}, {} frames; step {:.3f} s, fit {:.2f}; seen from {}, placed by {}, lights {:.0f} cm "
                          "beside the middle of their cells",
                          film.film.width, film.film.height, film.film.frames.size(), film.reading.timing.step_s,
                          film.reading.timing.fit, to_text(film.fit.from), film.fit.by, 100 * film.fit.error_m)) +
         line("lights", fmt::format("{} that flash, {} of them by reflection, {} beside the cells; {} that do not",
                                    film.reading.lights.size(), film.places.reflections, film.places.beside,
                                    film.reading.steady));
}

std::string turned_text(const TurnedLamps& turned, const Names& names) {
  const std::string which = fmt::format("{}: its lamps {} to {}", names.node(turned.node), turned.first, turned.last);
  return turned.reversed ? which + " hang the other way round" : fmt::format("{} are moved on by {}", which, turned.by);
}

}  // namespace

std::string commission_text(const CommissionReport& report, const FilmReport* film) {
  const Findings& found = report.findings;
  const Names names(report);
  const auto seen =
      static_cast<std::size_t>(std::ranges::count_if(report.seen, [](const auto& cell) { return cell.has_value(); }));
  std::string out = film == nullptr ? "" : film_text(*film);
  out +=
      line("lamps", fmt::format("{}: {} seen, {} of them where the rig says", report.lamps.size(), seen, found.right));
  for (const auto& [a, b] : found.nodes) {
    out += line("nodes", names.node(a) + " and " + names.node(b) + " are exchanged");
  }
  for (const TurnedLamps& turned : found.turned) out += line("turned", turned_text(turned, names));
  for (const auto& [a, b] : found.exchanged) {
    out += line("exchanged", fmt::format("{} is on {} and {} on {}", names.lamp(a), names.planned(b), names.lamp(b),
                                         names.planned(a)));
  }
  for (const auto& [lamp, cell] : found.moved) {
    out += line("moved",
                fmt::format("{} is on {}, the rig says {}", names.lamp(lamp), names.cell(cell), names.planned(lamp)));
  }
  for (const auto& [lamp, cell] : found.unassigned) {
    out += line("found", fmt::format("{} is on {}, the rig did not know it", names.lamp(lamp), names.cell(cell)));
  }
  for (const std::size_t i : found.dead) {
    out += line("dead", fmt::format("{} on {}: no light", names.lamp(i), names.planned(i)));
  }
  for (const std::size_t i : found.unreadable) {
    out += line("unread", fmt::format("{} on {}: a light that cannot be read", names.lamp(i), names.planned(i)));
  }
  for (const std::size_t i : found.nowhere) out += line("nowhere", names.lamp(i) + ": never assigned, and not seen");
  if (found.clean()) out += line("", "every lamp that was seen is where the rig says");
  if (!report.output.empty()) out += line("rig", report.output);
  return out;
}

std::string commission_json(const CommissionReport& report, const FilmReport* film) {
  const Findings& found = report.findings;
  const Names names(report);
  Json out;
  if (film != nullptr) {
    out["film"] = {{"width", film->film.width},
                   {"height", film->film.height},
                   {"frames", film->film.frames.size()},
                   {"step_s", film->reading.timing.step_s},
                   {"fit", film->reading.timing.fit},
                   {"reference_s", film->reading.reference_s},
                   {"moved_px", film->reading.most_moved_px},
                   {"from", to_text(film->fit.from)},
                   {"placed_by", film->fit.by},
                   {"error_m", film->fit.error_m},
                   {"lights", film->reading.lights.size()},
                   {"reflections", film->places.reflections},
                   {"beside", film->places.beside},
                   {"steady", film->reading.steady}};
  }
  out["lamps"] = report.lamps.size();
  out["right"] = found.right;
  for (const char* key : {"nodes", "turned", "exchanged", "moved", "found", "dead", "unread", "nowhere"}) {
    out[key] = Json::array();
  }
  for (const auto& [a, b] : found.nodes) out["nodes"].push_back({names.node(a), names.node(b)});
  for (const TurnedLamps& turned : found.turned) {
    out["turned"].push_back({{"node", names.node(turned.node)},
                             {"first", turned.first},
                             {"last", turned.last},
                             {"reversed", turned.reversed},
                             {"by", turned.by}});
  }
  for (const auto& [a, b] : found.exchanged) out["exchanged"].push_back({names.lamp(a), names.lamp(b)});
  const auto at = [&](std::size_t lamp, CellIndex cell) {
    Json one{{"lamp", names.lamp(lamp)}, {"cell", names.cell(cell)}};
    if (report.lamps[lamp].cell) one["rig"] = names.planned(lamp);
    return one;
  };
  for (const auto& [lamp, cell] : found.moved) out["moved"].push_back(at(lamp, cell));
  for (const auto& [lamp, cell] : found.unassigned) out["found"].push_back(at(lamp, cell));
  for (const std::size_t i : found.dead) out["dead"].push_back(names.lamp(i));
  for (const std::size_t i : found.unreadable) out["unread"].push_back(names.lamp(i));
  for (const std::size_t i : found.nowhere) out["nowhere"].push_back(names.lamp(i));
  if (!report.output.empty()) out["rig"] = report.output;
  return out.dump(2);
}

}  // namespace footlight::app
