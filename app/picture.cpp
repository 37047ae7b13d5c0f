// SPDX-License-Identifier: Apache-2.0
#include "app/picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <numbers>
#include <string_view>
#include <vector>

#include <cairo.h>
#include <fmt/format.h>

#include "app/numbers.hpp"
#include "core/check.hpp"

namespace footlight::app {
namespace {

constexpr double kFloorWidthPx = 1600;
constexpr double kFloorHeightPx = 1200;
constexpr double kLargestDotPx = 20;
constexpr double kLeftPx = 56;
constexpr double kRightPx = 24;
constexpr double kTopPx = 84;
constexpr double kBottomPx = 92;

struct Ink {
  double red, green, blue;
  double alpha = 1;
};
constexpr Ink kPaper{0.055, 0.065, 0.08};
constexpr Ink kFloor{0.10, 0.115, 0.14};
constexpr Ink kWings{0.07, 0.08, 0.10};
constexpr Ink kLine{1, 1, 1, 0.055};
constexpr Ink kTenthLine{1, 1, 1, 0.15};
constexpr Ink kCentreLine{1, 0.85, 0.4, 0.45};
constexpr Ink kFilm{0.45, 0.62, 0.85, 0.30};
constexpr Ink kBlocked{0.75, 0.25, 0.22, 0.8};
constexpr Ink kText{0.90, 0.92, 0.95};
constexpr Ink kFaintText{0.62, 0.66, 0.72};
constexpr Ink kRefused{1.0, 0.35, 0.3};

struct DestroySurface {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
struct DestroyContext {
  void operator()(cairo_t* context) const { cairo_destroy(context); }
};
using Surface = std::unique_ptr<cairo_surface_t, DestroySurface>;
using Context = std::unique_ptr<cairo_t, DestroyContext>;

/// Where the floor's metres lie on the paper's pixels.
struct Frame {
  Point low;  ///< downstage right corner, m
  Point high;
  double scale = 1;  ///< pixels a metre

  explicit Frame(const Grid& grid) : low(grid.centre(CellIndex(0))), high(low) {
    // The hull of the four edges' cells is the hull of the floor.
    for (int row = 0; row < grid.rows(); ++row) {
      for (int column = 0; column < grid.columns(); ++column) {
        const bool edge = row < 2 || row >= grid.rows() - 2 || column < 2 || column >= grid.columns() - 2;
        if (!edge) continue;
        for (const Point corner : grid.outline(grid.index({column, row}))) {
          low = {std::min(low.x, corner.x), std::min(low.y, corner.y)};
          high = {std::max(high.x, corner.x), std::max(high.y, corner.y)};
        }
      }
    }
    scale = std::min(kFloorWidthPx / (high.x - low.x), kFloorHeightPx / (high.y - low.y));
  }
  [[nodiscard]] double width_px() const { return (high.x - low.x) * scale; }
  [[nodiscard]] double height_px() const { return (high.y - low.y) * scale; }
  [[nodiscard]] Point at(Point metres) const {
    return {kLeftPx + (metres.x - low.x) * scale, kTopPx + (high.y - metres.y) * scale};
  }
};

class Drawing {
 public:
  Drawing(const Plan& plan, const Show& show, FormationIndex formation, const Film* film)
      : plan_(plan),
        show_(show),
        index_(formation),
        formation_(plan.formations.at(formation.at())),
        film_(film),
        grid_(plan.stage.grid),
        frame_(grid_),
        width_(static_cast<int>(std::ceil(kLeftPx + std::max(frame_.width_px(), 640.0) + kRightPx))),
        height_(static_cast<int>(std::ceil(kTopPx + frame_.height_px() + kBottomPx))),
        surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width_, height_)),
        cairo_(cairo_create(surface_.get())) {}

  std::string png() {
    cairo_t* c = cairo_.get();
    ink(kPaper);
    cairo_paint(c);
    floor();
    film();
    lines();
    blocked();
    walks();
    people();
    labels();
    title();
    stamp();
    std::string out;
    const auto append = [](void* to, const unsigned char* data, unsigned size) {
      static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(data), size);
      return CAIRO_STATUS_SUCCESS;
    };
    FL_CHECK(cairo_surface_write_to_png_stream(surface_.get(), append, &out) == CAIRO_STATUS_SUCCESS);
    return out;
  }

