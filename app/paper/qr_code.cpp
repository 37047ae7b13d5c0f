// SPDX-License-Identifier: Apache-2.0
#include "app/paper/qr_code.hpp"

#include <memory>

#include <qrencode.h>

#include "core/check.hpp"

namespace footlight::app {
namespace {

constexpr int kQuiet = 4;
constexpr unsigned char kDark = 1;  // the lowest bit of a module

}  // namespace

std::optional<QrCode> qr_code(const std::string& text) {
  if (text.empty() || text.size() > kMostCodeBytes) return std::nullopt;
  const std::unique_ptr<QRcode, void (*)(QRcode*)> made(
      QRcode_encodeData(static_cast<int>(text.size()), reinterpret_cast<const unsigned char*>(text.data()), 0,
                        QR_ECLEVEL_M),
      &QRcode_free);
  FL_CHECK(made != nullptr);
  QrCode out;
  out.modules = made->width;
  for (int i = 0; i < made->width * made->width; ++i) out.dark.push_back((made->data[i] & kDark) != 0);
  return out;
}

void draw_code(const Canvas& canvas, Point corner, double size, const QrCode& code) {
  canvas.ink({1, 1, 1});
  canvas.fill_box(corner, size, size);
  const double module = size / (code.modules + 2 * kQuiet);
  cairo_t* c = canvas.cairo();
  // One path: where two modules touch there is no seam.
  for (int row = 0; row < code.modules; ++row) {
    for (int column = 0; column < code.modules;) {
      const auto dark = [&](int x) { return code.dark[static_cast<std::size_t>(row * code.modules + x)]; };
      int end = column + 1;
      while (end < code.modules && dark(end) == dark(column)) ++end;
      if (dark(column)) {
        cairo_rectangle(c, corner.x + (column + kQuiet) * module, corner.y + (row + kQuiet) * module,
                        (end - column) * module, module);
      }
      column = end;
    }
  }
  canvas.ink({0, 0, 0});
  cairo_fill(c);
}

}  // namespace footlight::app
