// SPDX-License-Identifier: Apache-2.0
#include "app/planar_frame.hpp"

#include <cstddef>
#include <cstdint>

#include "core/check.hpp"

namespace footlight::app {
namespace {

// Of 256, so that white is 235 and grey has no colour.
constexpr int kRed = 47;
constexpr int kGreen = 157;
constexpr int kBlue = 16;
constexpr int kDark = (16 << 8) + 128;
// Sums of four pixels are of 1024.
constexpr int kGrey = (128 << 10) + 512;

void brightness_of_row(const unsigned char* __restrict from, std::size_t width, unsigned char* __restrict to) {
  for (std::size_t x = 0; x < width; ++x) {
    const int sum = kBlue * from[4 * x] + kGreen * from[4 * x + 1] + kRed * from[4 * x + 2] + kDark;
    to[x] = static_cast<unsigned char>(sum >> 8);
  }
}

void colour_of_rows(const unsigned char* __restrict one, const unsigned char* __restrict other, std::size_t squares,
                    unsigned char* __restrict blue, unsigned char* __restrict red) {
  for (std::size_t x = 0; x < squares; ++x) {
    const auto sum = [&](std::size_t c) {
      return one[8 * x + c] + one[8 * x + 4 + c] + other[8 * x + c] + other[8 * x + 4 + c];
    };
    const int b = sum(0);
    const int g = sum(1);
    const int r = sum(2);
    blue[x] = static_cast<unsigned char>((112 * b - 86 * g - 26 * r + kGrey) >> 10);
    red[x] = static_cast<unsigned char>((112 * r - 102 * g - 10 * b + kGrey) >> 10);
  }
}

}  // namespace

void to_planar(std::span<const unsigned char> pixels, int width, int height, std::vector<unsigned char>& out) {
  FL_CHECK(width > 0 && height > 0 && width % 2 == 0 && height % 2 == 0);
  const auto across = static_cast<std::size_t>(width);
  const auto down = static_cast<std::size_t>(height);
  FL_CHECK(pixels.size() == 4 * across * down);
  out.resize(across * down * 3 / 2);
  unsigned char* blue = out.data() + across * down;
  unsigned char* red = blue + across * down / 4;
  for (std::size_t y = 0; y < down; y += 2) {
    const unsigned char* one = pixels.data() + 4 * across * y;
    const unsigned char* other = one + 4 * across;
    brightness_of_row(one, across, out.data() + across * y);
    brightness_of_row(other, across, out.data() + across * (y + 1));
    colour_of_rows(one, other, across / 2, blue + across / 2 * (y / 2), red + across / 2 * (y / 2));
  }
}

}  // namespace footlight::app
