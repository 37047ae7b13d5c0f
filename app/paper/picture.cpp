// SPDX-License-Identifier: Apache-2.0
#include "app/paper/picture.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include <cairo.h>
#include <fmt/format.h>

#include "app/numbers.hpp"
#include "app/paper/canvas.hpp"
#include "app/paper/drawn_floor.hpp"
#include "app/paper/film_view.hpp"

namespace footlight::app {
namespace {

constexpr double kLeftPx = 56;
constexpr double kRightPx = 24;
constexpr double kTopPx = 84;
constexpr double kBottomPx = 118;
constexpr double kNarrowestPx = 760;  // of a floor: its legend needs the room
constexpr double kFloorWidthPx = 1600;
constexpr double kFloorHeightPx = 1200;
constexpr double kLargestDotPx = 20;
constexpr double kNameSizePx = 13;
constexpr double kLegendSizePx = 13;

class Drawing {
 public:
  Drawing(const Plan& plan, const Show& show, FormationIndex formation, const Film* film)
      : plan_(plan),
        show_(show),
        index_(formation),
        formation_(plan.formations.at(formation.at())),
        film_(plan, formation_.section, film),
        first_frame_(film == nullptr ? 0 : film->first_frame),
        grid_(plan.stage.grid),
        frame_(grid_, {kLeftPx, kTopPx}, kFloorWidthPx, kFloorHeightPx),
        canvas_(Canvas::png(static_cast<int>(std::ceil(kLeftPx + std::max(frame_.width(), kNarrowestPx) + kRightPx)),
                            static_cast<int>(std::ceil(kTopPx + frame_.height() + kBottomPx)), theme_.ground)) {}

  std::string draw() {
    const DrawnFloor floor(canvas_, frame_, plan_.stage, theme_);
    floor.ground(reserve());
    if (mask() != nullptr) floor.film(*mask(), film_.placement());
    floor.lines();
    floor.blocked();
    walks();
    people();
    floor.labels(12);
    sides();
    legend();
    title();
    stamp();
    return canvas_.finish();
  }

 private:
  [[nodiscard]] const std::vector<CellIndex>& reserve() const {
    return plan_.sections[formation_.section.at()].reserve;
  }
  [[nodiscard]] bool in_reserve(CellIndex cell) const {
    return std::binary_search(reserve().begin(), reserve().end(), cell);
  }

  /// What the film shows at this formation, or null.
  [[nodiscard]] const Mask* mask() const { return film_.of_frame(formation_.frame.value_or(first_frame_)); }

  [[nodiscard]] Ink colour_of(std::size_t performer, double alpha) const {
    Colour colour = show_.default_colour;
    if (performer < show_.performers.size()) {
      const std::optional<GroupIndex>& group = show_.performers[performer].group;
      if (group) colour = show_.groups.at(group->at()).colour;
    }
    return ink_of(colour, alpha);
  }

  /// Along the marks from this formation to the next one.
  void walks() {
    if (index_.at() + 1 >= plan_.formations.size()) return;
    const Instant until = plan_.formations[index_.at() + 1].time;
    cairo_t* c = canvas_.cairo();
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
      canvas_.ink(colour_of(p, 0.5));
      cairo_stroke(c);
      if (x == from.x && y == from.y) continue;
      canvas_.disc({x, y}, std::clamp(0.1 * grid_.pitch_m() * frame_.scale, 1.2, 4.0));
    }
  }

  void people() {
    const double pitch_px = grid_.pitch_m() * frame_.scale;
    const double dot_px = std::min(0.38 * pitch_px, kLargestDotPx);
    for (std::size_t p = 0; p < formation_.cells.size(); ++p) {
      person(frame_.at(grid_.centre(formation_.cells[p])), dot_px, standing(formation_.cells[p]), p);
    }
    // Twelve people on a school stage want their names; three thousand do not.
    if (pitch_px < 36) return;
    for (std::size_t p = 0; p < formation_.cells.size() && p < show_.performers.size(); ++p) {
      const Point at = frame_.at(grid_.centre(formation_.cells[p]));
      const std::string name = canvas_.shortened(show_.performers[p].name, kNameSizePx, pitch_px - 4);
      canvas_.text(name, {at.x, at.y + dot_px + 14}, kNameSizePx, theme_.text, 0.5);
    }
  }

