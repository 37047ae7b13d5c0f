// SPDX-License-Identifier: Apache-2.0
#include "app/paper/canvas.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string_view>

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <pango/pangocairo.h>

#include "app/paper/capsules.hpp"
#include "core/check.hpp"

namespace footlight::app {
namespace {

constexpr const char* kEllipsis = "\xE2\x80\xA6";
// Older than every show, so that the same pages are the same bytes.
constexpr const char* kNoDate = "2000-01-01T00:00:00Z";

cairo_status_t append(void* to, const unsigned char* data, unsigned size) {
  static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(data), size);
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace

void Canvas::DestroyLayout::operator()(PangoLayout* layout) const { g_object_unref(layout); }

Canvas::Canvas(Medium medium, double width, double height)
    : medium_(medium), width_(width), height_(height), bytes_(std::make_unique<std::string>()) {}

void Canvas::begin(cairo_surface_t* surface) {
  surface_.reset(surface);
  cairo_.reset(cairo_create(surface));
  FL_CHECK(cairo_status(cairo()) == CAIRO_STATUS_SUCCESS);
  layout_.reset(pango_cairo_create_layout(cairo()));
  // Letters as wide as their outlines: a page breaks its lines alike on paper and on a screen.
  cairo_font_options_t* options = cairo_font_options_create();
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
  pango_cairo_context_set_font_options(pango_layout_get_context(layout_.get()), options);
  cairo_font_options_destroy(options);
  pango_layout_set_wrap(layout_.get(), PANGO_WRAP_WORD_CHAR);
}

Canvas Canvas::png(int width_px, int height_px, Ink ground) {
  Canvas out(Medium::png, width_px, height_px);
  out.begin(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width_px, height_px));
  out.ink(ground);
  cairo_paint(out.cairo());
  return out;
}

Canvas Canvas::pdf(double width_pt, double height_pt, const Imprint& imprint) {
  Canvas out(Medium::pdf, width_pt, height_pt);
  cairo_surface_t* surface = cairo_pdf_surface_create_for_stream(append, out.bytes_.get(), width_pt, height_pt);
  cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_TITLE, imprint.title.c_str());
  cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_SUBJECT, imprint.subject.c_str());
  cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATOR, "Footlight");
  cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, kNoDate);
  out.begin(surface);
  return out;
}

Canvas Canvas::svg(double width_pt, double height_pt) {
  Canvas out(Medium::svg, width_pt, height_pt);
  out.begin(cairo_svg_surface_create_for_stream(append, out.bytes_.get(), width_pt, height_pt));
  return out;
}

void Canvas::set_language(const char* code) {
  pango_context_set_language(pango_layout_get_context(layout_.get()), pango_language_from_string(code));
  pango_layout_context_changed(layout_.get());
}

void Canvas::ink(Ink colour) const {
  cairo_set_source_rgba(cairo(), colour.red, colour.green, colour.blue, colour.alpha);
}

void Canvas::fill_box(Point corner, double width, double height) const {
  cairo_rectangle(cairo(), corner.x, corner.y, width, height);
  cairo_fill(cairo());
}

void Canvas::stroke_box(Point corner, double width, double height, double pen) const {
  cairo_set_line_width(cairo(), pen);
  cairo_rectangle(cairo(), corner.x, corner.y, width, height);
  cairo_stroke(cairo());
}

void Canvas::stroke_line(Point from, Point to, double pen) const {
  cairo_set_line_width(cairo(), pen);
  cairo_move_to(cairo(), from.x, from.y);
  cairo_line_to(cairo(), to.x, to.y);
  cairo_stroke(cairo());
}

void Canvas::disc(Point at, double radius) const {
  cairo_new_path(cairo());
  cairo_arc(cairo(), at.x, at.y, radius, 0, 2 * std::numbers::pi);
  cairo_fill(cairo());
}

