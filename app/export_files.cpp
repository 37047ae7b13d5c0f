// SPDX-License-Identifier: Apache-2.0
#include "app/export_files.hpp"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "app/numbers.hpp"

namespace footlight::app {
namespace {

using Json = nlohmann::ordered_json;

Json cells_of(const Grid& grid, const std::vector<CellIndex>& cells) {
  Json out = Json::array();
  for (const CellIndex index : cells) {
    const Cell cell = grid.cell(index);
    out.push_back({cell.column, cell.row});
  }
  return out;
}

Json centres_of(const Grid& grid) {
  Json out = Json::array();
  for (int i = 0; i < grid.size(); ++i) {
    const Cell cell = grid.cell(CellIndex::of(i));
    const Point at = grid.centre(cell);
    out.push_back({cell.column, cell.row, at.x, at.y});
  }
  return out;
}

std::string seen_from(const std::string& show_file, const std::string& path) {
  const std::filesystem::path folder = std::filesystem::absolute(show_file).parent_path();
  return std::filesystem::absolute(path)
      .lexically_normal()
      .lexically_proximate(folder.lexically_normal())
      .generic_string();
}

/// Largest speed that anybody may have anywhere.
double speed_limit(const Plan& plan) {
  double out = plan.stage.max_speed_mps;
  for (const PlanSection& section : plan.sections) out = std::max(out, section.max_speed_mps);
  for (const double own : plan.max_speed_mps) out = std::max(out, own);
  return out;
}

Json section_of(const Plan& plan, const Show& show, const PlanSection& section) {
  const double start_s = to_seconds(section.start);
  Json out{{"name", section.name},
           {"start_s", start_s},
           {"end_s", to_seconds(section.end)},
           {"max_speed_m_s", section.max_speed_mps},
           {"reserve", cells_of(plan.stage.grid, section.reserve)}};
  if (!section.film) return out;
  const FilmPlacement& film = *section.film;
  const StageToFrame& m = film.stage_to_frame;
  if (film.show_fps > 0) {
    // What is held after the last frame is no film any more: the section of a film ends with it.
    const double film_s = static_cast<double>(film.last_frame - film.first_frame) / film.show_fps;
    out["end_s"] = start_s + film_s;
    out["hold_until_s"] = to_seconds(section.end);
    out["video"] = seen_from(show.file, film.path);
    out["frame0"] = film.first_frame;
    out["last_frame"] = film.last_frame;
    out["fps"] = film.show_fps;
  } else {
    out["image"] = seen_from(show.file, film.path);
  }
  out["threshold"] = film.threshold;
  out["invert"] = film.inverted;
  out["stage_to_frame"] = {{m[0], m[1], m[2]}, {m[3], m[4], m[5]}};
  return out;
}

}  // namespace

std::string csv_field(std::string_view text) {
  const bool edges = !text.empty() && (text.front() == '#' || text.front() == ' ' || text.back() == ' ');
  if (!edges && text.find_first_of(",\"\r\n\t") == std::string_view::npos) return std::string(text);
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

MarkLooks::MarkLooks(const Plan& plan) : plan_(plan), arrivals_(static_cast<std::size_t>(plan.stage.grid.size())) {
  for (const auto& track : plan.tracks) {
    for (std::size_t k = 1; k < track.size(); ++k) {
      if (track[k].cell != track[k - 1].cell) arrivals_[track[k].cell.at()].push_back(track[k].time);
    }
  }
  for (auto& times : arrivals_) std::sort(times.begin(), times.end());
}

bool MarkLooks::arrives(CellIndex cell, Instant from, Instant to) const {
  const auto& times = arrivals_[cell.at()];
  const auto first = std::upper_bound(times.begin(), times.end(), from);
  return first != times.end() && *first <= to;
}

std::string_view MarkLooks::of(std::size_t performer, std::size_t k) const {
  const auto& track = plan_.tracks[performer];
  const std::vector<CellIndex>& reserve = plan_.sections[section_at(plan_, track[k].time)].reserve;
  if (std::binary_search(reserve.begin(), reserve.end(), track[k].cell)) return "dark";
  const bool stays = k + 1 == track.size() || track[k + 1].cell == track[k].cell;
  if (stays) return "here";
  if (arrives(track[k].cell, track[k].time, track[k + 1].time)) return "handover";
  return k > 0 && track[k - 1].cell != track[k].cell ? "arrive" : "here";
}

std::string marks_csv(const Plan& plan, const Show& show) {
  const MarkLooks looks(plan);
  const Grid& grid = plan.stage.grid;
  std::vector<std::string> places;  // "col,row,x_m,y_m" of each cell
  for (int i = 0; i < grid.size(); ++i) {
    const Cell cell = grid.cell(CellIndex::of(i));
    const Point at = grid.centre(cell);
    places.push_back(std::to_string(cell.column) + "," + std::to_string(cell.row) + "," + exact(at.x) + "," +
                     exact(at.y));
  }
  std::unordered_map<Duration::rep, std::string> instants;  // "count,time_s", looked up only
  std::string out = "performer,count,time_s,col,row,x_m,y_m,look,section\n";
  for (std::size_t p = 0; p < plan.tracks.size(); ++p) {
    const std::string name = csv_field(plan.performers[p]);
    const auto& track = plan.tracks[p];
    for (std::size_t k = 0; k < track.size(); ++k) {
      std::string& instant = instants[track[k].time.time_since_epoch().count()];
      if (instant.empty()) {
        instant = exact(tidy_count(show.tempo.count_at(track[k].time))) + "," + exact_seconds(track[k].time);
      }
      out.append(name).append(1, ',').append(instant).append(1, ',').append(places[track[k].cell.at()]).append(1, ',');
      out += looks.of(p, k);
      out.append(1, ',').append(csv_field(plan.sections[section_at(plan, track[k].time)].name)).append(1, '\n');
    }
  }
  return out;
}

std::string formations_csv(const Plan& plan) {
  std::string out = "formation,count,time_s,frame,performer,col,row,key\n";
  for (const Formation& formation : plan.formations) {
    const std::string start = csv_field(formation.id) + "," + exact(tidy_count(formation.count)) + "," +
                              exact_seconds(formation.time) + "," +
                              (formation.frame ? std::to_string(*formation.frame) : "") + ",";
    for (std::size_t p = 0; p < formation.cells.size(); ++p) {
      const Cell cell = plan.stage.grid.cell(formation.cells[p]);
      out += start + csv_field(plan.performers[p]) + "," + std::to_string(cell.column) + "," +
             std::to_string(cell.row) + (formation.key ? ",1\n" : ",0\n");
    }
  }
  return out;
}

std::string stage_json(const Plan& plan, const Show& show) {
  const Grid& grid = plan.stage.grid;
  Json out{{"title", plan.title},
           {"version", plan.version},
           {"valid", plan.valid},
           {"show_hash", plan.show_hash},
           {"grid",
            {{"kind", to_text(grid.kind())},
             {"cols", grid.columns()},
             {"rows", grid.rows()},
             {"pitch_m", grid.pitch_m()},
             {"cell_area_m2", grid.cell_area_m2()}}},
           {"blocked", cells_of(grid, plan.stage.blocked)},
           {"clearance_m", plan.stage.clearance_m},
           {"max_speed_m_s", speed_limit(plan)},
           {"lag_s", to_seconds(plan.stage.lag)},
           {"sections", Json::array()}};
  if (grid.kind() != GridKind::square) out["cells"] = centres_of(grid);
  for (const PlanSection& section : plan.sections) out["sections"].push_back(section_of(plan, show, section));
  return out.dump(1) + "\n";
}

}  // namespace footlight::app
