// SPDX-License-Identifier: Apache-2.0
#include "app/devices_report.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace footlight::app {
namespace {

using controller::FoundNode;
using controller::LatencyHistogram;
using controller::NodeHealth;
using Json = nlohmann::ordered_json;

std::string id_of(const drivers::Identity& identity) {
  std::string text = identity.unique_id ? fmt::format("0x{:08X}", *identity.unique_id) : "";
  if (!identity.model.empty()) text += (text.empty() ? "" : " ") + identity.model;
  return text;
}

Json identity_json(const drivers::Identity& identity) {
  Json out = Json::object();
  if (identity.unique_id) out["unique_id"] = fmt::format("0x{:08X}", *identity.unique_id);
  if (!identity.model.empty()) out["model"] = identity.model;
  if (identity.firmware > 0) out["firmware"] = identity.firmware;
  if (identity.channels > 0) out["channels"] = identity.channels;
  return out;
}

std::string said_of(const FoundNode& found, bool has_rig) {
  switch (found.kind) {
    case FoundNode::Kind::present:
      return found.expected || !has_rig ? "" : "not in the rig";
    case FoundNode::Kind::twofold:
      return found.identities.size() > 1 ? fmt::format("{} devices share this address: set-address one of them by --id",
                                                       found.identities.size())
                                         : "answers over each other: two devices of one address, or a bad line";
    case FoundNode::Kind::ghost:
      return "heard now and then: noise or a loose wire, perhaps nobody";
    case FoundNode::Kind::absent:
      return "in the rig, and does not answer";
  }
  return {};
}

std::string values_of(const NodeHealth& node) {
  std::string text;
  for (const drivers::HealthValue& value : node.values) {
    text += fmt::format("{}{} {:.4g} {}", text.empty() ? "" : ", ", value.name, value.value, value.unit);
  }
  return text;
}

std::string histogram_of(const LatencyHistogram& latency) {
  std::string text;
  for (std::size_t i = 0; i < latency.counts().size(); ++i) {
    if (latency.counts()[i] == 0) continue;
    const std::string upto = i < LatencyHistogram::kUpToMs.size()
                                 ? fmt::format("<={} ms", LatencyHistogram::kUpToMs[i])
                                 : fmt::format(">{} ms", LatencyHistogram::kUpToMs.back());
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", upto, latency.counts()[i]);
  }
  return text;
}

double in_ms(Duration duration) { return to_seconds(duration) * 1e3; }

}  // namespace

std::string list_text(const Rig& rig, const std::vector<std::string>& assumptions, const MachineWires& wires) {
  std::string text;
  for (std::size_t b = 0; b < rig.buses.size(); ++b) {
    const Bus& bus = rig.buses[b];
    const std::string profile = bus.profile ? " " + bus.profile->name : bus.outputs ? " " + bus.outputs->name : "";
    text += fmt::format("bus {}: {}{} at {}, {} bit/s\n", bus.name, to_text(bus.kind), profile, bus.url,
                        bus.bits_per_second);
    if (!assumptions[b].empty()) text += fmt::format("  unverified: {}\n", assumptions[b]);
    for (const Node& node : rig.nodes) {
      if (node.bus != BusIndex::of(b)) continue;
      text += fmt::format("  {:>3}  {:<20} {:>2} channels{}\n", node.address, node.name, node.channels.size(),
                          node.supply.empty() ? "" : ", supply " + node.supply);
    }
  }
  return text + wires_text(wires, rig);
}

std::string list_json(const Rig& rig, const std::vector<std::string>& assumptions, const MachineWires& wires) {
  Json buses = Json::array();
  for (std::size_t b = 0; b < rig.buses.size(); ++b) {
    const Bus& bus = rig.buses[b];
    Json wire = Json::array();
    for (const drivers::Objection& objection : drivers::preflight(bus)) {
      wire.push_back({{"text", objection.text}, {"stops", objection.stops}});
    }
    Json nodes = Json::array();
    for (const Node& node : rig.nodes) {
      if (node.bus != BusIndex::of(b)) continue;
      nodes.push_back({{"name", node.name},
                       {"address", node.address},
                       {"channels", node.channels.size()},
                       {"supply", node.supply}});
    }
    buses.push_back({{"name", bus.name},
                     {"kind", to_text(bus.kind)},
                     {"url", bus.url},
                     {"bits_per_second", bus.bits_per_second},
                     {"profile", bus.profile   ? bus.profile->name
                                 : bus.outputs ? bus.outputs->name
                                               : ""},
                     {"assumes", assumptions[b]},
                     {"objections", std::move(wire)},
                     {"nodes", std::move(nodes)}});
  }
  return Json{{"buses", std::move(buses)}, {"machine", wires_json(wires, rig)}}.dump(2);
}

std::string scan_text(const DeviceBus& bus, const std::vector<FoundNode>& found) {
  std::string text = fmt::format("{:>7}  {:<20} {:<8} {:>7}  {}\n", "address", "node", "is", "heard", "says");
  const bool has_rig = !bus.nodes().empty();
  int present = 0;
  for (const FoundNode& node : found) {
    present += node.kind == FoundNode::Kind::present ? 1 : 0;
    std::string says;
    for (const auto& identity : node.identities) says += (says.empty() ? "" : " + ") + id_of(identity);
    const std::string said = said_of(node, has_rig);
    if (!said.empty()) says += (says.empty() ? "" : "; ") + said;
    text +=
        fmt::format("{:>7}  {:<20} {:<8} {:>3}/{:<3}  {}\n", node.address,
                    node.expected ? bus.name_of(node.address) : "-", to_text(node.kind), node.heard, node.rounds, says);
  }
  if (!has_rig) return text + fmt::format("{} found", present);
  const auto answer = std::ranges::count_if(
      found, [](const FoundNode& node) { return node.expected && node.kind == FoundNode::Kind::present; });
  return text + fmt::format("{} of {} nodes of the rig answer; {} found", answer, bus.nodes().size(), present);
}

