// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/motion/painted_options.hpp"
#include "planner/painted/raster.hpp"

namespace footlight::planner {

/// A picture in colours, row 0 the top.
struct RgbPicture {
  int width = 0;
  int height = 0;
  std::span<const std::uint8_t> rgb;  ///< width x height x 3

  [[nodiscard]] Colour at(int x, int y) const {
    const std::size_t i =
        3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
    return {rgb[i], rgb[i + 1], rgb[i + 2]};
  }
};

/// Perceived brightness, 0..255 (ITU-R BT.601, as the grey of films is).
[[nodiscard]] float brightness(Colour colour);

/// What a pixel is, in a raster of marks; else the number of its paint.
inline constexpr std::int16_t kFloorMark = -1;
inline constexpr std::int16_t kBackgroundMark = -2;
inline constexpr std::int16_t kUnknownMark = -3;

/// Which pixels are which mark (Kang, Kim 2014, section 2): grey is background (red, green, blue differ by no more than
/// the tolerance), white is floor (all of them 230 or more), a shape's colour is as bound within the tolerance, a
/// stroke's has its hue, whatever its brightness. Among several the nearest one. Pixels of no bound colour within two
/// pixels of a mark are the soft edge of a brush and floor; others mean nothing. O(pixels x paints)
[[nodiscard]] Raster<std::int16_t> read_marks(const RgbPicture& picture, const PaintedOptions& options);

/// A colour that means nothing, and how much of it there is.
struct UnknownColour {
  Colour colour;  ///< the mean of what is alike
  std::size_t pixels = 0;
};
/// Most frequent first, alike within 32 of 256 in each of red, green, blue.
[[nodiscard]] std::vector<UnknownColour> unknown_colours(const RgbPicture& picture, const Raster<std::int16_t>& marks);

/// The marks of a floor that pixels of its own divide, whatever those of the picture are.
struct FloorMarks {
  Raster<std::int16_t> marks;
  Raster<float> brightness;  ///< mean over the mark's own pixels
};
/// @param picture_floor, floor  where the picture's pixels and the result's lie  Background wins where it has a third
/// of a pixel, so that thin walls stay; else the mark that has most. O(pixels of both)
[[nodiscard]] FloorMarks marks_on_floor(const RgbPicture& picture, const Raster<std::int16_t>& marks,
                                        const PictureFloor& picture_floor, const PictureFloor& floor, int width,
                                        int height);

/// Pixels of one mark.
[[nodiscard]] PixelSet pixels_of(const Raster<std::int16_t>& marks, std::int16_t mark);

}  // namespace footlight::planner
