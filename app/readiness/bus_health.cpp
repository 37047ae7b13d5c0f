// SPDX-License-Identifier: Apache-2.0
#include "app/readiness/bus_health.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "core/clock.hpp"

namespace footlight::app {
namespace {

constexpr std::size_t kNamed = 8;  // nodes of an alarm

std::string times(std::size_t count) { return count > 1 ? fmt::format(" ({} times since the last alarm)", count) : ""; }

}  // namespace

BusHealth::BusHealth(const Rig& rig, const NodeBoard& board, RunDesk& desk, Change change)
    : rig_(rig), board_(board), change_(std::move(change)), nodes_(rig.nodes.size()), buses_(rig.buses.size()) {
  for (const Node& node : rig.nodes) ++buses_[node.bus.at()].nodes;
  desk.add([this](DeskView& view) {
    for (std::size_t b = 0; b < std::min(buses_.size(), view.buses.size()); ++b) {
      view.buses[b].silent = buses_[b].silent;
      view.buses[b].last_fault = buses_[b].last_fault;
      view.buses[b].last_fault_unix_ms = buses_[b].last_fault_unix_ms;
    }
  });
}

void BusHealth::look(const DeskView& view, RunDesk& desk) {
  const Instant now = view.now;
  for (std::size_t b = 0; b < std::min(buses_.size(), view.buses.size()); ++b) {
    look_at_port(b, view.buses[b].trouble, now);
  }
  if (view.roll_called) {
    if (!std::exchange(called_, true)) begin(now);
    look_at_nodes(now);
  }
  for (std::size_t b = 0; b < buses_.size(); ++b) tell(b, now, desk);
}

/// Whoever has not answered in the roll call is silent from the first look on.
void BusHealth::begin(Instant now) {
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    nodes_[n].boots = board_.boots(n);
    if (answers_not(n)) nodes_[n].differs_since = now - kSuspect;
  }
}

void BusHealth::look_at_port(std::size_t b, const std::string& trouble, Instant now) {
  BusState& bus = buses_[b];
  if (trouble.empty()) {
    if (bus.down.empty()) return;
    bus.up_since = std::min(bus.up_since, now);
    if (now - bus.up_since < kSuspect) return;  // a loose contact is one fault
    bus.down.clear();
    changed(b, "its wire is up again");
    return;
  }
  bus.up_since = kNever;
  if (bus.down.empty()) {
    ++bus.downs;
    bus.was_down = trouble;
    bus.due = std::min(bus.due, now);
    changed(b, "its wire is down: " + trouble);
  }
  bus.down = trouble;
}

bool BusHealth::answers_not(std::size_t n) const {
  const NodeBoard::View node = board_.at(n);
  if ((node.flags & (NodeBoard::kSilent | NodeBoard::kQuarantined)) != 0) return true;
  return node.shown == NodeBoard::kNothingYet && (node.flags & NodeBoard::kUnverified) == 0;
}

void BusHealth::look_at_nodes(Instant now) {
  for (std::size_t n = 0; n < nodes_.size(); ++n) look_at_node(n, now);
  for (std::size_t b = 0; b < buses_.size(); ++b) {
    BusState& bus = buses_[b];
    if (!bus.now_silent.empty()) changed(b, "silent: " + names(bus.now_silent, bus.now_silent.size()));
    if (!bus.now_answer.empty()) changed(b, "answers again: " + names(bus.now_answer, bus.now_answer.size()));
    bus.now_silent.clear();
    bus.now_answer.clear();
  }
}