 private:
  void ink(Ink colour) { cairo_set_source_rgba(cairo_.get(), colour.red, colour.green, colour.blue, colour.alpha); }

  void cell_path(CellIndex cell) {
    cairo_new_sub_path(cairo_.get());
    for (const Point corner : grid_.outline(cell)) {
      const Point at = frame_.at(corner);
      cairo_line_to(cairo_.get(), at.x, at.y);
    }
    cairo_close_path(cairo_.get());
  }

  [[nodiscard]] const std::vector<CellIndex>& reserve() const {
    return plan_.sections[formation_.section.at()].reserve;
  }
  [[nodiscard]] bool in_reserve(CellIndex cell) const {
    return std::binary_search(reserve().begin(), reserve().end(), cell);
  }

  void floor() {
    cairo_t* c = cairo_.get();
    ink(kFloor);
    if (grid_.kind() == GridKind::square) {
      cairo_rectangle(c, kLeftPx, kTopPx, frame_.width_px(), frame_.height_px());
      cairo_fill(c);
    } else {
      for (int i = 0; i < grid_.size(); ++i) cell_path(CellIndex::of(i));
      cairo_fill(c);
    }
    ink(kWings);
    for (const CellIndex cell : reserve()) cell_path(cell);
    cairo_fill(c);
  }

  [[nodiscard]] const Mask* mask() const {
    if (film_ == nullptr || film_->frames.empty() || !plan_.sections[formation_.section.at()].film) return nullptr;
    const int k = formation_.frame ? *formation_.frame - film_->first_frame : 0;
    return k >= 0 && k < static_cast<int>(film_->frames.size()) ? &film_->frames[static_cast<std::size_t>(k)] : nullptr;
  }

