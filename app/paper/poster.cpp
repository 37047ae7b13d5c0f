// SPDX-License-Identifier: Apache-2.0
#include "app/paper/poster.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "app/numbers.hpp"
#include "app/paper/drawn_floor.hpp"

namespace footlight::app {
namespace {

constexpr double kHeading_pt = 24;
constexpr double kEdge_pt = 14;  // around a tile, for letters and numbers
constexpr double kLargestCell_pt = 48;
constexpr double kName_pt = 5.5;  // smallest name that is read without a lens
constexpr double kCellName_pt = 5;
constexpr double kMarker_pt = 3.6;

/// A floor cut into pages.
class Poster {
 public:
  /// Draws what belongs to a cell. @param size of a cell on paper, points
  using DrawCell = std::function<void(CellIndex cell, Point at, double size)>;

  Poster(Canvas& canvas, const PaperSize& paper, const Stamp& stamp, const Stage& stage, std::string title,
         double cell_pt)
      : canvas_(canvas),
        paper_(paper),
        stamp_(stamp),
        stage_(stage),
        grid_(stage.grid),
        title_(std::move(title)),
        whole_(grid_, {}, 1e9, 1e9),
        room_{paper.width_pt - 2 * paper.margin_pt - 2 * kEdge_pt,
              paper.height_pt - 2 * paper.margin_pt - 2 * kEdge_pt - kHeading_pt} {
    const double width_m = whole_.high.x - whole_.low.x;
    const double height_m = whole_.high.y - whole_.low.y;
    // No smaller than the page allows when one page is enough.
    scale_ = std::max(cell_pt / grid_.pitch_m(), std::min(room_.x / width_m, room_.y / height_m));
    scale_ = std::min(scale_, std::max(cell_pt, kLargestCell_pt) / grid_.pitch_m());
    const Point step = centre_step(grid_);
    across_ = pages_for(width_m, step.x, room_.x, tile_m_.x);
    up_ = pages_for(height_m, step.y, room_.y, tile_m_.y);
  }

  void draw(const DrawCell& draw_cell) {
    canvas_.bookmark(title_);
    if (across_ * up_ > 1) {
      overview(draw_cell);
      canvas_.next_page();
    }
    for (int row = up_ - 1; row >= 0; --row) {
      for (int column = 0; column < across_; ++column) {
        tile(column, row, draw_cell);
        if (row > 0 || column + 1 < across_) canvas_.next_page();
      }
    }
  }

 private:
  /// From one column to the next, and from one row to the next.
  static Point centre_step(const Grid& grid) {
    const Point first = grid.centre(Cell{0, 0});
    const double x = grid.columns() > 1 ? grid.centre(Cell{1, 0}).x - first.x : grid.pitch_m();
    const double y = grid.rows() > 1 ? grid.centre(Cell{0, grid.rows() - 1}).y - first.y : grid.pitch_m();
    return {x, y / std::max(1, grid.rows() - 1)};
  }

  /// How many tiles of whole columns, or rows, are as long as the floor; each about as large as the others.
  [[nodiscard]] int pages_for(double length_m, double step_m, double room_pt, double& tile_m) const {
    tile_m = length_m;
    if (length_m * scale_ <= room_pt * (1 + 1e-9)) return 1;
    const auto steps = static_cast<int>(std::ceil(length_m / step_m - 1e-9));
    const int most = std::max(1, static_cast<int>(std::floor(room_pt / (step_m * scale_))));
    const int pages = (steps + most - 1) / most;
    tile_m = (steps + pages - 1) / pages * step_m;
    return pages;
  }

  static std::string tile_name(int column, int row) { return cell_name({column, row}); }

  void heading(const std::string& words) {
    const double left = paper_.margin_pt;
    const double width = paper_.width_pt - 2 * left;
    canvas_.text(words, {left + width, left + 9}, 9, kOnPaper.text, 1, true);
    canvas_.text(canvas_.beginning(title_, 9, width - canvas_.width_of(words, 9, true) - 8), {left, left + 9}, 9,
                 kOnPaper.text, 0);
    canvas_.text(stamp_.line_of(canvas_, 5.5, width), {left, left + 18}, 5.5, kOnPaper.faint, 0);
  }

