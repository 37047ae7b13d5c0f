// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>

#include "config/media.hpp"
#include "config/nearest.hpp"
#include "config/obstacles.hpp"
#include "config/show_parts.hpp"
#include "core/terrain.hpp"

namespace footlight::config {
namespace {

std::optional<Grid> read_grid(MappingReader grid) {
  const auto kind = grid.choice("kind");
  const auto columns = grid.integer("columns");
  const auto rows = grid.integer("rows");
  const auto pitch = grid.quantity("pitch");
  if (!kind || !columns || !rows || !pitch) return std::nullopt;
  auto made = Grid::make(static_cast<GridKind>(*kind), *columns, *rows, *pitch);
  if (made) return *made;
  grid.error(grid.position(), grid.path(),
             std::to_string(*columns) + " x " + std::to_string(*rows) + " cells are too many", made.error().message);
  return std::nullopt;
}

/// The map's dark pixels, as drawn by the child process.
std::optional<Mask> read_map(ShowReading& show, MappingReader& obstacle) {
  PictureOptions options;
  options.invert = true;
  const auto threshold = obstacle.written("threshold");
  if (threshold && threshold->text != "otsu") {
    options.threshold = parse_integer(threshold->text);
    if (!options.threshold || *options.threshold < 0 || *options.threshold > 255) {
      obstacle.error(*threshold, in_quotes(threshold->text) + " is not a threshold", "0 to 255, or otsu");
      return std::nullopt;
    }
  }
  const std::string file = existing_file(obstacle, "map", show.folder, show.loaded.files);
  if (file.empty()) return std::nullopt;
  auto film = decode_image({file, options});
  if (film) return std::move(film->frames.front());
  obstacle.error("map", film.error().message);
  return std::nullopt;
}

/// The grey map is decoded by the child process.
void read_terrain(ShowReading& show, MappingReader reader) {
  Terrain out;
  out.position = reader.position();
  out.slowest = reader.number("slowest").value_or(out.slowest);
  out.path = existing_file(reader, "map", show.folder, show.loaded.files);
  if (out.path.empty()) return;
  const auto film = decode_painting({out.path});
  if (!film) return reader.error("map", film.error().message);
  out.width = film->width;
  out.height = film->height;
  for (std::size_t n = 0; n + 2 < film->rgb.size(); n += 3) {
    // Luma of red, green and blue (ITU-R BT.601), in thousandths.
    const int grey = 299 * film->rgb[n] + 587 * film->rgb[n + 1] + 114 * film->rgb[n + 2];
    out.grey.push_back(static_cast<std::uint8_t>((grey + 500) / 1000));
  }
  show.show().terrain = std::make_shared<const Terrain>(std::move(out));
}

/// Cells of all obstacles, ascending.
std::vector<CellIndex> read_obstacles(ShowReading& show, MappingReader& stage, const Grid& grid) {
  std::vector<CellIndex> out;
  for (MappingReader& obstacle : stage.mappings("obstacles")) {
    std::vector<CellIndex> cells;
    if (obstacle.has("map")) {
      const auto map = read_map(show, obstacle);
      if (!map) continue;
      cells = cells_of_map(grid, *map);
      if (cells.empty())
        obstacle.error("map", "nothing in the map is in the way", "dark pixels are; another threshold");
    } else {
      if (obstacle.has("threshold")) refuse_keys(obstacle, {"threshold"}, "it goes with a map");
      const std::vector<Point> corners = obstacle.polygon("polygon");
      if (corners.empty()) continue;
      cells = cells_of_polygon(grid, corners);
      if (cells.empty()) {
        obstacle.error("polygon", "it reaches into no cell of the stage",
                       "x from stage right to stage left with 0 in the middle, y upstage from 0 at the edge");
      }
    }
    out.insert(out.end(), cells.begin(), cells.end());
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

/// Whoever is blocked and in reserve at once is reported with the cells' names.
void check_disjoint(MappingReader& stage, const Stage& read) {
  std::vector<CellIndex> both;
  std::set_intersection(read.blocked.begin(), read.blocked.end(), read.reserve.begin(), read.reserve.end(),
                        std::back_inserter(both));
  if (both.empty()) return;
  const std::string name = read.grid.name(both.front());
  stage.error("reserve",
              both.size() == 1 ? "the cell " + name + " is blocked"
                               : std::to_string(both.size()) + " cells are blocked, the first is " + name,
              "nobody can stand on a blocked cell");
}

}  // namespace

std::optional<CellRange> read_cell_range(MappingReader& mapping, const Written& written, const Grid& grid) {
  const auto range = parse_cell_range(written.text);
  if (!range) {
    mapping.error(written, in_quotes(written.text) + " is not a cell or a range of cells",
                  "write for example A1 or A1:J48");
    return std::nullopt;
  }
  if (grid.contains(range->first) && grid.contains(range->last)) return range;
  const Cell off = grid.contains(range->last) ? range->first : range->last;
  mapping.error(written, "the cell " + cell_name(off) + " is off the grid",
                "A1 to " + cell_name({grid.columns() - 1, grid.rows() - 1}));
  return std::nullopt;
}

std::vector<CellIndex> read_cells(MappingReader& mapping, std::string_view key, const Grid& grid) {
  // Corners of the ranges first, sums along rows and columns after: the cost does not depend on how they overlap.
  const auto width = static_cast<std::size_t>(grid.columns()) + 1;
  std::vector<int> covers(width * (static_cast<std::size_t>(grid.rows()) + 1));
  const auto corner = [&](int column, int row) -> int& {
    return covers[static_cast<std::size_t>(row) * width + static_cast<std::size_t>(column)];
  };
  for (const Written& written : mapping.list(key)) {
    const auto range = read_cell_range(mapping, written, grid);
    if (!range) continue;
    ++corner(range->first.column, range->first.row);
    --corner(range->last.column + 1, range->first.row);
    --corner(range->first.column, range->last.row + 1);
    ++corner(range->last.column + 1, range->last.row + 1);
  }
  std::vector<CellIndex> out;
  for (int row = 0; row < grid.rows(); ++row) {
    for (int column = 0; column < grid.columns(); ++column) {
      if (column > 0) corner(column, row) += corner(column - 1, row);
      if (row > 0) corner(column, row) += corner(column, row - 1);
      if (column > 0 && row > 0) corner(column, row) -= corner(column - 1, row - 1);
      if (corner(column, row) > 0) out.push_back(grid.index({column, row}));
    }
  }
  return out;
}

void read_stage(ShowReading& show, MappingReader stage) {
  Stage& out = show.show().stage;
  if (auto grid = stage.mapping("grid")) {
    if (const auto made = read_grid(std::move(*grid))) {
      out.grid = *made;
      const auto cells = read_cells(stage, "blocked", out.grid);
      const auto obstacles = read_obstacles(show, stage, out.grid);
      std::set_union(cells.begin(), cells.end(), obstacles.begin(), obstacles.end(), std::back_inserter(out.blocked));
      out.reserve = read_cells(stage, "reserve", out.grid);
      check_disjoint(stage, out);
      show.has_stage = true;
    }
  }
  out.clearance_m = stage.quantity("clearance").value_or(out.clearance_m);
  out.max_speed_mps = stage.quantity("max_speed").value_or(out.max_speed_mps);
  if (const auto lag_s = stage.quantity("lag")) out.lag = seconds(*lag_s);
  if (stage.has("terrain")) {
    if (auto terrain = stage.mapping("terrain")) read_terrain(show, std::move(*terrain));
  }
}

}  // namespace footlight::config
