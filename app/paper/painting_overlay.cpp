// SPDX-License-Identifier: Apache-2.0
#include "app/paper/painting_overlay.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <numeric>
#include <utility>
#include <variant>

#include <cairo.h>
#include <fmt/format.h>

#include "app/paper/canvas.hpp"
#include "app/paper/drawn_floor.hpp"

namespace footlight::app {
namespace {

using planner::PaintedScene;
using planner::PixelSet;
using planner::Stroke;

constexpr double kLeft = 48;
constexpr double kTop = 62;
constexpr double kBottom = 48;
constexpr double kGap = 28;
constexpr double kPanel = 300;
constexpr double kLargest = 1000;  // side of the floor
constexpr double kArrow = 20;      // side of a square of the field
constexpr double kSize = 13;
constexpr double kPaintAlpha = 0.35;

// Okabe and Ito's, which people of every colour vision tell apart.
constexpr Ink kStrokeInk{0.835, 0.369, 0};
constexpr Ink kFieldInk{0, 0.447, 0.698};
constexpr Ink kShapeInk{0, 0.62, 0.451};
constexpr Ink kWallFieldInk{0.8, 0.475, 0.655};
constexpr Ink kWallInk{0.15, 0.15, 0.15};
constexpr Ink kHalo{1, 1, 1, 0.8};

/// One thing in the column beside the floor: words, behind a mark where they explain one.
struct Entry {
  std::string words;
  double indent = 0;
  bool bold = false;
  Ink ink = kOnPaper.text;
  double above = 3;                   ///< empty
  std::function<void(Point)> mark{};  ///< drawn around a point
};

std::vector<FieldArrow> arrows_of(const PaintedScene& scene, double side_m, double least,
                                  const std::function<Point(int, int)>& field) {
  std::vector<FieldArrow> out;
  const int columns = static_cast<int>(scene.width * scene.floor.pixel_m / side_m);
  const int rows = static_cast<int>(scene.height * scene.floor.pixel_m / side_m);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const Point pixel = (side_m / scene.floor.pixel_m) * Point{column + 0.5, row + 0.5};
      const Point way = field(static_cast<int>(pixel.x), static_cast<int>(pixel.y));
      // A picture's y points down, the floor's upstage.
      if (length(way) >= least) out.push_back({scene.floor.to_floor(pixel), {way.x, -way.y}});
    }
  }
  return out;
}

class Overlay {
 public:
  Overlay(const PaintingTask& task, bool svg)
      : show_(*task.show),
        section_(show_.sections[task.section.at()]),
        scene_(*task.scene),
        picture_(task.picture),
        frame_(show_.stage.grid, {kLeft, kTop}, kLargest, kLargest),
        entries_(entries()),
        canvas_(made(svg)) {}

  std::string draw() {
    const DrawnFloor floor(canvas_, frame_, show_.stage, kOnPaper);
    floor.ground(show_.stage.reserve);
    painting();
    floor.lines();
    fields();
    walls();
    for (const PaintedScene::Party& party : scene_.parties) shapes(party);
    for (const PaintedScene::Party& party : scene_.parties) strokes(party);
    for (const PaintedScene::Party& party : scene_.parties) labels(party);
    floor.labels(11);
    title();
    panel();
    return canvas_.finish();
  }

 private:
  [[nodiscard]] Point at(Point pixel) const { return frame_.at(scene_.floor.to_floor(pixel)); }
  [[nodiscard]] double units(double pixels) const { return pixels * scene_.floor.pixel_m * frame_.scale; }

  /// As high as the floor or the column beside it, whichever is higher.
  [[nodiscard]] Canvas made(bool svg) const {
    const Canvas scratch = Canvas::png(1, 1, kOnPaper.ground);
    double column = 0;
    for (const Entry& entry : entries_) {
      column += entry.above + scratch.height_of(entry.words, kPanel - entry.indent, kSize, entry.bold);
    }
    const double width = std::ceil(kLeft + frame_.width() + kGap + kPanel + kGap);
    const double height = std::ceil(kTop + std::max(frame_.height(), column) + kBottom);
    if (!svg) return Canvas::png(static_cast<int>(width), static_cast<int>(height), kOnPaper.ground);
    Canvas out = Canvas::svg(width, height);
    out.ink(kOnPaper.ground);
    out.fill_box({0, 0}, width, height);
    return out;
  }

