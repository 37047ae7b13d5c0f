// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/film.hpp"
#include "core/parts.hpp"
#include "core/result.hpp"
#include "core/stage.hpp"
#include "planner/formation/placement.hpp"

namespace footlight::planner {

/// One part of a formation that is to be laid on the floor.
struct PartTask {
  const Stage* stage = nullptr;
  const Part* part = nullptr;
  const Mask* picture = nullptr;      ///< of a part that needs one
  const CellFlags* usable = nullptr;  ///< cells for the formation
  int people = 1;
  double apart_m = 0;  ///< what neighbours need
  std::uint64_t seed = 1;
};

/// Where a part wants its people.
struct PartPoints {
  std::vector<Point> points;  ///< on the floor, as many as people
  double apart_m = 0;         ///< of neighbours
  CellFlags only;             ///< cells that the part may take, one flag a cell; empty: any
};

/// What is wrong with a part, without its place.
struct PartError {
  std::string message;
  std::string hint;
};

/// Where the people of a shape (shapes.hpp), of a picture or lettering (relax.hpp: on cells with picture in them), or
/// of a mesh are: its corners seen from one side (Son, Sung 2024, section 3.2.2), thinned to what neighbours need and
/// then to exactly the people (spread.hpp). Errors: a picture with nothing in it; a mesh with fewer corners than
/// people.
[[nodiscard]] Result<PartPoints, PartError> part_points(const PartTask& task);

/// The corners as seen: from above with the front downstage, from the front, or from its side at stage left, in the
/// mesh's own unit.
[[nodiscard]] std::vector<Point> projected(const Mesh& mesh);

/// For messages: "the circle", "the picture 'dove.svg'".
[[nodiscard]] std::string part_name(const Part& part);

/// The outlines of all cells.
[[nodiscard]] Box whole_floor(const Grid& grid);

}  // namespace footlight::planner