  /// The whole floor small, and how it is cut.
  void overview(const DrawCell& draw_cell) {
    const double left = paper_.margin_pt + kEdge_pt;
    const double top = paper_.margin_pt + kEdge_pt + kHeading_pt;
    heading(fmt::format("{} x {} pages", across_, up_));
    const Frame frame(grid_, {left, top}, room_.x, room_.y - 40);
    const DrawnFloor floor(canvas_, frame, stage_, kOnPaper);
    floor.ground({});
    floor.lines();
    for (int i = 0; i < grid_.size(); ++i) {
      draw_cell(CellIndex::of(i), frame.at(grid_.centre(CellIndex::of(i))), frame.scale * grid_.pitch_m());
    }
    floor.blocked();
    floor.labels(6);
    canvas_.text("audience", {left + frame.width() / 2, top + frame.height() + 20}, 7, kOnPaper.faint, 0.5);
    canvas_.ink(kOnPaper.refused);
    for (int row = 0; row < up_; ++row) {
      for (int column = 0; column < across_; ++column) {
        const Point low = corner_of(column, row);
        const Point a = frame.at(low);
        const double width = std::min(tile_m_.x, frame.high.x - low.x) * frame.scale;
        const double height = std::min(tile_m_.y, frame.high.y - low.y) * frame.scale;
        canvas_.ink(kOnPaper.refused);
        canvas_.stroke_box({a.x, a.y - height}, width, height, 0.8);
        canvas_.text(tile_name(column, row), {a.x + width / 2, a.y - height / 2 + 5}, 14, kOnPaper.refused, 0.5, true);
      }
    }
  }

  /// Downstage right corner of a tile, m.
  [[nodiscard]] Point corner_of(int column, int row) const {
    return whole_.low + Point{column * tile_m_.x, row * tile_m_.y};
  }

  void tile(int column, int row, const DrawCell& draw_cell) {
    heading(across_ * up_ > 1 ? "page " + tile_name(column, row) : "");
    const Point low = corner_of(column, row);
    const Point corner{paper_.margin_pt + kEdge_pt, paper_.margin_pt + kEdge_pt + kHeading_pt};
    const double width = std::min(tile_m_.x, whole_.high.x - low.x) * scale_;
    const double height = std::min(tile_m_.y, whole_.high.y - low.y) * scale_;
    Frame frame = whole_;
    frame.scale = scale_;
    frame.corner = {corner.x - (low.x - whole_.low.x) * scale_, corner.y + height - (whole_.high.y - low.y) * scale_};
    cairo_t* c = canvas_.cairo();
    cairo_save(c);
    cairo_rectangle(c, corner.x, corner.y, width, height);
    cairo_clip(c);
    const double cell = scale_ * grid_.pitch_m();
    for (int i = 0; i < grid_.size(); ++i) {
      const Point at = frame.at(grid_.centre(CellIndex::of(i)));
      const bool here = at.x > corner.x - cell && at.x < corner.x + width + cell && at.y > corner.y - cell &&
                        at.y < corner.y + height + cell;
      if (!here) continue;
      outline(frame, CellIndex::of(i));
    }
    canvas_.ink(kOnPaper.centre_line);
    canvas_.stroke_line(frame.at({0, frame.low.y}), frame.at({0, frame.high.y}), 0.8);
    cairo_restore(c);
    // What belongs to a cell stands whole on the tile that has the cell's middle, also where a staggered row's cells
    // reach over the edge.
    for (int i = 0; i < grid_.size(); ++i) {
      const Point at = frame.at(grid_.centre(CellIndex::of(i)));
      const bool mine = at.x >= corner.x && at.x < corner.x + width && at.y > corner.y && at.y <= corner.y + height;
      if (mine) draw_cell(CellIndex::of(i), at, cell);
    }
    edges(frame, corner, width, height);
  }

  void outline(const Frame& frame, CellIndex cell) {
    cairo_t* c = canvas_.cairo();
    cairo_new_sub_path(c);
    for (const Point corner : grid_.outline(cell)) {
      const Point at = frame.at(corner);
      cairo_line_to(c, at.x, at.y);
    }
    cairo_close_path(c);
    if (std::ranges::binary_search(stage_.blocked, cell)) {
      canvas_.ink({0.7, 0.15, 0.12, 0.25});
      cairo_fill_preserve(c);
    }
    canvas_.ink({0, 0, 0, 0.25});
    cairo_set_line_width(c, 0.3);
    cairo_stroke(c);
  }

