// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>

#include <pango/pangocairo.h>

#include "config/decode_still.hpp"

namespace footlight::config {
namespace {

constexpr double kLine = 256;      // pixels of a line's height
constexpr double kLargest = 4096;  // pixels of the picture's longer side
constexpr const char* kAnyFont = "Sans Bold";

struct Unref {
  void operator()(PangoLayout* layout) const { g_object_unref(layout); }
  void operator()(PangoFontDescription* font) const { pango_font_description_free(font); }
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  void operator()(cairo_t* cairo) const { cairo_destroy(cairo); }
  void operator()(PangoLayoutIter* iter) const { pango_layout_iter_free(iter); }
};
template <class T>
using Owned = std::unique_ptr<T, Unref>;

bool is_installed(PangoLayout* layout, const char* family) {
  PangoFontFamily** families = nullptr;
  int count = 0;
  pango_context_list_families(pango_layout_get_context(layout), &families, &count);
  const bool found = std::any_of(families, families + count, [&](PangoFontFamily* one) {
    return g_ascii_strcasecmp(pango_font_family_get_name(one), family) == 0;
  });
  g_free(families);
  return found;
}

/// The first character that no glyph stands for; 0 when every one has its own.
gunichar missing_character(PangoLayout* layout) {
  if (pango_layout_get_unknown_glyphs_count(layout) == 0) return 0;
  const char* text = pango_layout_get_text(layout);
  const Owned<PangoLayoutIter> iter(pango_layout_get_iter(layout));
  do {
    const PangoLayoutRun* run = pango_layout_iter_get_run_readonly(iter.get());
    if (run == nullptr) continue;
    for (int i = 0; i < run->glyphs->num_glyphs; ++i) {
      if ((run->glyphs->glyphs[i].glyph & PANGO_GLYPH_UNKNOWN_FLAG) == 0) continue;
      return g_utf8_get_char(text + run->item->offset + run->glyphs->log_clusters[i]);
    }
  } while (pango_layout_iter_next_run(iter.get()) != 0);
  return g_utf8_get_char(text);
}

/// What the layout draws, at the origin.
cv::Mat drawn(PangoLayout* layout, const PangoRectangle& ink) {
  const Owned<cairo_surface_t> surface(cairo_image_surface_create(CAIRO_FORMAT_A8, ink.width, ink.height));
  const Owned<cairo_t> cairo(cairo_create(surface.get()));
  cairo_move_to(cairo.get(), -ink.x, -ink.y);
  pango_cairo_show_layout(cairo.get(), layout);
  cairo_surface_flush(surface.get());
  if (cairo_status(cairo.get()) != CAIRO_STATUS_SUCCESS) return {};
  const cv::Mat view(ink.height, ink.width, CV_8U, cairo_image_surface_get_data(surface.get()),
                     static_cast<std::size_t>(cairo_image_surface_get_stride(surface.get())));
  return view.clone();
}

/// Every character by this font or not at all.
void forbid_other_fonts(PangoLayout* layout) {
  PangoAttrList* attributes = pango_attr_list_new();
  pango_attr_list_insert(attributes, pango_attr_fallback_new(FALSE));
  pango_layout_set_attributes(layout, attributes);
  pango_attr_list_unref(attributes);
}

/// Sets the size of the font: a line's height, or less where the text would be too long. @return what is drawn then
PangoRectangle set_size(PangoLayout* layout, PangoFontDescription* description) {
  PangoRectangle ink{};
  for (double size = kLine;;) {
    pango_font_description_set_absolute_size(description, size * PANGO_SCALE);
    pango_layout_set_font_description(layout, description);
    pango_layout_get_pixel_extents(layout, &ink, nullptr);
    const double longest = std::max(ink.width, ink.height);
    if (longest <= kLargest) return ink;
    size *= 0.98 * kLargest / longest;
  }
}

}  // namespace

Still draw_text(const std::string& text, const std::string& font) {
  Still out;
  if (g_utf8_validate(text.data(), static_cast<gssize>(text.size()), nullptr) == 0) return out;
  const Owned<cairo_surface_t> nowhere(cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1));
  const Owned<cairo_t> cairo(cairo_create(nowhere.get()));
  const Owned<PangoLayout> layout(pango_cairo_create_layout(cairo.get()));
  const Owned<PangoFontDescription> description(
      pango_font_description_from_string(font.empty() ? kAnyFont : font.c_str()));
  const char* family = pango_font_description_get_family(description.get());
  if (!font.empty() && (family == nullptr || !is_installed(layout.get(), family))) {
    out.status = DecodeStatus::unknown_font;
    return out;
  }
  pango_layout_set_text(layout.get(), text.data(), static_cast<int>(text.size()));
  pango_layout_set_alignment(layout.get(), PANGO_ALIGN_CENTER);
  if (!font.empty()) forbid_other_fonts(layout.get());
  const PangoRectangle ink = set_size(layout.get(), description.get());
  if (const gunichar missing = missing_character(layout.get()); missing != 0) {
    out.status = DecodeStatus::missing_character;
    out.detail = static_cast<std::int64_t>(missing);
    return out;
  }
  if (ink.width < 1 || ink.height < 1) {
    out.status = DecodeStatus::nothing_drawn;
    return out;
  }
  out.grey = drawn(layout.get(), ink);
  out.drawing = true;
  out.status = out.grey.empty() ? DecodeStatus::undecodable : DecodeStatus::ok;
  return out;
}

}  // namespace footlight::config
