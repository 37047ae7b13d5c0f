// SPDX-License-Identifier: Apache-2.0
#include "app/dry_run_report.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace footlight::app {
namespace {

using Json = nlohmann::ordered_json;

Json cue_json(const CueReport& cue) {
  Json first = Json::array();
  for (const WrongMarker& marker : cue.first) {
    first.push_back(
        {{"node", marker.node}, {"channel", marker.channel}, {"shows", marker.shows}, {"should", marker.should}});
  }
  return {{"number", cue.number}, {"name", cue.name},     {"end_s", cue.end_s},
          {"wrong", cue.wrong},   {"exempt", cue.exempt}, {"first", std::move(first)}};
}

double worst_lateness_ms(const BusReport& bus) { return to_seconds(bus.worst_lateness) * 1e3; }

Json bus_json(const BusReport& bus) {
  Json out = figures_json(bus);
  out["utilisation"] = bus.utilisation;
  out["frames"] = bus.frames;
  out["worst_lateness_ms"] = worst_lateness_ms(bus);
  return out;
}

}  // namespace

std::string dry_run_json(const DryRunReport& report) {
  Json buses = Json::array();
  for (const BusReport& bus : report.buses) buses.push_back(bus_json(bus));
  Json cues = Json::array();
  for (const CueReport& cue : report.cues) cues.push_back(cue_json(cue));
  const Json document{{"wrong_final", report.wrong_final},
                      {"right_share", report.right_share},
                      {"deliveries", report.deliveries},
                      {"retries", report.retries},
                      {"duration_s", report.duration_s},
                      {"run_s", report.run_s},
                      {"markers", report.markers},
                      {"switches", report.switches},
                      {"looks", report.looks},
                      {"late", report.late},
                      {"wrong", report.wrong},
                      {"wrong_s", report.wrong_s},
                      {"wrong_after_recovery", report.wrong_after_recovery},
                      {"recovery_s", report.recovery_s},
                      {"confusion", {{"before", report.confusion_before}, {"after", report.confusion_after}}},
                      {"reboots", report.reboots},
                      {"dead", report.dead},
                      {"cues", std::move(cues)},
                      {"buses", std::move(buses)},
                      {"supplies", supplies_json(report.supplies)}};
  return document.dump(2) + "\n";
}

std::string dry_run_text(const DryRunReport& report) {
  std::string text = fmt::format("{:.1f} s of show, {} markers, {} switches, {} looks\n", report.duration_s,
                                 report.markers, report.switches, report.looks);
  for (const CueReport& cue : report.cues) {
    text += fmt::format("  cue {:<6} {:<24} until {:8.2f} s  {} wrong{}\n", cue.number, cue.name, cue.end_s, cue.wrong,
                        cue.exempt > 0 ? fmt::format(", {} of a node that had just restarted", cue.exempt) : "");
  }
  text += fmt::format("  {:<16} {:<11} {:>6} {:>6} {:>11} {:>8} {:>7} {:>7} {:>9}\n", "bus", "kind", "nodes", "load",
                      "deliveries", "retries", "misses", "boots", "lateness");
  for (const BusReport& bus : report.buses) {
    text += fmt::format("  {:<16} {:<11} {:>6} {:>5.1f}% {:>11} {:>8} {:>7} {:>7} {:>6.1f} ms\n", bus.name, bus.kind,
                        bus.nodes, bus.utilisation * 100, bus.deliveries, bus.retries, bus.misses, bus.boots,
                        worst_lateness_ms(bus));
  }
  for (const BusReport& bus : report.buses) text += assumption_line(bus);
  text += supplies_text(report.supplies);
  text += fmt::format("lamps that could mislead: {} with one pattern for all, {} with patterns\n",
                      report.confusion_before, report.confusion_after);
  if (!report.dead.empty()) {
    text += "dead nodes, left out of the comparison:";
    for (const std::string& node : report.dead) text += " " + node;
    text += "\n";
  }
  text += fmt::format("{} deliveries, {} retries; {} of marker-time right; {} markers late at a switch\n",
                      report.deliveries, report.retries,
                      report.markers == 0 ? "no marker, nothing" : fmt::format("{:.3f} %", report.right_share * 100),
                      report.late);
  text += fmt::format(
      "{} markers wrong at the end of a cue, {} seen with a look of another moment, {} wrong {:.1f} s after "
      "the last fault\n",
      report.wrong_final, report.wrong, report.wrong_after_recovery, report.recovery_s);
  return text;
}

std::string dry_run_failure(const DryRunReport& report) {
  std::string text;
  for (const CueReport& cue : report.cues) {
    if (cue.wrong == 0) continue;
    text += fmt::format("{}cue {} \"{}\": {} marker{} wrong at its end ({:.3f} s):", text.empty() ? "" : "\n",
                        cue.number, cue.name, cue.wrong, cue.wrong == 1 ? "" : "s", cue.end_s);
    for (const WrongMarker& marker : cue.first) {
      text += fmt::format(" {} channel {} shows look {} instead of {};", marker.node, marker.channel, marker.shows,
                          marker.should);
    }
    text.back() = cue.wrong > cue.first.size() ? ',' : '.';
    if (cue.wrong > cue.first.size()) text += " ...";
  }
  return text;
}

}  // namespace footlight::app
