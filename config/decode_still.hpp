// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "config/decode_protocol.hpp"
#include "core/show.hpp"

namespace footlight::config {

/// A single picture, before anything is decided about it. For `footlight-decode` alone.
struct Still {
  DecodeStatus status = DecodeStatus::undecodable;
  std::int64_t detail = 0;  ///< DecodeRecord::count of a status that has one
  cv::Mat grey;             ///< 8 bits: of a bitmap on black; of a drawing or a text how much of a pixel is drawn
  cv::Mat bgra;             ///< 8 bits a channel; of a text empty
  bool drawing = false;     ///< what is drawn is the picture, whatever its colour
};

/// A bitmap (PNG, JPEG, BMP, PBM, PGM) or an SVG drawing, by its first bytes.
[[nodiscard]] Still read_still(const std::string& path);
/// An SVG drawing, its longer side kSvgSide pixels long. Nothing is read but this file; a drawing that asks for more is
/// refused. Built without librsvg it says so.
[[nodiscard]] Still read_svg(const std::string& path);
inline constexpr int kSvgSide = 1024;
/// A text as Pango lays it out in black on nothing, cut to what is drawn. @param font family and style: it has to have
/// every character; empty: a bold one, and whatever font has a character
[[nodiscard]] Still draw_text(const std::string& text, const std::string& font);

/// "RRGGBBRRGGBB": from, to.
[[nodiscard]] std::optional<ColourRange> colours_from(const std::string& text);
/// 255 where the pixel is opaque and its colour lies in the range (Xu 2015, Eq. 1), else 0.
[[nodiscard]] cv::Mat in_colours(const Still& still, const ColourRange& range);
/// Red, green and blue of each pixel, row by row, as seen on white paper.
[[nodiscard]] std::vector<std::uint8_t> on_white(const Still& still);

}  // namespace footlight::config
