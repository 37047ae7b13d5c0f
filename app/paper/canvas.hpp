// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <utility>

#include <cairo.h>

#include "core/grid.hpp"
#include "core/look.hpp"

typedef struct _PangoLayout PangoLayout;  // NOLINT: as Pango declares it; its headers stay in canvas.cpp

namespace footlight::app {

struct Ink {
  double red, green, blue;
  double alpha = 1;
};

[[nodiscard]] inline Ink ink_of(Colour colour, double alpha = 1) {
  return {colour.red / 255.0, colour.green / 255.0, colour.blue / 255.0, alpha};
}

/// What a PDF says of itself.
struct Imprint {
  std::string title;
  std::string subject;
};

/// Everything within a radius of a straight line: a dot where both ends are one.
struct Capsule {
  Point from;
  Point to;
  double radius = 0;
  Ink colour;
};

/// A picture or pages with strokes and words: PNG, PDF or SVG. One unit is a pixel (PNG) or a point, 1/72 inch (PDF,
/// SVG); x to the right, y downwards. Words are set by Pango with whatever fonts fontconfig finds, so that Chinese and
/// accented names show. Colours stay as they were set last by `ink`. A canvas is used by the thread that made it, whose
/// fonts it shares with that thread's others. The only owner of Cairo and Pango.
class Canvas {
 public:
  [[nodiscard]] static Canvas png(int width_px, int height_px, Ink ground);
  /// A PDF whose pages have this size; begins with one. The same strokes give the same bytes.
  [[nodiscard]] static Canvas pdf(double width_pt, double height_pt, const Imprint& imprint);
  [[nodiscard]] static Canvas svg(double width_pt, double height_pt);

  [[nodiscard]] double width() const { return width_; }
  [[nodiscard]] double height() const { return height_; }
  [[nodiscard]] cairo_t* cairo() const { return cairo_.get(); }
  /// "zh-cn": which of several shapes a Chinese character has.
  void set_language(const char* code);

  void ink(Ink colour) const;
  /// The outline of a rectangle, filled, or stroked with a pen of this width.
  void fill_box(Point corner, double width, double height) const;
  void stroke_box(Point corner, double width, double height, double pen) const;
  void stroke_line(Point from, Point to, double pen) const;
  void disc(Point at, double radius) const;
  /// @param radius of its outer edge
  void ring(Point at, double radius, double pen) const;
  void cross(Point at, double radius) const;
  /// A filled head of an arrow that points from `from` to its tip.
  void arrow_head(Point from, Point tip, double size) const;

  /// Many capsules, one over the other; on a PNG without Cairo, which takes microseconds for each.
  void capsules(std::span<const Capsule> list);
  /// PNG: what another one of the same size shows.
  void copy(Canvas& other);

  /// One line. @param at on the base line  @param anchor 0: starts at x, 0.5: centred, 1: ends there
  void text(const std::string& words, Point at, double size, Ink colour, double anchor, bool bold = false);
  [[nodiscard]] double width_of(const std::string& words, double size, bool bold = false) const;
  /// The words as they fit into the width: whole, the first word, its beginning, or nothing.
  [[nodiscard]] std::string shortened(const std::string& words, double size, double width) const;
  /// The words as they fit into the width: whole, their beginning and an ellipsis, or nothing.
  [[nodiscard]] std::string beginning(const std::string& words, double size, double width) const;
  /// Words broken into lines of at most this width. @param top_left of the first line  @return the height taken
  double paragraph(const std::string& words, Point top_left, double width, double size, Ink colour, bool bold = false);
  [[nodiscard]] double height_of(const std::string& words, double width, double size, bool bold = false) const;
  /// How many characters no font here could show so far.
  [[nodiscard]] int missing_characters() const { return missing_; }

  /// PDF: a line of its table of contents that leads to this page.
  void bookmark(const std::string& words) const;
  /// PDF: ends this page and begins the next.
  void next_page();
  /// Rows of a PNG's pixels, 4 bytes each (blue, green, red, unused), `stride` bytes a row.
  [[nodiscard]] std::span<unsigned char> pixels();
  [[nodiscard]] int stride() const;
  /// The whole file; nothing can be drawn any more.
  [[nodiscard]] std::string finish();

 private:
  enum class Medium { png, pdf, svg };
  Canvas(Medium medium, double width, double height);
  void begin(cairo_surface_t* surface);
  void set(const std::string& words, double size, bool bold, double width) const;

  struct DestroySurface {
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  };
  struct DestroyContext {
    void operator()(cairo_t* context) const { cairo_destroy(context); }
  };
  struct DestroyLayout {
    void operator()(PangoLayout* layout) const;
  };
  Medium medium_;
  double width_;
  double height_;
  std::unique_ptr<std::string> bytes_;  ///< where a PDF or SVG is written; it stays where it is when the canvas moves
  std::unique_ptr<cairo_surface_t, DestroySurface> surface_;
  std::unique_ptr<cairo_t, DestroyContext> cairo_;
  std::unique_ptr<PangoLayout, DestroyLayout> layout_;
  mutable std::pair<double, bool> font_{0, false};  ///< of the layout
  int missing_ = 0;
  int page_ = 1;
};

}  // namespace footlight::app
