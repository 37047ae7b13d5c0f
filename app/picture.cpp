// SPDX-License-Identifier: Apache-2.0
#include "app/picture.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include <cairo.h>
#include <fmt/format.h>

#include "app/numbers.hpp"
#include "app/paper.hpp"

namespace footlight::app {
namespace {

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

constexpr double kLargestDotPx = 20;
constexpr double kNameSizePx = 13;
constexpr double kLegendSizePx = 13;

class Drawing : private Paper {
 public:
  Drawing(const Plan& plan, const Show& show, FormationIndex formation, const Film* film)
      : Paper(plan.stage.grid, kPaper),
        plan_(plan),
        show_(show),
        index_(formation),
        formation_(plan.formations.at(formation.at())),
        film_(film),
        grid_(plan.stage.grid) {}

  std::string draw() {
    floor();
    film();
    lines();
    blocked();
    walks();
    people();
    labels();
    legend();
    title();
    stamp();
    return png();
  }

 private:
  [[nodiscard]] const std::vector<CellIndex>& reserve() const {
    return plan_.sections[formation_.section.at()].reserve;
  }
  [[nodiscard]] bool in_reserve(CellIndex cell) const {
    return std::binary_search(reserve().begin(), reserve().end(), cell);
  }

  void floor() {
    cairo_t* c = cairo();
    ink(kFloor);
    if (grid_.kind() == GridKind::square) {
      cairo_rectangle(c, kLeftPx, kTopPx, frame().width_px(), frame().height_px());
      cairo_fill(c);
    } else {
      for (int i = 0; i < grid_.size(); ++i) cell_path(grid_, CellIndex::of(i));
      cairo_fill(c);
    }
    ink(kWings);
    for (const CellIndex cell : reserve()) cell_path(grid_, cell);
    cairo_fill(c);
  }

  /// How the section's film lies on the stage; null without a film.
  [[nodiscard]] const FilmPlacement* placement() const {
    const std::optional<FilmPlacement>& film = plan_.sections[formation_.section.at()].film;
    return film ? &*film : nullptr;
  }

  /// What the film shows at this formation, or null. There is a placement then.
  [[nodiscard]] const Mask* mask() const {
    if (film_ == nullptr || film_->frames.empty() || placement() == nullptr) return nullptr;
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
    cairo_surface_t* source = cairo_image_surface_create_for_data(pixels.data(), CAIRO_FORMAT_A8, picture->width(),
                                                                  picture->height(), stride);

    cairo_t* c = cairo();
    cairo_save(c);
    cairo_rectangle(c, kLeftPx, kTopPx, frame().width_px(), frame().height_px());
    cairo_clip(c);
    // From the paper's pixels to metres to the film's pixels.
    const StageToFrame& m = placement()->stage_to_frame;
    const double s = 1 / frame().scale;
    const double x0 = frame().low.x - kLeftPx * s;
    const double y0 = frame().high.y + kTopPx * s;
    cairo_matrix_t to_film;
    cairo_matrix_init(&to_film, m[0] * s, m[3] * s, -m[1] * s, -m[4] * s, m[0] * x0 + m[1] * y0 + m[2],
                      m[3] * x0 + m[4] * y0 + m[5]);
    cairo_pattern_t* pattern = cairo_pattern_create_for_surface(source);
    cairo_pattern_set_matrix(pattern, &to_film);
    ink(kFilm);
    cairo_mask(c, pattern);
    cairo_pattern_destroy(pattern);
    cairo_surface_destroy(source);
    cairo_restore(c);
  }

  void lines() {
    cairo_t* c = cairo();
    cairo_set_line_width(c, 1);
    if (grid_.kind() == GridKind::square) {
      const double p = grid_.pitch_m();
      for (int column = 0; column <= grid_.columns(); ++column) {
        ink(column % 10 == 0 ? kTenthLine : kLine);
        line({frame().low.x + column * p, frame().low.y}, {frame().low.x + column * p, frame().high.y});
        cairo_stroke(c);
      }
      for (int row = 0; row <= grid_.rows(); ++row) {
        ink(row % 10 == 0 ? kTenthLine : kLine);
        line({frame().low.x, frame().low.y + row * p}, {frame().high.x, frame().low.y + row * p});
        cairo_stroke(c);
      }
    } else {
      ink(kLine);
      for (int i = 0; i < grid_.size(); ++i) cell_path(grid_, CellIndex::of(i));
      cairo_stroke(c);
    }
    ink(kCentreLine);
    line({0, frame().low.y}, {0, frame().high.y});
    cairo_stroke(c);
  }

  void blocked() {
    cairo_t* c = cairo();
    for (const CellIndex cell : plan_.stage.blocked) {
      const Point at = frame().at(grid_.centre(cell));
      const double r = 0.32 * grid_.pitch_m() * frame().scale;
      ink({kBlocked.red, kBlocked.green, kBlocked.blue, 0.25});
      cell_path(grid_, cell);
      cairo_fill(c);
      ink(kBlocked);
      cross(at, r);
    }
  }

