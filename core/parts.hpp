// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/diagnostic.hpp"
#include "core/grid.hpp"
#include "core/index.hpp"
#include "core/show.hpp"

namespace footlight {

/// People evenly on a figure that has a name.
struct Shape {
  enum class Kind {
    line,     ///< from stage right to stage left
    block,    ///< ranks one behind the other
    circle,   ///< filled
    ring,     ///< on its edge
    arc,      ///< of a ring, its middle upstage
    spiral,   ///< from the middle out
    wedge,    ///< filled, its point downstage
    chevron,  ///< two lines that meet downstage
  };
  Kind kind = Kind::line;
  int rows = 0;                         ///< of a block; 0: as fits its size
  double angle_rad = std::numbers::pi;  ///< of an arc, (0, 2 pi)
  double turns = 2;                     ///< of a spiral, > 0
};
/// Words as a font draws them, one line or several.
struct Lettering {
  std::string text;
  std::string font;  ///< as Pango names it: "Noto Sans CJK SC Bold"
};
/// The corners of a body, seen from one side (Son, Sung 2024, section 3.2.2, Figure 5).
struct Mesh {
  enum class View { top, front, side };
  std::string path;  ///< as resolved against the show file's folder
  View view = View::top;
  std::vector<std::array<double, 3>> vertices;  ///< x, y, z of the file, y up; at least one
};
/// A bitmap or an SVG drawing; what is in the picture is laid on the floor, whatever is around it.
struct Picture {
  std::string path;  ///< as resolved against the show file's folder
  PictureOptions options;
};
using Drawing = std::variant<Shape, Lettering, Mesh, Picture>;

/// One drawing of a formation that is put together, for some of the people.
struct Part {
  Drawing drawing;
  std::optional<GroupIndex> group;  ///< whose places they are; nothing: of everybody in no other part's group
  std::optional<int> people;        ///< nothing: who of the group is in no part with a number, shared evenly
  std::optional<Point> at;          ///< its middle; nothing: the middle of the floor without the reserve
  double width_m = 0;               ///< 0: as the height asks, or as the spacing where both are 0
  double height_m = 0;              ///< 0: as the width asks
  double radius_m = 0;              ///< of round shapes in the place of width and height
  double spacing_m = 0;             ///< of neighbours where no size is given; 0: one and a half pitches
  double turn_rad = 0;              ///< counter-clockwise as seen from above
  Position position;

  /// Whether somebody has to decode it.
  [[nodiscard]] bool needs_picture() const {
    return std::holds_alternative<Lettering>(drawing) || std::holds_alternative<Picture>(drawing);
  }
};

/// Whether a formation of parts has any that somebody has to decode.
[[nodiscard]] inline bool needs_pictures(const PartsSource& source) {
  return std::any_of(source.parts->begin(), source.parts->end(), [](const Part& part) { return part.needs_picture(); });
}

}  // namespace footlight
