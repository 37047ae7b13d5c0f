// SPDX-License-Identifier: Apache-2.0
#include "config/rig_supplies.hpp"

#include <algorithm>
#include <set>

#include "config/lamp_currents.hpp"
#include "config/nearest.hpp"

namespace footlight::config {

void SuppliesReader::read() {
  if (root_.has("lamps")) {
    if (auto lamps = root_.mapping("lamps")) rig_.currents = read_currents(*lamps);
  }
  for (MappingReader& reader : root_.mappings("supplies")) {
    Supply supply;
    supply.position = reader.position();
    supply.name = reader.text("name").value_or("");
    const auto twin = std::find_if(rig_.supplies.begin(), rig_.supplies.end(),
                                   [&](const Supply& s) { return s.name == supply.name; });
    if (twin != rig_.supplies.end() && !supply.name.empty()) {
      reader.error("name", "a second supply has the name " + in_quotes(supply.name),
                   "the first stands in line " + std::to_string(twin->position.line));
    }
    supply.limit_a = reader.quantity("limit").value_or(0);
    supply.overload = static_cast<Supply::Overload>(reader.choice("overload").value_or(0));
    supply.stagger = seconds(reader.quantity("stagger").value_or(0));
    for (MappingReader& feed : reader.mappings("feeds")) feeds_.push_back({rig_.supplies.size(), feed});
    rig_.supplies.push_back(std::move(supply));
  }
}

std::optional<std::string> SuppliesReader::name_in(MappingReader& reader) const {
  if (!reader.has("supply")) return std::nullopt;
  const auto written = reader.written("supply");
  if (!written) return std::nullopt;
  std::vector<std::string> names;
  for (const Supply& supply : rig_.supplies) names.push_back(supply.name);
  if (!names.empty() && std::find(names.begin(), names.end(), written->text) == names.end()) {
    reader.error(*written, "no supply has the name " + in_quotes(written->text),
                 suggestion(written->text, names, "supplies"));
  }
  return written->text;
}

void SuppliesReader::hang() {
  for (Feed& one : feeds_) feed(one);
  if (rig_.supplies.empty() || root_.reading().diagnostics.has_errors()) return;
  check_currents();
  warn();
}

void SuppliesReader::feed(Feed& feed) {
  MappingReader& reader = feed.reader;
  const auto written = reader.written("bus");
  const int first = reader.integer("first").value_or(1);
  const int last = reader.integer("last").value_or(512);
  if (!written) return;
  const auto bus =
      std::find_if(rig_.buses.begin(), rig_.buses.end(), [&](const Bus& b) { return b.name == written->text; });
  if (bus == rig_.buses.end()) {
    std::vector<std::string> names;
    for (const Bus& b : rig_.buses) names.push_back(b.name);
    return reader.error(*written, "no bus has the name " + in_quotes(written->text),
                        suggestion(written->text, names, "buses"));
  }
  if (last < first) {
    return reader.error("last",
                        "the last address is " + std::to_string(last) + ", and the first " + std::to_string(first),
                        "at least " + std::to_string(first));
  }
  const BusIndex at = BusIndex::of(static_cast<std::size_t>(bus - rig_.buses.begin()));
  bool any = false;
  for (Node& node : rig_.nodes) {
    if (node.bus != at || node.address < first || node.address > last) continue;
    any = true;
    const std::string& name = rig_.supplies[feed.supply].name;
    const auto [other, is_new] = said_.emplace(std::pair(node.bus, node.address), reader.position().line);
    if (!is_new && node.supply != name) {
      return reader.error(
          reader.position(), reader.path(),
          "the node " + in_quotes(node.name) + " hangs on the supply " + in_quotes(node.supply) + " already",
          "line " + std::to_string(other->second) + " says so");
    }
    node.supply = name;
  }
  if (any || root_.reading().diagnostics.has_errors()) return;  // nodes with errors are not there
  reader.error(*written,
               "no node of the bus " + in_quotes(bus->name) + " has an address from " + std::to_string(first) + " to " +
                   std::to_string(last),
               "addresses of its nodes");
}

void SuppliesReader::check_currents() {
  std::set<std::size_t> told;
  for (const Node& node : rig_.nodes) {
    const Bus& bus = rig_.buses[node.bus.at()];
    const LampCurrents& currents = rig_.currents_of(bus);
    if (node.supply.empty() || currents.red_a + currents.green_a + currents.blue_a > 0) continue;
    if (!told.insert(node.bus.at()).second) continue;
    root_.error("supplies", "nothing says what the lamps of the bus " + in_quotes(bus.name) + " take",
                "lamps: {red: 20 mA, green: 20 mA, blue: 20 mA, node: 10 mA}, or currents in its profile");
  }
}

void SuppliesReader::warn() {
  Diagnostics& diagnostics = root_.reading().diagnostics;
  std::set<std::string> used;
  std::size_t without = 0;
  std::string first;
  for (const Node& node : rig_.nodes) {
    used.insert(node.supply);
    if (node.supply.empty() && without++ == 0) first = node.name;
  }
  for (std::size_t s = 0; s < rig_.supplies.size(); ++s) {
    const Supply& supply = rig_.supplies[s];
    if (used.contains(supply.name)) continue;
    diagnostics.warning(supply.position, "supplies[" + std::to_string(s) + "]",
                        "nothing hangs on the supply " + in_quotes(supply.name), "feeds, or supply of nodes and buses");
  }
  if (without == 0) return;
  diagnostics.warning(root_.key_position("supplies"), "supplies",
                      without == 1
                          ? "the node " + in_quotes(first) + " hangs on no supply"
                          : std::to_string(without) + " nodes hang on no supply, the first is " + in_quotes(first),
                      without == 1 ? "its current is counted nowhere" : "their currents are counted nowhere");
}

}  // namespace footlight::config
