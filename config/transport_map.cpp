// SPDX-License-Identifier: Apache-2.0
#include "config/transport_map.hpp"

#include <algorithm>
#include <set>

#include "config/mapping_reader.hpp"
#include "config/nearest.hpp"
#include "config/rig_file.hpp"

namespace footlight::config {
namespace {

constexpr std::size_t kMaxMapBytes = std::size_t{1} << 20U;

const Listing& transport_listing() {
  static const Listing kListing{
      "buses[]",
      "Where a bus is found.",
      {{.key = "name", .type = Type::text, .doc = "of a bus of the rig", .required = true},
       {.key = "url", .type = Type::text, .doc = "as in the rig, but not simulated", .required = true}}};
  return kListing;
}

const Listing& map_listing() {
  static const Listing kListing{"transports.yaml",
                                "Where the buses of a rig are found here and today.",
                                {{.key = "transports",
                                  .type = Type::integer,
                                  .doc = "Version of this format.",
                                  .required = true,
                                  .range = {1, 1}},
                                 {.key = "buses",
                                  .type = Type::mapping,
                                  .doc = "Those that are elsewhere than the rig says.",
                                  .required = true,
                                  .listing = &transport_listing(),
                                  .list = true}}};
  return kListing;
}

void take(MappingReader& reader, Rig& rig, std::set<std::string>& seen) {
  const auto name = reader.text("name");
  const auto url = reader.text("url");
  if (!name) return;
  const auto bus = std::ranges::find(rig.buses, *name, &Bus::name);
  if (bus == rig.buses.end()) {
    std::vector<std::string> known;
    for (const Bus& other : rig.buses) known.push_back(other.name);
    reader.error("name", "the rig has no bus " + in_quotes(*name), suggestion(*name, known, "buses"));
    return;
  }
  if (!seen.insert(*name).second) {
    reader.error("name", "the bus " + in_quotes(*name) + " is named twice", "one place for each bus");
    return;
  }
  if (!url) return;
  const std::string example = example_url(bus->kind);
  if (url->starts_with("sim://")) {
    reader.error("url", in_quotes(*url) + " has no wire", example);
  } else if (kind_of_url(*url) != bus->kind) {
    reader.error("url", in_quotes(*url) + " is not the URL of a " + std::string(to_text(bus->kind)) + " bus", example);
  } else {
    bus->url = *url;
  }
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

}  // namespace

Status<Diagnostics> take_transports(const std::filesystem::path& file, Rig& rig) {
  Diagnostics diagnostics;
  Reading reading{file.string(), diagnostics};
  const auto bytes = read_bounded(file, kMaxMapBytes);
  if (!bytes) {
    diagnostics.error({reading.file, 0, 0}, "", bytes.error().message);
    return diagnostics;
  }
  if (auto root = read_root(reading, *bytes, map_listing())) {
    (void)root->integer("transports");
    std::set<std::string> seen;
    for (MappingReader& entry : root->mappings("buses")) take(entry, rig, seen);
  }
  if (diagnostics.has_errors()) return diagnostics;
  return Done{};
}

std::string transport_map_text(const std::vector<BusTransport>& transports, const std::string& made_by) {
  std::string text = "# " + made_by + "\ntransports: 1\nbuses:" + (transports.empty() ? " []\n" : "\n");
  for (const BusTransport& transport : transports) {
    text += "  - {name: " + quoted(transport.bus) + ", url: " + quoted(transport.url) + "}\n";
  }
  return text;
}

}  // namespace footlight::config
