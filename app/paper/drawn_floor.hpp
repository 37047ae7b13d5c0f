// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "app/paper/canvas.hpp"
#include "core/film.hpp"
#include "core/plan.hpp"
#include "core/stage.hpp"

namespace footlight::app {

/// Where the floor's metres lie on a canvas: downstage at the bottom, stage right on the left.
struct Frame {
  Point low;  ///< downstage right corner, m
  Point high;
  Point corner;      ///< of the floor on the canvas, upstage right
  double scale = 1;  ///< of the canvas a metre

  /// The floor as large as it fits into the box.
  Frame(const Grid& grid, Point corner, double width, double height);
  [[nodiscard]] double width() const { return (high.x - low.x) * scale; }
  [[nodiscard]] double height() const { return (high.y - low.y) * scale; }
  [[nodiscard]] Point at(Point metres) const {
    return {corner.x + (metres.x - low.x) * scale, corner.y + (high.y - metres.y) * scale};
  }
};

/// Colours of a floor: on a dark screen, or on white paper.
struct Theme {
  Ink ground, floor, wings, line, tenth_line, centre_line, film, blocked, text, faint, refused;
  double pen;  ///< of lines
};
extern const Theme kOnScreen;
extern const Theme kOnPaper;

/// Draws the floor of a stage. Borrows everything.
class DrawnFloor {
 public:
  DrawnFloor(Canvas& canvas, const Frame& frame, const Stage& stage, const Theme& theme)
      : canvas_(canvas), frame_(frame), stage_(stage), grid_(stage.grid), theme_(theme) {}

  /// @param reserve cells that are shaded
  void ground(const std::vector<CellIndex>& reserve) const;
  /// What a film shows, where its placement lays it.
  void film(const Mask& picture, const StageToFrame& placement) const;
  /// The edges of cells; every tenth and the centre line stronger.
  void lines() const;
  void blocked() const;
  /// Letters below the columns and numbers beside the rows, as many as there is room for.
  void labels(double size) const;

 private:
  void cell_path(CellIndex cell) const;
  void line(Point from, Point to) const;

  Canvas& canvas_;
  const Frame& frame_;
  const Stage& stage_;
  const Grid& grid_;
  const Theme& theme_;
};

}  // namespace footlight::app
