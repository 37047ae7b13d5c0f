// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

namespace footlight::app {

/// A picture as encoders take it: brightness of each pixel, then two differences of colour of each square of two by
/// two, 8 bits each (4:2:0), by the matrix and in the range of ITU-R BT.709 (16 to 235, 16 to 240). A third of the
/// bytes of a canvas.
/// @param pixels 4 bytes each (blue, green, red, unused), rows without gaps  @param width, height  even
/// @param out  width * height * 3 / 2 bytes; what it held is lost
void to_planar(std::span<const unsigned char> pixels, int width, int height, std::vector<unsigned char>& out);

}  // namespace footlight::app
