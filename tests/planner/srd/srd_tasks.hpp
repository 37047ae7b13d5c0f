// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "planner/motion/crowd.hpp"

namespace footlight::planner::test {

/// A floor with its own stage, that a task can point to.
struct TaskFloor {
  explicit TaskFloor(int columns = 60, int rows = 40, const std::vector<Cell>& blocked = {},
                     std::vector<MovingObstacle> moving = {}, std::optional<Terrain> ground = {})
      : terrain(std::move(ground)) {
    stage.grid = *Grid::make(GridKind::square, columns, rows, 1.0);
    for (const Cell cell : blocked) stage.blocked.push_back(stage.grid.index(cell));
    std::sort(stage.blocked.begin(), stage.blocked.end());
    ways = std::make_unique<Ways>(stage, 0.25);
    floor =
        std::make_unique<MotionFloor>(*ways, std::move(moving), TempoMap(60), Instant{}, terrain ? &*terrain : nullptr);
  }
  Stage stage;
  std::optional<Terrain> terrain;
  std::unique_ptr<Ways> ways;
  std::unique_ptr<MotionFloor> floor;
};

/// Ground from a row of pixels, from stage right to stage left; white leaves half of everybody's speed.
inline Terrain ground_of(std::vector<std::uint8_t> grey) {
  Terrain out;
  out.slowest = 0.5;
  out.width = static_cast<int>(grey.size());
  out.height = 1;
  out.grey = std::move(grey);
  return out;
}

inline std::vector<Point> block(Point corner, int columns, int rows, double spacing_m = 1) {
  std::vector<Point> out;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) out.push_back(corner + Point{x * spacing_m, y * spacing_m});
  }
  return out;
}

/// Adds a group that shall be led from some places to others.
inline void add_group(MotionTask& task, std::uint32_t group, const std::vector<Point>& from,
                      const std::vector<Point>& to) {
  task.from.insert(task.from.end(), from.begin(), from.end());
  task.to.insert(task.to.end(), to.begin(), to.end());
  task.group.insert(task.group.end(), from.size(), group);
  task.to_group.insert(task.to_group.end(), to.size(), group);
  task.radius_m.insert(task.radius_m.end(), from.size(), 0.25);
  task.speed_mps.insert(task.speed_mps.end(), from.size(), 1.4);
}

inline MotionTask task_on(const TaskFloor& floor, double duration_s) {
  MotionTask task;
  task.floor = floor.floor.get();
  for (double at = 0; at < duration_s; at += 0.5) task.at_s.push_back(at);
  task.at_s.push_back(duration_s);
  return task;
}

/// Two blocks of columns x rows that walk through each other, and back to the same formation on the other side.
inline MotionTask crossing(const TaskFloor& floor, int columns, int rows, double duration_s, double spacing_m = 1) {
  MotionTask task = task_on(floor, duration_s);
  const Point left{-20, 15};
  const Point right{12, 15};
  add_group(task, 0, block(left, columns, rows, spacing_m), block(right, columns, rows, spacing_m));
  add_group(task, 1, block(right, columns, rows, spacing_m), block(left, columns, rows, spacing_m));
  return task;
}

}  // namespace footlight::planner::test