  [[nodiscard]] Ink colour_of(std::size_t performer, double alpha) const {
    Colour colour = show_.default_colour;
    if (performer < show_.performers.size()) {
      const std::optional<GroupIndex>& group = show_.performers[performer].group;
      if (group) colour = show_.groups.at(group->at()).colour;
    }
    return {colour.red / 255.0, colour.green / 255.0, colour.blue / 255.0, alpha};
  }

  /// Along the marks from this formation to the next one.
  void walks() {
    if (index_.at() + 1 >= plan_.formations.size()) return;
    const Instant until = plan_.formations[index_.at() + 1].time;
    cairo_t* c = cairo();
    cairo_set_line_width(c, std::clamp(0.07 * grid_.pitch_m() * frame().scale, 0.6, 2.0));
    for (std::size_t p = 0; p < plan_.tracks.size(); ++p) {
      const auto& track = plan_.tracks[p];
      const Point from = frame().at(position_at(grid_, track, formation_.time));
      cairo_move_to(c, from.x, from.y);
      auto mark = std::upper_bound(track.begin(), track.end(), formation_.time,
                                   [](Instant t, const Mark& m) { return t < m.time; });
      for (; mark != track.end() && mark->time <= until; ++mark) {
        const Point at = frame().at(grid_.centre(mark->cell));
        cairo_line_to(c, at.x, at.y);
      }
      double x = from.x;
      double y = from.y;
      cairo_get_current_point(c, &x, &y);
      ink(colour_of(p, 0.5));
      cairo_stroke(c);
      if (x == from.x && y == from.y) continue;
      disc({x, y}, std::clamp(0.1 * grid_.pitch_m() * frame().scale, 1.2, 4.0));
    }
  }

  void people() {
    const double pitch_px = grid_.pitch_m() * frame().scale;
    const double dot_px = std::min(0.38 * pitch_px, kLargestDotPx);
    for (std::size_t p = 0; p < formation_.cells.size(); ++p) {
      person(frame().at(grid_.centre(formation_.cells[p])), dot_px, standing(formation_.cells[p]), p);
    }
    // Twelve people on a school stage want their names; three thousand do not.
    if (pitch_px < 36) return;
    for (std::size_t p = 0; p < formation_.cells.size() && p < show_.performers.size(); ++p) {
      const Point at = frame().at(grid_.centre(formation_.cells[p]));
      const std::string name = shortened(show_.performers[p].name, kNameSizePx, pitch_px - 4);
      text(name, {at.x, at.y + dot_px + 14}, kNameSizePx, kText, 0.5);
    }
  }

  enum class Standing { in_picture, outside, waits };

  [[nodiscard]] Standing standing(CellIndex cell) const {
    if (in_reserve(cell)) return Standing::waits;
    return mask() == nullptr || on_picture(cell) ? Standing::in_picture : Standing::outside;
  }

  /// Whether the film shows something on some part of the cell.
  [[nodiscard]] bool on_picture(CellIndex cell) const {
    constexpr int kProbes = 5;  // a side
    const Mask& picture = *mask();
    const StageToFrame& m = placement()->stage_to_frame;
    const Point centre = grid_.centre(cell);
    for (int i = 0; i < kProbes * kProbes; ++i) {
      const int across = i % kProbes - kProbes / 2;
      const int up = i / kProbes - kProbes / 2;
      const double x = centre.x + across * grid_.pitch_m() / kProbes;
      const double y = centre.y + up * grid_.pitch_m() / kProbes;
      const int column = static_cast<int>(std::floor(m[0] * x + m[1] * y + m[2]));
      const int row = static_cast<int>(std::floor(m[3] * x + m[4] * y + m[5]));
      if (column < 0 || row < 0 || column >= picture.width() || row >= picture.height()) continue;
      if (picture.at(column, row)) return true;
    }
    return false;
  }

  /// A dot; a ring for who is not where the film shows something; small and dim for who waits.
  void person(Point at, double dot_px, Standing standing, std::size_t performer) {
    ink(colour_of(performer, standing == Standing::waits ? 0.45 : 1));
    if (standing == Standing::outside) {
      ring(at, dot_px, std::max(1.5, 0.3 * dot_px));
    } else {
      disc(at, (standing == Standing::waits ? 0.6 : 1) * dot_px);
    }
  }

