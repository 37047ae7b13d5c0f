// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace footlight::app {

/// Points, 1/72 inch.
inline constexpr double kPoints_mm = 72 / 25.4;

/// A page, upright.
struct PaperSize {
  double width_pt = 0;
  double height_pt = 0;
  double margin_pt = 0;  ///< that printers keep white
  double words_pt = 0;   ///< size of words in running text
};
inline constexpr PaperSize kA4{595.28, 841.89, 34, 7.5};
inline constexpr PaperSize kLetter{612, 792, 34, 7.5};
/// 9 to 19.5, to be read on a telephone without turning it.
inline constexpr PaperSize kPhone{252, 546, 10, 8};

}  // namespace footlight::app
