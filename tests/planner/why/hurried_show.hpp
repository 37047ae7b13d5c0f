// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/check.hpp"
#include "planner/plan_show.hpp"
#include "tests/support/films.hpp"

namespace footlight::tests {

/// A show and its plan.
struct HurriedShow {
  Show show;
  std::optional<Film> film;
  Plan plan;
};

inline Show empty_show(int people, int columns, int rows) {
  Show show;
  show.file = "show.yaml";
  show.stage.grid = Grid::make(GridKind::square, columns, rows, 1.0).value();
  for (int p = 1; p <= people; ++p) {
    Performer performer;
    performer.id = performer.name = std::to_string(p);
    show.performers.push_back(performer);
  }
  return show;
}

/// Three people on A1, B2, K10; after a hold of four counts the first has four to walk to C1.
inline HurriedShow two_lists() {
  HurriedShow made;
  made.show = empty_show(3, 12, 12);
  const Grid& grid = made.show.stage.grid;
  const auto list = [&](const char* name, Cell first, double start) {
    Section section;
    section.name = name;
    section.from = CellsSource{"cells.csv", {grid.index(first), grid.index({1, 1}), grid.index({10, 9})}, true};
    section.start_count = start;
    section.hold_counts = 4;
    made.show.sections.push_back(section);
  };
  list("here", {0, 0}, 1);
  list("there", {2, 0}, 9);
  auto planned = planner::plan_show(made.show, {std::nullopt, std::nullopt});
  FL_CHECK(planned.has_value());
  FL_CHECK(planned->plan.valid);
  made.plan = std::move(planned->plan);
  return made;
}

/// A disc that jumps from one side of the floor to the other, faster than anybody walks.
inline HurriedShow jumping_film() {
  HurriedShow made;
  made.show = empty_show(60, 30, 20);
  Section section;
  section.name = "jump";
  section.from = VideoSource{"film.mp4", 0, std::nullopt, {}};
  section.start_count = 1;
  section.duration_counts = 40;
  section.planner.model = PlannerModel::flat;
  made.show.sections.push_back(section);
  made.film = film_of(40, [](int f) { return disc(80, 60, f < 20 ? 25 : 55, 30, 14); });
  auto planned = planner::plan_show(made.show, {made.film});
  FL_CHECK(planned.has_value());
  FL_CHECK(planned->plan.valid);
  made.plan = std::move(planned->plan);
  return made;
}

}  // namespace footlight::tests
