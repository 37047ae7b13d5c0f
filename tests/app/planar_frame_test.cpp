// SPDX-License-Identifier: Apache-2.0
#include "app/planar_frame.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "core/rng.hpp"

namespace footlight::app {
namespace {

TEST(PlanarFrame, IsOfTheFormulasOfBT709) {
  constexpr int kWidth = 34;
  constexpr int kHeight = 6;
  Rng rng(3);
  std::vector<unsigned char> pixels(4 * kWidth * kHeight);
  for (unsigned char& byte : pixels) byte = static_cast<unsigned char>(rng.below(256));
  for (std::size_t i = 0; i < 8; ++i) pixels[i] = 255;  // two white pixels
  std::vector<unsigned char> planar;
  to_planar(pixels, kWidth, kHeight, planar);
  ASSERT_EQ(planar.size(), std::size_t{kWidth * kHeight * 3 / 2});
  EXPECT_EQ(planar[0], 235) << "white";
  const auto part = [&](int x, int y, int c) {
    return pixels[static_cast<std::size_t>(4 * (y * kWidth + x) + c)] / 255.0;
  };
  const auto luma = [&](int x, int y) {
    return 0.2126 * part(x, y, 2) + 0.7152 * part(x, y, 1) + 0.0722 * part(x, y, 0);
  };
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      EXPECT_NEAR(planar[static_cast<std::size_t>(y * kWidth + x)], 16 + 219 * luma(x, y), 1.5);
      double blue = 0;
      double red = 0;
      for (const int dy : {0, 1}) {
        for (const int dx : {0, 1}) {
          const int px = x / 2 * 2 + dx;
          const int py = y / 2 * 2 + dy;
          blue += (part(px, py, 0) - luma(px, py)) / 1.8556 / 4;
          red += (part(px, py, 2) - luma(px, py)) / 1.5748 / 4;
        }
      }
      const auto square = static_cast<std::size_t>(kWidth * kHeight + y / 2 * (kWidth / 2) + x / 2);
      EXPECT_NEAR(planar[square], 128 + 224 * blue, 1.5);
      EXPECT_NEAR(planar[square + kWidth * kHeight / 4], 128 + 224 * red, 1.5);
    }
  }
}

}  // namespace
}  // namespace footlight::app
