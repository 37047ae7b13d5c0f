// SPDX-License-Identifier: Apache-2.0
#include "app/paper/lists.hpp"

#include <algorithm>
#include <map>
#include <string>

#include "app/paper/stage_words.hpp"
#include "controller/cue_list.hpp"

namespace footlight::app {
namespace {

/// What a group does from one instant at which somebody of it sets out to the next.
struct GroupMove {
  int walk = 0;
  Point sum;
  double longest_m = 0;
};

std::map<Instant, GroupMove> moves_of(const std::vector<Part>& parts, const std::vector<std::size_t>& members) {
  std::map<Instant, GroupMove> out;
  for (const std::size_t p : members) {
    for (const Place& place : parts[p]) {
      if (!place.way) continue;
      GroupMove& move = out[place.way->leave];
      ++move.walk;
      move.sum = move.sum + place.way->walk;
      move.longest_m = std::max(move.longest_m, place.way->length_m);
    }
  }
  return out;
}

/// "1-32 A1..AF1": channels that go along a row together.
std::string channels_text(const Node& node, const Grid& grid, const Show& show) {
  std::string out;
  const auto is_next = [&](std::size_t i) {
    const Channel& a = node.channels[i - 1];
    const Channel& b = node.channels[i];
    if (a.kind != Channel::Kind::cell || b.kind != Channel::Kind::cell) return false;
    const Cell one = grid.cell(a.cell);
    return grid.cell(b.cell) == Cell{one.column + 1, one.row};
  };
  for (std::size_t i = 0; i < node.channels.size();) {
    std::size_t end = i + 1;
    while (end < node.channels.size() && is_next(end)) ++end;
    const Channel& channel = node.channels[i];
    std::string what;
    if (channel.kind == Channel::Kind::wearable) what = show.performers.at(channel.performer.at()).name;
    if (channel.kind == Channel::Kind::cell) {
      what = grid.name(channel.cell);
      if (end > i + 1) what += ".." + grid.name(node.channels[end - 1].cell);
    }
    if (!what.empty()) {
      out += out.empty() ? "" : "   ";
      out += end > i + 1 ? fmt::format("{}-{} {}", i + 1, end, what) : fmt::format("{} {}", i + 1, what);
    }
    i = end;
  }
  return out;
}

}  // namespace

void add_call_list(Flow& flow, const Plan& plan, const Show& show, const std::vector<Part>& parts,
                   std::optional<GroupIndex> group, Language language) {
  std::vector<std::size_t> members;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (!group || show.performers.at(p).group == group) members.push_back(p);
  }
  const std::string name = group ? show.groups.at(group->at()).name : say(language, Word::everybody);
  flow.begin(say(language, Word::call_list) + "   " + name);
  const auto moves = moves_of(parts, members);
  const auto standing = [&](const GroupMove& move) {
    return say(language, Word::walk_and_wait, fmt::arg("walk", move.walk),
               fmt::arg("wait", members.size() - static_cast<std::size_t>(move.walk)));
  };
  const auto count = [&](Instant at) { return spoken_count(show.tempo.count_at(at)); };
  const std::vector<double> shares{0.10, 0.10, 0.30, 0.30, 0.20};
  bool follows = false;
  for (const controller::CuePlay& play : controller::cue_plays(show, plan)) {
    const std::string cue =
        say(language, Word::cue, fmt::arg("number", play.cue.number.to_text()), fmt::arg("name", play.cue.name));
    flow.heading(fmt::format("{}: {}, {} ... {}{}", say(language, Word::standby), name, cue, say(language, Word::go),
                             follows ? "  (" + say(language, Word::follows) + ")" : ""));
    if (!play.cue.notes.empty()) flow.words(play.cue.notes);
    for (auto move = moves.lower_bound(play.from); move != moves.end() && move->first < play.to; ++move) {
      const double at = show.tempo.count_at(move->first);
      flow.row(shares, {count(move->first), show.tempo.measure_beat(at), standing(move->second),
                        std::string(text_of(language, direction_of(move->second.sum))),
                        fmt::format("<= {:.1f} m", move->second.longest_m)});
    }
    follows = play.cue.continue_mode != ContinueMode::manual;
  }
}

void add_patch_list(Flow& flow, const Plan& plan, const Show& show, const Rig& rig) {
  flow.begin("Patch list");
  const std::vector<double> shares{0.10, 0.20, 0.15, 0.55};
  for (std::size_t b = 0; b < rig.buses.size(); ++b) {
    const Bus& bus = rig.buses[b];
    flow.heading(fmt::format("{}   {}   {}   {} bit/s", bus.name, to_text(bus.kind), bus.url, bus.bits_per_second));
    flow.row(shares, {"address", "node", "supply", "channel and cell"}, true);
    for (const Node& node : rig.nodes) {
      if (node.bus != BusIndex::of(b)) continue;
      flow.row(shares, {std::to_string(node.address), node.name, node.supply.empty() ? bus.supply : node.supply,
                        channels_text(node, plan.stage.grid, show)});
    }
  }
}

}  // namespace footlight::app
