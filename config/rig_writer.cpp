// SPDX-License-Identifier: Apache-2.0
#include "config/rig_writer.hpp"

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "config/device_profile.hpp"
#include "config/rig_file.hpp"
#include "config/text_tree.hpp"

namespace footlight::config {
namespace {

constexpr std::ptrdiff_t kLeastRun = 3;  // cells that become a range

std::string in_double_quotes(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (c == '\n') {
      out += "\\n";
    } else if (c == '\t') {
      out += "\\t";
    } else {
      out += c;
    }
  }
  return out + "\"";
}

/// As it was written, in quotes where a flow needs them.
std::string scalar_text(const std::string& text, bool quoted) {
  const bool plain = !text.empty() && text.find_first_of(",[]{}#:&*!|>'\"%@`\n\t") == std::string::npos &&
                     text.front() != '-' && text.front() != '?' && text.front() != ' ' && text.back() != ' ';
  return quoted || !plain ? in_double_quotes(text) : text;
}

std::string flow(const TextNode& node);

std::string flow(const TextEntry& entry) { return scalar_text(entry.key, false) + ": " + flow(*entry.value); }

std::string flow(const TextNode& node) {
  std::string out;
  switch (node.kind) {
    case TextNode::Kind::null:
      return "~";
    case TextNode::Kind::scalar:
      return scalar_text(node.text, node.quoted);
    case TextNode::Kind::sequence:
      for (const auto& item : node.items) out += (out.empty() ? "" : ", ") + flow(*item);
      return "[" + out + "]";
    case TextNode::Kind::mapping:
      for (const TextEntry& entry : node.entries) out += (out.empty() ? "" : ", ") + flow(entry);
      return "{" + out + "}";
  }
  return "~";
}

const TextNode* value_of(const TextNode& mapping, std::string_view key) {
  for (const TextEntry& entry : mapping.entries) {
    if (entry.key == key) return entry.value.get();
  }
  return nullptr;
}

std::string text_of(const TextNode& mapping, std::string_view key) {
  const TextNode* value = value_of(mapping, key);
  return value == nullptr ? "" : value->text;
}

/// A bus as it was written; a profile that stands beside the old file is named from the new one's folder.
std::string bus_line(const TextNode& bus, const std::filesystem::path& from, const std::filesystem::path& to) {
  std::string out;
  for (const TextEntry& entry : bus.entries) {
    std::string text = flow(entry);
    const std::string ending = std::filesystem::path(entry.value->text).extension().string();
    if (entry.key == "profile" && (ending == ".yaml" || ending == ".yml")) {
      if (const auto file = find_profile(entry.value->text, from)) {
        text = "profile: " + in_double_quotes(std::filesystem::proximate(*file, to).string());
      }
    }
    out += (out.empty() ? "" : ", ") + text;
  }
  return "  - {" + out + "}\n";
}

std::string own_bus_line(const Bus& bus) {
  std::string out = fmt::format("  - {{name: {}, kind: {}, url: {}", scalar_text(bus.name, false), to_text(bus.kind),
                                in_double_quotes(bus.url));
  if (bus.kind != BusKind::modbus_tcp && bus.kind != BusKind::dmx) {
    out += fmt::format(", bits_per_second: {}", bus.bits_per_second);
  }
  return out + "}\n";
}

/// What the old file says of a node that it lists; nothing for one that its floor has laid.
const TextNode* listed(const TextNode* nodes, const Rig& rig, const Node& node) {
  if (nodes == nullptr) return nullptr;
  for (const auto& item : nodes->items) {
    if (text_of(*item, "bus") == rig.buses[node.bus.at()].name &&
        text_of(*item, "address") == std::to_string(node.address)) {
      return item.get();
    }
  }
  return nullptr;
}

std::string node_line(const Rig& rig, const Node& node, const Show& show, const TextNode* nodes) {
  const TextNode* old = listed(nodes, rig, node);
  std::string out;
  if (old == nullptr) {
    const Bus& bus = rig.buses[node.bus.at()];
    out = fmt::format("name: {}, bus: {}, address: {}", scalar_text(node.name, false), scalar_text(bus.name, false),
                      node.address);
    if (node.supply != bus.supply) out += ", supply: " + scalar_text(node.supply, false);
  } else {
    for (const TextEntry& entry : old->entries) {
      if (entry.key != "channels") out += (out.empty() ? "" : ", ") + flow(entry);
    }
  }
  return "  - {" + out + ", channels: [" + channels_text(node, show) + "]}\n";
}

/// Everything of the old file but its lamps.
std::string kept_text(const TextNode& root, const std::filesystem::path& from, const std::filesystem::path& to) {
  std::string out;
  for (const TextEntry& entry : root.entries) {
    if (entry.key == "nodes" || entry.key == "floor") continue;
    const TextNode& value = *entry.value;
    if (value.kind != TextNode::Kind::sequence) {
      out += flow(entry) + "\n";
      continue;
    }
    out += entry.key + ":\n";
    for (const auto& item : value.items) {
      out += entry.key == "buses" ? bus_line(*item, from, to) : "  - " + flow(*item) + "\n";
    }
  }
  return out;
}

}  // namespace

std::string channels_text(const Node& node, const Show& show) {
  const Grid& grid = show.stage.grid;
  std::string out;
  const auto add = [&](const std::string& text) { out += (out.empty() ? "" : ", ") + text; };
  for (auto at = node.channels.begin(); at != node.channels.end();) {
    if (at->kind != Channel::Kind::cell) {
      add(at->kind == Channel::Kind::unused
              ? std::string(kUnusedChannel)
              : "{wearable: " + in_double_quotes(show.performers[at->performer.at()].wearable) + "}");
      ++at;
      continue;
    }
    auto last = at;
    for (auto next = at + 1; next != node.channels.end(); last = next++) {
      const Cell before = grid.cell(last->cell);
      if (next->kind != Channel::Kind::cell || grid.cell(next->cell) != Cell{before.column + 1, before.row}) break;
    }
    if (last - at + 1 >= kLeastRun) {
      add(grid.name(at->cell) + ":" + grid.name(last->cell));
      at = last + 1;
    } else {
      add(grid.name(at->cell));
      ++at;
    }
  }
  return out;
}

Result<std::string> rig_text(const Rig& rig, const Show& show, const std::filesystem::path& output) {
  std::string text = "# Which lamp hangs on which wire, written by footlight commission.\n";
  std::shared_ptr<const TextNode> root;
  const TextNode* nodes = nullptr;
  if (rig.file.empty()) {
    text += "rig: 1\nbuses:\n";
    for (const Bus& bus : rig.buses) text += own_bus_line(bus);
  } else {
    const auto bytes = read_bounded(rig.file, TextLimits{}.max_bytes);
    if (!bytes) return bytes.error();
    Diagnostics diagnostics;
    root = parse_text_tree(*bytes, rig.file, diagnostics);
    if (!root) return input_error(diagnostics.to_text());
    std::error_code ignored;
    const auto to = std::filesystem::absolute(output, ignored).parent_path();
    text += kept_text(*root, std::filesystem::absolute(rig.file, ignored).parent_path(), to);
    nodes = value_of(*root, "nodes");
  }
  text += "nodes:\n";
  for (const Node& node : rig.nodes) text += node_line(rig, node, show, nodes);
  return text;
}

}  // namespace footlight::config
