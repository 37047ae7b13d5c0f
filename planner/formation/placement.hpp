// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/film.hpp"
#include "core/plan.hpp"
#include "core/show.hpp"

namespace footlight::planner {

/// A rectangle in metres or in pixels.
struct Box {
  double x0 = 0;
  double y0 = 0;
  double x1 = 0;
  double y1 = 0;

  [[nodiscard]] double width() const { return x1 - x0; }
  [[nodiscard]] double height() const { return y1 - y0; }
  friend bool operator==(const Box&, const Box&) = default;
};

/// Where pictures go: one flag a cell, neither blocked nor reserve nor too near to a blocked cell to stand on.
using CellFlags = std::vector<char>;

/// The largest rectangle of cells, metres, that holds no reserve cell: where pictures lie. The whole floor where all of
/// it is reserve. O(cells)
[[nodiscard]] Box picture_floor(const Stage& stage);

/// Bounding box of the picture's pixels over some masks; nothing when all of them are blank. O(pixels / 64)
[[nodiscard]] std::optional<Box> picture_extent(const std::vector<const Mask*>& masks);

/// A picture on the stage.
struct Placement {
  StageToFrame map{};
  double drawn_share = 1;  ///< of the length that `fit` asks for; below 1 when it had to be made smaller to fit
};

struct PlacementTask {
  const Stage* stage = nullptr;
  const CellFlags* usable = nullptr;  ///< for pictures
  Fit fit = Fit::area;
  const Mask* largest = nullptr;  ///< the key frame with the most picture
  Box extent;                     ///< of all key frames, pixels
  int people = 1;
};

/// Lays a picture on the floor, one map for a whole section: the scale as `fit` asks, the extent (area) or the frame
/// (contain, cover) in the middle of `picture_floor`, then the offset of Li 2020 Eq. 5-6 within half a cell by steepest
/// descent on the largest key frame. Where `area` does not fit beside reserve and blocked cells the picture is made
/// smaller until it does. Complexity: O(cells) a trial, about fifty trials.
[[nodiscard]] Placement place_picture(const PlacementTask& task);

}  // namespace footlight::planner
