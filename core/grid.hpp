// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/index.hpp"
#include "core/result.hpp"

namespace footlight {

/// A place on the stage floor, metres. +x stage left (audience right), +y upstage; x = 0 on the centre line, y = 0 on
/// the downstage edge.
struct Point {
  double x = 0;
  double y = 0;

  friend bool operator==(const Point&, const Point&) = default;
  friend Point operator+(Point a, Point b) { return {a.x + b.x, a.y + b.y}; }
  friend Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y}; }
  friend Point operator*(double s, Point a) { return {s * a.x, s * a.y}; }
};

[[nodiscard]] inline double dot(Point a, Point b) { return a.x * b.x + a.y * b.y; }
[[nodiscard]] inline double squared_length(Point a) { return dot(a, a); }
[[nodiscard]] double length(Point a);
[[nodiscard]] inline double distance(Point a, Point b) { return length(a - b); }

/// Column from stage right, row from downstage, both from 0.
struct Cell {
  int column = 0;
  int row = 0;

  friend auto operator<=>(const Cell&, const Cell&) = default;
};

/// A rectangle of cells, both corners included.
struct CellRange {
  Cell first;
  Cell last;
  friend bool operator==(const CellRange&, const CellRange&) = default;
};

enum class GridKind { square, hexagonal, triangular };

[[nodiscard]] std::string_view to_text(GridKind kind);
[[nodiscard]] std::optional<GridKind> grid_kind_from(std::string_view text);

/// "A1" is column 0, row 0; columns go A..Z, AA..ZZ, ... as on a spreadsheet.
[[nodiscard]] std::string cell_name(Cell cell);
/// Accepts lower case. @return nothing when the text is no cell name
[[nodiscard]] std::optional<Cell> parse_cell(std::string_view text);
/// "A1:J48" or "B2". Corners may be given in any order.
[[nodiscard]] std::optional<CellRange> parse_cell_range(std::string_view text);

/// The cells of the stage floor. Neighbouring centres are one pitch apart on every kind of grid.
///
///   square      x = (col - (cols - 1) / 2) p,                              y = (row + 1/2) p
///   hexagonal   x = (col - (cols - 1) / 2 + (row odd ? 1/2 : 0)) p,        y = (1/sqrt(3) + row sqrt(3)/2) p
///   triangular  x = (col - (cols - 1) / 2) p sqrt(3)/2,                    y = (3/2 row + (upward ? 1/2 : 1)) p
/// A triangular cell points upstage when col + row is even; its sides are p sqrt(3).
class Grid {
 public:
  Grid() = default;
  /// @param columns, rows in [1, 4096]; columns x rows <= 4 million  @param pitch_m in (0, 100] m; else
  /// ErrorKind::input
  static Result<Grid> make(GridKind kind, int columns, int rows, double pitch_m);

  [[nodiscard]] GridKind kind() const { return kind_; }
  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] double pitch_m() const { return pitch_m_; }
  [[nodiscard]] int size() const { return columns_ * rows_; }
  [[nodiscard]] double cell_area_m2() const;

  [[nodiscard]] bool contains(Cell cell) const {
    return cell.column >= 0 && cell.column < columns_ && cell.row >= 0 && cell.row < rows_;
  }
  [[nodiscard]] CellIndex index(Cell cell) const {
    FL_CHECK(contains(cell));
    return CellIndex::of(cell.row * columns_ + cell.column);
  }
  [[nodiscard]] Cell cell(CellIndex index) const {
    const int i = static_cast<int>(index.value());
    return {i % columns_, i / columns_};
  }
  [[nodiscard]] Point centre(Cell cell) const;
  [[nodiscard]] Point centre(CellIndex index) const { return centre(cell(index)); }
  [[nodiscard]] std::string name(CellIndex index) const { return cell_name(cell(index)); }

  /// Cells whose centres are one pitch away: up to 4 (square), 6 (hexagonal), 3 (triangular), ascending.
  [[nodiscard]] std::vector<CellIndex> neighbours(CellIndex index) const;
  /// Corners of a cell's outline, metres, counter-clockwise.
  [[nodiscard]] std::vector<Point> outline(CellIndex index) const;
  /// The cell whose centre is nearest; the lower index among equals; clamped to the grid. O(1)
  [[nodiscard]] CellIndex nearest(Point point) const;
  /// Every cell whose centre lies within `radius_m`, ascending index. O(result)
  [[nodiscard]] std::vector<CellIndex> within(Point point, double radius_m) const;

  /// Straight walks that start and arrive together between cells, and satisfy (s_i - s_j).(g_i - g_j) >= 0, never bring
  /// two people nearer than this: p / sqrt(2) on squares, p sqrt(3)/2 on hexagons and triangles (Turpin, Michael, Kumar
  /// 2014).
  [[nodiscard]] double clearance_bound_m() const;

  friend bool operator==(const Grid&, const Grid&) = default;

 private:
  GridKind kind_ = GridKind::square;
  int columns_ = 1;
  int rows_ = 1;
  double pitch_m_ = 1;
};

}  // namespace footlight
