// SPDX-License-Identifier: Apache-2.0
#include "app/paper/drawn_floor.hpp"

#include <algorithm>
#include <string>

namespace footlight::app {

const Theme kOnScreen{{0.055, 0.065, 0.08}, {0.10, 0.115, 0.14},  {0.07, 0.08, 0.10},       {1, 1, 1, 0.055},
                      {1, 1, 1, 0.15},      {1, 0.85, 0.4, 0.45}, {0.45, 0.62, 0.85, 0.30}, {0.75, 0.25, 0.22, 0.8},
                      {0.90, 0.92, 0.95},   {0.62, 0.66, 0.72},   {1.0, 0.35, 0.3},         1};
const Theme kOnPaper{{1, 1, 1},
                     {1, 1, 1},
                     {0.93, 0.93, 0.93},
                     {0, 0, 0, 0.10},
                     {0, 0, 0, 0.35},
                     {0.70, 0.35, 0, 0.9},
                     {0.35, 0.55, 0.85, 0.30},
                     {0.70, 0.15, 0.12, 0.8},
                     {0.05, 0.05, 0.05},
                     {0.38, 0.38, 0.38},
                     {0.80, 0.05, 0.05},
                     0.4};

Frame::Frame(const Grid& grid, Point top_left, double width, double height)
    : low(grid.centre(CellIndex(0))), high(low), corner(top_left) {
  // The hull of the four edges' cells is the hull of the floor.
  for (int row = 0; row < grid.rows(); ++row) {
    const bool whole = row < 2 || row >= grid.rows() - 2;
    for (int column = 0; column < grid.columns(); ++column) {
      if (!whole && column == 2) column = std::max(column, grid.columns() - 2);
      if (column >= grid.columns()) break;
      for (const Point of_cell : grid.outline(grid.index({column, row}))) {
        low = {std::min(low.x, of_cell.x), std::min(low.y, of_cell.y)};
        high = {std::max(high.x, of_cell.x), std::max(high.y, of_cell.y)};
      }
    }
  }
  scale = std::min(width / (high.x - low.x), height / (high.y - low.y));
}

void DrawnFloor::cell_path(CellIndex cell) const {
  cairo_new_sub_path(canvas_.cairo());
  for (const Point corner : grid_.outline(cell)) {
    const Point at = frame_.at(corner);
    cairo_line_to(canvas_.cairo(), at.x, at.y);
  }
  cairo_close_path(canvas_.cairo());
}

void DrawnFloor::line(Point from, Point to) const { canvas_.stroke_line(frame_.at(from), frame_.at(to), theme_.pen); }

void DrawnFloor::ground(const std::vector<CellIndex>& reserve) const {
  cairo_t* c = canvas_.cairo();
  canvas_.ink(theme_.floor);
  if (grid_.kind() == GridKind::square) {
    canvas_.fill_box(frame_.corner, frame_.width(), frame_.height());
  } else {
    for (int i = 0; i < grid_.size(); ++i) cell_path(CellIndex::of(i));
    cairo_fill(c);
  }
  canvas_.ink(theme_.wings);
  for (const CellIndex cell : reserve) cell_path(cell);
  cairo_fill(c);
}

void DrawnFloor::film(const Mask& picture, const StageToFrame& m) const {
  const int stride = cairo_format_stride_for_width(CAIRO_FORMAT_A8, picture.width());
  std::vector<unsigned char> pixels(static_cast<std::size_t>(stride) * static_cast<std::size_t>(picture.height()));
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      if (picture.at(x, y))
        pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(stride) + static_cast<std::size_t>(x)] = 255;
    }
  }
  cairo_surface_t* source =
      cairo_image_surface_create_for_data(pixels.data(), CAIRO_FORMAT_A8, picture.width(), picture.height(), stride);
  cairo_t* c = canvas_.cairo();
  cairo_save(c);
  cairo_rectangle(c, frame_.corner.x, frame_.corner.y, frame_.width(), frame_.height());
  cairo_clip(c);
  // From the canvas to metres to the film's pixels.
  const double s = 1 / frame_.scale;
  const double x0 = frame_.low.x - frame_.corner.x * s;
  const double y0 = frame_.high.y + frame_.corner.y * s;
  cairo_matrix_t to_film;
  cairo_matrix_init(&to_film, m[0] * s, m[3] * s, -m[1] * s, -m[4] * s, m[0] * x0 + m[1] * y0 + m[2],
                    m[3] * x0 + m[4] * y0 + m[5]);
  cairo_pattern_t* pattern = cairo_pattern_create_for_surface(source);
  cairo_pattern_set_matrix(pattern, &to_film);
  canvas_.ink(theme_.film);
  cairo_mask(c, pattern);
  cairo_pattern_destroy(pattern);
  cairo_surface_destroy(source);
  cairo_restore(c);
}

void DrawnFloor::lines() const {
  cairo_t* c = canvas_.cairo();
  if (grid_.kind() == GridKind::square) {
    const double p = grid_.pitch_m();
    for (int column = 0; column <= grid_.columns(); ++column) {
      canvas_.ink(column % 10 == 0 ? theme_.tenth_line : theme_.line);
      line({frame_.low.x + column * p, frame_.low.y}, {frame_.low.x + column * p, frame_.high.y});
    }
    for (int row = 0; row <= grid_.rows(); ++row) {
      canvas_.ink(row % 10 == 0 ? theme_.tenth_line : theme_.line);
      line({frame_.low.x, frame_.low.y + row * p}, {frame_.high.x, frame_.low.y + row * p});
    }
  } else {
    canvas_.ink(theme_.line);
    for (int i = 0; i < grid_.size(); ++i) cell_path(CellIndex::of(i));
    cairo_set_line_width(c, theme_.pen);
    cairo_stroke(c);
  }
  canvas_.ink(theme_.centre_line);
  line({0, frame_.low.y}, {0, frame_.high.y});
}

void DrawnFloor::blocked() const {
  for (const CellIndex cell : stage_.blocked) {
    canvas_.ink({theme_.blocked.red, theme_.blocked.green, theme_.blocked.blue, 0.25});
    cell_path(cell);
    cairo_fill(canvas_.cairo());
    canvas_.ink(theme_.blocked);
    canvas_.cross(frame_.at(grid_.centre(cell)), 0.32 * grid_.pitch_m() * frame_.scale);
  }
}

void DrawnFloor::labels(double size) const {
  const auto step_for = [](double cell, double room) {
    for (const int step : {1, 2, 5, 10, 20, 50, 100, 200, 500}) {
      if (step * cell >= room) return step;
    }
    return 1000;
  };
  const int columns = step_for(frame_.width() / grid_.columns(), 2.5 * size);
  for (int column = 0; column < grid_.columns(); column += columns) {
    const std::string name = cell_name({column, 0});
    const Point at = frame_.at(grid_.centre(Cell{column, 0}));
    canvas_.text(name.substr(0, name.size() - 1), {at.x, frame_.corner.y + frame_.height() + 4.0 / 3 * size}, size,
                 theme_.faint, 0.5);
  }
  const int rows = step_for(frame_.height() / grid_.rows(), 1.5 * size);
  for (int row = 0; row < grid_.rows(); row = row == 0 && rows > 1 ? rows - 1 : row + rows) {
    const Point at = frame_.at(grid_.centre(Cell{0, row}));
    canvas_.text(std::to_string(row + 1), {frame_.corner.x - 2.0 / 3 * size, at.y + size / 3}, size, theme_.faint, 1);
  }
}

}  // namespace footlight::app
