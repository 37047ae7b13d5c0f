// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "planner/joint/time_flow.hpp"
#include "planner/schedule/ways.hpp"

namespace footlight::planner {

/// Walks to and from the reserve are kinds of their own.
enum Border : std::uint8_t { kWithin, kOut, kIn, kBorders };

/// The floor cut into squares of `factor` x `factor` pitches, each of which is one place of a flow: what coarse prices
/// are found on. With a factor of 1 every cell is a block, of whatever kind the grid is.
class Blocks {
 public:
  /// @param reserve one flag a cell
  Blocks(const Ways& ways, const CellFlags& reserve, int factor);

  [[nodiscard]] int factor() const { return factor_; }
  [[nodiscard]] std::size_t size() const { return centres_.size(); }
  /// How many cells one block stands for: so many people are one unit of flow.
  [[nodiscard]] double cells_each() const { return cells_each_; }
  [[nodiscard]] std::uint32_t block_of(std::size_t cell) const { return block_of_[cell]; }
  /// Of each block: most of its cells are in the reserve.
  [[nodiscard]] bool waits(std::size_t block) const { return waits_[block] != 0; }
  /// Means over what the cells of each block have; cells that nobody can stand on count as 0.
  template <class T>
  [[nodiscard]] std::vector<T> mean(const std::vector<T>& of_cells) const {
    if (factor_ == 1) return of_cells;
    std::vector<T> out(size(), T{0});
    for (std::size_t c = 0; c < of_cells.size(); ++c) {
      if (ways_.can_stand(CellIndex::of(c))) out[block_of_[c]] += of_cells[c] / static_cast<T>(cells_each_);
    }
    return out;
  }
  /// Numbers of the blocks, at their centres, in between: one for each cell.
  [[nodiscard]] std::vector<float> at_cells(const std::vector<float>& of_blocks) const;

  /// Walks of at most `reach_m`, clear of blocked cells; squares a block apart are joined in any case.
  [[nodiscard]] Reach reach(double reach_m);
  /// Of the walks found so far, in pitches: the square of the length of each kind / kBorders.
  [[nodiscard]] const std::vector<double>& squares() const { return squares_; }

 private:
  [[nodiscard]] std::vector<std::uint32_t> near(std::uint32_t block, double reach_m) const;
  [[nodiscard]] std::uint8_t kind_of(double length_m, Border border);

  const Ways& ways_;
  const Grid& grid_;
  int factor_;
  double side_m_;
  double left_m_ = 0;
  double front_m_ = 0;
  int columns_ = 0;
  int rows_ = 0;
  double cells_each_ = 1;
  std::vector<std::uint32_t> block_of_;
  std::vector<Point> centres_;
  std::vector<CellIndex> stands_on_;  ///< the cell of each block from which ways are looked for
  CellFlags usable_;
  CellFlags waits_;
  std::map<long long, std::size_t> lengths_;  ///< thousandths of a pitch, and their number
  std::vector<double> squares_;
};

}  // namespace footlight::planner
