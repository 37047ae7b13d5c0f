// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/paper/drawn_floor.hpp"
#include "core/grid.hpp"

namespace footlight::app {

/// From where a stage is seen.
enum class Seat {
  above,     ///< downstage at the bottom
  audience,  ///< a high seat in front of the centre line
};

/// Where places of the stage lie on a canvas, seen from a seat.
class View {
 public:
  /// The stage as large as it fits into the box.
  View(Seat seat, const Grid& grid, Point corner, double width, double height);

  /// @param height_m above the floor
  [[nodiscard]] Point at(Point floor, double height_m = 0) const;
  /// How much a metre across is on the canvas, there.
  [[nodiscard]] double scale_at(Point floor) const;
  /// How far away, for who is drawn first; larger is farther.
  [[nodiscard]] double depth_of(Point floor) const;
  [[nodiscard]] Seat seat() const { return seat_; }
  [[nodiscard]] const Frame& frame() const { return frame_; }  ///< of the view from above

 private:
  struct Ray {
    double across, up, depth;
  };
  [[nodiscard]] Ray ray_to(Point floor, double height_m) const;

  Seat seat_;
  Frame frame_;
  Point eye_;   ///< distance from the downstage edge and height, m
  Point look_;  ///< unit vector upstage and upwards
  double scale_ = 1;
  Point middle_;  ///< of the canvas, for a ray straight ahead
};

}  // namespace footlight::app
