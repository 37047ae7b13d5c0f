// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <cairo.h>

#include "core/grid.hpp"

namespace footlight::app {

struct Ink {
  double red, green, blue;
  double alpha = 1;
};

/// Where the floor's metres lie on the paper's pixels: downstage at the bottom, stage right on the left.
struct Frame {
  Point low;  ///< downstage right corner, m
  Point high;
  double scale = 1;  ///< pixels a metre

  explicit Frame(const Grid& grid);
  [[nodiscard]] double width_px() const { return (high.x - low.x) * scale; }
  [[nodiscard]] double height_px() const { return (high.y - low.y) * scale; }
  [[nodiscard]] Point at(Point metres) const;
};

/// A sheet with room for a floor, for a title above and a legend below, and the strokes that a picture is made of.
/// Colours stay as they were set last by `ink`.
class Paper {
 public:
  static constexpr double kLeftPx = 56;
  static constexpr double kRightPx = 24;
  static constexpr double kTopPx = 84;
  static constexpr double kBottomPx = 118;
  static constexpr double kNarrowestPx = 760;  ///< of a floor: its legend needs the room

  explicit Paper(const Grid& grid, Ink ground);

  [[nodiscard]] const Frame& frame() const { return frame_; }
  [[nodiscard]] int width_px() const { return width_; }
  [[nodiscard]] int height_px() const { return height_; }
  [[nodiscard]] cairo_t* cairo() const { return cairo_.get(); }

  void ink(Ink colour);
  /// The outline of a cell becomes part of the path.
  void cell_path(const Grid& grid, CellIndex cell);
  /// A line between two points of the floor, in metres, becomes part of the path.
  void line(Point from, Point to);
  void disc(Point at, double radius_px);
  /// @param radius_px of its outer edge
  void ring(Point at, double radius_px, double width_px);
  void cross(Point at, double radius_px);
  /// @param anchor 0: starts at x, 0.5: centred, 1: ends there
  void text(const std::string& words, Point at, double size, Ink colour, double anchor, bool bold = false);
  [[nodiscard]] double width_of(const std::string& words, double size, bool bold = false) const;
  /// The words as they fit into the width: whole, the first word, its beginning, or nothing.
  [[nodiscard]] std::string shortened(const std::string& words, double size, double width_px) const;

  [[nodiscard]] std::string png() const;

 private:
  struct DestroySurface {
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  };
  struct DestroyContext {
    void operator()(cairo_t* context) const { cairo_destroy(context); }
  };
  Frame frame_;
  int width_;
  int height_;
  std::unique_ptr<cairo_surface_t, DestroySurface> surface_;
  std::unique_ptr<cairo_t, DestroyContext> cairo_;
};

}  // namespace footlight::app
