// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/motion/painted_options.hpp"
#include "core/result.hpp"
#include "core/show.hpp"
#include "planner/painted/flow_field.hpp"
#include "planner/painted/marks.hpp"
#include "planner/painted/sodm.hpp"
#include "planner/painted/stroke.hpp"
#include "planner/progress.hpp"
#include "planner/schedule/ways.hpp"

namespace footlight::planner {

/// What a painting says, on the floor. Pixels are those of one raster that covers the whole floor.
struct PaintedScene {
  /// From one shape of a group to its next one.
  struct Leg {
    std::vector<Stroke> strokes;    ///< none: people find their way
    std::vector<FlowField> fields;  ///< of each stroke
  };
  /// People who go through the same shapes.
  struct Party {
    std::optional<GroupIndex> group;  ///< nothing: of who is in no other party's group
    int people = 0;
    std::vector<int> orders;                 ///< of the shapes
    std::vector<PixelSet> shapes;            ///< in order, at least two
    std::vector<std::vector<Point>> places;  ///< in each shape, metres; who is k-th in one is k-th in all
    std::vector<Leg> legs;                   ///< one fewer than shapes
    std::vector<CellIndex> begin;            ///< cell of each of them in the first shape
    std::vector<CellIndex> end;              ///< in the last one
  };

  PictureFloor picture;  ///< where the painting lies
  int picture_width = 0;
  int picture_height = 0;
  PictureFloor floor;  ///< where the raster lies
  int width = 0;
  int height = 0;
  std::vector<Party> parties;
  PixelSet background;             ///< grey
  Raster<Point> background_field;  ///< vectors 0..1 long, y down
  std::vector<CellIndex> covered;  ///< cells that the background blocks beside the stage's own, ascending
  std::optional<Ways> ways;        ///< of the stage with the covered cells blocked
  PixelSet blocked;                ///< where nobody's centre may be
  std::vector<std::string> notes;

  [[nodiscard]] std::size_t people() const;
  /// Cells in the order of parties, then of their people, and whose places they are.
  [[nodiscard]] std::vector<CellIndex> begin_cells() const;
  [[nodiscard]] std::vector<CellIndex> end_cells() const;
  [[nodiscard]] std::vector<std::optional<GroupIndex>> groups() const;
};

struct SceneTask {
  const Show* show = nullptr;
  SectionIndex section;
  const PaintedOptions* options = nullptr;
  const RgbPicture* picture = nullptr;
  const Ways* ways = nullptr;  ///< of the stage
  std::uint64_t seed = 1;
};

/// Reads a painting for a section: the whole of it lies on the floor beside the reserve's columns, as large as fits, in
/// the middle.
/// @return ErrorKind::input, positioned at the section or the paint: an empty painting, a bound colour that is not in
/// it, a shape with fewer free cells than its people, a group without shapes or with one, a stroke that is too short or
/// has no gradient, that does not lead from its shape to the next one, ways that the background cuts; interrupted when
/// told to stop. Deterministic. O(pixels x paints + maps of the shapes)
[[nodiscard]] Result<PaintedScene> read_painting(const SceneTask& task, const Progress& progress);

}  // namespace footlight::planner
