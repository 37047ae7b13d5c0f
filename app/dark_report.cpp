// SPDX-License-Identifier: Apache-2.0
#include "app/dark_report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/numbers.hpp"
#include "app/text_table.hpp"

namespace footlight::app {
namespace {

using controller::DarkUnit;
using controller::UnsafeCue;
using Json = nlohmann::ordered_json;

std::string_view kind_text(DarkUnit::Kind kind) { return kind == DarkUnit::Kind::supply ? "supply" : "node"; }

/// The cue that a walk belongs to: the last one of the section in which the walk ends.
std::string cue_of(const Show& show, const Plan& plan, const UnsafeCue& cue) {
  const auto section = SectionIndex::of(section_at(plan, cue.told + Duration(1)));
  std::string out = "-";
  for (const Cue& one : show.cues) {
    if (one.section == section) out = one.number.to_text();
  }
  return out;
}

std::string sentence(const Show& show, const Plan& plan, const UnsafeCue& cue) {
  return fmt::format("cue {}: performer {} is not shown {} at count {:g}; {} comes as near as {:.3f} m at count {:g}",
                     cue_of(show, plan, cue), plan.performers[cue.who.at()], plan.stage.grid.name(cue.place),
                     std::round(show.tempo.count_at(cue.told) * 100) / 100, plan.performers[cue.other.at()],
                     cue.distance_m, std::round(show.tempo.count_at(cue.at) * 100) / 100);
}

/// Units, and units with an unsafe cue, of a kind.
std::string summary(const std::vector<DarkUnit>& units, DarkUnit::Kind kind) {
  const auto all = std::count_if(units.begin(), units.end(), [&](const DarkUnit& u) { return u.kind == kind; });
  const auto unsafe =
      std::count_if(units.begin(), units.end(), [&](const DarkUnit& u) { return u.kind == kind && u.unsafe > 0; });
  if (all == 0) return {};
  const char* plural =
      kind == DarkUnit::Kind::supply ? (all == 1 ? "supply" : "supplies") : (all == 1 ? "node" : "nodes");
  return fmt::format("{} of {} {} have cues that become unsafe when dark\n", unsafe, all, plural);
}

}  // namespace

std::string dark_text(const Show& show, const Plan& plan, const std::vector<DarkUnit>& units) {
  std::string out = summary(units, DarkUnit::Kind::node) + summary(units, DarkUnit::Kind::supply);
  TextTable table({"dark", "kind", "nodes", "not shown", "unsafe"});
  std::string worst;
  for (std::size_t i = 0; i < std::min(kDarkKept, units.size()); ++i) {
    const DarkUnit& unit = units[i];
    if (unit.unsafe == 0) break;
    table.add({unit.name, std::string(kind_text(unit.kind)), fmt::format("{}", unit.nodes),
               fmt::format("{}", unit.not_shown), fmt::format("{}", unit.unsafe)});
    worst += fmt::format("{}: {}\n", unit.name, sentence(show, plan, unit.worst.front()));
  }
  return worst.empty() ? out : out + "\n" + table.to_text() + "\n" + worst;
}

std::string dark_json(const Show& show, const Plan& plan, const std::vector<DarkUnit>& units) {
  Json out{{"units", Json::array()}};
  const auto count = [&](DarkUnit::Kind kind, bool unsafe_only) {
    return std::count_if(units.begin(), units.end(),
                         [&](const DarkUnit& u) { return u.kind == kind && (!unsafe_only || u.unsafe > 0); });
  };
  out["nodes"] = count(DarkUnit::Kind::node, false);
  out["nodes_unsafe"] = count(DarkUnit::Kind::node, true);
  out["supplies"] = count(DarkUnit::Kind::supply, false);
  out["supplies_unsafe"] = count(DarkUnit::Kind::supply, true);
  for (std::size_t i = 0; i < std::min(kDarkKept, units.size()); ++i) {
    const DarkUnit& unit = units[i];
    Json one{{"name", unit.name},           {"kind", kind_text(unit.kind)}, {"nodes", unit.nodes},
             {"not_shown", unit.not_shown}, {"unsafe", unit.unsafe},        {"worst", Json::array()}};
    for (const UnsafeCue& cue : unit.worst) {
      one["worst"].push_back({{"performer", plan.performers[cue.who.at()]},
                              {"cue", cue_of(show, plan, cue)},
                              {"not_shown", plan.stage.grid.name(cue.place)},
                              {"told_s", to_seconds(cue.told)},
                              {"other", plan.performers[cue.other.at()]},
                              {"distance_m", cue.distance_m},
                              {"at_s", to_seconds(cue.at)}});
    }
    out["units"].push_back(std::move(one));
  }
  return out.dump(1) + "\n";
}

}  // namespace footlight::app