  void painting() {
    cairo_t* c = canvas_.cairo();
    cairo_surface_t* source = cairo_image_surface_create(CAIRO_FORMAT_RGB24, picture_.width, picture_.height);
    const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(source));
    unsigned char* pixels = cairo_image_surface_get_data(source);
    for (int y = 0; y < picture_.height && pixels != nullptr; ++y) {
      for (int x = 0; x < picture_.width; ++x) {
        const Colour colour = picture_.at(x, y);
        unsigned char* to = pixels + static_cast<std::size_t>(y) * stride + 4 * static_cast<std::size_t>(x);
        to[0] = colour.blue;
        to[1] = colour.green;
        to[2] = colour.red;
      }
    }
    cairo_surface_mark_dirty(source);
    const Point corner = frame_.at(scene_.picture.corner);
    const double scale = scene_.picture.pixel_m * frame_.scale;
    cairo_save(c);
    cairo_translate(c, corner.x, corner.y);
    cairo_scale(c, scale, scale);
    cairo_set_source_surface(c, source, 0, 0);
    cairo_paint_with_alpha(c, kPaintAlpha);
    cairo_restore(c);
    cairo_surface_destroy(source);
  }

  void arrow(Point middle, Point way, Ink ink) {
    const Point half = (0.46 * kArrow) * Point{way.x, -way.y};
    canvas_.ink(ink);
    canvas_.stroke_line(middle - half, middle + half, 1.2);
    canvas_.arrow_head(middle - half, middle + half, std::min(6.0, 1.4 * length(half)));
  }

  void fields() {
    const FieldArrows arrows = field_arrows(scene_, kArrow / frame_.scale);
    for (const FieldArrow& one : arrows.background) arrow(frame_.at(one.at), one.way, kWallFieldInk);
    for (const FieldArrow& one : arrows.strokes) arrow(frame_.at(one.at), one.way, kFieldInk);
  }

  /// Slanting lines over what the path on the canvas encloses; takes the path.
  void hatch(Point from, Point to) {
    cairo_t* c = canvas_.cairo();
    cairo_save(c);
    cairo_clip(c);
    canvas_.ink(kWallInk);
    const double high = to.y - from.y;
    for (double x = from.x - high; x < to.x; x += 6) canvas_.stroke_line({x, to.y}, {x + high, from.y}, 1.2);
    cairo_restore(c);
  }

  void walls() {
    if (scene_.ways->blocked().empty()) return;
    cairo_t* c = canvas_.cairo();
    const auto path = [&] {
      for (const CellIndex cell : scene_.ways->blocked()) {
        cairo_new_sub_path(c);
        for (const Point corner : show_.stage.grid.outline(cell)) {
          const Point to = frame_.at(corner);
          cairo_line_to(c, to.x, to.y);
        }
        cairo_close_path(c);
      }
    };
    canvas_.ink({1, 1, 1, 0.6});
    path();
    cairo_fill(c);
    path();
    hatch(frame_.corner, frame_.corner + Point{frame_.width(), frame_.height()});
  }

  /// The sides of pixels between those of the set and others, drawn as runs.
  void outline(const PixelSet& set) {
    cairo_t* c = canvas_.cairo();
    const auto has = [&](int x, int y) { return set.inside(x, y) && set.at(x, y) != 0; };
    const auto runs = [&](int lines, int steps, const auto& edge, const auto& corner) {
      for (int line = 0; line <= lines; ++line) {
        for (int begin = 0; begin < steps; ++begin) {
          int end = begin;
          while (end < steps && edge(line, end)) ++end;
          if (end == begin) continue;
          const Point from = at(corner(line, begin));
          const Point to = at(corner(line, end));
          cairo_move_to(c, from.x, from.y);
          cairo_line_to(c, to.x, to.y);
          begin = end;
        }
      }
    };
    runs(
        set.height, set.width, [&](int y, int x) { return has(x, y - 1) != has(x, y); },
        [](int y, int x) {
          return Point{double(x), double(y)};
        });
    runs(
        set.width, set.height, [&](int x, int y) { return has(x - 1, y) != has(x, y); },
        [](int x, int y) {
          return Point{double(x), double(y)};
        });
    canvas_.ink(kShapeInk);
    cairo_set_line_cap(c, CAIRO_LINE_CAP_SQUARE);
    cairo_set_line_width(c, 2);
    cairo_stroke(c);
    cairo_set_line_cap(c, CAIRO_LINE_CAP_BUTT);
  }

  void shapes(const PaintedScene::Party& party) {
    for (const PixelSet& shape : party.shapes) outline(shape);
    const double dot = std::clamp(0.18 * show_.stage.grid.pitch_m() * frame_.scale, 1.2, 4.0);
    canvas_.ink(kOnPaper.text);
    for (std::size_t s = 0; s < party.places.size(); ++s) {
      for (const Point place : party.places[s]) canvas_.disc(frame_.at(place), dot);
    }
  }

  void polyline(const std::vector<Point>& line, Ink ink, double pen) {
    cairo_t* c = canvas_.cairo();
    for (const Point pixel : line) {
      const Point to = at(pixel);
      cairo_line_to(c, to.x, to.y);
    }
    canvas_.ink(ink);
    cairo_set_line_width(c, pen);
    cairo_stroke(c);
  }

  /// One edge of a stroke's width. @param side 1 or -1
  [[nodiscard]] static std::vector<Point> edge(const Stroke& stroke, double side) {
    std::vector<Point> out;
    for (std::size_t i = 0; i < stroke.line.size(); ++i) {
      const Point along = stroke.line[std::min(i + 1, stroke.line.size() - 1)] - stroke.line[i == 0 ? 0 : i - 1];
      const double n = std::max(1e-9, length(along));
      out.push_back(stroke.line[i] + (side * stroke.half_width[i] / n) * Point{-along.y, along.x});
    }
    return out;
  }

  void stroke(const Stroke& one) {
    cairo_t* c = canvas_.cairo();
    constexpr double kDash[] = {5, 4};
    cairo_set_dash(c, kDash, 2, 0);
    polyline(edge(one, 1), kStrokeInk, 1.3);
    polyline(edge(one, -1), kStrokeInk, 1.3);
    cairo_set_dash(c, nullptr, 0, 0);
    polyline(one.line, kHalo, 6);
    polyline(one.line, kStrokeInk, 3);
    polyline(one.skeleton, kOnPaper.text, 0.9);
    const Point tail = at(one.line.front());
    canvas_.ink(kOnPaper.ground);
    canvas_.disc(tail, 6);
    canvas_.ink(kStrokeInk);
    canvas_.ring(tail, 7, 3);
    heads(one);
  }

  /// An arrow at the head, and one every so often on the way.
  void heads(const Stroke& one) {
    constexpr double kApart = 90;
    const double whole = units(one.length_px());
    const int between = std::max(0, static_cast<int>(whole / kApart) - 1);
    canvas_.ink(kStrokeInk);
    const auto last = static_cast<double>(one.line.size() - 1);
    for (int k = 1; k <= between + 1; ++k) {
      const auto i = static_cast<std::size_t>(std::lround(last * k / (between + 1)));
      const std::size_t before = i - std::min<std::size_t>(i, 3);
      const Point tip = at(one.line[i]);
      canvas_.arrow_head(at(one.line[before]), tip, k == between + 1 ? 20 : 14);
    }
  }

  void strokes(const PaintedScene::Party& party) {
    for (const PaintedScene::Leg& leg : party.legs) {
      for (const Stroke& one : leg.strokes) stroke(one);
    }
  }

  /// In the widest part of a shape, where no stroke begins or ends.
  void labels(const PaintedScene::Party& party) {
    const std::string name = party.group ? show_.groups[party.group->at()].name + " " : "";
    for (std::size_t s = 0; s < party.shapes.size(); ++s) {
      PixelSet outside = party.shapes[s];
      for (std::uint8_t& pixel : outside.cells) pixel = pixel == 0 ? 1 : 0;
      const auto away = planner::nearest_pixels(outside).distance_px;
      const auto widest = std::ranges::max_element(away.cells) - away.cells.begin();
      const Point middle =
          at({static_cast<double>(widest % away.width) + 0.5, static_cast<double>(widest / away.width) + 0.5});
      label(fmt::format("{}{}: {}", name, party.orders[s], party.people), middle);
    }
  }

  /// Kept within the floor's width.
  void label(const std::string& words, Point middle) {
    const double width = canvas_.width_of(words, kSize, true);
    const double half = std::min(width, frame_.width()) / 2;
    const double x = std::clamp(middle.x, kLeft + half, kLeft + frame_.width() - half);
    canvas_.ink(kHalo);
    canvas_.fill_box({x - width / 2 - 3, middle.y - 9}, width + 6, 18);
    canvas_.text(words, {x, middle.y + 4.5}, kSize, kOnPaper.text, 0.5, true);
  }

  void title() {
    const std::string words = show_.title.empty() ? section_.name : show_.title + " \xE2\x80\x94 " + section_.name;
    canvas_.text(canvas_.beginning(words, 20, frame_.width()), {kLeft, 26}, 20, kOnPaper.text, 0, true);
    const double below = kTop + frame_.height() + 34;
    canvas_.text("audience", {frame_.at({0, 0}).x, below}, kSize, kOnPaper.faint, 0.5);
    canvas_.text("stage right", {kLeft, below}, kSize, kOnPaper.faint, 0);
    canvas_.text("stage left", {kLeft + frame_.width(), below}, kSize, kOnPaper.faint, 1);
  }

  void panel() {
    double y = kTop;
    const double x = kLeft + frame_.width() + kGap;
    for (const Entry& entry : entries_) {
      y += entry.above;
      if (entry.mark) entry.mark({x + 12, y + 9});
      y += canvas_.paragraph(entry.words, {x + entry.indent, y}, kPanel - entry.indent, kSize, entry.ink, entry.bold);
    }
  }

  [[nodiscard]] std::vector<Entry> entries() {
    const std::filesystem::path file = std::get<PaintingSource>(section_.from).path;
    std::vector<Entry> out{{fmt::format("{}, {} x {} pixels of {:.3g} m", file.filename().string(), picture_.width,
                                        picture_.height, scene_.picture.pixel_m),
                            0, false, kOnPaper.faint, 0}};
    for (const PaintedScene::Party& party : scene_.parties) {
      out.push_back({party_name(show_, party), 0, true, kOnPaper.text, 10});
      for (std::string& line : party_lines(scene_, party)) out.push_back({std::move(line), 14});
    }
    if (!scene_.notes.empty()) out.push_back({"Warnings", 0, true, kOnPaper.refused, 22});
    for (const std::string& note : scene_.notes) out.push_back({note, 14, false, kOnPaper.refused});
    legend(out);
    return out;
  }

  [[nodiscard]] bool has_strokes() const {
    return std::ranges::any_of(scene_.parties, [](const PaintedScene::Party& party) {
      return std::ranges::any_of(party.legs, [](const PaintedScene::Leg& leg) { return !leg.strokes.empty(); });
    });
  }

  /// Of the marks that are there.
  void legend(std::vector<Entry>& out) {
    const auto entry = [&](const char* words, std::function<void(Point)> mark) {
      out.push_back({words, 34, false, kOnPaper.text, 7, std::move(mark)});
    };
    entry("a shape: its number and how many people; a dot for each of them", [this](Point p) {
      canvas_.ink(kShapeInk);
      canvas_.stroke_box({p.x - 11, p.y - 7}, 22, 14, 2);
      canvas_.ink(kOnPaper.text);
      canvas_.disc(p, 2.5);
    });
    out[out.size() - 1].above = 24;
    if (has_strokes()) {
      entry("a stroke: its skeleton, from the tail (ring) to the head, smoothed; dashed: its width", [this](Point p) {
        canvas_.ink(kStrokeInk);
        canvas_.stroke_line({p.x - 8, p.y}, {p.x + 6, p.y}, 3);
        canvas_.ring({p.x - 8, p.y}, 5, 2.5);
        canvas_.arrow_head({p.x - 8, p.y}, {p.x + 13, p.y}, 12);
      });
      entry("the field of a stroke: where people are led, the longer the more", [this](Point p) {
        arrow({p.x - 5, p.y}, {0.9, 0}, kFieldInk);
      });
    }
    if (planner::count(scene_.background) > 0) {
      entry("the background's field: where it pushes or pulls people", [this](Point p) {
        arrow({p.x - 5, p.y}, {0.9, 0}, kWallFieldInk);
      });
    }
    if (!scene_.ways->blocked().empty()) {
      entry("blocked cells: walls of the painting and of the stage", [this](Point p) {
        cairo_rectangle(canvas_.cairo(), p.x - 11, p.y - 7, 22, 14);
        hatch({p.x - 11, p.y - 7}, {p.x + 11, p.y + 7});
      });
    }
  }

  const Show& show_;
  const Section& section_;
  const PaintedScene& scene_;
  planner::RgbPicture picture_;
  Frame frame_;
  std::vector<Entry> entries_;
  Canvas canvas_;
};

