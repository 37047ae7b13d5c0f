// SPDX-License-Identifier: Apache-2.0
#include "config/show_file.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "config/nearest.hpp"
#include "config/rig_file.hpp"
#include "config/show_parts.hpp"

namespace footlight::config {
namespace {

/// Printed at most; a file with more errors has one reason, not that many.
constexpr std::size_t kMostErrors = 200;
/// Of the errors of one kind in a table.
constexpr std::size_t kShownAlike = 3;

void read_show(ShowReading& show, MappingReader& root) {
  (void)root.integer("footlight");
  show.show().title = root.text("title").value_or("");
  show.show().version = root.text("version").value_or("");
  if (auto stage = root.mapping("stage")) read_stage(show, std::move(*stage));
  show.show().stage.walk = root.choice("walk").value_or(0) == 0 ? WalkKind::straight : WalkKind::cells;
  if (auto performers = root.mapping("performers")) read_performers(show, std::move(*performers));
  read_absent(show, root);
  if (auto music = root.mapping("music")) read_music(show, std::move(*music));
  if (auto time = root.mapping("time")) read_time(show, std::move(*time));
  read_sections(show, root);
  read_cues(show, root);
  if (auto looks = root.mapping("looks")) read_looks(show, std::move(*looks));
  show.show().announce_counts = root.quantity("announce").value_or(4);
}

void read_show_rig(ShowReading& show, MappingReader& root) {
  if (root.has("rig")) {
    const std::string file = existing_file(root, "rig", show.folder, show.loaded.files);
    show.show().rig_file = file;
    if (file.empty() || !show.has_stage) return;
    show.loaded.rig = read_rig(file, show.show(), show.has_performers, root.reading().diagnostics, show.loaded.files);
  } else if (!root.reading().diagnostics.has_errors()) {
    show.loaded.rig = make_simulated_rig(show.show());
  }
}

/// A text without what differs from row to row: numbers, names of cells and what stands in quotes.
std::string kind_of(const std::string& text) {
  std::string out;
  bool quoted = false;
  for (const char c : text) {
    const bool digit = c >= '0' && c <= '9';
    if (digit) {
      while (!out.empty() && ((out.back() >= 'A' && out.back() <= 'Z') || out.back() == '#')) out.pop_back();
    }
    if (c == '"') quoted = !quoted;
    if (!quoted) out += digit ? '#' : c;
  }
  return out;
}

/// Rows of a table that are wrong in the same way, as one wrong word in a roster makes them: the first few, and how
/// many more there are.
std::vector<Diagnostic> grouped(std::vector<Diagnostic> sorted) {
  struct Alike {
    std::size_t count = 0;
    int last_line = 0;
    std::size_t told = 0;
  };
  std::map<std::pair<std::string, std::string>, Alike> kinds;
  std::vector<Alike*> kind;
  for (const Diagnostic& diagnostic : sorted) {
    const bool of_table =
        diagnostic.severity == Severity::error && diagnostic.key_path.empty() && diagnostic.position.line > 0;
    kind.push_back(of_table ? &kinds[{diagnostic.position.file, kind_of(diagnostic.text)}] : nullptr);
    if (!of_table) continue;
    ++kind.back()->count;
    kind.back()->last_line = diagnostic.position.line;
  }
  std::vector<Diagnostic> out;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    Alike* alike = kind[i];
    // One line more says no less than "and 1 more".
    if (alike != nullptr && alike->count > kShownAlike + 1 && ++alike->told > kShownAlike) {
      if (alike->told > kShownAlike + 1) continue;
      sorted[i].text = "and " + std::to_string(alike->count - kShownAlike) +
                       " more like this: " + std::exchange(sorted[i].text, {}) + "; the last in line " +
                       std::to_string(alike->last_line);
    }
    out.push_back(std::move(sorted[i]));
  }
  return out;
}

/// The errors, without the warnings, and not without end.
Diagnostics bounded(const Diagnostics& all, const std::string& file) {
  Diagnostics out;
  std::size_t errors = 0;
  for (Diagnostic& diagnostic : grouped(all.sorted())) {
    if (diagnostic.severity != Severity::error || errors++ >= kMostErrors) continue;
    out.add(std::move(diagnostic));
  }
  if (errors > kMostErrors) {
    out.error({file, 0, 0}, "", std::to_string(errors - kMostErrors) + " more errors are not shown",
              "the first " + std::to_string(kMostErrors) + " follow");
  }
  return out;
}

}  // namespace

std::string existing_file(MappingReader& mapping, std::string_view key, const std::filesystem::path& folder,
                          std::vector<std::string>& files) {
  const auto written = mapping.text(key);
  if (!written) return {};
  std::string file = (folder / *written).lexically_normal().string();
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) {
    mapping.error(key, "the file " + in_quotes(*written) + " is missing", "looked for " + file);
    return {};
  }
  if (!std::filesystem::is_regular_file(status)) {
    mapping.error(key, in_quotes(*written) + " is not a file", "looked at " + file);
    return {};
  }
  if (std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
  return file;
}

Result<LoadedShow, Diagnostics> load_show(const std::filesystem::path& file) {
  Diagnostics diagnostics;
  Reading reading{file.string(), diagnostics};
  const auto bytes = read_bounded(file, TextLimits{}.max_bytes);
  if (!bytes) {
    const bool large = bytes.error().message.find(" bytes, more than ") != std::string::npos;
    diagnostics.error({reading.file, 0, 0}, "", bytes.error().message, large ? "long data belong in CSV files" : "");
    return diagnostics;
  }
  LoadedShow loaded;
  loaded.show.file = reading.file;
  loaded.files.push_back(reading.file);
  ShowReading show{reading, file.parent_path(), loaded};
  if (auto root = read_root(reading, *bytes, show_listing())) {
    read_show(show, *root);
    loaded.planned_files = loaded.files;
    read_show_rig(show, *root);
  }
  if (diagnostics.has_errors()) return bounded(diagnostics, reading.file);
  loaded.warnings = diagnostics.sorted();
  return loaded;
}

Status<Diagnostics> settle_film_lengths(Show& show, const std::vector<std::optional<FilmLength>>& films) {
  FL_CHECK(films.size() == show.sections.size());
  Diagnostics diagnostics;
  for (std::size_t s = 0; s < films.size(); ++s) {
    Section& section = show.sections[s];
    const std::optional<FilmLength>& length = films[s];
    if (!std::holds_alternative<VideoSource>(section.from) || section.duration_counts > 0 || !length) continue;
    const FilmLength& film = *length;
    if (film.frames < 2 || !(film.fps > 0)) {
      diagnostics.error(section.position, section_path(show.sections, section) + ".duration",
                        "the video of section " + in_quotes(section.name) + " has no length of its own",
                        "give the section a duration, as 224 counts");
      continue;
    }
    const Instant end = show.tempo.at(section.start_count) + seconds((film.frames - 1) / film.fps);
    section.duration_counts = show.tempo.count_at(end) - section.start_count;
  }
  if (!diagnostics.has_errors()) check_overlaps(show.sections, diagnostics);
  if (diagnostics.has_errors()) return diagnostics;
  return Done{};
}

}  // namespace footlight::config
