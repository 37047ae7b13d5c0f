// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/plan.hpp"
#include "core/rng.hpp"

namespace footlight::tests {

/// A plan on an empty stage without limits of anybody's own, for tests to spoil. Performers are called "1", "2", ...
[[nodiscard]] inline Plan plan_of(const Grid& grid, std::vector<std::vector<Mark>> tracks) {
  Plan plan;
  plan.title = "test";
  plan.stage.grid = grid;
  plan.tracks = std::move(tracks);
  for (std::size_t i = 0; i < plan.tracks.size(); ++i) plan.performers.push_back(std::to_string(i + 1));
  plan.radius_m.assign(plan.tracks.size(), 0);
  plan.max_speed_mps.assign(plan.tracks.size(), 0);
  return plan;
}

[[nodiscard]] inline Mark mark_at(double time_s, const Grid& grid, int column, int row) {
  return {instant_at(time_s), grid.index({column, row})};
}

/// `count` different cells of a list.
[[nodiscard]] inline std::vector<CellIndex> random_cells(std::vector<CellIndex> all, std::size_t count, Rng& rng) {
  for (std::size_t i = 0; i < count; ++i) std::swap(all[i], all[i + rng.below(all.size() - i)]);
  all.resize(count);
  return all;
}

/// `count` different cells of a grid.
[[nodiscard]] inline std::vector<CellIndex> random_cells(const Grid& grid, std::size_t count, Rng& rng) {
  std::vector<CellIndex> all;
  for (int i = 0; i < grid.size(); ++i) all.push_back(CellIndex::of(i));
  return random_cells(std::move(all), count, rng);
}

/// Random walks between `marks` instants, shared or (when `own_times`) of everybody's own between the first and the
/// last. Nothing keeps people apart.
[[nodiscard]] inline Plan random_plan(const Grid& grid, std::size_t people, int marks, bool own_times, Rng& rng) {
  std::vector<std::vector<Mark>> tracks(people);
  const double last_s = 2.0 * (marks - 1);
  for (int k = 0; k < marks; ++k) {
    const std::vector<CellIndex> cells = random_cells(grid, people, rng);
    for (std::size_t i = 0; i < people; ++i) {
      const bool inner = k > 0 && k + 1 < marks;
      const double shift = own_times && inner && rng.below(3) > 0 ? 1.8 * (rng.uniform() - 0.5) : 0;
      if (own_times && inner && rng.below(4) == 0) continue;
      tracks[i].push_back({instant_at(2.0 * k + shift), cells[i]});
    }
  }
  Plan plan = plan_of(grid, std::move(tracks));
  plan.sections.push_back({"all", kStart, instant_at(last_s), 100, {}, {}, {}});
  return plan;
}

}  // namespace footlight::tests
