// SPDX-License-Identifier: Apache-2.0
#include "app/supply_figures.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace footlight::app {
namespace {

constexpr std::size_t kShownCues = 6;

std::string cue_of(const std::optional<std::size_t>& cue, std::span<const controller::CuePlay> plays) {
  return cue ? plays[*cue].cue.number.to_text() : std::string();
}

}  // namespace

std::vector<SupplyFigures> supply_figures(const controller::CueSchedule& schedule, const Rig& rig,
                                          std::span<const controller::CuePlay> plays) {
  std::vector<SupplyFigures> out;
  for (const controller::SupplyLoad& load : schedule.supplies()) {
    const Supply& supply = rig.supplies[load.supply];
    const controller::Switch& peak = schedule.switches()[load.peak_at];
    SupplyFigures& figures = out.emplace_back();
    figures.name = supply.name;
    figures.limit_a = supply.limit_a;
    figures.nodes = load.nodes;
    figures.lamps = load.lamps;
    figures.peak_a = load.peak_a;
    figures.peak_cue = cue_of(peak.cue, plays);
    figures.peak_s = to_seconds(peak.time);
    figures.mean_a = load.mean_a;
    figures.unguided_a = load.unguided_a;
    for (const controller::DimmedCue& cue : load.dimmed) {
      figures.dimmed.push_back({cue_of(cue.cue, plays), cue.factor, cue.asked_a});
    }
  }
  return out;
}

std::string peak_text(const SupplyFigures& supply) {
  return supply.peak_cue.empty() ? "the opening" : fmt::format("cue {}, {:.1f} s", supply.peak_cue, supply.peak_s);
}

std::string dimmed_text(const SupplyFigures& supply) {
  std::string out;
  for (std::size_t i = 0; i < std::min(kShownCues, supply.dimmed.size()); ++i) {
    const SupplyFigures::Dimmed& one = supply.dimmed[i];
    out += fmt::format("{}{} to {:.0f} %", out.empty() ? "" : ", ", one.cue.empty() ? "the opening" : "cue " + one.cue,
                       100 * one.factor);
  }
  if (supply.dimmed.size() > kShownCues) out += fmt::format(" and {} more", supply.dimmed.size() - kShownCues);
  return out;
}

std::string supplies_text(const std::vector<SupplyFigures>& supplies) {
  std::string out;
  for (const SupplyFigures& supply : supplies) {
    const std::string dimmed = dimmed_text(supply);
    out += fmt::format(
        "supply {}: at most {:.2f} A of {:g} A ({}), {:.2f} A on average, {:.2f} A without a controller{}\n",
        supply.name, supply.peak_a, supply.limit_a, peak_text(supply), supply.mean_a, supply.unguided_a,
        dimmed.empty() ? "" : "; dimmed: " + dimmed);
  }
  return out;
}

nlohmann::ordered_json supplies_json(const std::vector<SupplyFigures>& supplies) {
  auto out = nlohmann::ordered_json::array();
  for (const SupplyFigures& supply : supplies) {
    nlohmann::ordered_json one{{"name", supply.name},
                               {"limit_a", supply.limit_a},
                               {"nodes", supply.nodes},
                               {"lamps", supply.lamps},
                               {"peak_a", supply.peak_a},
                               {"peak_cue", supply.peak_cue},
                               {"peak_s", supply.peak_s},
                               {"mean_a", supply.mean_a},
                               {"unguided_a", supply.unguided_a},
                               {"dimmed", nlohmann::ordered_json::array()}};
    for (const SupplyFigures::Dimmed& cue : supply.dimmed) {
      one["dimmed"].push_back({{"cue", cue.cue}, {"factor", cue.factor}, {"asked_a", cue.asked_a}});
    }
    out.push_back(std::move(one));
  }
  return out;
}

}  // namespace footlight::app
