// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <memory>
#include <string_view>

#include <librsvg/rsvg.h>
#include <opencv2/imgproc.hpp>
#include <pugixml.hpp>

#include "config/decode_still.hpp"

namespace footlight::config {
namespace {

constexpr std::size_t kMostBytes = std::size_t{16} << 20U;

/// Inside of the file: nothing, a name in it, or data that stand there.
bool is_inside(std::string_view reference) {
  const auto begin = reference.find_first_not_of(" \t\r\n\"'");
  if (begin == std::string_view::npos) return true;
  reference.remove_prefix(begin);
  return reference.starts_with('#') || reference.starts_with("data:");
}

/// Style sheets and attributes name files as url(...).
bool style_is_inside(std::string_view style) {
  if (style.find("@import") != std::string_view::npos) return false;
  for (std::size_t at = style.find("url("); at != std::string_view::npos; at = style.find("url(", at + 4)) {
    if (!is_inside(style.substr(at + 4))) return false;
  }
  return true;
}

bool attributes_are_inside(const pugi::xml_node& node) {
  const bool is_link = std::string_view(node.name()) == "a" || std::string_view(node.name()).ends_with(":a");
  return std::all_of(node.attributes_begin(), node.attributes_end(), [&](const pugi::xml_attribute& attribute) {
    const std::string_view name = attribute.name();
    const bool is_reference = name == "href" || name.ends_with(":href");
    return is_reference ? is_link || is_inside(attribute.value()) : style_is_inside(attribute.value());
  });
}

class Walker : public pugi::xml_tree_walker {
 public:
  bool for_each(pugi::xml_node& node) override {
    switch (node.type()) {
      case pugi::node_element:
        return attributes_are_inside(node);
      case pugi::node_pcdata:
      case pugi::node_cdata:
        return style_is_inside(node.value()) ||
               std::string_view(node.parent().name()).find("style") == std::string_view::npos;
      case pugi::node_pi:
        return std::string_view(node.name()) != "xml-stylesheet";
      default:
        return true;
    }
  }
};

struct Unref {
  void operator()(RsvgHandle* handle) const { g_object_unref(handle); }
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  void operator()(cairo_t* cairo) const { cairo_destroy(cairo); }
};
template <class T>
using Owned = std::unique_ptr<T, Unref>;

/// Width and height of the picture, pixels; nothing when the drawing has none.
std::optional<cv::Size> size_of(RsvgHandle* handle) {
  double width = 0;
  double height = 0;
  gboolean has_box = FALSE;
  RsvgRectangle box{};
  rsvg_handle_get_intrinsic_dimensions(handle, nullptr, nullptr, nullptr, nullptr, &has_box, &box);
  if (has_box != 0) {
    width = box.width;
    height = box.height;
  } else if (rsvg_handle_get_intrinsic_size_in_pixels(handle, &width, &height) == 0) {
    RsvgRectangle ink{};
    if (rsvg_handle_get_geometry_for_element(handle, nullptr, &ink, nullptr, nullptr) == 0) return std::nullopt;
    width = ink.width;
    height = ink.height;
  }
  if (!(width > 0 && height > 0 && width < 1e9 && height < 1e9)) return std::nullopt;
  const double scale = kSvgSide / std::max(width, height);
  return cv::Size(std::max(1, static_cast<int>(width * scale + 0.5)),
                  std::max(1, static_cast<int>(height * scale + 0.5)));
}

/// Colours that are no longer multiplied with how opaque they are.
void take_pixels(cairo_surface_t* surface, const cv::Size& size, Still& out) {
  const cv::Mat view(size.height, size.width, CV_8UC4, cairo_image_surface_get_data(surface),
                     static_cast<std::size_t>(cairo_image_surface_get_stride(surface)));
  out.bgra = view.clone();
  for (int y = 0; y < size.height; ++y) {
    cv::Vec4b* row = out.bgra.ptr<cv::Vec4b>(y);
    for (int x = 0; x < size.width; ++x) {
      const int alpha = row[x][3];
      for (int c = 0; alpha > 0 && c < 3; ++c) {
        row[x][c] = static_cast<std::uint8_t>(std::min(255, (row[x][c] * 255 + alpha / 2) / alpha));
      }
    }
  }
  cv::extractChannel(out.bgra, out.grey, 3);
}

}  // namespace

Still read_svg(const std::string& path) {
  Still out;
  std::ifstream in(path, std::ios::binary);
  std::string bytes(kMostBytes + 1, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  if (bytes.size() > kMostBytes) return out;
  pugi::xml_document document;
  if (!document.load_buffer(bytes.data(), bytes.size(), pugi::parse_full)) return out;
  Walker walker;
  const bool names_entities = bytes.find("<!ENTITY") != std::string::npos &&
                              (bytes.find("SYSTEM") != std::string::npos || bytes.find("PUBLIC") != std::string::npos);
  if (names_entities || !document.traverse(walker)) {
    out.status = DecodeStatus::outside_reference;
    return out;
  }
  // Without the place of the file the library has nothing to which another file could be relative.
  const Owned<RsvgHandle> handle(
      rsvg_handle_new_from_data(reinterpret_cast<const guint8*>(bytes.data()), bytes.size(), nullptr));
  if (handle == nullptr) return out;
  const auto size = size_of(handle.get());
  out.status = DecodeStatus::nothing_drawn;
  if (!size) return out;
  const Owned<cairo_surface_t> surface(cairo_image_surface_create(CAIRO_FORMAT_ARGB32, size->width, size->height));
  const Owned<cairo_t> cairo(cairo_create(surface.get()));
  const RsvgRectangle all{0, 0, static_cast<double>(size->width), static_cast<double>(size->height)};
  out.status = DecodeStatus::undecodable;
  if (rsvg_handle_render_document(handle.get(), cairo.get(), &all, nullptr) == 0) return out;
  cairo_surface_flush(surface.get());
  take_pixels(surface.get(), *size, out);
  out.drawing = true;
  out.status = DecodeStatus::ok;
  return out;
}

}  // namespace footlight::config