std::string scan_json(const DeviceBus& bus, const std::vector<FoundNode>& found) {
  Json list = Json::array();
  for (const FoundNode& node : found) {
    Json identities = Json::array();
    for (const auto& identity : node.identities) identities.push_back(identity_json(identity));
    list.push_back({{"address", node.address},
                    {"node", node.expected ? bus.name_of(node.address) : ""},
                    {"is", to_text(node.kind)},
                    {"expected", node.expected},
                    {"asked", node.rounds},
                    {"heard", node.heard},
                    {"garbled", node.garbled},
                    {"identities", std::move(identities)}});
  }
  return Json{{"bus", bus.bus().name}, {"found", std::move(list)}}.dump(2);
}

namespace {

std::string_view said_of(const NodePatch& patch) {
  if (!patch.kept) return "silent";
  if (patch.kept->patch == 0) return "none";
  if (!patch.wanted) return "unknown";
  return patch.same() ? "same" : "other";
}

std::string words_of(const NodePatch& patch) {
  if (!patch.kept) return "does not tell what it keeps";
  if (patch.kept->patch == 0) return "no patch";
  if (!patch.wanted) return fmt::format("patch 0x{:08X}; the rig has no such node", patch.kept->patch);
  if (patch.same()) return "the rig's patch";
  return fmt::format("another patch: 0x{:08X}, the rig's is 0x{:08X}", patch.kept->patch, *patch.wanted);
}

}  // namespace

std::string patch_text(const DeviceBus& bus, const std::vector<NodePatch>& patches) {
  std::string text;
  for (const NodePatch& patch : patches) {
    text += fmt::format("{:>3}  {:<20} {}", patch.address, bus.name_of(patch.address), words_of(patch));
    if (patch.kept && patch.kept->plan != 0) text += fmt::format("; plan 0x{:08X}", patch.kept->plan);
    text += '\n';
  }
  return text + fmt::format("{} of {} nodes keep the rig's patch", std::ranges::count_if(patches, &NodePatch::same),
                            patches.size());
}

std::string patch_json(const DeviceBus& bus, const std::vector<NodePatch>& patches) {
  const auto check = [](bool there, std::uint32_t value) {
    return there && value != 0 ? Json(fmt::format("0x{:08X}", value)) : Json(nullptr);
  };
  Json list = Json::array();
  for (const NodePatch& patch : patches) {
    const drivers::KeptChecks kept = patch.kept.value_or(drivers::KeptChecks{});
    list.push_back({{"address", patch.address},
                    {"node", bus.name_of(patch.address)},
                    {"is", said_of(patch)},
                    {"patch", check(patch.kept.has_value(), kept.patch)},
                    {"rig", check(patch.wanted.has_value(), patch.wanted.value_or(0))},
                    {"plan", check(patch.kept.has_value(), kept.plan)}});
  }
  return Json{{"bus", bus.bus().name}, {"nodes", std::move(list)}}.dump(2);
}

std::string health_text(const DeviceBus& bus, const std::vector<NodeHealth>& health) {
  std::string text;
  const Instant now = bus.clock().now();
  for (const NodeHealth& node : health) {
    text += fmt::format("{:>3}  {:<20} {:>5.1f} % of {} answered, {} garbled, {} silent", node.address,
                        bus.name_of(node.address), node.answered_share() * 100, node.asked, node.garbled, node.silent);
    if (node.refused > 0) text += fmt::format(", {} refused", node.refused);
    text += node.last_seen ? fmt::format("; last seen {:.1f} s ago\n", to_seconds(now - *node.last_seen)) : "\n";
    if (node.latency.total() > 0) {
      text += fmt::format("     answers after {:.1f} ms, longest {:.1f} ms: {}\n", in_ms(node.latency.mean()),
                          in_ms(node.latency.longest()), histogram_of(node.latency));
    }
    if (!node.values.empty()) text += "     " + values_of(node) + "\n";
  }
  if (!text.empty()) text.pop_back();
  return text;
}

std::string health_json(const DeviceBus& bus, const std::vector<NodeHealth>& health, const std::string& verdict) {
  Json list = Json::array();
  const Instant now = bus.clock().now();
  for (const NodeHealth& node : health) {
    Json values = Json::array();
    for (const auto& value : node.values) {
      values.push_back({{"name", value.name}, {"value", value.value}, {"unit", value.unit}});
    }
    Json histogram = Json::array();
    for (std::size_t i = 0; i < node.latency.counts().size(); ++i) {
      Json upto = i < LatencyHistogram::kUpToMs.size() ? Json(LatencyHistogram::kUpToMs[i]) : Json(nullptr);
      histogram.push_back({{"up_to_ms", std::move(upto)}, {"answers", node.latency.counts()[i]}});
    }
    list.push_back({{"address", node.address},
                    {"node", bus.name_of(node.address)},
                    {"asked", node.asked},
                    {"answered", node.answered},
                    {"garbled", node.garbled},
                    {"silent", node.silent},
                    {"refused", node.refused},
                    {"last_seen_s_ago", node.last_seen ? Json(to_seconds(now - *node.last_seen)) : Json(nullptr)},
                    {"latency_mean_ms", in_ms(node.latency.mean())},
                    {"latency_longest_ms", in_ms(node.latency.longest())},
                    {"latency", std::move(histogram)},
                    {"values", std::move(values)}});
  }
  Json document{{"bus", bus.bus().name}, {"nodes", std::move(list)}};
  if (!verdict.empty()) document["cable"] = verdict;
  return document.dump(2);
}

}  // namespace footlight::app
