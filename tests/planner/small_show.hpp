// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/show.hpp"
#include "tests/support/films.hpp"

namespace footlight::planner::test {

/// A show without sections on an open floor of 30 x 20 cells, people named 1, 2, 3 ...
inline Show show_with(int people, GridKind kind = GridKind::square, int columns = 30, int rows = 20) {
  Show show;
  show.file = "show.yaml";
  show.title = "Test";
  show.stage.grid = *Grid::make(kind, columns, rows, 1.0);
  for (int p = 0; p < people; ++p) {
    Performer performer;
    performer.id = performer.name = std::to_string(p + 1);
    show.performers.push_back(performer);
  }
  return show;
}

/// Every cell of a range, row by row.
inline std::vector<CellIndex> cells_in(const Grid& grid, const char* range) {
  const CellRange r = *parse_cell_range(range);
  std::vector<CellIndex> out;
  for (int row = r.first.row; row <= r.last.row; ++row) {
    for (int column = r.first.column; column <= r.last.column; ++column) out.push_back(grid.index({column, row}));
  }
  return out;
}

inline Section section_of(const char* name, Source from, double start, double duration, double hold, int line) {
  Section section;
  section.name = name;
  section.from = std::move(from);
  section.start_count = start;
  section.duration_counts = duration;
  section.hold_counts = hold;
  section.position = {"show.yaml", line, 5};
  return section;
}

inline VideoSource video() { return {"film.mp4", 0, std::nullopt, {}}; }

using Films = std::vector<std::optional<Film>>;

/// An image, a film and an image, a few people in the wings.
inline Show three_sections(int people = 44, GridKind kind = GridKind::square) {
  Show show = show_with(people, kind, 24, 16);
  show.stage.reserve = cells_in(show.stage.grid, "A1:B16");
  Section first = section_of("first", ImageSource{"a.png", {}}, 1, 0, 4, 11);
  Section film = section_of("film", video(), 45, 40, 0, 12);
  film.sampling.interval = milliseconds(3000);
  Section last = section_of("last", ImageSource{"b.png", {}}, 130, 0, 4, 13);
  show.sections = {first, film, last};
  return show;
}
inline Films three_films() {
  const Mask start = tests::disc(80, 60, 30, 30, 20);
  const Mask end = tests::mask_where(80, 60, [](int x, int y) { return x > 20 && x < 60 && y > 20 && y < 45; });
  return {tests::film_of(1, [&](int) { return start; }),
          tests::film_of(30, [](int f) { return tests::disc(80, 60, 25 + f, 30, 18); }),
          tests::film_of(1, [&](int) { return end; })};
}

}  // namespace footlight::planner::test
