// SPDX-License-Identifier: Apache-2.0
#include "app/floor.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace footlight::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr Colour kNoLamp{28, 28, 32};

double phase(Instant now, double period_s) { return std::fmod(to_seconds(now), period_s); }

Colour dimmed(Colour colour, double level) {
  const auto part = [level](std::uint8_t value) {
    return static_cast<std::uint8_t>(std::lround(static_cast<double>(value) * level));
  };
  return {part(colour.red), part(colour.green), part(colour.blue)};
}

}  // namespace

double effect_level(Effect effect, Instant now) {
  switch (effect) {
    case Effect::steady:
      return 1;
    case Effect::blink:
    case Effect::count_down:
      return phase(now, 1) < 0.5 ? 1 : 0;
    case Effect::pulse:
      return 0.5 + 0.5 * std::sin(std::numbers::pi * phase(now, 2));
    case Effect::double_blink: {
      const double at_s = phase(now, 1.2);
      return at_s < 0.2 || (at_s >= 0.4 && at_s < 0.6) ? 1 : 0;
    }
  }
  return 1;
}

Floor::Floor(const Show& show, const Rig& rig)
    : show_(show), rig_(rig), lamp_of_cell_(static_cast<std::size_t>(show.stage.grid.size()), -1) {
  for (std::size_t n = 0; n < rig.nodes.size(); ++n) {
    for (std::size_t c = 0; c < rig.nodes[n].channels.size(); ++c) {
      const Channel& channel = rig.nodes[n].channels[c];
      if (channel.kind == Channel::Kind::unused) continue;
      if (channel.kind == Channel::Kind::cell) {
        lamp_of_cell_.at(channel.cell.at()) = static_cast<std::int32_t>(lamps_.size());
      }
      lamps_.push_back({{NodeIndex::of(n), static_cast<int>(c)}, kDark, Look{{}, Effect::steady, 0}});
    }
  }
}

const std::vector<LampChange>& Floor::look_at(const sim::SimulatedRig& simulated, Instant now) {
  changes_.clear();
  for (Lamp& lamp : lamps_) {
    const LookIndex index = simulated.shown(lamp.place.node, lamp.place.channel);
    const Look look = simulated.lamp(lamp.place.node, lamp.place.channel);
    if (index == lamp.index && look == lamp.look) continue;
    lamp.index = index;
    lamp.look = look;
    changes_.push_back({now, lamp.place, index, look});
  }
  return changes_;
}

std::string Floor::json(const LampChange& change) const {
  const Node& node = rig_.nodes[change.place.node.at()];
  const Channel& channel = node.channels[static_cast<std::size_t>(change.place.channel)];
  Json line{{"t", to_seconds(change.at)}, {"node", node.name}, {"channel", change.place.channel}};
  if (channel.kind == Channel::Kind::cell) {
    line["cell"] = show_.stage.grid.name(channel.cell);
  } else {
    line["performer"] = show_.performers[channel.performer.at()].id;
  }
  line["look"] = change.index;
  line["colour"] = to_text(change.look.colour);
  line["brightness"] = change.look.brightness;
  line["effect"] = std::string(to_text(change.look.effect));
  return line.dump();
}

std::string Floor::json(Instant now) const {
  Json nodes = Json::array();
  NodeIndex last;
  for (const Lamp& lamp : lamps_) {
    if (nodes.empty() || lamp.place.node != last) {
      nodes.push_back({{"node", rig_.nodes[lamp.place.node.at()].name}, {"looks", Json::object()}});
    }
    last = lamp.place.node;
    nodes.back()["looks"][std::to_string(lamp.place.channel)] = lamp.index;
  }
  return Json{{"t", to_seconds(now)}, {"floor", std::move(nodes)}}.dump();
}

Colour Floor::seen(CellIndex cell, Instant now) const {
  const std::int32_t index = lamp_of_cell_[cell.at()];
  if (index < 0) return kNoLamp;
  const Look& look = lamps_[static_cast<std::size_t>(index)].look;
  return dimmed(look.colour, look.brightness / 255.0 * effect_level(look.effect, now));
}

std::string Floor::picture(Instant now, int most_columns) const {
  const Grid& grid = show_.stage.grid;
  const int columns = std::min(grid.columns(), most_columns);
  const int first = (grid.columns() - columns) / 2;
  std::string text;
  for (int row = grid.rows() - 1; row >= 0; row -= 2) {
    for (int column = first; column < first + columns; ++column) {
      const Colour upper = seen(grid.index({column, row}), now);
      text += fmt::format("\x1B[38;2;{};{};{}", upper.red, upper.green, upper.blue);
      if (row > 0) {
        const Colour lower = seen(grid.index({column, row - 1}), now);
        text += fmt::format(";48;2;{};{};{}m\u2580", lower.red, lower.green, lower.blue);
      } else {
        text += ";49m\u2580";
      }
    }
    text += "\x1B[0m\n";
  }
  return text;
}

}  // namespace footlight::app
