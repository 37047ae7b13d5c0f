// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "planner/motion/crowd.hpp"

namespace footlight::tests {

/// A task on a floor of square cells, a metre each, and all that it borrows. People are 0.25 m wide on each side and
/// walk 1.4 m/s.
struct FloorTask {
  std::unique_ptr<planner::Ways> ways;
  std::unique_ptr<planner::MotionFloor> floor;
  planner::MotionTask task;
};

[[nodiscard]] inline FloorTask task_on(int columns, int rows, const std::vector<Cell>& blocked, std::vector<Point> from,
                                       std::vector<Point> to, double duration_s,
                                       std::vector<MovingObstacle> moving = {}) {
  FloorTask out;
  Stage stage;
  stage.grid = *Grid::make(GridKind::square, columns, rows, 1);
  for (const Cell cell : blocked) stage.blocked.push_back(stage.grid.index(cell));
  std::sort(stage.blocked.begin(), stage.blocked.end());
  out.ways = std::make_unique<planner::Ways>(stage, 0.25);
  out.floor = std::make_unique<planner::MotionFloor>(*out.ways, std::move(moving), TempoMap(60), kStart);
  planner::MotionTask& task = out.task;
  task.from = std::move(from);
  task.to = std::move(to);
  task.group.assign(task.from.size(), planner::kNoGroup);
  task.radius_m.assign(task.from.size(), 0.25);
  task.speed_mps.assign(task.from.size(), 1.4);
  for (double at_s = 0; at_s < duration_s; at_s += 0.5) task.at_s.push_back(at_s);
  task.at_s.push_back(duration_s);
  task.floor = out.floor.get();
  return out;
}

/// Centres of the cells of a rectangle, every `step`-th column and row.
[[nodiscard]] inline std::vector<Point> block_of(const Grid& grid, Cell first, int columns, int rows, int step = 1) {
  std::vector<Point> out;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      out.push_back(grid.centre(Cell{first.column + column * step, first.row + row * step}));
    }
  }
  return out;
}

}  // namespace footlight::tests
