// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "app/import/drill_words.hpp"
#include "app/import/imported.hpp"
#include "core/result.hpp"

namespace footlight::app {

/// What a list's own words leave open.
struct ListChoice {
  DrillField field;
  double unit_m = 1;  ///< of columns x and y without a unit
};

/// One CSV file of a list.
struct ListFile {
  std::string name;
  std::string text;
};

/// Coordinates as drill programs list them, a row for each person and set. Columns, by any of these names, whatever
/// their case, blanks and hyphens:
///   who     performer, name, label, id (a symbol before it, if any, is part of the name); without one the file's name
///   set     set, page; without one there is one formation
///   when    counts (of the walk into the set; of the first set they are not walked) or count (of the show, from 1)
///   where   side to side (Side 1-Side 2) and front-back in words (drill_words.hpp), or x and y in `unit_m`, or with a
///           unit in the name: x_m, x_steps, x_yd, x_ft
/// Performers come in natural order, sets in the file's. Errors as file:line:col, all of them: words that cannot be
/// understood, people without all sets, sets of different counts, more than 100,000 people.
[[nodiscard]] Result<Imported> read_coordinate_lists(const std::vector<ListFile>& files, const ListChoice& choice);

}  // namespace footlight::app
