// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/import/coordinate_list.hpp"
#include "app/import/drone_zip.hpp"
#include "config/score.hpp"
#include "core/result.hpp"

namespace footlight::app {

/// Files by what they are; what a file is called says nothing.
struct ImportSources {
  std::optional<config::ScoreEvents> score;
  std::string score_file;
  std::vector<DroneTrack> tracks;  ///< of a zip in its order, of single files in natural order
  std::vector<ListFile> lists;     ///< either these or tracks, or none
};

/// Reads and sorts them. Errors: a file that cannot be read or is of no known kind, a second piece of music, tracks and
/// lists at once.
[[nodiscard]] Result<ImportSources> read_import_sources(const std::vector<std::string>& files);

}  // namespace footlight::app
