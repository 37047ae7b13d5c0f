// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/grid.hpp"
#include "planner/formation/placement.hpp"

namespace footlight::planner {

/// A fixed even order of the cells (Bayer's ordered dither, 64 x 64): any first part of it is spread evenly over the
/// floor, and the same in every frame, so that thinning moves nobody. One rank a cell.
[[nodiscard]] std::vector<std::uint32_t> even_ranks(const Grid& grid);

/// What one frame draws.
struct Drawing {
  std::vector<CellIndex> cells;  ///< ascending, exactly `people`, unless fewer are usable
  int in_picture = 0;            ///< chosen cells with picture in them
  int touched = 0;               ///< usable cells with picture in them, chosen or not
  int full = 0;                  ///< cells that the picture fills by area, before the number was settled
};

struct DrawingTask {
  const Grid* grid = nullptr;
  const std::vector<double>* shares = nullptr;        ///< picture in each cell
  const CellFlags* usable = nullptr;                  ///< cells that may be chosen
  const std::vector<std::uint32_t>* ranks = nullptr;  ///< even_ranks
  int most = 0;                                       ///< people there are
  int least = 0;                                      ///< people who must be drawn because the reserve cannot hold them
  std::span<const CellIndex> when_blank;              ///< the picture to widen when this one is blank; may be empty
};

/// The cells of a frame (Li 2020 Eq. 5-6): as many as the picture's area fills, within [least, most]. They are the
/// cells with the most picture, so T_g is the share of the last one chosen; among cells with equal shares an even
/// pattern decides. Where there must be more people than cells with picture the picture is widened by the cells nearest
/// to it. O(cells); where it is widened O(cells log cells)
[[nodiscard]] Drawing draw(const DrawingTask& task);

/// Who waits where from frame to frame.
struct WaitingTask {
  const Grid* grid = nullptr;
  const std::vector<CellIndex>* reserve = nullptr;  ///< ascending; cells that can be stood on
  const std::vector<Drawing>* drawings = nullptr;   ///< one a frame
  int people = 0;
};

/// The reserve cells that are occupied in each frame: at first the ones nearest to all pictures together, then as few
/// changes as the number of people allows, always at the cells nearest to the frame's own picture, so that who enters
/// and who leaves has the shortest way. @return for each frame ascending cells; a drawing and its waiting cells are
/// `people` together. O(frames x (cells + reserve x
/// (rows + log reserve)))
[[nodiscard]] std::vector<std::vector<CellIndex>> waiting_places(const WaitingTask& task);

}  // namespace footlight::planner
