// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "app/paper/canvas.hpp"

namespace footlight::app {

/// Mixes capsules, one over the other, into rows of pixels of 4 bytes (blue, green, red, unused). Their edges are as
/// soft as a pixel is wide; what is outside of the picture is cut off.
/// @param stride  bytes a row
void blend_capsules(std::span<const Capsule> list, std::span<unsigned char> pixels, int stride, int width, int height);

}  // namespace footlight::app
