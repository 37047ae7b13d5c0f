// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/diagnostic.hpp"
#include "core/result.hpp"
#include "core/rig.hpp"
#include "core/show.hpp"

namespace footlight::config {

/// A show as written, with what deserves a word but is no error.
struct LoadedShow {
  Show show;
  Rig rig;  ///< of `show.rig_file`, or simulated buses made for the stage
  std::vector<Diagnostic> warnings;
  std::vector<std::string> files;  ///< show, rig, CSV, profiles and media, resolved: no output may overwrite them
  /// Of them what the planner reads, which a plan's hash covers: all but the rig and its profiles.
  std::vector<std::string> planned_files;
};

/// Reads a show file, its rig and its CSV files (not the media, which must only exist). Every error of all files in one
/// run, positioned. Hostile input (depth, alias bombs and cycles, duplicate keys, NUL, more than 1 MiB) is refused in
/// bounded time and memory. Thread: reentrant. Hot path: no.
[[nodiscard]] Result<LoadedShow, Diagnostics> load_show(const std::filesystem::path& file);

/// What a film's own length comes from: its frames in the section's range, and its rate.
struct FilmLength {
  int frames = 0;
  double fps = 0;
};
/// Gives every video section without a duration (duration_counts 0) its film's own length, (frames - 1) / fps seconds
/// from its start, and looks for overlaps again, since only now they can be seen.
/// @param films for each section; nothing where it is no video or not decoded: such a section stays as it is
[[nodiscard]] Status<Diagnostics> settle_film_lengths(Show& show, const std::vector<std::optional<FilmLength>>& films);

/// JSON Schema (draft 2020-12) of the show file and of the rig file, made from the listings that the reader uses.
[[nodiscard]] std::string show_schema();
[[nodiscard]] std::string rig_schema();
[[nodiscard]] std::string profile_schema();
/// The tables of docs/show-file.md, made from the same listings.
[[nodiscard]] std::string show_reference();

}  // namespace footlight::config
