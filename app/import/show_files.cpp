// SPDX-License-Identifier: Apache-2.0
#include "app/import/show_files.hpp"

#include <algorithm>
#include <map>
#include <variant>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/export_files.hpp"
#include "app/numbers.hpp"
#include "config/show_file.hpp"

namespace footlight::app {
namespace {

std::string one_line(std::string text) {
  for (char& c : text) {
    if (c == 0x7F || (c >= 0 && c < 0x20)) c = ' ';
  }
  return text;
}

/// In double quotes, which YAML reads as JSON does; one line, and no bytes that are no text.
std::string quoted(std::string text) {
  text = one_line(std::move(text));
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// Without an exponent: counts go to a million.
std::string decimal(double value) {
  std::string out = fmt::format("{:.9f}", value);
  while (out.back() == '0') out.pop_back();
  if (out.back() == '.') out.pop_back();
  return out;
}

std::string colour(Colour c) { return fmt::format("\"#{:02X}{:02X}{:02X}\"", c.red, c.green, c.blue); }

/// Cells as few rectangles: runs of a row, and equal runs of rows above each other.
std::vector<CellRange> rectangles(const Grid& grid, const std::vector<CellIndex>& ascending) {
  std::vector<CellRange> out;
  std::map<std::pair<int, int>, std::size_t> open;  // columns of a run of the row before -> its rectangle
  std::map<std::pair<int, int>, std::size_t> next;
  int row = -1;
  for (std::size_t i = 0; i < ascending.size();) {
    const Cell first = grid.cell(ascending[i]);
    Cell last = first;
    while (++i < ascending.size() && grid.cell(ascending[i]) == Cell{last.column + 1, last.row}) ++last.column;
    if (first.row != row) {
      open = first.row == row + 1 ? std::move(next) : std::map<std::pair<int, int>, std::size_t>{};
      next.clear();
      row = first.row;
    }
    const std::pair run{first.column, last.column};
    const auto above = open.find(run);
    if (above != open.end()) {
      out[above->second].last = last;
      next[run] = above->second;
    } else {
      next[run] = out.size();
      out.push_back({first, last});
    }
  }
  return out;
}

std::string cell_list(const char* key, const Grid& grid, const std::vector<CellIndex>& cells) {
  if (cells.empty()) return {};
  std::string out = fmt::format("  {}:\n", key);
  for (const CellRange& range : rectangles(grid, cells)) {
    out += fmt::format("    - {}:{}\n", cell_name(range.first), cell_name(range.last));
  }
  return out;
}

std::string stage_yaml(const Stage& stage) {
  const Grid& grid = stage.grid;
  return fmt::format("stage:\n  grid: {{kind: {}, columns: {}, rows: {}, pitch: {} m}}\n", to_text(grid.kind()),
                     grid.columns(), grid.rows(), exact(grid.pitch_m())) +
         cell_list("blocked", grid, stage.blocked) + cell_list("reserve", grid, stage.reserve) +
         fmt::format("  clearance: {} m\n  max_speed: {} m/s\n  lag: {} s\n", exact(stage.clearance_m),
                     exact(stage.max_speed_mps), exact(to_seconds(stage.lag))) +
         (stage.walk == WalkKind::cells ? "walk: cells\n" : "");
}

std::string performers_yaml(const Show& show) {
  std::string out = fmt::format("performers:\n  from: performers.csv\n  colour: {}\n", colour(show.default_colour));
  if (show.groups.empty()) return out;
  out += "  groups:\n";
  for (const Group& group : show.groups) {
    out += fmt::format("    - {{name: {}, colour: {}{}}}\n", quoted(group.name), colour(group.colour),
                       group.exchange ? "" : ", exchange: false");
  }
  return out;
}

std::string roster(const Show& show) {
  std::string out = "id,name,group,radius,speed,wearable\n";
  for (const Performer& performer : show.performers) {
    const std::string group = performer.group ? csv_field(show.groups.at(performer.group->at()).name) : "";
    const std::string radius = performer.radius_m > 0 ? exact(performer.radius_m) + " m" : "";
    const std::string speed = performer.max_speed_mps > 0 ? exact(performer.max_speed_mps) + " m/s" : "";
    out += fmt::format("{},{},{},{},{},{}\n", csv_field(performer.id), csv_field(performer.name), group, radius, speed,
                       csv_field(performer.wearable));
  }
  return out;
}

std::string cells_csv(const Show& show, const CellsSource& source) {
  std::string out = "performer,col,row\n";
  for (std::size_t p = 0; p < source.cells.size(); ++p) {
    const Cell cell = show.stage.grid.cell(source.cells[p]);
    out += fmt::format("{},{},{}\n", csv_field(show.performers[p].id), cell.column, cell.row);
  }
  return out;
}

}  // namespace

std::string music_yaml(const TempoMap& tempo, const std::vector<config::Score::Rehearsal>& rehearsals) {
  std::string out = "music:\n";
  const bool one = tempo.changes().size() == 1 && tempo.meters().size() == 1;
  if (one) out += fmt::format("  tempo: {}\n", exact(tempo.changes().front().bpm));
  out += fmt::format("  meter: {}/4\n", tempo.beats_per_measure());
  if (tempo.pickup_counts() > 0) out += fmt::format("  pickup: {} counts\n", decimal(tempo.pickup_counts()));
  if (!one) {
    std::map<double, std::string> changes;
    for (const TempoChange& change : tempo.changes()) changes[change.count] += ", tempo: " + exact(change.bpm);
    for (std::size_t i = 1; i < tempo.meters().size(); ++i) {
      changes[tempo.meters()[i].count] += fmt::format(", meter: {}/4", tempo.meters()[i].beats);
    }
    out += "  changes:\n";
    for (const auto& [count, change] : changes)
      out += fmt::format("    - {{at: count {}{}}}\n", decimal(count), change);
  }
  for (const auto& mark : rehearsals) {
    out += fmt::format("  # count {} (measure {}): {}\n", decimal(mark.count), tempo.measure_beat(mark.count),
                       one_line(mark.text));
  }
  return out;
}

std::vector<std::pair<std::string, std::string>> show_files(const Show& show, const std::vector<std::string>& remarks) {
  std::string yaml = "# yaml-language-server: $schema=show.schema.json\n";
  for (const std::string& remark : remarks) yaml += "# " + one_line(remark) + "\n";
  yaml += "footlight: 1\ntitle: " + quoted(show.title) + "\n" + stage_yaml(show.stage) + performers_yaml(show) +
          music_yaml(show.tempo, {}) + "sections:\n";
  std::vector<std::pair<std::string, std::string>> out;
  for (std::size_t s = 0; s < show.sections.size(); ++s) {
    const Section& section = show.sections[s];
    const std::string file = fmt::format("formations/{:0{}}.csv", s + 1, show.sections.size() > 999 ? 5 : 3);
    yaml += fmt::format("  - {{name: {}, from: {{cells: {}}}, start: count {}", quoted(section.name), file,
                        decimal(section.start_count));
    if (section.hold_counts > 0) yaml += fmt::format(", hold: {} counts", decimal(section.hold_counts));
    yaml += "}\n";
    out.emplace_back(file, cells_csv(show, std::get<CellsSource>(section.from)));
  }
  out.emplace_back("performers.csv", roster(show));
  out.emplace_back("show.schema.json", config::show_schema());
  out.emplace_back("show.yaml", std::move(yaml));
  return out;
}

}  // namespace footlight::app
