// SPDX-License-Identifier: Apache-2.0
#include "core/grid.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>

namespace footlight {
namespace {

constexpr double kSqrt3 = std::numbers::sqrt3;

bool points_upstage(Cell cell) { return (cell.column + cell.row) % 2 == 0; }

/// Distance of two rows' centre lines and of two columns' centres, in pitches.
double row_step(GridKind kind) {
  return kind == GridKind::square ? 1.0 : kind == GridKind::hexagonal ? kSqrt3 / 2 : 1.5;
}
double column_step(GridKind kind) { return kind == GridKind::triangular ? kSqrt3 / 2 : 1.0; }

}  // namespace

double length(Point a) { return std::sqrt(squared_length(a)); }

std::string_view to_text(GridKind kind) {
  switch (kind) {
    case GridKind::square:
      return "square";
    case GridKind::hexagonal:
      return "hexagonal";
    case GridKind::triangular:
      return "triangular";
  }
  return "square";
}

std::optional<GridKind> grid_kind_from(std::string_view text) {
  for (const GridKind kind : {GridKind::square, GridKind::hexagonal, GridKind::triangular}) {
    if (text == to_text(kind)) return kind;
  }
  return std::nullopt;
}

std::string cell_name(Cell cell) {
  std::string letters;
  for (int n = cell.column + 1; n > 0; n = (n - 1) / 26) {
    letters.insert(letters.begin(), static_cast<char>('A' + (n - 1) % 26));
  }
  return letters + std::to_string(cell.row + 1);
}

std::optional<Cell> parse_cell(std::string_view text) {
  int column = 0;
  int row = 0;
  std::size_t i = 0;
  for (; i < text.size() && std::isalpha(static_cast<unsigned char>(text[i])) != 0; ++i) {
    column = column * 26 + (std::toupper(static_cast<unsigned char>(text[i])) - 'A' + 1);
    if (column > 100'000) return std::nullopt;
  }
  const std::size_t letters = i;
  for (; i < text.size() && std::isdigit(static_cast<unsigned char>(text[i])) != 0; ++i) {
    row = row * 10 + (text[i] - '0');
    if (row > 100'000) return std::nullopt;
  }
  if (letters == 0 || i == letters || i != text.size() || row == 0) return std::nullopt;
  return Cell{column - 1, row - 1};
}

std::optional<CellRange> parse_cell_range(std::string_view text) {
  const std::size_t colon = text.find(':');
  const auto a = parse_cell(text.substr(0, colon));
  const auto b = colon == std::string_view::npos ? a : parse_cell(text.substr(colon + 1));
  if (!a || !b) return std::nullopt;
  return CellRange{{std::min(a->column, b->column), std::min(a->row, b->row)},
                   {std::max(a->column, b->column), std::max(a->row, b->row)}};
}

Result<Grid> Grid::make(GridKind kind, int columns, int rows, double pitch_m) {
  if (columns < 1 || columns > 4096) return input_error("a grid has 1 to 4096 columns");
  if (rows < 1 || rows > 4096) return input_error("a grid has 1 to 4096 rows");
  if (columns * rows > 4'000'000) return input_error("a grid has at most 4,000,000 cells");
  if (!(pitch_m > 0 && pitch_m <= 100)) return input_error("the pitch lies above 0 m and is at most 100 m");
  Grid grid;
  grid.kind_ = kind;
  grid.columns_ = columns;
  grid.rows_ = rows;
  grid.pitch_m_ = pitch_m;
  return grid;
}

double Grid::cell_area_m2() const {
  const double square = pitch_m_ * pitch_m_;
  switch (kind_) {
    case GridKind::square:
      return square;
    case GridKind::hexagonal:
      return square * kSqrt3 / 2;
    case GridKind::triangular:
      return square * 3 * kSqrt3 / 4;
  }
  return square;
}

Point Grid::centre(Cell cell) const {
  const double column = cell.column - (columns_ - 1) / 2.0;
  const double row = cell.row;
  switch (kind_) {
    case GridKind::square:
      return {column * pitch_m_, (row + 0.5) * pitch_m_};
    case GridKind::hexagonal:
      return {(column + (cell.row % 2 != 0 ? 0.5 : 0.0)) * pitch_m_, (1 / kSqrt3 + row * kSqrt3 / 2) * pitch_m_};
    case GridKind::triangular:
      return {column * pitch_m_ * kSqrt3 / 2, (1.5 * row + (points_upstage(cell) ? 0.5 : 1.0)) * pitch_m_};
  }
  return {};
}

std::vector<CellIndex> Grid::neighbours(CellIndex index) const {
  std::vector<CellIndex> out;
  for (const CellIndex other : within(centre(index), pitch_m_ * 1.01)) {
    if (other != index) out.push_back(other);
  }
  return out;
}

std::vector<Point> Grid::outline(CellIndex index) const {
  const Cell at = cell(index);
  const Point c = centre(at);
  const bool triangle = kind_ == GridKind::triangular;
  const int corners = kind_ == GridKind::square ? 4 : triangle ? 3 : 6;
  const double radius = kind_ == GridKind::square ? pitch_m_ / std::numbers::sqrt2
                        : triangle                ? pitch_m_
                                                  : pitch_m_ / kSqrt3;
  const double turn = kind_ == GridKind::square         ? std::numbers::pi / 4
                      : triangle && !points_upstage(at) ? -std::numbers::pi / 2
                                                        : std::numbers::pi / 2;
  std::vector<Point> out;
  for (int k = 0; k < corners; ++k) {
    const double angle = turn + 2 * std::numbers::pi * k / corners;
    out.push_back({c.x + radius * std::cos(angle), c.y + radius * std::sin(angle)});
  }
  return out;
}

CellIndex Grid::nearest(Point point) const {
  const double rows_up = (point.y / pitch_m_ - (kind_ == GridKind::hexagonal ? 1 / kSqrt3
                                                : kind_ == GridKind::square  ? 0.5
                                                                             : 0.75)) /
                         row_step(kind_);
  const double columns_left = point.x / pitch_m_ / column_step(kind_) + (columns_ - 1) / 2.0;
  const int row0 = static_cast<int>(std::clamp(std::floor(rows_up), 0.0, rows_ - 1.0));
  const int column0 = static_cast<int>(std::clamp(std::floor(columns_left), 0.0, columns_ - 1.0));
  Cell best{column0, row0};
  double best_distance = squared_length(centre(best) - point);
  for (int row = std::max(0, row0 - 1); row <= std::min(rows_ - 1, row0 + 2); ++row) {
    for (int column = std::max(0, column0 - 2); column <= std::min(columns_ - 1, column0 + 2); ++column) {
      const Cell cell{column, row};
      const double d = squared_length(centre(cell) - point);
      if (d < best_distance || (d == best_distance && index(cell) < index(best))) {
        best = cell;
        best_distance = d;
      }
    }
  }
  return index(best);
}

std::vector<CellIndex> Grid::within(Point point, double radius_m) const {
  const double row_m = row_step(kind_) * pitch_m_;
  const double column_m = column_step(kind_) * pitch_m_;
  const int row_first =
      static_cast<int>(std::clamp(std::floor((point.y - radius_m) / row_m) - 1, 0.0, static_cast<double>(rows_)));
  const int row_last = static_cast<int>(std::clamp(std::ceil((point.y + radius_m) / row_m) + 1, -1.0, rows_ - 1.0));
  const double middle = (columns_ - 1) / 2.0;
  const int column_first = static_cast<int>(
      std::clamp(std::floor((point.x - radius_m) / column_m + middle) - 1, 0.0, static_cast<double>(columns_)));
  const int column_last =
      static_cast<int>(std::clamp(std::ceil((point.x + radius_m) / column_m + middle) + 1, -1.0, columns_ - 1.0));
  std::vector<CellIndex> out;
  for (int row = row_first; row <= row_last; ++row) {
    for (int column = column_first; column <= column_last; ++column) {
      if (squared_length(centre(Cell{column, row}) - point) <= radius_m * radius_m) out.push_back(index({column, row}));
    }
  }
  return out;
}

double Grid::clearance_bound_m() const {
  return kind_ == GridKind::square ? pitch_m_ / std::numbers::sqrt2 : pitch_m_ * kSqrt3 / 2;
}

}  // namespace footlight
