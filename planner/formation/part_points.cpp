// SPDX-License-Identifier: Apache-2.0
#include "planner/formation/part_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "core/check.hpp"
#include "planner/formation/shapes.hpp"

namespace footlight::planner {
namespace {

/// Neighbours of a part without a size, in pitches or clearances.
constexpr double kLoose = 1.5;

template <class... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};
template <class... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

/// Turned and moved to where the part is.
void lay_down(const PartTask& task, std::vector<Point>& points) {
  const Box floor = picture_floor(*task.stage);
  const Point middle{(floor.x0 + floor.x1) / 2, (floor.y0 + floor.y1) / 2};
  const Point at = task.part->at.value_or(middle);
  const double c = std::cos(task.part->turn_rad);
  const double s = std::sin(task.part->turn_rad);
  for (Point& p : points) p = at + Point{c * p.x - s * p.y, s * p.x + c * p.y};
}

std::string file_name(const std::string& path) { return std::filesystem::path(path).filename().string(); }

}  // namespace

Result<PartPoints, PartError> part_points(const PartTask& task) {
  const double spacing_m = task.part->spacing_m > 0 ? task.part->spacing_m : kLoose * task.apart_m;
  PartPoints out;
  const auto* shape = std::get_if<Shape>(&task.part->drawing);
  FL_CHECK(shape != nullptr);
  Laid laid = lay_shape(*shape, *task.part, task.people, spacing_m);
  out.points = std::move(laid.points);
  out.apart_m = laid.apart_m;
  lay_down(task, out.points);
  return out;
}

std::string part_name(const Part& part) {
  constexpr std::array kShapes{"line", "block", "circle", "ring", "arc", "spiral", "wedge", "chevron"};
  return std::visit(
      Overloaded{
          [&](const Shape& shape) { return std::string("the ") + kShapes.at(static_cast<std::size_t>(shape.kind)); },
          [](const Lettering& lettering) { return "the text '" + lettering.text + "'"; },
          [](const Mesh& mesh) { return "the mesh '" + file_name(mesh.path) + "'"; },
          [](const Picture& picture) { return "the picture '" + file_name(picture.path) + "'"; },
      },
      part.drawing);
}

Box whole_floor(const Grid& grid) {
  Box box{1e300, 1e300, -1e300, -1e300};
  // The first and the last two rows and columns have every kind of outline that a grid has at its edges.
  const auto widen = [&](int column, int row) {
    for (const Point p : grid.outline(grid.index({column, row}))) {
      box = {std::min(box.x0, p.x), std::min(box.y0, p.y), std::max(box.x1, p.x), std::max(box.y1, p.y)};
    }
  };
  for (const int row : {0, std::min(1, grid.rows() - 1), std::max(0, grid.rows() - 2), grid.rows() - 1}) {
    for (const int column : {0, std::min(1, grid.columns() - 1), std::max(0, grid.columns() - 2), grid.columns() - 1}) {
      widen(column, row);
    }
  }
  return box;
}

}  // namespace footlight::planner
