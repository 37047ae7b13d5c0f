// SPDX-License-Identifier: Apache-2.0
#include "config/rig_file.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "config/nearest.hpp"
#include "config/rig_bus.hpp"
#include "config/rig_supplies.hpp"
#include "config/show_parts.hpp"

namespace footlight::config {
namespace {

/// The most channels that a device of a bus has.
struct ProfileLimit {
  std::string profile;
  int channels = 0;
};

std::optional<ProfileLimit> profile_limit(const Bus& bus) {
  if (bus.profile) return ProfileLimit{bus.profile->name, bus.profile->channels};
  if (bus.outputs) return ProfileLimit{bus.outputs->name, bus.outputs->outputs};
  return std::nullopt;
}

/// Reads one rig: buses, then nodes, then the floor that takes what is left.
class RigReader {
 public:
  RigReader(MappingReader& root, const Show& show, bool performers_known, std::vector<std::string>& files)
      : root_(root), show_(show), performers_known_(performers_known), files_(files) {
    folder_ = std::filesystem::path(root.reading().file).parent_path();
    for (std::size_t p = 0; p < show.performers.size(); ++p) {
      if (!show.performers[p].wearable.empty()) wearables_[show.performers[p].wearable] = PerformerIndex::of(p);
    }
  }

  Rig read() {
    rig_.file = root_.reading().file;
    (void)root_.integer("rig");
    supplies_.read();
    for (MappingReader& bus : root_.mappings("buses")) read_bus(bus);
    for (MappingReader& node : root_.mappings("nodes")) read_node(node);
    if (root_.has("floor")) {
      if (auto floor = root_.mapping("floor")) read_floor(*floor);
    }
    supplies_.hang();
    if (!root_.reading().diagnostics.has_errors()) warn_of_dark_places();
    std::stable_sort(rig_.nodes.begin(), rig_.nodes.end(), [](const Node& a, const Node& b) {
      return std::pair(a.bus, a.address) < std::pair(b.bus, b.address);
    });
    return std::move(rig_);
  }

 private:
  void read_bus(MappingReader& reader) {
    Bus bus = read_bus_keys(reader, folder_, files_);
    if (!bus.name.empty() && find_bus(bus.name)) {
      reader.error("name", "a second bus has the name " + in_quotes(bus.name), "names of buses are unique");
    }
    bus.supply = supplies_.name_in(reader).value_or("");
    rig_.buses.push_back(std::move(bus));  // kept when wrong, so that its nodes give no echo
  }

  void read_node(MappingReader& reader) {
    Node node;
    node.position = reader.position();
    const auto bus = read_bus_name(reader, "bus");
    const auto address = reader.integer("address");
    read_channels(reader, node);
    if (!bus || !address) return;
    node.bus = *bus;
    node.address = *address;
    const Bus& on = rig_.buses[bus->at()];
    node.name = reader.text("name").value_or(on.name + "-" + std::to_string(*address));
    const auto supply = supplies_.name_in(reader);
    node.supply = supply.value_or(on.supply);
    if (supply) supplies_.keep(node, reader.position().line);
    if (*address > last_address(on.kind)) {
      return reader.error("address", "the address " + std::to_string(*address) + " is out of range",
                          std::string(to_text(on.kind)) + ": 1 to " + std::to_string(last_address(on.kind)));
    }
    check_unique(reader, node, on);
    check_profile(reader, node, on);
    check_slots(reader, node, on);
    rig_.nodes.push_back(std::move(node));
  }

  void check_unique(MappingReader& reader, const Node& node, const Bus& bus) {
    const auto [other, is_new] = nodes_at_.emplace(std::pair(node.bus, node.address), reader.position().line);
    if (!is_new) {
      reader.error(
          "address",
          "a second node has the address " + std::to_string(node.address) + " on the bus " + in_quotes(bus.name),
          "the first stands in line " + std::to_string(other->second));
    }
    const auto [named, name_is_new] = node_names_.emplace(node.name, reader.position().line);
    if (!name_is_new && is_new) {
      reader.error("name", "a second node has the name " + in_quotes(node.name),
                   "the first stands in line " + std::to_string(named->second));
    }
  }