  /// Cut marks, letters and numbers around a tile.
  void edges(const Frame& frame, Point corner, double width, double height) {
    // Names of cells in the middle of the edge reach half a cell beyond it.
    const double beyond = grid_.kind() == GridKind::square ? 0 : 0.5 * scale_ * grid_.pitch_m();
    canvas_.ink(kOnPaper.text);
    canvas_.stroke_box(corner, width, height, 0.6);
    for (int column = 0; column < grid_.columns(); ++column) {
      const double x = frame.at(grid_.centre(Cell{column, 0})).x;
      if (x < corner.x || x > corner.x + width) continue;
      const std::string name = cell_name({column, 0});
      canvas_.text(name.substr(0, name.size() - 1), {x, corner.y + height + beyond + 8}, 5.5, kOnPaper.faint, 0.5);
    }
    for (int row = 0; row < grid_.rows(); ++row) {
      const double y = frame.at(grid_.centre(Cell{0, row})).y;
      if (y < corner.y || y > corner.y + height) continue;
      canvas_.text(std::to_string(row + 1), {corner.x - beyond - 3, y + 2}, 5.5, kOnPaper.faint, 1);
    }
  }

  Canvas& canvas_;
  const PaperSize& paper_;
  const Stamp& stamp_;
  const Stage& stage_;
  const Grid& grid_;
  std::string title_;
  Frame whole_;
  Point room_;    ///< of a tile on paper
  Point tile_m_;  ///< size of a tile
  double scale_ = 1;
  int across_ = 1;
  int up_ = 1;
};

/// What is written into somebody's cell: the name where it fits, else the id, else the name's beginning.
std::string label_of(const Canvas& canvas, const Performer& performer, double room) {
  if (canvas.width_of(performer.name, kName_pt) <= room) return performer.name;
  if (canvas.width_of(performer.id, kName_pt) <= room) return performer.id;
  return canvas.shortened(performer.name, kName_pt, room);
}

}  // namespace

void draw_chart(Canvas& canvas, const PaperSize& paper, const Stamp& stamp, const Plan& plan, const Show& show,
                FormationIndex index) {
  const Formation& formation = plan.formations.at(index.at());
  std::vector<std::optional<std::size_t>> on_cell(static_cast<std::size_t>(plan.stage.grid.size()));
  for (std::size_t p = 0; p < formation.cells.size(); ++p) on_cell[formation.cells[p].at()] = p;
  double widest = 2 * kName_pt;
  for (const Performer& performer : show.performers) {
    widest = std::max(widest, std::min(kLargestCell_pt - 2, canvas.width_of(performer.name, kName_pt)));
  }
  const double cell_pt = widest + 2;
  const double count = tidy_count(formation.count);
  Poster poster(canvas, paper, stamp, plan.stage,
                fmt::format("{}   count {:g}   {}", formation.id, count, show.tempo.measure_beat(count)), cell_pt);
  poster.draw([&](CellIndex cell, Point at, double size) {
    if (!on_cell[cell.at()]) return;
    const Performer& performer = show.performers.at(*on_cell[cell.at()]);
    const auto& group = performer.group;
    canvas.ink(ink_of(group ? show.groups.at(group->at()).colour : show.default_colour, 0.45));
    canvas.disc(at, 0.45 * size);
    canvas.ink({0, 0, 0, 0.6});
    canvas.ring(at, 0.45 * size, std::min(0.5, 0.05 * size));
    if (size < 0.9 * cell_pt) return;  // the overview
    canvas.text(label_of(canvas, performer, size - 1.5), {at.x, at.y + 0.36 * kName_pt}, kName_pt, kOnPaper.text, 0.5);
  });
}

void draw_floor_plan(Canvas& canvas, const PaperSize& paper, const Stamp& stamp, const Plan& plan, const Rig& rig) {
  std::vector<std::string> lamps(static_cast<std::size_t>(plan.stage.grid.size()));
  for (const Node& node : rig.nodes) {
    for (std::size_t channel = 0; channel < node.channels.size(); ++channel) {
      if (node.channels[channel].kind != Channel::Kind::cell) continue;
      lamps[node.channels[channel].cell.at()] = fmt::format("{}.{}", node.name, channel + 1);
    }
  }
  double widest = 4 * kCellName_pt;
  for (const std::string& lamp : lamps) widest = std::max(widest, canvas.width_of(lamp, kMarker_pt));
  const double cell_pt = widest + 2;
  Poster poster(canvas, paper, stamp, plan.stage,
                fmt::format("Floor plan   {} x {} cells   pitch {:g} m", plan.stage.grid.columns(),
                            plan.stage.grid.rows(), plan.stage.grid.pitch_m()),
                cell_pt);
  poster.draw([&](CellIndex cell, Point at, double size) {
    if (size < 0.9 * cell_pt) return;
    canvas.text(plan.stage.grid.name(cell), {at.x, at.y}, kCellName_pt, kOnPaper.text, 0.5, true);
    canvas.text(lamps[cell.at()], {at.x, at.y + 1.3 * kCellName_pt}, kMarker_pt, kOnPaper.faint, 0.5);
  });
}

}  // namespace footlight::app
