// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/terrain.hpp"
#include "planner/motion/crowd.hpp"

namespace footlight::planner::test {

/// A floor of square cells of one metre, and people on it; what a task of a model of motion points to lives here.
class Scene {
 public:
  Scene(int columns, int rows, std::vector<std::string> blocked = {}) {
    stage_.grid = *Grid::make(GridKind::square, columns, rows, 1.0);
    for (const std::string& text : blocked) {
      for (const CellIndex cell : cells(text)) stage_.blocked.push_back(cell);
    }
    std::sort(stage_.blocked.begin(), stage_.blocked.end());
    ways_ = std::make_unique<Ways>(stage_, stage_.clearance_m / 2);
    for (int n = 0; n <= 120; ++n) task_.at_s.push_back(0.5 * n);
    lay_floor();
  }

  [[nodiscard]] std::vector<CellIndex> cells(const std::string& range) const {
    const CellRange r = *parse_cell_range(range);
    std::vector<CellIndex> out;
    for (int row = r.first.row; row <= r.last.row; ++row) {
      for (int column = r.first.column; column <= r.last.column; ++column) {
        out.push_back(stage_.grid.index({column, row}));
      }
    }
    return out;
  }
  [[nodiscard]] Point at(const std::string& cell) const { return stage_.grid.centre(cells(cell).front()); }

  /// People of one group walk from a range of cells to another of as many.
  Scene& send(const std::string& from, const std::string& to, std::uint32_t group = kNoGroup) {
    for (const CellIndex cell : cells(from)) {
      task_.from.push_back(stage_.grid.centre(cell));
      task_.group.push_back(group);
      task_.radius_m.push_back(stage_.clearance_m / 2);
      task_.speed_mps.push_back(1.4);
    }
    for (const CellIndex cell : cells(to)) {
      task_.to.push_back(stage_.grid.centre(cell));
      task_.to_group.push_back(group);
    }
    return *this;
  }
  Scene& moving(MovingObstacle one) {
    moving_.push_back(std::move(one));
    lay_floor();
    return *this;
  }
  Scene& terrain(Terrain terrain) {
    terrain_ = std::make_unique<Terrain>(std::move(terrain));
    lay_floor();
    return *this;
  }
  Scene& path(std::vector<Point> through, std::optional<GroupIndex> group = std::nullopt) {
    task_.paths.push_back({group, std::move(through), {}});
    return *this;
  }

  [[nodiscard]] MotionTask& task() {
    task_.floor = floor_.get();
    return task_;
  }
  [[nodiscard]] const Ways& ways() const { return *ways_; }
  [[nodiscard]] const MotionFloor& floor() const { return *floor_; }
  [[nodiscard]] const Stage& stage() const { return stage_; }

 private:
  void lay_floor() { floor_ = std::make_unique<MotionFloor>(*ways_, moving_, tempo_, tempo_.at(1), terrain_.get()); }

  Stage stage_;
  TempoMap tempo_;                    ///< 120 a minute: count n is at (n - 1) / 2 s
  std::unique_ptr<Terrain> terrain_;  ///< level where nothing
  std::vector<MovingObstacle> moving_;
  std::unique_ptr<Ways> ways_;
  std::unique_ptr<MotionFloor> floor_;
  MotionTask task_;
};

}  // namespace footlight::planner::test
