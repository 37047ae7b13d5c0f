// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/check.hpp"

namespace footlight {

/// A monochrome picture, one bit a pixel: which pixels belong to the drawing. Row 0 is the top (upstage), column 0
/// stage right.
class Mask {
 public:
  Mask() = default;
  Mask(int width, int height)
      : width_(width),
        height_(height),
        words_(static_cast<std::size_t>(row_words()) * static_cast<std::size_t>(height)) {}

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] bool at(int x, int y) const {
    return ((words_[word(x, y)] >> (static_cast<unsigned>(x) % 64U)) & 1U) != 0;
  }
  void set(int x, int y) { words_[word(x, y)] |= std::uint64_t{1} << (static_cast<unsigned>(x) % 64U); }
  /// Bits of a row, pixel x in bit x % 64 of word x / 64; unused bits are 0.
  [[nodiscard]] int row_words() const { return (width_ + 63) / 64; }
  [[nodiscard]] const std::vector<std::uint64_t>& words() const { return words_; }
  [[nodiscard]] std::vector<std::uint64_t>& words() { return words_; }

  friend bool operator==(const Mask&, const Mask&) = default;

 private:
  [[nodiscard]] std::size_t word(int x, int y) const {
    FL_CHECK(x >= 0 && x < width_ && y >= 0 && y < height_);
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(row_words()) + static_cast<std::size_t>(x) / 64;
  }
  int width_ = 0;
  int height_ = 0;
  std::vector<std::uint64_t> words_;
};

/// A decoded video, image or painting; of all but paintings what is left after thresholding. All frames have one size.
/// Of a formation of parts one frame for each that is a picture or lettering, in their order.
struct Film {
  int width = 0;        ///< pixels
  int height = 0;       ///< pixels
  double fps = 0;       ///< of the file; 0 for an image
  int first_frame = 0;  ///< number in the file of frames[0]
  int threshold = 128;  ///< a pixel brighter than this belongs to the picture (darker or equal when inverted)
  bool inverted = false;
  std::vector<Mask> frames;
  /// Of a painting, in the place of frames: width x height x 3 bytes (red, green, blue), row 0 the top; what is
  /// transparent is white.
  std::vector<std::uint8_t> rgb{};
};

}  // namespace footlight
