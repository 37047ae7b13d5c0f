// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/cue_number.hpp"
#include "core/rig.hpp"
#include "core/show.hpp"
#include "tests/support/plan_builder.hpp"

namespace footlight::tests {

/// A show, a plan of it and a rig, as small as a test wants them. The plan counts as proved.
struct SmallShow {
  Show show;
  Plan plan;
  Rig rig;
};

[[nodiscard]] inline Cue cue_of(const char* number, std::size_t section, ContinueMode mode = ContinueMode::manual) {
  Cue cue;
  cue.number = CueNumber::parse(number).value();
  cue.name = "cue " + cue.number.to_text();
  cue.section = SectionIndex::of(section);
  cue.continue_mode = mode;
  return cue;
}

/// A lamp on every cell: nodes of 32 channels, dealt to the buses of the given kinds in turn.
[[nodiscard]] inline Rig lamps_everywhere(const Grid& grid, const std::vector<BusKind>& kinds, int bits_per_second,
                                          int channels = kChannelsPerNode) {
  Rig rig;
  for (std::size_t b = 0; b < kinds.size(); ++b) {
    const int rate = kinds[b] == BusKind::can ? 500'000 : bits_per_second;
    rig.buses.push_back(
        {"bus" + std::to_string(b + 1), kinds[b], "sim://" + std::string(to_text(kinds[b])), rate, std::nullopt, {}});
  }
  std::vector<std::vector<Node>> of_bus(kinds.size());
  for (int cell = 0; cell < grid.size(); ++cell) {
    std::vector<Node>& nodes = of_bus[static_cast<std::size_t>(cell / channels) % kinds.size()];
    if (cell % channels == 0) {
      Node& node = nodes.emplace_back();
      node.bus = BusIndex::of(static_cast<std::size_t>(cell / channels) % kinds.size());
      node.address = static_cast<int>(nodes.size());
      node.name = rig.buses[node.bus.at()].name + "/" + std::to_string(node.address);
    }
    nodes.back().channels.push_back({Channel::Kind::cell, CellIndex::of(cell), {}});
  }
  for (const auto& nodes : of_bus) rig.nodes.insert(rig.nodes.end(), nodes.begin(), nodes.end());
  return rig;
}

/// `sections` sections of `marks` walks of two seconds each; the walk into a section takes four. People in two groups
/// go to random cells.
[[nodiscard]] inline SmallShow random_show(int columns, int rows, std::size_t people, int sections, int marks,
                                           std::uint64_t seed) {
  SmallShow out;
  Rng rng(seed);
  const Grid grid = Grid::make(GridKind::square, columns, rows, 1.0).value();
  out.show.title = "random";
  out.show.stage.grid = grid;
  out.show.groups = {{"stem", {0, 200, 0}}, {"bloom", {255, 105, 180}}};
  std::vector<std::vector<Mark>> tracks(people);
  double time_s = 0;
  std::vector<Formation> formations;
  for (int s = 0; s < sections; ++s) {
    Section section;
    section.name = "s" + std::to_string(s + 1);
    if (s > 0) time_s += 4;
    const double start_s = time_s;
    for (int m = 0; m <= marks; ++m) {
      if (m > 0) time_s += 2;
      const std::vector<CellIndex> cells = random_cells(grid, people, rng);
      for (std::size_t p = 0; p < people; ++p) tracks[p].push_back({instant_at(time_s), cells[p]});
      Formation formation;
      formation.id = section.name + "/" + std::to_string(m + 1);
      formation.section = SectionIndex::of(s);
      formation.time = instant_at(time_s);
      formations.push_back(formation);
    }
    section.start_count = out.show.tempo.count_at(instant_at(start_s));
    section.duration_counts = out.show.tempo.count_at(instant_at(time_s)) - section.start_count;
    out.show.sections.push_back(section);
    out.show.cues.push_back(cue_of(std::to_string(s + 1).c_str(), static_cast<std::size_t>(s),
                                   s % 2 == 0 ? ContinueMode::auto_follow : ContinueMode::manual));
  }
  out.show.announce_counts = 2;
  for (std::size_t p = 0; p < people; ++p) {
    Performer performer;
    performer.id = std::to_string(p + 1);
    performer.group = GroupIndex::of(p % 2);
    out.show.performers.push_back(performer);
  }
  out.plan = plan_of(grid, std::move(tracks));
  out.plan.formations = std::move(formations);
  for (const Section& section : out.show.sections) {
    const Instant start = out.show.tempo.at(section.start_count);
    out.plan.sections.push_back({section.name, start, out.show.tempo.at(section.end_count()), 100, {}, {}, {}});
  }
  out.plan.valid = true;
  return out;
}

}  // namespace footlight::tests
