// SPDX-License-Identifier: Apache-2.0
#include "app/paper/preview.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "app/numbers.hpp"
#include "app/paper/drawn_floor.hpp"

namespace footlight::app {
namespace {

constexpr double kPerson_m = 1.7;
constexpr double kDot = 0.4;  // radius, pitches
constexpr double kSmallestDot = 1.2;
constexpr double kWaiting = 0.45;  // alpha of who waits in the reserve
constexpr Ink kInside{0.92, 0.93, 0.95};

double words_size(double height) { return std::clamp(height / 45, 7.0, 24.0); }

}  // namespace

Preview::Preview(const Plan& plan, const Show& show, std::vector<const Film*> films, PreviewStyle style, Point corner,
                 double width, double height)
    : plan_(plan), show_(show), style_(style), view_(style.seat, plan.stage.grid, corner, width, height) {
  films.resize(plan.sections.size(), nullptr);
  for (std::size_t s = 0; s < plan.sections.size(); ++s) {
    films_.emplace_back(plan, SectionIndex::of(s), style.film ? films[s] : nullptr);
    std::vector<bool>& reserve = reserve_.emplace_back(static_cast<std::size_t>(plan.stage.grid.size()));
    for (const CellIndex cell : plan.sections[s].reserve) reserve[cell.at()] = true;
  }
}

SectionIndex Preview::section_of(Instant instant) const { return SectionIndex::of(section_at(plan_, instant)); }

double Preview::dot_radius(Point floor) const {
  return std::max(kSmallestDot, kDot * plan_.stage.grid.pitch_m() * view_.scale_at(floor));
}

void Preview::draw_ground(Canvas& canvas, SectionIndex section) const {
  if (style_.seat == Seat::audience) {
    ground_from_audience(canvas, section);
    return;
  }
  const DrawnFloor floor(canvas, view_.frame(), plan_.stage, kOnScreen);
  floor.ground(plan_.sections[section.at()].reserve);
  floor.lines();
  floor.blocked();
}

void Preview::ground_from_audience(Canvas& canvas, SectionIndex section) const {
  cairo_t* c = canvas.cairo();
  const Grid& grid = plan_.stage.grid;
  const auto cell_path = [&](CellIndex cell) {
    cairo_new_sub_path(c);
    for (const Point corner : grid.outline(cell)) {
      const Point at = view_.at(corner);
      cairo_line_to(c, at.x, at.y);
    }
    cairo_close_path(c);
  };
  canvas.ink(kOnScreen.floor);
  for (int i = 0; i < grid.size(); ++i) cell_path(CellIndex::of(i));
  cairo_fill(c);
  canvas.ink(kOnScreen.wings);
  for (const CellIndex cell : plan_.sections[section.at()].reserve) cell_path(cell);
  cairo_fill(c);
  canvas.ink({kOnScreen.blocked.red, kOnScreen.blocked.green, kOnScreen.blocked.blue, 0.35});
  for (const CellIndex cell : plan_.stage.blocked) cell_path(cell);
  cairo_fill(c);
  const Frame& frame = view_.frame();
  const double step = 10 * grid.pitch_m();
  canvas.ink(kOnScreen.tenth_line);
  for (double x = frame.low.x; x < frame.high.x + 1e-9; x += step) {
    canvas.stroke_line(view_.at({x, frame.low.y}), view_.at({x, frame.high.y}), 1);
  }
  for (double y = frame.low.y; y < frame.high.y + 1e-9; y += step) {
    canvas.stroke_line(view_.at({frame.low.x, y}), view_.at({frame.high.x, y}), 1);
  }
  canvas.ink(kOnScreen.centre_line);
  canvas.stroke_line(view_.at({0, frame.low.y}), view_.at({0, frame.high.y}), 1);
}

void Preview::film_from_audience(Canvas& canvas, const Mask& picture, const StageToFrame& m) const {
  const Frame& frame = view_.frame();
  const double area = m[0] * m[4] - m[1] * m[3];
  // From the film's pixels to metres, no farther than the floor's edges: what lies behind the eye has no place.
  const auto at = [&](int x, int y) {
    const double u = x - m[2];
    const double v = y - m[5];
    const Point floor{(m[4] * u - m[1] * v) / area, (m[0] * v - m[3] * u) / area};
    return view_.at({std::clamp(floor.x, frame.low.x, frame.high.x), std::clamp(floor.y, frame.low.y, frame.high.y)});
  };
  cairo_t* c = canvas.cairo();
  // All runs of pixels are one path: where two touch there is no seam.
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      if (!picture.at(x, y)) continue;
      const int first = x;
      while (x < picture.width() && picture.at(x, y)) ++x;
      cairo_new_sub_path(c);
      for (const Point corner : {at(first, y), at(x, y), at(x, y + 1), at(first, y + 1)}) {
        cairo_line_to(c, corner.x, corner.y);
      }
      cairo_close_path(c);
    }
  }
  canvas.ink(kOnScreen.film);
  cairo_fill(c);
}

