// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/import/fitting_grid.hpp"
#include "app/import/imported.hpp"
#include "config/score.hpp"
#include "core/result.hpp"
#include "core/show.hpp"

namespace footlight::app {

/// What a show takes from elsewhere than the imported file.
struct ShowFrame {
  std::string title;
  TempoMap tempo;
  std::vector<config::Score::Rehearsal> rehearsals;  ///< a section that starts at one has its name
  const Show* like = nullptr;                        ///< stage and people are this show's; absent: made for the file
};

struct ImportedShow {
  Show show;
  OnCells on;
  /// People's numbers in the imported file, in the order of the show.
  std::vector<std::size_t> order;
  std::vector<std::string> notes;  ///< limits that were set, each as a sentence
};

/// A show whose sections are the imported formations. Without `like` the people have the file's names and the groups of
/// their colours, who is dark stands in the reserve, and clearance and speed are the usual ones, widened to what the
/// file asks for, with a note. Errors: as `cells_of`; with `like` people whom one of the two does not know.
[[nodiscard]] Result<ImportedShow> imported_show(const Imported& imported, const FittingGrid& grid,
                                                 const ShowFrame& frame);

}  // namespace footlight::app