std::string stroke_words(const PaintedScene& scene, const Stroke& stroke) {
  return fmt::format("stroke of {:.1f} m, {:.1f} m wide, {:.0f} of 255 darker at its head",
                     stroke.length_px() * scene.floor.pixel_m, mean_width_m(scene, stroke), stroke.fall);
}

}  // namespace

FieldArrows field_arrows(const PaintedScene& scene, double side_m, double least) {
  FieldArrows out;
  for (const PaintedScene::Party& party : scene.parties) {
    for (const PaintedScene::Leg& leg : party.legs) {
      for (const planner::FlowField& field : leg.fields) {
        auto more = arrows_of(scene, side_m, least,
                              [&](int x, int y) { return field.strength.at(x, y) * field.direction.at(x, y); });
        out.strokes.insert(out.strokes.end(), more.begin(), more.end());
      }
    }
  }
  out.background = arrows_of(scene, side_m, least, [&](int x, int y) { return scene.background_field.at(x, y); });
  return out;
}

std::string painting_overlay(const PaintingTask& task, bool svg) { return Overlay(task, svg).draw(); }

std::string party_name(const Show& show, const PaintedScene::Party& party) {
  return fmt::format("{}: {} people", party.group ? show.groups[party.group->at()].name : "everybody else",
                     party.people);
}

std::vector<std::string> party_lines(const PaintedScene& scene, const PaintedScene::Party& party) {
  std::vector<std::string> out;
  for (std::size_t s = 0; s < party.shapes.size(); ++s) {
    out.push_back(fmt::format("shape {}: {:.0f} m2", party.orders[s], area_m2(scene, party.shapes[s])));
    if (s == party.legs.size()) continue;
    const std::string from_to = fmt::format("{} to {}: ", party.orders[s], party.orders[s + 1]);
    for (const Stroke& stroke : party.legs[s].strokes) out.push_back(from_to + stroke_words(scene, stroke));
    if (party.legs[s].strokes.empty()) out.push_back(from_to + "no stroke, the shortest way");
  }
  return out;
}

double area_m2(const PaintedScene& scene, const PixelSet& shape) {
  return static_cast<double>(planner::count(shape)) * scene.floor.pixel_m * scene.floor.pixel_m;
}

double mean_width_m(const PaintedScene& scene, const Stroke& stroke) {
  const double sum = std::accumulate(stroke.half_width.begin(), stroke.half_width.end(), 0.0);
  return 2 * sum / static_cast<double>(stroke.half_width.size()) * scene.floor.pixel_m;
}

}  // namespace footlight::app
