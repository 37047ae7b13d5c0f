// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "planner/painted/raster.hpp"

namespace footlight::planner {

/// An incompressible flow without viscosity in the pixels of a stroke, driven along it.
///
/// Source: Kang, Kim 2014, Eq. 4: u_t = -(u . grad) u - grad p + f, div u = 0; solved as Stam, "Stable Fluids",
/// SIGGRAPH 1999, sections 2-3: force, advection along the flow backwards, projection; on a staggered grid (Harlow,
/// Welch 1965), the pressure by conjugate gradients. The paper leaves f open: here it is (wanted velocity - u) /
/// reaction, so that the flow tends to the stroke's field and no friction is needed. What is neither fluid nor open is
/// wall; in open pixels, the shapes that a stroke joins, the pressure is 0.
class GridFlow {
 public:
  enum class Pixel : std::uint8_t { wall, fluid, open };
  struct State {
    Raster<double> across;    ///< px/s to the right, on the left side of each pixel; one column more than pixels
    Raster<double> down;      ///< px/s downwards, on the upper side of each pixel; one row more
    Raster<double> pressure;  ///< where the next solution begins
    bool steady = false;      ///< nothing changes any more
  };

  /// @param wanted velocity in px/s in each pixel  @param reaction_s > 0
  GridFlow(Raster<Pixel> pixels, Raster<Point> wanted, double reaction_s);

  [[nodiscard]] State begin() const;
  /// @param next a copy of `now`  O(fluid pixels x iterations of the pressure)
  void step(const State& now, State& next, double step_s) const;
  /// Between the faces, px/s; 0 in walls.
  [[nodiscard]] Point velocity(const State& state, Point pixel) const;
  /// Largest net outflow of a fluid pixel, px/s.
  [[nodiscard]] double divergence(const State& state) const;

 private:
  struct Face {
    int x = 0;
    int y = 0;
  };
  [[nodiscard]] Pixel pixel(int x, int y) const { return pixels_.inside(x, y) ? pixels_.at(x, y) : Pixel::wall; }
  [[nodiscard]] static Point flow(const State& state, Point at);
  void project(State& state, double step_s) const;
  [[nodiscard]] double outflow(const State& state, Face at) const;

  Raster<Pixel> pixels_;
  Raster<Point> wanted_;
  double reaction_s_;
  std::vector<Face> fluid_;   ///< pixels
  std::vector<Face> across_;  ///< faces that are no wall
  std::vector<Face> down_;
  struct Row {
    double diagonal = 0;
    std::int32_t neighbour[4] = {-1, -1, -1, -1};  // in fluid_
  };
  std::vector<Row> rows_;  ///< of the Laplacian, for each fluid pixel
};

}  // namespace footlight::planner