void Canvas::ring(Point at, double radius, double pen) const {
  cairo_new_path(cairo());
  cairo_set_line_width(cairo(), pen);
  cairo_arc(cairo(), at.x, at.y, radius - pen / 2, 0, 2 * std::numbers::pi);
  cairo_stroke(cairo());
}

void Canvas::cross(Point at, double radius) const {
  cairo_set_line_width(cairo(), std::max(1.0, radius / 6));
  cairo_move_to(cairo(), at.x - radius, at.y - radius);
  cairo_line_to(cairo(), at.x + radius, at.y + radius);
  cairo_move_to(cairo(), at.x - radius, at.y + radius);
  cairo_line_to(cairo(), at.x + radius, at.y - radius);
  cairo_stroke(cairo());
}

void Canvas::arrow_head(Point from, Point tip, double size) const {
  const Point way = tip - from;
  const double along = length(way);
  if (along == 0) return;
  const Point u = (1 / along) * way;
  const Point base = tip - size * u;
  const Point side = {-0.45 * size * u.y, 0.45 * size * u.x};
  cairo_move_to(cairo(), tip.x, tip.y);
  cairo_line_to(cairo(), base.x + side.x, base.y + side.y);
  cairo_line_to(cairo(), base.x - side.x, base.y - side.y);
  cairo_close_path(cairo());
  cairo_fill(cairo());
}

void Canvas::capsules(std::span<const Capsule> list) {
  if (medium_ == Medium::png) {
    blend_capsules(list, pixels(), stride(), static_cast<int>(width_), static_cast<int>(height_));
    cairo_surface_mark_dirty(surface_.get());
    return;
  }
  cairo_save(cairo());
  cairo_set_line_cap(cairo(), CAIRO_LINE_CAP_ROUND);
  for (const Capsule& one : list) {
    ink(one.colour);
    stroke_line(one.from, one.to, 2 * one.radius);
  }
  cairo_restore(cairo());
}

void Canvas::copy(Canvas& other) {
  const std::span<unsigned char> from = other.pixels();
  const std::span<unsigned char> to = pixels();
  FL_CHECK(from.size() == to.size());
  std::ranges::copy(from, to.begin());
  cairo_surface_mark_dirty(surface_.get());
}

void Canvas::set(const std::string& words, double size, bool bold, double width) const {
  PangoLayout* layout = layout_.get();
  if (font_ != std::pair(size, bold)) {
    font_ = {size, bold};
    PangoFontDescription* font = pango_font_description_from_string(bold ? "sans-serif bold" : "sans-serif");
    pango_font_description_set_absolute_size(font, size * PANGO_SCALE);
    pango_layout_set_font_description(layout, font);
    pango_font_description_free(font);
  }
  pango_layout_set_width(layout, width < 0 ? -1 : static_cast<int>(width * PANGO_SCALE));
  pango_layout_set_text(layout, words.c_str(), static_cast<int>(words.size()));
}

double Canvas::width_of(const std::string& words, double size, bool bold) const {
  set(words, size, bold, -1);
  int width = 0;
  pango_layout_get_size(layout_.get(), &width, nullptr);
  return static_cast<double>(width) / PANGO_SCALE;
}

void Canvas::text(const std::string& words, Point at, double size, Ink colour, double anchor, bool bold) {
  const double width = width_of(words, size, bold);
  missing_ += pango_layout_get_unknown_glyphs_count(layout_.get());
  ink(colour);
  const double rise = static_cast<double>(pango_layout_get_baseline(layout_.get())) / PANGO_SCALE;
  cairo_move_to(cairo(), at.x - anchor * width, at.y - rise);
  pango_cairo_show_layout(cairo(), layout_.get());
  cairo_new_path(cairo());
}

double Canvas::height_of(const std::string& words, double width, double size, bool bold) const {
  if (words.empty()) return 0;
  set(words, size, bold, width);
  int height = 0;
  pango_layout_get_size(layout_.get(), nullptr, &height);
  return static_cast<double>(height) / PANGO_SCALE;
}

