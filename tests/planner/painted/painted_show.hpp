// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "planner/painted/scene.hpp"
#include "tests/planner/painted/painter.hpp"
#include "tests/planner/small_show.hpp"

namespace footlight::planner::test {

inline constexpr Colour kGrey{120, 120, 120};

/// Forty people on 30 x 20 cells of a metre, and a painting of four pixels a metre: a green shape at stage right, a
/// darker one at stage left, a red stroke from the one to the other.
struct PaintedShow {
  Show show = show_with(40);
  PaintedOptions options;
  Painter painter{120, 80};

  PaintedShow() {
    show.sections = {section_of("painted", PaintingSource{"painting.png"}, 1, 40, 0, 7)};
    Paint first{{0, 200, 0}, Paint::Role::shape, {}, 1, 20, {"show.yaml", 10, 7}};
    Paint second{{0, 160, 0}, Paint::Role::shape, {}, 2, 18, {"show.yaml", 11, 7}};
    Paint stroke{{220, 40, 40}, Paint::Role::stroke, {}, 1, 15, {"show.yaml", 12, 7}};
    options.paint = {first, second, stroke};
    options.iterations = 500;
    paint();
  }
  void paint() {
    painter.box(2, 24, 22, 56, options.paint[0].colour);
    painter.box(98, 20, 118, 60, options.paint[1].colour);
    stroke({255, 150, 150}, {110, 20, 20});
  }
  void stroke(Colour tail, Colour head) { painter.stroke({{26, 40}, {94, 40}}, 5, tail, head); }

  [[nodiscard]] Ways ways() const { return Ways(show.stage, show.stage.clearance_m / 2); }
  [[nodiscard]] Result<PaintedScene> read() const {
    const Ways free = ways();
    const RgbPicture picture = painter.picture();
    return read_painting({&show, SectionIndex(0), &options, &picture, &free, 1}, {});
  }
};

}  // namespace footlight::planner::test
