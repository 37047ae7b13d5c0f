// SPDX-License-Identifier: Apache-2.0
#include "planner/formation/part_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "core/check.hpp"
#include "planner/formation/cell_shares.hpp"
#include "planner/formation/relax.hpp"
#include "planner/formation/shapes.hpp"
#include "planner/formation/spread.hpp"

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

Point middle_on_floor(const PartTask& task) {
  const Box floor = picture_floor(*task.stage);
  return task.part->at.value_or(Point{(floor.x0 + floor.x1) / 2, (floor.y0 + floor.y1) / 2});
}

/// Turned and moved to where the part is.
void lay_down(const PartTask& task, std::vector<Point>& points) {
  const Point at = middle_on_floor(task);
  const double c = std::cos(task.part->turn_rad);
  const double s = std::sin(task.part->turn_rad);
  for (Point& p : points) p = at + Point{c * p.x - s * p.y, s * p.x + c * p.y};
}

/// Metres for a unit of something of this extent, so that it keeps within the part's width and height; 0: it has none.
double fitting_scale(const Part& part, double width, double height) {
  double scale = 0;
  if (part.width_m > 0 && width > 0) scale = part.width_m / width;
  if (part.height_m > 0 && height > 0) {
    scale = scale > 0 ? std::min(scale, part.height_m / height) : part.height_m / height;
  }
  return scale;
}

std::string file_name(const std::string& path) { return std::filesystem::path(path).filename().string(); }

std::string nothing_drawn(const Part& part) {
  const auto* picture = std::get_if<Picture>(&part.drawing);
  if (picture == nullptr) return "nothing is drawn by " + part_name(part);
  const PictureOptions& options = picture->options;
  std::string which = options.invert ? "dark enough" : "bright enough";
  if (options.colour) {
    which = std::string(options.invert ? "outside of " : "between ") + to_text(options.colour->from) + " and " +
            to_text(options.colour->to);
  }
  return "no pixel of '" + file_name(picture->path) + "' is " + which;
}

/// The picture's middle at the part's, upright and then turned.
StageToFrame map_of(const PartTask& task, const Box& extent, double pixels_a_metre) {
  const Point at = middle_on_floor(task);
  const double c = pixels_a_metre * std::cos(task.part->turn_rad);
  const double s = pixels_a_metre * std::sin(task.part->turn_rad);
  const Point middle{(extent.x0 + extent.x1) / 2, (extent.y0 + extent.y1) / 2};
  // x = c dx + s dy, y = -(-s dx + c dy), rows counting downward
  return {c, s, middle.x - c * at.x - s * at.y, s, -c, middle.y - s * at.x + c * at.y};
}

Result<PartPoints, PartError> picture_points(const PartTask& task, double spacing_m) {
  const Mask& picture = *task.picture;
  const auto extent = picture_extent({&picture});
  if (!extent) return PartError{nothing_drawn(*task.part), "another threshold or other colours"};
  double scale = fitting_scale(*task.part, extent->width(), extent->height());
  if (scale == 0) scale = spacing_m / std::sqrt(static_cast<double>(picture_area(picture)) / task.people);
  PartPoints out;
  out.points = fill_picture(picture, task.people, task.seed);
  const Point middle{(extent->x0 + extent->x1) / 2, (extent->y0 + extent->y1) / 2};
  for (Point& p : out.points) p = {scale * (p.x - middle.x), scale * (middle.y - p.y)};
  lay_down(task, out.points);
  const auto shares = cell_shares(picture, task.stage->grid, map_of(task, *extent, 1 / scale));
  out.only.resize(shares.size());
  int room = 0;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    out.only[i] = shares[i] > 0 && (*task.usable)[i] != 0 ? 1 : 0;
    room += out.only[i];
  }
  // As many people as cells with picture in them stand a cell apart; of more each would have less.
  out.apart_m = room >= task.people ? task.apart_m : task.apart_m * std::sqrt(static_cast<double>(room) / task.people);
  return out;
}

Result<PartPoints, PartError> mesh_points(const PartTask& task, const Mesh& mesh, double spacing_m) {
  std::vector<Point> corners = projected(mesh);
  Box extent{1e300, 1e300, -1e300, -1e300};
  for (const Point p : corners) {
    extent = {std::min(extent.x0, p.x), std::min(extent.y0, p.y), std::max(extent.x1, p.x), std::max(extent.y1, p.y)};
  }
  const auto wanted = static_cast<std::size_t>(task.people);
  double scale = fitting_scale(*task.part, extent.width(), extent.height());
  if (scale == 0) {
    const double wide = std::max({extent.width(), extent.height(), 1e-9});
    for (Point& p : corners) p = (1 / wide) * p;  // thinning knows no distances below a micrometre
    extent = {extent.x0 / wide, extent.y0 / wide, extent.x1 / wide, extent.y1 / wide};
    const auto thinned = thin(corners, wanted, 0);
    scale = thinned.size() > 1 ? spacing_m / least_distance(thinned) : 1.0;
  }
  const Point middle{(extent.x0 + extent.x1) / 2, (extent.y0 + extent.y1) / 2};
  for (Point& p : corners) p = scale * (p - middle);
  PartPoints out;
  out.points = thin(corners, wanted, task.apart_m * (1 - 1e-6));
  out.apart_m = task.apart_m;
  if (out.points.size() < wanted) {
    out.points = thin(corners, wanted, 0);
    if (out.points.size() < wanted) {
      return PartError{part_name(*task.part) + " has " + std::to_string(out.points.size()) +
                           " different corners as seen from here, and " + std::to_string(wanted) + " people",
                       "a finer mesh, another view, or fewer people"};
    }
    out.apart_m = least_distance(out.points);
  }
  lay_down(task, out.points);
  return out;
}

}  // namespace

std::vector<Point> projected(const Mesh& mesh) {
  std::vector<Point> out;
  out.reserve(mesh.vertices.size());
  for (const auto& [x, y, z] : mesh.vertices) {
    out.push_back(mesh.view == Mesh::View::top     ? Point{x, -z}
                  : mesh.view == Mesh::View::front ? Point{x, y}
                                                   : Point{-z, y});
  }
  return out;
}

Result<PartPoints, PartError> part_points(const PartTask& task) {
  const double spacing_m = task.part->spacing_m > 0 ? task.part->spacing_m : kLoose * task.apart_m;
  if (const auto* mesh = std::get_if<Mesh>(&task.part->drawing)) return mesh_points(task, *mesh, spacing_m);
  if (task.part->needs_picture()) {
    FL_CHECK(task.picture != nullptr);
    return picture_points(task, spacing_m);
  }
  Laid laid = lay_shape(std::get<Shape>(task.part->drawing), *task.part, task.people, spacing_m);
  PartPoints out;
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