  enum class Standing { in_picture, outside, waits };

  [[nodiscard]] Standing standing(CellIndex cell) const {
    if (in_reserve(cell)) return Standing::waits;
    return mask() == nullptr || film_.shows(*mask(), grid_.centre(cell)) ? Standing::in_picture : Standing::outside;
  }

  /// A dot; a ring for who is not where the film shows something; small and dim for who waits.
  void person(Point at, double dot_px, Standing standing, std::size_t performer) {
    canvas_.ink(colour_of(performer, standing == Standing::waits ? 0.45 : 1));
    if (standing == Standing::outside) {
      canvas_.ring(at, dot_px, std::max(1.5, 0.3 * dot_px));
    } else {
      canvas_.disc(at, (standing == Standing::waits ? 0.6 : 1) * dot_px);
    }
  }

  /// What the marks mean, of those that are there.
  void legend() {
    cairo_t* c = canvas_.cairo();
    const double y = kTopPx + frame_.height() + 66;
    double x = kLeftPx;
    const auto entry = [&](const char* words, const auto& mark) {
      mark(Point{x + 8, y - 4});
      canvas_.text(words, {x + 24, y}, kLegendSizePx, theme_.faint, 0);
      x += 24 + canvas_.width_of(words, kLegendSizePx) + 22;
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
        canvas_.ink(colour_of(0, 0.7));
        cairo_set_line_width(c, 1.5);
        cairo_move_to(c, at.x - 8, at.y);
        cairo_line_to(c, at.x + 6, at.y);
        cairo_stroke(c);
        canvas_.disc({at.x + 6, at.y}, 2.5);
      });
    }
    if (mask() != nullptr) {
      entry("the film", [&](Point at) {
        canvas_.ink({theme_.film.red, theme_.film.green, theme_.film.blue, 0.6});
        cairo_rectangle(c, at.x - 7, at.y - 6, 14, 12);
        cairo_fill(c);
      });
    }
    if (!plan_.stage.blocked.empty())
      entry("blocked", [&](Point at) {
        canvas_.ink(theme_.blocked);
        canvas_.cross(at, 6);
      });
  }

  void sides() {
    const double middle = frame_.at({0, 0}).x;
    const double below = kTopPx + frame_.height() + 38;
    canvas_.text("audience", {middle, below}, 13, theme_.faint, 0.5);
    canvas_.text("stage right", {kLeftPx, below}, 13, theme_.faint, 0);
    canvas_.text("stage left", {kLeftPx + frame_.width(), below}, 13, theme_.faint, 1);
  }

  void title() {
    const std::string name = plan_.title.empty() ? formation_.id : plan_.title + " \xE2\x80\x94 " + formation_.id;
    canvas_.text(name, {kLeftPx, 34}, 22, theme_.text, 0, true);
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
    canvas_.text(facts, {kLeftPx, 60}, 14, theme_.faint, 0);
  }

  /// Paper that can be told from last week's.
  void stamp() {
    const double y = canvas_.height() - 16.0;
    canvas_.text(
        fmt::format("plan {}   clearance {:g} m   Footlight", plan_.show_hash.substr(0, 12), plan_.stage.clearance_m),
        {kLeftPx, y}, 12, theme_.faint, 0);
    if (!plan_.valid)
      canvas_.text("REFUSED: this plan breaks its limits", {canvas_.width() - kRightPx, y}, 16, theme_.refused, 1,
                   true);
  }

  const Plan& plan_;
  const Show& show_;
  FormationIndex index_;
  const Formation& formation_;
  FilmView film_;
  int first_frame_;  ///< of an image, which is all frames
  const Grid& grid_;
  const Theme& theme_ = kOnScreen;
  Frame frame_;
  Canvas canvas_;
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
