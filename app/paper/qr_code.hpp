// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/paper/canvas.hpp"

namespace footlight::app {

/// A QR code: a square of dark and light modules, which a telephone reads as a text. Made by libqrencode, its only
/// owner.
struct QrCode {
  int modules = 0;  ///< a side
  std::vector<bool> dark;
};

/// Bytes that a code holds whose modules, on the square of a sheet's heading, are wide enough for a telephone: 57
/// modules (version 10), with a correction of a quarter (level M).
inline constexpr std::size_t kMostCodeBytes = 213;

/// @return nothing for an empty text and for one that is longer than `kMostCodeBytes`
[[nodiscard]] std::optional<QrCode> qr_code(const std::string& text);

/// Black on white, with the quiet zone of four modules that readers want around it inside of the square.
void draw_code(const Canvas& canvas, Point corner, double size, const QrCode& code);

}  // namespace footlight::app