  void film() {
    const Mask* picture = mask();
    if (picture == nullptr) return;
    const int stride = cairo_format_stride_for_width(CAIRO_FORMAT_A8, picture->width());
    std::vector<unsigned char> pixels(static_cast<std::size_t>(stride) * static_cast<std::size_t>(picture->height()));
    for (int y = 0; y < picture->height(); ++y) {
      for (int x = 0; x < picture->width(); ++x) {
        if (picture->at(x, y))
          pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(stride) + static_cast<std::size_t>(x)] = 255;
      }
    }
    const Surface source(cairo_image_surface_create_for_data(pixels.data(), CAIRO_FORMAT_A8, picture->width(),
                                                             picture->height(), stride));
    cairo_t* c = cairo_.get();
    cairo_save(c);
    cairo_rectangle(c, kLeftPx, kTopPx, frame_.width_px(), frame_.height_px());
    cairo_clip(c);
    // From the paper's pixels to metres to the film's pixels.
    const StageToFrame& m = plan_.sections[formation_.section.at()].film->stage_to_frame;
    const double s = 1 / frame_.scale;
    const double x0 = frame_.low.x - kLeftPx * s;
    const double y0 = frame_.high.y + kTopPx * s;
    cairo_matrix_t to_film;
    cairo_matrix_init(&to_film, m[0] * s, m[3] * s, -m[1] * s, -m[4] * s, m[0] * x0 + m[1] * y0 + m[2],
                      m[3] * x0 + m[4] * y0 + m[5]);
    cairo_pattern_t* pattern = cairo_pattern_create_for_surface(source.get());
    cairo_pattern_set_matrix(pattern, &to_film);
    ink(kFilm);
    cairo_mask(c, pattern);
    cairo_pattern_destroy(pattern);
    cairo_restore(c);
  }

  void line(Point from, Point to) {
    const Point a = frame_.at(from);
    const Point b = frame_.at(to);
    cairo_move_to(cairo_.get(), a.x, a.y);
    cairo_line_to(cairo_.get(), b.x, b.y);
  }

  void lines() {
    cairo_t* c = cairo_.get();
    cairo_set_line_width(c, 1);
    if (grid_.kind() == GridKind::square) {
      const double p = grid_.pitch_m();
      for (int column = 0; column <= grid_.columns(); ++column) {
        ink(column % 10 == 0 ? kTenthLine : kLine);
        line({frame_.low.x + column * p, frame_.low.y}, {frame_.low.x + column * p, frame_.high.y});
        cairo_stroke(c);
      }
      for (int row = 0; row <= grid_.rows(); ++row) {
        ink(row % 10 == 0 ? kTenthLine : kLine);
        line({frame_.low.x, frame_.low.y + row * p}, {frame_.high.x, frame_.low.y + row * p});
        cairo_stroke(c);
      }
    } else {
      ink(kLine);
      for (int i = 0; i < grid_.size(); ++i) cell_path(CellIndex::of(i));
      cairo_stroke(c);
    }
    ink(kCentreLine);
    line({0, frame_.low.y}, {0, frame_.high.y});
    cairo_stroke(c);
  }

  void blocked() {
    cairo_t* c = cairo_.get();
    for (const CellIndex cell : plan_.stage.blocked) {
      const Point at = frame_.at(grid_.centre(cell));
      const double r = 0.32 * grid_.pitch_m() * frame_.scale;
      ink({kBlocked.red, kBlocked.green, kBlocked.blue, 0.25});
      cell_path(cell);
      cairo_fill(c);
      ink(kBlocked);
      cairo_set_line_width(c, std::max(1.0, r / 6));
      cairo_move_to(c, at.x - r, at.y - r);
      cairo_line_to(c, at.x + r, at.y + r);
      cairo_move_to(c, at.x - r, at.y + r);
      cairo_line_to(c, at.x + r, at.y - r);
      cairo_stroke(c);
    }
  }

  [[nodiscard]] Ink colour_of(std::size_t performer, double alpha) const {
    Colour colour = show_.default_colour;
    if (performer < show_.performers.size() && show_.performers[performer].group) {
      colour = show_.groups.at(show_.performers[performer].group->at()).colour;
    }
    return {colour.red / 255.0, colour.green / 255.0, colour.blue / 255.0, alpha};
  }

  /// Along the marks from this formation to the next one.
  void walks() {
    if (index_.at() + 1 >= plan_.formations.size()) return;
    const Instant until = plan_.formations[index_.at() + 1].time;
    cairo_t* c = cairo_.get();
    cairo_set_line_width(c, std::clamp(0.07 * grid_.pitch_m() * frame_.scale, 0.6, 2.0));
    for (std::size_t p = 0; p < plan_.tracks.size(); ++p) {
      const auto& track = plan_.tracks[p];
      const Point from = frame_.at(position_at(grid_, track, formation_.time));
      cairo_move_to(c, from.x, from.y);
      auto mark = std::upper_bound(track.begin(), track.end(), formation_.time,
                                   [](Instant t, const Mark& m) { return t < m.time; });
      for (; mark != track.end() && mark->time <= until; ++mark) {
        const Point at = frame_.at(grid_.centre(mark->cell));
        cairo_line_to(c, at.x, at.y);
      }
      double x = from.x;
      double y = from.y;
      cairo_get_current_point(c, &x, &y);
      ink(colour_of(p, 0.5));
      cairo_stroke(c);
      if (x == from.x && y == from.y) continue;
      cairo_arc(c, x, y, std::clamp(0.1 * grid_.pitch_m() * frame_.scale, 1.2, 4.0), 0, 2 * std::numbers::pi);
      cairo_fill(c);
    }
  }

  void people() {
    cairo_t* c = cairo_.get();
    const double pitch_px = grid_.pitch_m() * frame_.scale;
    const double dot_px = std::min(0.38 * pitch_px, kLargestDotPx);
    for (std::size_t p = 0; p < formation_.cells.size(); ++p) {
      const bool waits = in_reserve(formation_.cells[p]);
      const Point at = frame_.at(grid_.centre(formation_.cells[p]));
      ink(colour_of(p, waits ? 0.45 : 1));
      cairo_arc(c, at.x, at.y, (waits ? 0.6 : 1) * dot_px, 0, 2 * std::numbers::pi);
      cairo_fill(c);
    }
    // Twelve people on a school stage want their names; three thousand do not.
    if (pitch_px < 36) return;
    for (std::size_t p = 0; p < formation_.cells.size() && p < show_.performers.size(); ++p) {
      const Point at = frame_.at(grid_.centre(formation_.cells[p]));
      text(show_.performers[p].name, {at.x, at.y + dot_px + 14}, 13, kText, 0.5);
    }
  }

  /// @param anchor 0: starts at x, 0.5: centred, 1: ends there
  void text(const std::string& words, Point at, double size, Ink colour, double anchor, bool bold = false) {
    cairo_t* c = cairo_.get();
    cairo_select_font_face(c, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                           bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(c, size);
    cairo_text_extents_t extents;
    cairo_text_extents(c, words.c_str(), &extents);
    ink(colour);
    cairo_move_to(c, at.x - anchor * extents.x_advance, at.y);
    cairo_show_text(c, words.c_str());
    cairo_new_path(c);
  }

  /// Letters below the columns and numbers beside the rows, as many as there is room for.
  void labels() {
    const auto step_for = [](double cell_px, double room_px) {
      for (const int step : {1, 2, 5, 10, 20, 50, 100, 200, 500}) {
        if (step * cell_px >= room_px) return step;
      }
      return 1000;
    };
    const double column_px = frame_.width_px() / grid_.columns();
    const double row_px = frame_.height_px() / grid_.rows();
    const int columns = step_for(column_px, 30);
    for (int column = 0; column < grid_.columns(); column += columns) {
      const std::string name = cell_name({column, 0});
      const Point at = frame_.at(grid_.centre(Cell{column, 0}));
      text(name.substr(0, name.size() - 1), {at.x, kTopPx + frame_.height_px() + 16}, 12, kFaintText, 0.5);
    }
    const int rows = step_for(row_px, 18);
    for (int row = 0; row < grid_.rows(); row = row == 0 && rows > 1 ? rows - 1 : row + rows) {
      const Point at = frame_.at(grid_.centre(Cell{0, row}));
      text(std::to_string(row + 1), {kLeftPx - 8, at.y + 4}, 12, kFaintText, 1);
    }
    const double middle = frame_.at({0, 0}).x;
    const double below = kTopPx + frame_.height_px() + 38;
    text("audience", {middle, below}, 13, kFaintText, 0.5);
    text("stage right", {kLeftPx, below}, 13, kFaintText, 0);
    text("stage left", {kLeftPx + frame_.width_px(), below}, 13, kFaintText, 1);
  }

  void title() {
    const std::string name = plan_.title.empty() ? formation_.id : plan_.title + " \xE2\x80\x94 " + formation_.id;
    text(name, {kLeftPx, 34}, 22, kText, 0, true);
    std::string facts =
        fmt::format("count {:g}   {}   {:.1f} s", tidy_count(formation_.count),
                    show_.tempo.measure_beat(tidy_count(formation_.count)), to_seconds(formation_.time));
    if (formation_.frame) facts += fmt::format("   frame {}", *formation_.frame);
    facts += fmt::format("   {} of {} in the picture", formation_.in_picture, formation_.cells.size());
    if (index_.at() + 1 < plan_.formations.size()) {
      const Formation& next = plan_.formations[index_.at() + 1];
      facts += fmt::format("   lines: walks to {} ({:g} counts)", next.id, tidy_count(next.count - formation_.count));
    }
    text(facts, {kLeftPx, 60}, 14, kFaintText, 0);
  }

  /// Paper that can be told from last week's.
  void stamp() {
    const double y = height_ - 16.0;
    text(fmt::format("plan {}   clearance {:g} m   Footlight", plan_.show_hash.substr(0, 12), plan_.stage.clearance_m),
         {kLeftPx, y}, 12, kFaintText, 0);
    if (!plan_.valid) text("REFUSED: this plan breaks its limits", {width_ - kRightPx, 34}, 20, kRefused, 1, true);
  }

  const Plan& plan_;
  const Show& show_;
  FormationIndex index_;
  const Formation& formation_;
  const Film* film_;
  const Grid& grid_;
  Frame frame_;
  int width_;
  int height_;
  Surface surface_;
  Context cairo_;
};

}  // namespace

std::string formation_png(const Plan& plan, const Show& show, FormationIndex formation, const Film* film) {
  return Drawing(plan, show, formation, film).png();
}

std::string picture_name(const Plan& plan, FormationIndex formation) {
  std::string id = plan.formations.at(formation.at()).id;
  for (char& c : id) {
    const bool plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    if (!plain) c = '-';
  }
  return fmt::format("{:03}-{}.png", formation.value() + 1, id);
}

}  // namespace footlight::app