  std::optional<BusIndex> find_bus(std::string_view name) const {
    for (std::size_t b = 0; b < rig_.buses.size(); ++b) {
      if (rig_.buses[b].name == name) return BusIndex::of(b);
    }
    return std::nullopt;
  }

  std::optional<BusIndex> bus_named(MappingReader& reader, const Written& written) {
    const auto bus = find_bus(written.text);
    if (bus) return bus;
    std::vector<std::string> names;
    for (const Bus& b : rig_.buses) names.push_back(b.name);
    reader.error(written, "no bus has the name " + in_quotes(written.text), suggestion(written.text, names, "buses"));
    return std::nullopt;
  }

  std::optional<BusIndex> read_bus_name(MappingReader& reader, std::string_view key) {
    const auto written = reader.written(key);
    return written ? bus_named(reader, *written) : std::nullopt;
  }

  void read_channels(MappingReader& reader, Node& node) {
    std::size_t channels = 0;
    for (auto& item : reader.items("channels")) {
      channels += item.scalar ? add_cells(reader, *item.scalar, node) : add_wearable(*item.mapping, node);
    }
    if (channels > kChannelsPerNode) {
      reader.error("channels", "the node has " + std::to_string(channels) + " channels",
                   "at most " + std::to_string(kChannelsPerNode) + "; give the others to another node");
    }
  }

  void check_slots(MappingReader& reader, const Node& node, const Bus& bus) {
    if (!bus.fixture) return;
    const auto footprint = static_cast<int>(bus.fixture->slots.size());
    const int end = node.address + static_cast<int>(node.channels.size()) * footprint - 1;
    if (end > last_address(bus.kind)) {
      return reader.error("address", "the lamps of this node end at slot " + std::to_string(end),
                          "at most 512; a lamp of the profile " + in_quotes(bus.fixture->name) + " has " +
                              std::to_string(footprint) + " slots");
    }
    for (int slot = node.address; slot <= end; ++slot) {
      const auto [other, is_new] = slots_.emplace(std::pair(node.bus, slot), reader.position().line);
      if (is_new) continue;
      return reader.error("address", "slot " + std::to_string(slot) + " is used by other lamps as well",
                          "the node in line " + std::to_string(other->second) + "; a lamp of the profile " +
                              in_quotes(bus.fixture->name) + " has " + std::to_string(footprint) + " slots");
    }
  }

  void check_profile(MappingReader& reader, const Node& node, const Bus& bus) {
    const auto limit = profile_limit(bus);
    if (!limit || static_cast<int>(node.channels.size()) <= limit->channels) return;
    if (node.channels.size() > kChannelsPerNode) return;  // has been said
    reader.error("channels", "the node has " + std::to_string(node.channels.size()) + " channels",
                 "a device of the profile " + in_quotes(limit->profile) + " has at most " +
                     std::to_string(limit->channels) + "; give the others to another node");
  }

  /// @return how many channels the text stands for
  std::size_t add_cells(MappingReader& reader, const Written& written, Node& node) {
    const Grid& grid = show_.stage.grid;
    if (written.text == kUnusedChannel) {
      node.channels.emplace_back();
      return 1;
    }
    const auto range = read_cell_range(reader, written, grid);
    if (!range) return 0;
    const bool single = range->first == range->last;
    std::size_t count = 0;
    for (int row = range->first.row; row <= range->last.row; ++row) {
      for (int column = range->first.column; column <= range->last.column; ++column) {
        const CellIndex cell = grid.index({column, row});
        if (std::binary_search(show_.stage.blocked.begin(), show_.stage.blocked.end(), cell)) {
          if (single)
            reader.error(written, "the cell " + written.text + " is blocked", "there is no lamp on a blocked cell");
          count += single ? 1 : 0;
          continue;
        }
        ++count;
        if (count > kMaxCounted) return count;  // too many in any case
        add_cell(reader, written, cell, node);
      }
    }
    return count;
  }

