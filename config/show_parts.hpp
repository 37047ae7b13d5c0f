// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <string>
#include <vector>

#include "config/mapping_reader.hpp"
#include "config/show_file.hpp"
#include "core/parts.hpp"

namespace footlight::config {

/// What the parts of a show file need while they are read: the show so far, the files it names, and what is known well
/// enough to be checked against. A part that failed leaves its flag false, so that no error has an echo.
struct ShowReading {
  Reading& reading;
  std::filesystem::path folder;  ///< of the show file
  LoadedShow& loaded;
  bool has_stage = false;
  bool has_performers = false;
  bool has_all_sections = false;  ///< every section is known by its name

  [[nodiscard]] Show& show() const { return loaded.show; }
};

/// A path of a file that must exist, noted in LoadedShow::files; empty after an error.
/// @param folder of the file that names it
[[nodiscard]] std::string existing_file(MappingReader& mapping, std::string_view key,
                                        const std::filesystem::path& folder, std::vector<std::string>& files);

void read_stage(ShowReading& show, MappingReader stage);
void read_performers(ShowReading& show, MappingReader performers);
void read_music(ShowReading& show, MappingReader music);
void read_time(ShowReading& show, MappingReader time);
void read_sections(ShowReading& show, MappingReader& root);
/// `keys`, `overrides` and `regions` of a section whose start and duration are known.
void read_by_hand(ShowReading& show, MappingReader& section, Section& out);
/// Keys that mean nothing beside what else the mapping says.
void refuse_keys(MappingReader& from, std::initializer_list<std::string_view> keys, const std::string& hint);
/// Which pixels are the picture; the fit is the caller's.
[[nodiscard]] PictureOptions read_picture(MappingReader& from);
/// Whether `from` is a single drawing, or an image with a place or a size of its own.
[[nodiscard]] bool is_one_part(const MappingReader& from);
/// `from.parts`, or the one drawing that `from` is.
[[nodiscard]] PartsSource read_parts(ShowReading& show, MappingReader& from);
/// The lines `v` of an OBJ file (Wavefront, "Advanced Visualizer Manual", appendix B1: x, y, z; what follows is weight
/// or colour); all other lines say nothing about where the corners are. Errors at their line; none at all is one.
[[nodiscard]] std::vector<std::array<double, 3>> read_mesh(const std::string& file, Diagnostics& diagnostics);
/// `absent`: who does not come.
void read_absent(ShowReading& show, MappingReader& root);
/// "sections[2]": its place in the file, which need not be its place in time.
[[nodiscard]] std::string section_path(const std::vector<Section>& sections, const Section& section);
/// Sections ascending by start. Says which two overlap; a video without a duration has no length yet.
void check_overlaps(const std::vector<Section>& sections, Diagnostics& diagnostics);
void read_cues(ShowReading& show, MappingReader& root);
void read_looks(ShowReading& show, MappingReader looks);

/// Cells of a list of names and ranges, ascending and each once; what lies off the grid is reported.
[[nodiscard]] std::vector<CellIndex> read_cells(MappingReader& mapping, std::string_view key, const Grid& grid);
/// The group of that name; nothing after an error. Asked when the show's groups are known.
[[nodiscard]] std::optional<GroupIndex> find_group(ShowReading& show, MappingReader& mapping, const Written& name);
/// One name or range; nothing after an error.
[[nodiscard]] std::optional<CellRange> read_cell_range(MappingReader& mapping, const Written& written,
                                                       const Grid& grid);

/// CSV `performer,col,row` or `performer,cell`: a free cell for every performer; without the column `performer` as many
/// free cells as there are performers, whose places they are in the column `group`, if any. Errors with line and
/// column.
[[nodiscard]] CellsSource read_cells_csv(ShowReading& show, const std::string& file);
/// CSV id,name,call_name,group,cast,cover,radius,speed,wearable; only id is needed.
void read_roster_csv(ShowReading& show, const std::string& file);

}  // namespace footlight::config
