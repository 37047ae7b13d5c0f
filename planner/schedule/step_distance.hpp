// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "planner/schedule/ways.hpp"

namespace footlight::planner {

/// Somebody on a cell with a goal.
struct Walker {
  std::int16_t column = 0;
  std::int16_t row = 0;
  std::int16_t goal_column = 0;
  std::int16_t goal_row = 0;

  [[nodiscard]] bool home() const { return column == goal_column && row == goal_row; }
};

/// A few neighbouring cells, by index.
class NextCells {
 public:
  void add(std::int32_t cell) { cells_[size_++] = cell; }
  [[nodiscard]] const std::int32_t* begin() const { return cells_.data(); }
  [[nodiscard]] const std::int32_t* end() const { return cells_.data() + size_; }

 private:
  std::array<std::int32_t, 6> cells_;
  std::uint32_t size_ = 0;
};

/// How many steps over neighbouring cells there are between two cells, where nothing stands in the way.
[[nodiscard]] int steps_between(GridKind kind, Cell a, Cell b);

/// Steps to goals on a stage. Keeps what it has searched.
class StepDistance {
 public:
  /// Searched distances that are kept at once: half a gigabyte.
  static constexpr std::size_t kMostKept = std::size_t{1} << 28U;

  explicit StepDistance(const Ways& ways);

  /// Whether the goal can be reached over neighbouring cells at all, and the memory for it allowed.
  [[nodiscard]] bool reachable(const Walker& walker);
  /// Neighbouring cells that are a step nearer to the goal, ascending; at least one for a goal that can be reached and
  /// is not here.
  [[nodiscard]] NextCells nearer(const Walker& walker);
  /// Steps from a cell to a goal that can be reached; a large number from where it cannot.
  [[nodiscard]] int steps(CellIndex from, CellIndex goal);
  /// Whether one can step from a cell to a neighbouring one.
  [[nodiscard]] bool linked(CellIndex from, CellIndex to) const;

 private:
  using Field = std::vector<std::uint16_t>;
  [[nodiscard]] bool free_rectangle(const Walker& walker) const;
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(grid_.columns()) + static_cast<std::size_t>(column);
  }
  const Field& field(std::size_t goal);
  void link_cells();
  void count_blocked();

  const Ways& ways_;
  const Grid& grid_;
  bool open_;
  std::vector<std::array<std::int32_t, 6>> links_;  // of each cell, the cells one step away; -1: none; blocked stages
  std::vector<std::uint32_t> blocked_sums_;         // (columns + 1) x (rows + 1), cells nobody can stand on; squares
  std::unordered_map<std::size_t, Field> fields_;   // of each goal that was searched
};

}  // namespace footlight::planner