void BusHealth::look_at_node(std::size_t n, Instant now) {
  NodeHealth& node = nodes_[n];
  BusState& bus = buses_[rig_.nodes[n].bus.at()];
  const NodeBoard::View seen = board_.at(n);
  if (const std::uint8_t boots = board_.boots(n); boots != node.boots) {
    node.boots = boots;
    bus.restarted.insert(n);
    bus.due = std::min(bus.due, now + kGather);
    changed(rig_.nodes[n].bus.at(), "has restarted: " + rig_.nodes[n].name);
  }
  const bool right = (seen.flags & (NodeBoard::kRight | NodeBoard::kUnverified)) != 0;
  node.wrong_since = right ? kNever : std::min(node.wrong_since, now);
  node.unproved = !right && now - node.wrong_since >= kUnproved;
  const bool not_heard = answers_not(n);
  if (not_heard == node.silent || (node.silent && !right)) {
    node.differs_since = kNever;
    return;
  }
  node.differs_since = std::min(node.differs_since, now);
  const bool at_once = not_heard && (!bus.down.empty() || (seen.flags & NodeBoard::kQuarantined) != 0);
  if (!at_once && now - node.differs_since < kSuspect) return;
  node.differs_since = kNever;
  node.silent = not_heard;
  if (!not_heard) {
    --bus.silent;
    return bus.now_answer.push_back(n);
  }
  ++bus.silent;
  bus.now_silent.push_back(n);
  if (!bus.down.empty()) return;  // that was told
  bus.fell_silent.insert(n);
  bus.due = std::min(bus.due, now + kGather);
}

void BusHealth::tell(std::size_t b, Instant now, RunDesk& desk) {
  BusState& bus = buses_[b];
  const bool well = bus.down.empty() && bus.silent == 0;
  bus.well_since = well ? std::min(bus.well_since, now) : kNever;
  if (bus.due <= now && bus.not_before <= now) {
    bus.last_fault = alarm_text(b);
    bus.last_fault_unix_ms = wall_time() / milliseconds(1);
    desk.tell({RunEvent::Kind::alarm, fmt::format("bus \"{}\": {}", rig_.buses[b].name, bus.last_fault)});
    bus.downs = 0;
    bus.fell_silent.clear();
    bus.restarted.clear();
    bus.due = kNever;
    bus.not_before = now + bus.interval;
    bus.interval = std::min(2 * bus.interval, kAlarmAtMost);
    if (!well) bus.bad_since = std::min(bus.bad_since, now);
  }
  if (!well) return;
  if (const Instant since = std::exchange(bus.bad_since, kNever); since != kNever) {
    desk.tell({RunEvent::Kind::note, fmt::format("bus \"{}\": all {} nodes answer, {:.1f} s after the alarm",
                                                 rig_.buses[b].name, bus.nodes, to_seconds(now - since))});
  }
  if (now - bus.well_since >= kCalm) bus.interval = kAlarmAgain;
}

void BusHealth::changed(std::size_t bus, const std::string& what) const {
  if (change_) change_(fmt::format("bus \"{}\": {}", rig_.buses[bus].name, what));
}

std::string BusHealth::alarm_text(std::size_t b) const {
  const BusState& bus = buses_[b];
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
  if (!bus.down.empty()) {
    add(fmt::format("its wire is down: {}; its {} nodes are silent{}", bus.down, bus.nodes, times(bus.downs)));
  } else if (bus.downs > 0) {
    add(fmt::format("its wire was down: {}; it is up again{}", bus.was_down, times(bus.downs)));
  }
  if (bus.down.empty() && !bus.fell_silent.empty()) {
    std::vector<std::size_t> silent;
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      if (nodes_[n].silent && rig_.nodes[n].bus.at() == b) silent.push_back(n);
    }
    if (silent.empty()) {
      add("silent for a moment: " + names(bus.fell_silent, kNamed));
    } else if (silent.size() == bus.nodes) {
      add(fmt::format("all {} nodes are silent, and its port is open: cable, terminators, power of the markers",
                      bus.nodes));
    } else {
      add(fmt::format("{} of {} nodes silent: {}", silent.size(), bus.nodes, names(silent, kNamed)));
    }
  }
  if (!bus.restarted.empty()) {
    add(fmt::format("{} restarted: {}", bus.restarted.size() == 1 ? "a node has" : "nodes have",
                    names(bus.restarted, kNamed)));
  }
  return text;
}

template <class Nodes>
std::string BusHealth::names(const Nodes& nodes, std::size_t most) const {
  std::string text;
  std::size_t named = 0;
  for (const std::size_t n : nodes) {
    if (named == most) break;
    text += (named++ > 0 ? ", " : "") + rig_.nodes[n].name;
  }
  if (nodes.size() > most) text += fmt::format(" and {} more", nodes.size() - most);
  return text;
}

}  // namespace footlight::app
