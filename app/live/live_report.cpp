// SPDX-License-Identifier: Apache-2.0
#include "app/live/live_report.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace footlight::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kResolution_ms = 0.001;  // of the lateness: nothing is a thousand times better than nothing

Json lateness_json(const LatenessReport& lateness) {
  return {{"count", lateness.count},
          {"p50_ms", lateness.p50_ms},
          {"p99_ms", lateness.p99_ms},
          {"p999_ms", lateness.p999_ms},
          {"worst_ms", lateness.worst_ms}};
}

double ratio(double ours_ms, double bare_ms) {
  return std::max(ours_ms, kResolution_ms) / std::max(bare_ms, kResolution_ms);
}

Json bus_json(const LiveBusReport& bus) {
  Json out = figures_json(bus);
  out["url"] = bus.url;
  out["latch_lateness"] = lateness_json(bus.latch);
  out["wake_lateness"] = lateness_json(bus.wake);
  out["cpu_share"] = bus.cpu_share;
  out["unconfirmed"] = bus.unconfirmed;
  out["silent"] = bus.silent;
  out["trouble"] = bus.trouble;
  return out;
}

std::string lateness_row(const char* what, const LatenessReport& lateness) {
  return fmt::format("  {:<24} {:>8} {:>9.3f} {:>9.3f} {:>9.3f} {:>9.3f} ms\n", what, lateness.count, lateness.p50_ms,
                     lateness.p99_ms, lateness.p999_ms, lateness.worst_ms);
}

}  // namespace

std::string live_json(const LiveReport& report, const Rig& rig) {
  Json buses = Json::array();
  for (const LiveBusReport& bus : report.buses) buses.push_back(bus_json(bus));
  Json cues = Json::array();
  for (const LiveCueReport& cue : report.cues) {
    cues.push_back({{"number", cue.number},
                    {"name", cue.name},
                    {"go_to_last_lamp_ms", cue.go_to_last_lamp_ms},
                    {"unconfirmed", cue.unconfirmed}});
  }
  Json floor = Json::array();
  for (std::size_t n = 0; n < rig.nodes.size(); ++n) {
    floor.push_back({{"node", rig.nodes[n].name}, {"looks", report.floor[n]}});
  }
  const Json document{{"unconfirmed", report.unconfirmed},
                      {"late", report.late},
                      {"deliveries", report.deliveries},
                      {"retries", report.retries},
                      {"late_latches", report.late_latches},
                      {"worst_skew_ms", report.worst_skew_ms},
                      {"duration_s", report.duration_s},
                      {"run_s", report.run_s},
                      {"markers", report.markers},
                      {"switches", report.switches},
                      {"deaf", report.deaf},
                      {"real_time", report.real_time},
                      {"wake_lateness", lateness_json(report.wake)},
                      {"bare_timer", lateness_json(report.bare)},
                      {"wake_p99_ratio", ratio(report.wake.p99_ms, report.bare.p99_ms)},
                      {"cues", std::move(cues)},
                      {"buses", std::move(buses)},
                      {"floor", std::move(floor)}};
  return document.dump(2) + "\n";
}

std::string live_text(const LiveReport& report) {
  std::string text = fmt::format("{:.1f} s of show in {:.1f} s, {} markers, {} switches\n", report.duration_s,
                                 report.run_s, report.markers, report.switches);
  for (const LiveCueReport& cue : report.cues) {
    text += fmt::format("  cue {:<6} {:<24} {} node{} not right at its end", cue.number, cue.name, cue.unconfirmed,
                        cue.unconfirmed == 1 ? "" : "s");
    text +=
        cue.go_to_last_lamp_ms > 0 ? fmt::format("; GO to the last lamp {:.1f} ms\n", cue.go_to_last_lamp_ms) : "\n";
  }
  text += fmt::format("  {:<16} {:<11} {:>5} {:>11} {:>10} {:>8} {:>7} {:>6} {:>5} {:>10} {:>6}\n", "bus", "kind",
                      "nodes", "deliveries", "unverified", "retries", "misses", "boots", "late", "lateness", "CPU");
  for (const LiveBusReport& bus : report.buses) {
    text += fmt::format("  {:<16} {:<11} {:>5} {:>11} {:>10} {:>8} {:>7} {:>6} {:>5} {:>7.3f} ms {:>5.1f}%\n", bus.name,
                        bus.kind, bus.nodes, bus.deliveries, bus.unverified, bus.retries, bus.misses, bus.boots,
                        bus.late_latches, bus.latch.worst_ms, bus.cpu_share * 100);
  }
  for (const LiveBusReport& bus : report.buses) text += assumption_line(bus);
  text += fmt::format("  {:<24} {:>8} {:>9} {:>9} {:>9} {:>9}\n", "lateness", "times", "p50", "p99", "p99.9", "worst");
  for (const LiveBusReport& bus : report.buses) text += lateness_row(("latch, " + bus.name).c_str(), bus.latch);
  text += lateness_row("bus threads waking", report.wake) + lateness_row("a bare timer", report.bare);
  text += fmt::format("bus threads wake {:.1f} times as late as a bare timer (p99), {} real-time priority\n",
                      ratio(report.wake.p99_ms, report.bare.p99_ms), report.real_time ? "with" : "without");
  text += fmt::format("latches of a switch at most {:.3f} ms apart between buses\n", report.worst_skew_ms);
  if (report.deaf > 0) text += fmt::format("{} times a bus stood still, for the cue thread was silent\n", report.deaf);
  text +=
      fmt::format("{} deliveries, {} retries, {} late latches; {} node{} late at a switch, {} not right at the end\n",
                  report.deliveries, report.retries, report.late_latches, report.late, report.late == 1 ? "" : "s",
                  report.unconfirmed);
  return text;
}

std::string live_failure(const LiveReport& report) {
  std::string text;
  for (const LiveBusReport& bus : report.buses) {
    if (bus.unconfirmed == 0) continue;
    text += fmt::format("{}bus \"{}\" ({}): {} of {} nodes not confirmed right at the end", text.empty() ? "" : "\n",
                        bus.name, bus.url, bus.unconfirmed, bus.nodes);
    for (std::size_t i = 0; i < bus.silent.size(); ++i) text += (i == 0 ? "; silent: " : ", ") + bus.silent[i];
    for (const std::string& complaint : bus.complaints) text += "; " + complaint;
    if (!bus.trouble.empty()) text += "; its wire is down: " + bus.trouble;
  }
  return text;
}

}  // namespace footlight::app