  void add_cell(MappingReader& reader, const Written& written, CellIndex cell, Node& node) {
    const auto [other, is_new] = lamp_line_.emplace(cell, written.position.line);
    if (is_new) {
      node.channels.push_back({Channel::Kind::cell, cell, {}});
    } else {
      reader.error(written, "the cell " + show_.stage.grid.name(cell) + " is given a second lamp",
                   "the first stands in line " + std::to_string(other->second));
    }
  }

  std::size_t add_wearable(MappingReader& reader, Node& node) {
    const auto written = reader.written("wearable");
    if (!written) return 0;
    const auto wearer = wearables_.find(written->text);
    if (wearer == wearables_.end()) {
      std::vector<std::string> ids;
      for (const auto& [id, performer] : wearables_) ids.push_back(id);
      if (performers_known_) {
        reader.error(*written, "nobody wears " + in_quotes(written->text),
                     ids.empty() ? "the roster has no wearables" : suggestion(written->text, ids, "wearables"));
      }
      return 1;
    }
    const auto [other, is_new] = worn_line_.emplace(wearer->second, written->position.line);
    if (is_new) {
      node.channels.push_back({Channel::Kind::wearable, {}, wearer->second});
    } else {
      reader.error(*written, "the wearable " + in_quotes(written->text) + " is given a second channel",
                   "the first stands in line " + std::to_string(other->second));
    }
    return 1;
  }

  std::vector<Channel> lamps_left(bool with_wearables) const {
    std::vector<Channel> out;
    const auto& blocked = show_.stage.blocked;
    for (int c = 0; c < show_.stage.grid.size(); ++c) {
      const CellIndex cell = CellIndex::of(c);
      if (std::binary_search(blocked.begin(), blocked.end(), cell) || lamp_line_.contains(cell)) continue;
      out.push_back({Channel::Kind::cell, cell, {}});
    }
    for (std::size_t p = 0; p < show_.performers.size() && with_wearables; ++p) {
      const PerformerIndex performer = PerformerIndex::of(p);
      if (show_.performers[p].wearable.empty() || worn_line_.contains(performer)) continue;
      out.push_back({Channel::Kind::wearable, {}, performer});
    }
    return out;
  }

  void read_floor(MappingReader& floor) {
    const auto per_bus = floor.integer("nodes_per_bus");
    const auto channels = floor.integer("channels_per_node");
    const auto with_wearables = floor.boolean("wearables");
    std::vector<BusIndex> buses;
    bool wrong = false;
    for (const Written& written : floor.list("buses")) {
      const auto bus = bus_named(floor, written);
      wrong = wrong || !bus;
      if (!bus) continue;
      if (std::find(buses.begin(), buses.end(), *bus) == buses.end()) {
        buses.push_back(*bus);
      } else {
        floor.error(written, "the bus " + in_quotes(written.text) + " stands here for the second time");
      }
    }
    if (wrong || !channels || !with_wearables || (floor.has("nodes_per_bus") && !per_bus)) return;
    for (const BusIndex b : buses) {
      const Bus& bus = rig_.buses[b.at()];
      if (bus.kind == BusKind::dmx) {
        return floor.error("buses", "the lamps of the DMX bus " + in_quotes(bus.name) + " have addresses set by hand",
                           "list them under nodes");
      }
      const auto limit = profile_limit(bus);
      if (!limit || *channels <= limit->channels) continue;
      return floor.error(
          "channels_per_node",
          "the devices of the bus " + in_quotes(bus.name) + " have fewer than " + std::to_string(*channels) +
              " channels",
          "at most " + std::to_string(limit->channels) + ", as the profile " + in_quotes(limit->profile) + " says");
    }
    lay_floor(floor, buses, per_bus, *channels, lamps_left(*with_wearables));
  }

