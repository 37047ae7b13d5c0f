// SPDX-License-Identifier: Apache-2.0
#include "config/starter_show.hpp"

#include <algorithm>
#include <array>

#include "config/show_file.hpp"
#include "config/text_scan.hpp"
#include "core/grid.hpp"

namespace footlight::config {
namespace {

constexpr std::string_view kShow = R"(# yaml-language-server: $schema=show.schema.json
# A show for Footlight. Every key is explained in docs/show-file.md.
#   footlight check  show.yaml     finds what is wrong, with line and column
#   footlight plan   show.yaml     plans who walks where
#   footlight dryrun show.yaml     plays it on simulated hardware
footlight: 1
title: @TITLE@

stage:
  # One lamp and at most one person on a cell. A1 is downstage, stage right (the audience's left).
  grid: {kind: square, columns: 12, rows: 8, pitch: 1 m}
  clearance: 0.5 m       # nobody comes nearer to anybody, centre to centre
  max_speed: 1.4 m/s     # a brisk walk

performers:
  count: 12              # or  from: roster.csv  with a row for everybody
  groups:
    - {name: left, members: 1-6, colour: "#FF69B4"}
    - {name: right, members: 7-12, colour: "#00A0FF"}

music: {tempo: 100, meter: 4/4}

# Between two sections people walk: here the line becomes a ring between count 9 and count 25.
sections:
  - {name: line, from: {cells: line.csv}, start: count 1, hold: 8 counts}
  - {name: ring, from: {cells: ring.csv}, start: count 25, hold: 8 counts}
  - {name: arrow, from: {cells: arrow.csv}, start: count 49, hold: 8 counts}
  # From a video instead (formations are found in it by themselves):
  # - {name: flower, from: {video: flower.mp4}, start: count 73, duration: 64 counts}

cues:                    # what GO starts; numbers are quoted, so that "1.10" stays what it is
  - {number: "1", section: line, name: Opening line, continue: auto-follow}
  - {number: "2", section: ring, name: Ring, continue: auto-follow}
  - {number: "3", section: arrow, name: Arrow}

looks:                   # what a lamp tells
  here: {colour: group, effect: steady}
  next: {colour: group, effect: count-down}
announce: 4 counts       # the next places light up that long before a move

# rig: rig.yaml          # real buses and lamps; without it the show runs on simulated ones
)";

constexpr int kPeople = 12;
struct Formation {
  std::string_view file;
  std::string_view about;
  std::array<Cell, kPeople> cells;
};
// In an order for which no exchange of two people shortens the sum of squared walks, so that nobody comes near anybody.
constexpr std::array<Formation, 3> kFormations{
    Formation{"line.csv",
              "A line across the stage, downstage.",
              {{{0, 1}, {1, 1}, {2, 1}, {3, 1}, {4, 1}, {5, 1}, {6, 1}, {7, 1}, {8, 1}, {9, 1}, {10, 1}, {11, 1}}}},
    Formation{"ring.csv",
              "A ring around the middle.",
              {{{3, 3}, {3, 5}, {4, 6}, {4, 2}, {5, 1}, {5, 7}, {6, 1}, {6, 7}, {7, 6}, {7, 2}, {8, 3}, {8, 5}}}},
    Formation{"arrow.csv",
              "An arrow that points at the audience.",
              {{{3, 4}, {1, 6}, {2, 5}, {4, 3}, {5, 2}, {5, 5}, {6, 2}, {6, 5}, {9, 5}, {7, 3}, {8, 4}, {10, 6}}}},
};

std::string in_yaml(std::string_view title) {
  std::string out = "\"";
  for (std::size_t i = 0; i < title.size();) {
    const char c = title[i];
    const std::size_t length = utf8_length(title, i);
    if (length == 0 || static_cast<unsigned char>(c) < 0x20 || c == 0x7F) {
      out += length == 0 ? '?' : ' ';
    } else {
      if (c == '"' || c == '\\') out += '\\';
      out += title.substr(i, length);
    }
    i += std::max<std::size_t>(length, 1);
  }
  return out + "\"";
}

std::string csv(const Formation& formation) {
  std::string out =
      "# " + std::string(formation.about) + " Columns count from stage right, rows from downstage, both from 0.\n";
  out += "performer,col,row\n";
  int id = 1;
  for (const Cell& cell : formation.cells) {
    out += std::to_string(id++) + "," + std::to_string(cell.column) + "," + std::to_string(cell.row) + "\n";
  }
  return out;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> starter_show(std::string_view title) {
  std::string show(kShow);
  constexpr std::string_view kMark = "@TITLE@";
  show.replace(show.find(kMark), kMark.size(), in_yaml(title.empty() ? "A new show" : title));
  std::vector<std::pair<std::string, std::string>> out{{"show.yaml", std::move(show)},
                                                       {"show.schema.json", show_schema()}};
  for (const Formation& formation : kFormations) out.emplace_back(formation.file, csv(formation));
  return out;
}

}  // namespace footlight::config
