// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/diagnostic.hpp"
#include "core/grid.hpp"
#include "core/look.hpp"
#include "core/result.hpp"
#include "core/tempo_map.hpp"

namespace footlight::app {

/// Where somebody stands, as another program's file says it, and where it says so.
struct ImportedPlace {
  Point at;      ///< metres, as of the file: before it lies on a stage
  int file = 0;  ///< of Imported::files
  int line = 0;
  int column = 0;
};

/// Everybody's places from one instant on.
struct ImportedFormation {
  std::string name;
  double count = 1;        ///< everybody stands here at this count
  double hold_counts = 0;  ///< and stays that long
  std::vector<ImportedPlace> places;
};

struct ImportedPerson {
  std::string name;
  std::optional<Colour> colour;
};

/// What a file of another program says, understood and not yet on a grid.
struct Imported {
  std::vector<std::string> files;
  std::vector<ImportedPerson> people;
  std::vector<ImportedFormation> formations;  ///< counts increase; places in the order of people
  std::vector<Point> dark;                    ///< places of people who are not lit there
  double step_m = 0;                          ///< of places told in steps; 0: told otherwise
  std::vector<std::string> ignored;           ///< what was found and is not kept, each as a sentence's beginning

  [[nodiscard]] Position position(const ImportedPlace& place) const {
    return {files.at(static_cast<std::size_t>(place.file)), place.line, place.column};
  }
};

/// Whose walk between two formations is the fastest, and how fast. 0 where nobody walks.
struct FastestWalk {
  double speed_mps = 0;
  std::size_t person = 0;
  std::size_t formation = 0;  ///< into which
};
[[nodiscard]] FastestWalk fastest_walk(const Imported& imported, const TempoMap& tempo);

/// The first of many errors, a line each, and how many more there are: one wrong program writes thousands of wrong
/// lines.
[[nodiscard]] Error first_errors(const Diagnostics& diagnostics);

}  // namespace footlight::app