  void lay_floor(MappingReader& floor, const std::vector<BusIndex>& buses, std::optional<int> per_bus, int channels,
                 const std::vector<Channel>& lamps) {
    std::vector<int> capacities;
    std::vector<std::vector<int>> taken(buses.size());
    for (std::size_t b = 0; b < buses.size(); ++b) {
      const BusKind kind = rig_.buses[buses[b].at()].kind;
      for (const Node& node : rig_.nodes) {
        if (node.bus == buses[b]) taken[b].push_back(node.address);
      }
      const int addresses = last_address(kind) - static_cast<int>(taken[b].size());
      const int well = per_bus ? *per_bus : nodes_that_carry_well(kind) - static_cast<int>(taken[b].size());
      capacities.push_back(std::clamp(well, 0, addresses));
    }
    const int capacity = std::accumulate(capacities.begin(), capacities.end(), 0);
    const auto nodes = (lamps.size() + static_cast<std::size_t>(channels) - 1) / static_cast<std::size_t>(channels);
    if (static_cast<int>(nodes) > capacity) {
      return floor.error("buses",
                         std::to_string(lamps.size()) + " lamps need " + std::to_string(nodes) + " nodes of " +
                             std::to_string(channels) + " channels, and these buses carry " + std::to_string(capacity),
                         "more buses, or a larger nodes_per_bus");
    }
    for (Node& node : lay_nodes(lamps, rig_.buses, buses, capacities, taken, channels)) {
      node.position = floor.position();
      node.supply = rig_.buses[node.bus.at()].supply;
      rig_.nodes.push_back(std::move(node));
    }
  }

  void warn_of_dark_places() {
    std::set<CellIndex> lit;
    for (const Node& node : rig_.nodes) {
      for (const Channel& channel : node.channels) {
        if (channel.kind == Channel::Kind::cell) lit.insert(channel.cell);
      }
    }
    std::size_t dark = 0;
    std::string first;
    for (int c = 0; c < show_.stage.grid.size(); ++c) {
      const CellIndex cell = CellIndex::of(c);
      const auto& blocked = show_.stage.blocked;
      if (lit.contains(cell) || std::binary_search(blocked.begin(), blocked.end(), cell)) continue;
      if (dark++ == 0) first = show_.stage.grid.name(cell);
    }
    if (dark == 0) return;
    root_.reading().diagnostics.warning({rig_.file, 0, 0}, "",
                                        dark == 1 ? "the cell " + first + " has no lamp"
                                                  : std::to_string(dark) + " cells have no lamp, the first is " + first,
                                        "people find their place there without light; floor: lays what is left");
  }

  static constexpr std::size_t kMaxCounted = 10'000;

  MappingReader& root_;
  const Show& show_;
  bool performers_known_;
  std::vector<std::string>& files_;
  std::filesystem::path folder_;
  Rig rig_;
  SuppliesReader supplies_{root_, rig_};
  std::map<std::string, PerformerIndex> wearables_;
  std::map<std::pair<BusIndex, int>, int> nodes_at_;
  std::map<std::pair<BusIndex, int>, int> slots_;  ///< DMX: line of the node that uses one
  std::map<std::string, int> node_names_;
  std::map<CellIndex, int> lamp_line_;
  std::map<PerformerIndex, int> worn_line_;
};

}  // namespace

Rig read_rig(const std::string& file, const Show& show, bool performers_known, Diagnostics& diagnostics,
             std::vector<std::string>& files) {
  Reading reading{file, diagnostics};
  const auto bytes = read_bounded(file, TextLimits{}.max_bytes);
  if (!bytes) {
    diagnostics.error({file, 0, 0}, "", bytes.error().message);
    return {};
  }
  auto root = read_root(reading, *bytes, rig_listing());
  if (!root) return {};
  return RigReader(*root, show, performers_known, files).read();
}

}  // namespace footlight::config