  /// What the marks mean, of those that are there.
  void legend() {
    cairo_t* c = cairo();
    const double y = kTopPx + frame().height_px() + 66;
    double x = kLeftPx;
    const auto entry = [&](const char* words, const auto& mark) {
      mark(Point{x + 8, y - 4});
      text(words, {x + 24, y}, kLegendSizePx, kFaintText, 0);
      x += 24 + width_of(words, kLegendSizePx) + 22;
    };
    bool stands = false;
    bool outside = false;
    bool waits = false;
    for (const CellIndex cell : formation_.cells) {
      const Standing where = standing(cell);
      stands = stands || where == Standing::in_picture;
      outside = outside || where == Standing::outside;
      waits = waits || where == Standing::waits;
    }
    const auto dot = [&](Standing where) { return [&, where](Point at) { person(at, 6, where, 0); }; };
    if (stands) entry("stands in the picture", dot(Standing::in_picture));
    if (outside) entry("on the way, outside of it", dot(Standing::outside));
    if (waits) entry("waits in the reserve", dot(Standing::waits));
    if (index_.at() + 1 < plan_.formations.size()) {
      entry("walks", [&](Point at) {
        ink(colour_of(0, 0.7));
        cairo_set_line_width(c, 1.5);
        cairo_move_to(c, at.x - 8, at.y);
        cairo_line_to(c, at.x + 6, at.y);
        cairo_stroke(c);
        disc({at.x + 6, at.y}, 2.5);
      });
    }
    if (mask() != nullptr) {
      entry("the film", [&](Point at) {
        ink({kFilm.red, kFilm.green, kFilm.blue, 0.6});
        cairo_rectangle(c, at.x - 7, at.y - 6, 14, 12);
        cairo_fill(c);
      });
    }
    if (!plan_.stage.blocked.empty())
      entry("blocked", [&](Point at) {
        ink(kBlocked);
        cross(at, 6);
      });
  }

  /// Letters below the columns and numbers beside the rows, as many as there is room for.
  void labels() {
    const auto step_for = [](double cell_px, double room_px) {
      for (const int step : {1, 2, 5, 10, 20, 50, 100, 200, 500}) {
        if (step * cell_px >= room_px) return step;
      }
      return 1000;
    };
    const double column_px = frame().width_px() / grid_.columns();
    const double row_px = frame().height_px() / grid_.rows();
    const int columns = step_for(column_px, 30);
    for (int column = 0; column < grid_.columns(); column += columns) {
      const std::string name = cell_name({column, 0});
      const Point at = frame().at(grid_.centre(Cell{column, 0}));
      text(name.substr(0, name.size() - 1), {at.x, kTopPx + frame().height_px() + 16}, 12, kFaintText, 0.5);
    }
    const int rows = step_for(row_px, 18);
    for (int row = 0; row < grid_.rows(); row = row == 0 && rows > 1 ? rows - 1 : row + rows) {
      const Point at = frame().at(grid_.centre(Cell{0, row}));
      text(std::to_string(row + 1), {kLeftPx - 8, at.y + 4}, 12, kFaintText, 1);
    }
    const double middle = frame().at({0, 0}).x;
    const double below = kTopPx + frame().height_px() + 38;
    text("audience", {middle, below}, 13, kFaintText, 0.5);
    text("stage right", {kLeftPx, below}, 13, kFaintText, 0);
    text("stage left", {kLeftPx + frame().width_px(), below}, 13, kFaintText, 1);
  }

  void title() {
    const std::string name = plan_.title.empty() ? formation_.id : plan_.title + " \xE2\x80\x94 " + formation_.id;
    text(name, {kLeftPx, 34}, 22, kText, 0, true);
    std::string facts =
        fmt::format("count {:g}   {}   {:.1f} s", tidy_count(formation_.count),
                    show_.tempo.measure_beat(tidy_count(formation_.count)), to_seconds(formation_.time));
    if (formation_.frame) facts += fmt::format("   frame {}", *formation_.frame);
    facts += fmt::format("   {} of {} in the picture", formation_.in_picture, formation_.cells.size());
    const auto waiting = std::ranges::count_if(formation_.cells, [&](CellIndex cell) { return in_reserve(cell); });
    const auto late = static_cast<std::ptrdiff_t>(formation_.cells.size()) - waiting - formation_.in_picture;
    if (late > 0) facts += fmt::format(", {} on the way", late);
    if (index_.at() + 1 < plan_.formations.size()) {
      const Formation& next = plan_.formations[index_.at() + 1];
      facts += fmt::format("   lines: walks to {} ({:g} counts)", next.id, tidy_count(next.count - formation_.count));
    }
    text(facts, {kLeftPx, 60}, 14, kFaintText, 0);
  }

  /// Paper that can be told from last week's.
  void stamp() {
    const double y = height_px() - 16.0;
    text(fmt::format("plan {}   clearance {:g} m   Footlight", plan_.show_hash.substr(0, 12), plan_.stage.clearance_m),
         {kLeftPx, y}, 12, kFaintText, 0);
    if (!plan_.valid) text("REFUSED: this plan breaks its limits", {width_px() - kRightPx, y}, 16, kRefused, 1, true);
  }

  const Plan& plan_;
  const Show& show_;
  FormationIndex index_;
  const Formation& formation_;
  const Film* film_;
  const Grid& grid_;
};

}  // namespace

std::string formation_png(const Plan& plan, const Show& show, FormationIndex formation, const Film* film) {
  return Drawing(plan, show, formation, film).draw();
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