Ink Preview::colour_of(std::size_t performer, Point at, SectionIndex section, const Mask* picture) const {
  const bool waits = reserve_[section.at()][plan_.stage.grid.nearest(at).at()];
  const double alpha = waits ? kWaiting : 1;
  if (style_.film && picture != nullptr && !waits) {
    return films_[section.at()].shows(*picture, at) ? kInside : kOutside;
  }
  Colour colour = show_.default_colour;
  if (performer < show_.performers.size() && show_.performers[performer].group) {
    colour = show_.groups.at(show_.performers[performer].group->at()).colour;
  }
  return ink_of(colour, alpha);
}

void Preview::draw_people(Canvas& canvas, Instant instant) const {
  const SectionIndex section = section_of(instant);
  const Mask* picture = films_[section.at()].at(instant);
  if (picture != nullptr && style_.seat == Seat::above) {
    const DrawnFloor floor(canvas, view_.frame(), plan_.stage, kOnScreen);
    floor.film(*picture, films_[section.at()].placement());
  } else if (picture != nullptr) {
    film_from_audience(canvas, *picture, films_[section.at()].placement());
  }
  std::vector<std::pair<double, Capsule>> people;
  people.reserve(plan_.tracks.size());
  for (std::size_t p = 0; p < plan_.tracks.size(); ++p) {
    const Point at = position_at(plan_.stage.grid, plan_.tracks[p], instant);
    const Ink colour = colour_of(p, at, section, picture);
    const double radius = dot_radius(at);
    if (style_.seat == Seat::above) {
      people.push_back({0, {view_.at(at), view_.at(at), radius, colour}});
    } else {
      const double thick = 0.6 * radius;
      const Point feet = view_.at(at);
      const Point head = view_.at(at, kPerson_m);
      people.push_back({-view_.depth_of(at), {feet + Point{0, -thick}, head + Point{0, thick}, thick, colour}});
    }
  }
  // Those behind first.
  std::ranges::stable_sort(people, {}, [](const auto& one) { return one.first; });
  std::vector<Capsule> drawn;
  drawn.reserve(people.size());
  for (const auto& one : people) drawn.push_back(one.second);
  canvas.capsules(drawn);
}

PreviewFrame::PreviewFrame(const Plan& plan, const Show& show, const Stamp& stamp, std::vector<const Film*> films,
                           PreviewStyle style, double width, double height)
    : plan_(plan),
      show_(show),
      stamp_(stamp),
      words_(words_size(height)),
      preview_(plan, show, std::move(films), style, {words_, 2.2 * words_}, width - 2 * words_, height - 4.2 * words_) {
}

