// SPDX-License-Identifier: Apache-2.0
#include "app/import/imported_show.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "app/numbers.hpp"
#include "app/output_place.hpp"
#include "config/nearest.hpp"

namespace footlight::app {
namespace {

/// Groups of people of one colour, in the order of the people; one colour of all is no group.
void group_by_colour(const Imported& imported, Show& show) {
  std::map<std::array<int, 3>, GroupIndex> known;
  std::set<std::array<int, 3>> colours;
  const auto key = [](const Colour& c) { return std::array<int, 3>{c.red, c.green, c.blue}; };
  for (const ImportedPerson& person : imported.people) {
    if (person.colour) colours.insert(key(*person.colour));
  }
  for (std::size_t p = 0; p < imported.people.size(); ++p) {
    const auto& colour = imported.people[p].colour;
    if (!colour) continue;
    if (colours.size() == 1) {
      show.default_colour = *colour;
      continue;
    }
    const auto found = known.find(key(*colour));
    if (found != known.end()) {
      show.performers[p].group = found->second;
      continue;
    }
    show.performers[p].group = GroupIndex::of(show.groups.size());
    known.emplace(key(*colour), GroupIndex::of(show.groups.size()));
    show.groups.push_back({fmt::format("{:02X}{:02X}{:02X}", colour->red, colour->green, colour->blue), *colour});
  }
}

/// Where people stand dark and nobody stands lit.
std::vector<CellIndex> reserve_of(const Imported& imported, const FittingGrid& grid) {
  std::vector<CellIndex> out;
  for (const Point& at : imported.dark) out.push_back(grid.cell(at));
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

/// The smallest distance of two people in a formation, where that is less than `most_m`.
double nearest_two_m(const Grid& grid, const OnCells& on, double most_m) {
  double out = most_m;
  if (grid.pitch_m() >= most_m) return out;
  std::vector<bool> taken(static_cast<std::size_t>(grid.size()), false);
  for (const auto& cells : on.cells) {
    for (const CellIndex cell : cells) taken[cell.at()] = true;
    for (const CellIndex cell : cells) {
      for (const CellIndex other : grid.within(grid.centre(cell), out)) {
        if (other != cell && taken[other.at()]) out = std::min(out, distance(grid.centre(cell), grid.centre(other)));
      }
    }
    for (const CellIndex cell : cells) taken[cell.at()] = false;
  }
  return out;
}

void make_limits(const Imported& imported, const Grid& grid, ImportedShow& out) {
  Stage& stage = out.show.stage;
  const double nearest_m = std::floor(nearest_two_m(grid, out.on, stage.clearance_m) * 1000 + 1e-6) / 1000;
  if (nearest_m < stage.clearance_m) {
    out.notes.push_back(fmt::format("people stand {:g} m apart: stage.clearance is set to that", nearest_m));
    stage.clearance_m = nearest_m;
  }
  const FastestWalk fastest = fastest_walk(imported, out.show.tempo);
  if (fastest.speed_mps <= stage.max_speed_mps) return;
  stage.max_speed_mps = std::ceil(fastest.speed_mps * 10 - 1e-9) / 10;
  out.notes.push_back(fmt::format("{} walks {:.2f} m/s into {} (count {:g}): stage.max_speed is set to {:g} m/s",
                                  imported.people[fastest.person].name, fastest.speed_mps,
                                  imported.formations[fastest.formation].name,
                                  imported.formations[fastest.formation].count, stage.max_speed_mps));
}

/// The imported people's numbers in the order of a show that knows them, by id, name, or what an id is as a file's
/// name.
Result<std::vector<std::size_t>> order_like(const Imported& imported, const Show& show) {
  std::map<std::string, std::size_t> by_name;
  for (std::size_t p = 0; p < imported.people.size(); ++p) by_name.emplace(imported.people[p].name, p);
  std::set<std::string> taken;
  std::vector<std::size_t> out;
  for (const Performer& performer : show.performers) {
    const std::string file = file_name_of(performer.id, taken);
    auto found = by_name.find(performer.id);
    if (found == by_name.end()) found = by_name.find(file);
    if (found == by_name.end()) found = by_name.find(performer.name);
    if (found == by_name.end()) {
      std::vector<std::string> names;
      names.reserve(by_name.size());
      for (const auto& [name, person] : by_name) names.push_back(name);
      return input_error(fmt::format("the file does not say where performer {} of {} stands ({})", performer.id,
                                     show.file, config::suggestion(performer.id, names, "people of the file")));
    }
    out.push_back(found->second);
    by_name.erase(found);
  }
  if (by_name.empty()) return out;
  return input_error(fmt::format("{} of the file is nobody of {} ({} people there)", by_name.begin()->first, show.file,
                                 show.performers.size()));
}

/// Names of sections are unique: the rehearsal mark at the count, if any, and the formation's own.
std::string section_name(const ImportedFormation& formation, const ShowFrame& frame, std::set<std::string>& taken) {
  std::string out = formation.name;
  for (const auto& mark : frame.rehearsals) {
    if (std::abs(mark.count - formation.count) < 1e-6) {
      out = fmt::format("{} ({})", mark.text, formation.name);
      break;
    }
  }
  std::string unique = out;
  for (int n = 2; !taken.insert(unique).second; ++n) unique = fmt::format("{} {}", out, n);
  return unique;
}

}  // namespace

Result<ImportedShow> imported_show(const Imported& imported, const FittingGrid& grid, const ShowFrame& frame) {
  auto on = cells_of(imported, grid);
  if (!on) return on.error();
  ImportedShow out;
  out.on = *std::move(on);
  out.show.title = frame.title;
  out.show.tempo = frame.tempo;
  if (frame.like != nullptr) {
    auto order = order_like(imported, *frame.like);
    if (!order) return order.error();
    out.order = *std::move(order);
    out.show.stage = frame.like->stage;
    out.show.performers = frame.like->performers;
    out.show.groups = frame.like->groups;
    out.show.default_colour = frame.like->default_colour;
  } else {
    out.order.resize(imported.people.size());
    std::iota(out.order.begin(), out.order.end(), std::size_t{0});
    for (const ImportedPerson& person : imported.people) {
      Performer& performer = out.show.performers.emplace_back();
      performer.id = performer.name = person.name;
    }
    group_by_colour(imported, out.show);
    out.show.stage.grid = grid.grid;
    out.show.stage.reserve = reserve_of(imported, grid);
    make_limits(imported, grid.grid, out);
  }
  std::set<std::string> taken;
  for (std::size_t f = 0; f < imported.formations.size(); ++f) {
    const ImportedFormation& formation = imported.formations[f];
    Section& section = out.show.sections.emplace_back();
    section.name = section_name(formation, frame, taken);
    section.start_count = formation.count;
    section.hold_counts = formation.hold_counts;
    CellsSource cells;
    for (const std::size_t p : out.order) cells.cells.push_back(out.on.cells[f][p]);
    section.from = std::move(cells);
  }
  return out;
}

}  // namespace footlight::app