double Canvas::paragraph(const std::string& words, Point top_left, double width, double size, Ink colour, bool bold) {
  if (words.empty()) return 0;
  const double height = height_of(words, width, size, bold);
  missing_ += pango_layout_get_unknown_glyphs_count(layout_.get());
  ink(colour);
  cairo_move_to(cairo(), top_left.x, top_left.y);
  pango_cairo_show_layout(cairo(), layout_.get());
  cairo_new_path(cairo());
  return height;
}

std::string Canvas::shortened(const std::string& words, double size, double width) const {
  if (width_of(words, size) <= width) return words;
  const std::string first = words.substr(0, words.find(' '));
  return width_of(first, size) <= width ? first : beginning(first, size, width);
}

std::string Canvas::beginning(const std::string& words, double size, double width) const {
  const auto fits = [&](const std::string& part) { return width_of(part, size) <= width; };
  if (fits(words)) return words;
  std::string part = words;
  while (!part.empty()) {
    // A character of UTF-8 is taken off as a whole.
    while (part.size() > 1 && (static_cast<unsigned char>(part.back()) & 0xC0U) == 0x80U) part.pop_back();
    part.pop_back();
    if (!part.empty() && fits(part + kEllipsis)) return part + kEllipsis;
  }
  return {};
}

void Canvas::bookmark(const std::string& words) const {
  const std::string place = "page=" + std::to_string(page_);
  if (medium_ == Medium::pdf)
    cairo_pdf_surface_add_outline(surface_.get(), CAIRO_PDF_OUTLINE_ROOT, words.c_str(), place.c_str(),
                                  static_cast<cairo_pdf_outline_flags_t>(0));
}

void Canvas::next_page() {
  cairo_show_page(cairo());
  ++page_;
}

std::span<unsigned char> Canvas::pixels() {
  FL_CHECK(medium_ == Medium::png);
  cairo_surface_flush(surface_.get());
  return {cairo_image_surface_get_data(surface_.get()),
          static_cast<std::size_t>(stride()) * static_cast<std::size_t>(height_)};
}

int Canvas::stride() const { return cairo_image_surface_get_stride(surface_.get()); }

namespace {

/// Numbers one kind of an SVG's parts anew.
std::string numbered_anew(const std::string& svg, std::string_view part) {
  std::map<std::string, std::size_t> known;
  std::string out;
  std::size_t done = 0;
  for (std::size_t at = svg.find(part); at != std::string::npos; at = svg.find(part, done)) {
    const std::size_t begin = at + part.size();
    const std::size_t end = std::min(svg.find_first_not_of("0123456789", begin), svg.size());
    out.append(svg, done, begin - done);
    if (end > begin)
      out += std::to_string(known.emplace(svg.substr(begin, end - begin), known.size() + 1).first->second);
    done = end;
  }
  return out.append(svg, done, std::string::npos);
}

/// Cairo numbers surfaces and pictures through a whole run of a program; here they begin with 1 in every file. Of
/// pictures where they are named and where they are used, for the same letters may stand in one's bytes.
std::string numbered_anew(const std::string& svg) {
  return numbered_anew(numbered_anew(numbered_anew(svg, "surface"), "\"image"), "\"#image");
}

}  // namespace

std::string Canvas::finish() {
  if (medium_ == Medium::png) {
    FL_CHECK(cairo_surface_write_to_png_stream(surface_.get(), append, bytes_.get()) == CAIRO_STATUS_SUCCESS);
  } else {
    cairo_surface_finish(surface_.get());
    FL_CHECK(cairo_surface_status(surface_.get()) == CAIRO_STATUS_SUCCESS);
  }
  return medium_ == Medium::svg ? numbered_anew(*bytes_) : std::move(*bytes_);
}

}  // namespace footlight::app