void PreviewFrame::draw_still(Canvas& canvas, SectionIndex section) const {
  canvas.ink(kOnScreen.ground);
  canvas.fill_box({0, 0}, canvas.width(), canvas.height());
  preview_.draw_ground(canvas, section);
  const double room = canvas.width() - 2 * words_;
  constexpr double kCountRoom = 16;  // of the count on the right, in sizes of words; bold letters are wider
  const double title_room = 0.85 * (room - kCountRoom * words_);
  canvas.text(canvas.beginning(stamp_.title + "   " + plan_.sections[section.at()].name, words_, title_room),
              {words_, 1.5 * words_}, words_, kOnScreen.text, 0, true);
  canvas.text(stamp_.line_of(canvas, 0.7 * words_, room), {words_, canvas.height() - 0.6 * words_}, 0.7 * words_,
              stamp_.valid ? kOnScreen.faint : kOnScreen.refused, 0);
}

void PreviewFrame::draw_moving(Canvas& canvas, Instant instant) const {
  preview_.draw_people(canvas, instant);
  constexpr double kOnTheCount = 1e-6;
  const double count = std::floor(show_.tempo.count_at(instant) + kOnTheCount);
  canvas.text(fmt::format("count {:.0f}   {}   {:.1f} s", count, show_.tempo.measure_beat(count), to_seconds(instant)),
              {canvas.width() - words_, 1.5 * words_}, words_, kOnScreen.text, 1);
}

namespace {

/// As many columns as make pictures of this shape largest.
int columns_for(int pictures, double width, double height, double shape) {
  int out = 1;
  double best = 0;
  for (int n = 1; n <= pictures; ++n) {
    const int rows = (pictures + n - 1) / n;
    const double size = std::min(width / n, height / rows * shape);
    if (size <= best) continue;
    best = size;
    out = n;
  }
  return out;
}

}  // namespace

void draw_contact_sheet(Canvas& canvas, const Plan& plan, const Show& show, const Stamp& stamp,
                        const std::vector<const Film*>& films, PreviewStyle style) {
  std::vector<const Formation*> shown;
  for (const Formation& formation : plan.formations) {
    if (formation.key) shown.push_back(&formation);
  }
  const double words = words_size(canvas.height());
  canvas.ink(kOnScreen.ground);
  canvas.fill_box({0, 0}, canvas.width(), canvas.height());
  const double room = canvas.width() - 2 * words;
  canvas.text(canvas.beginning(stamp.title, words, 0.85 * room), {words, 1.5 * words}, words, kOnScreen.text, 0, true);
  canvas.text(stamp.line_of(canvas, 0.7 * words, room), {words, canvas.height() - 0.6 * words}, 0.7 * words,
              kOnScreen.faint, 0);
  if (shown.empty()) return;
  const double width = canvas.width() - 2 * words;
  const double height = canvas.height() - 4 * words;
  const Frame whole(plan.stage.grid, {}, 1, 1);
  const int pictures = static_cast<int>(shown.size());
  const int columns = columns_for(pictures, width, height, (whole.high.x - whole.low.x) / (whole.high.y - whole.low.y));
  const int rows = (pictures + columns - 1) / columns;
  const double name = std::clamp(0.05 * width / columns, 5.0, 14.0);
  for (int i = 0; i < pictures; ++i) {
    const Formation& formation = *shown[static_cast<std::size_t>(i)];
    const Point corner{words + i % columns * (width / columns), 2.4 * words + i / columns * (height / rows)};
    const double wide = 0.95 * width / columns;
    const double high = height / rows - 2.2 * name;
    const Preview one(plan, show, films, style, corner, wide, high);
    one.draw_ground(canvas, formation.section);
    one.draw_people(canvas, formation.time);
    const std::string label = fmt::format("{}   {:g}", formation.id, tidy_count(formation.count));
    canvas.text(canvas.shortened(label, name, wide), {corner.x + wide / 2, corner.y + high + 1.4 * name}, name,
                kOnScreen.faint, 0.5);
  }
}

}  // namespace footlight::app
