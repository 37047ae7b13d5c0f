// SPDX-License-Identifier: Apache-2.0
#include "app/import/drone_zip.hpp"

#include <charconv>
#include <cmath>
#include <memory>
#include <set>

#include <fmt/format.h>
#include <zip.h>

#include "app/export_files.hpp"
#include "app/import/imported.hpp"
#include "app/numbers.hpp"
#include "app/output_place.hpp"
#include "config/csv.hpp"
#include "config/nearest.hpp"
#include "config/zip_file.hpp"

namespace footlight::app {
namespace {

const std::vector<std::string> kColumns{"Time_msec", "x_m", "y_m", "z_m", "R", "G", "B"};

struct DiscardZip {
  void operator()(zip_t* zip) const { zip_discard(zip); }
};
using Zip = std::unique_ptr<zip_t, DiscardZip>;
struct FreeSource {
  void operator()(zip_source_t* source) const { zip_source_free(source); }
};
using Source = std::unique_ptr<zip_source_t, FreeSource>;

std::string csv_of(const DroneTrack& track) {
  std::string out = "Time_msec,x_m,y_m,z_m,R,G,B\n";
  for (const DronePoint& point : track.points) {
    out += fmt::format("{},{},{},{},{},{},{}\n", point.time_ms, exact(point.at.x), exact(point.at.y),
                       exact(point.height_m), point.colour.red, point.colour.green, point.colour.blue);
  }
  return out;
}

/// A number of the whole field; an error at its place.
template <class Number>
std::optional<Number> number_in(const config::CsvTable& table, const config::CsvField& field, Number low, Number high,
                                Diagnostics& diagnostics) {
  Number out{};
  const char* end = field.text.data() + field.text.size();
  const auto [stop, error] = std::from_chars(field.text.data(), end, out);
  if (error == std::errc{} && stop == end && out >= low && out <= high) return out;
  diagnostics.error(table.at(field), "", config::in_quotes(field.text) + " is no number of this column",
                    fmt::format("{} to {}", low, high));
  return std::nullopt;
}

void read_row(const config::CsvTable& table, const std::vector<config::CsvField>& row, DroneTrack& track,
              Diagnostics& diagnostics) {
  constexpr double kFar_m = 1e6;
  const auto field = [&](std::string_view name) -> const config::CsvField& { return row[*table.column(name)]; };
  const auto ms = number_in<std::int64_t>(table, field("Time_msec"), 0, 1'000'000'000, diagnostics);
  const auto x = number_in<double>(table, field("x_m"), -kFar_m, kFar_m, diagnostics);
  const auto y = number_in<double>(table, field("y_m"), -kFar_m, kFar_m, diagnostics);
  const auto z = number_in<double>(table, field("z_m"), -kFar_m, kFar_m, diagnostics);
  const auto red = number_in<int>(table, field("R"), 0, 255, diagnostics);
  const auto green = number_in<int>(table, field("G"), 0, 255, diagnostics);
  const auto blue = number_in<int>(table, field("B"), 0, 255, diagnostics);
  if (!ms || !x || !y || !z || !red || !green || !blue) return;
  if (!track.points.empty() && track.points.back().time_ms >= *ms) {
    diagnostics.error(table.at(field("Time_msec")), "", fmt::format("{} ms is not later than the line before", *ms),
                      "times increase");
    return;
  }
  const auto byte = [](int value) { return static_cast<std::uint8_t>(value); };
  track.points.push_back({*ms, {*x, *y}, *z, {byte(*red), byte(*green), byte(*blue)}});
  track.lines.push_back(row.front().line);
}

std::optional<DroneTrack> track_in(std::string_view text, const std::string& name, const std::string& file,
                                   Diagnostics& diagnostics) {
  const auto table = config::parse_csv(text, file, kColumns, diagnostics);
  if (!table) return std::nullopt;
  for (const std::string& column : kColumns) {
    if (table->column(column)) continue;
    diagnostics.error(table->at(table->header.front()), "", "the column \"" + column + "\" is missing",
                      "Time_msec,x_m,y_m,z_m,R,G,B");
    return std::nullopt;
  }
  DroneTrack out{name, {}, file, {}};
  for (const auto& row : table->rows) read_row(*table, row, out, diagnostics);
  return out;
}

/// "show/D7.csv" is D7's.
std::string performer_of(std::string_view file) {
  const std::size_t slash = file.find_last_of("/\\") + 1;
  std::string out(file.substr(slash));
  if (out.ends_with(".csv") || out.ends_with(".CSV")) out.resize(out.size() - 4);
  return out;
}

}  // namespace

std::vector<DroneTrack> drone_tracks(const Plan& plan, const Show& show) {
  const MarkLooks looks(plan);
  std::vector<DroneTrack> out;
  for (std::size_t p = 0; p < plan.tracks.size(); ++p) {
    DroneTrack& track = out.emplace_back();
    track.name = plan.performers[p];
    const auto& group = show.performers.at(p).group;
    const Colour colour = group ? show.groups.at(group->at()).colour : show.default_colour;
    for (std::size_t k = 0; k < plan.tracks[p].size(); ++k) {
      const Mark& mark = plan.tracks[p][k];
      const std::int64_t ms = std::llround(1000 * to_seconds(mark.time));
      const bool dark = looks.of(p, k) == "dark";
      const DronePoint point{ms, plan.stage.grid.centre(mark.cell), 0, dark ? Colour{} : colour};
      if (!track.points.empty() && track.points.back().time_ms == ms)
        track.points.back() = point;
      else
        track.points.push_back(point);
    }
  }
  return out;
}

Result<std::string> drone_zip(const std::vector<DroneTrack>& tracks) {
  std::vector<std::string> texts;  // libzip reads them when it closes
  for (const DroneTrack& track : tracks) texts.push_back(csv_of(track));
  zip_error_t error;
  zip_error_init(&error);
  const Source whole(zip_source_buffer_create(nullptr, 0, 0, &error));
  if (!whole) return internal_error("libzip has no memory for a zip");
  zip_source_keep(whole.get());
  Zip zip(zip_open_from_source(whole.get(), ZIP_TRUNCATE, &error));
  if (!zip) {
    zip_source_free(whole.get());
    return internal_error(std::string("libzip cannot begin a zip: ") + zip_error_strerror(&error));
  }
  std::set<std::string> taken;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    zip_source_t* content = zip_source_buffer(zip.get(), texts[i].data(), texts[i].size(), 0);
    const std::string name = file_name_of(tracks[i].name, taken) + ".csv";
    const zip_int64_t at = content == nullptr ? -1 : zip_file_add(zip.get(), name.c_str(), content, ZIP_FL_ENC_UTF_8);
    if (at < 0) {
      if (content != nullptr) zip_source_free(content);
      return internal_error("libzip cannot take " + name);
    }
    // The same show is the same zip, whenever it is made: 1 January 1980, the oldest that zips know.
    zip_file_set_dostime(zip.get(), static_cast<zip_uint64_t>(at), 0, 0x0021, 0);
  }
  if (zip_close(zip.get()) != 0) return internal_error(std::string("libzip: ") + zip_strerror(zip.get()));
  static_cast<void>(zip.release());
  if (zip_source_open(whole.get()) != 0) return internal_error("libzip cannot read its zip");
  zip_source_seek(whole.get(), 0, SEEK_END);
  const zip_int64_t size = zip_source_tell(whole.get());
  zip_source_seek(whole.get(), 0, SEEK_SET);
  std::string out(static_cast<std::size_t>(size), '\0');
  const zip_int64_t got = zip_source_read(whole.get(), out.data(), out.size());
  zip_source_close(whole.get());
  if (got != size) return internal_error("libzip cannot read its zip");
  return out;
}

Result<DroneTrack> read_drone_csv(std::string_view text, const std::string& file) {
  Diagnostics diagnostics;
  if (text.size() > kMostDroneFileBytes) {
    return input_error(fmt::format("{}: error: is more than {} bytes", file, kMostDroneFileBytes));
  }
  auto track = track_in(text, performer_of(file), file, diagnostics);
  if (diagnostics.has_errors()) return first_errors(diagnostics);
  if (!track || track->points.empty()) return input_error(file + ": error: no line says where anybody is");
  return *std::move(track);
}

bool is_drone_csv(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  Diagnostics ignored;
  const std::size_t end = text.find('\n');
  const auto table = config::parse_csv(text.substr(0, end), "", {}, ignored);
  return table && table->column("Time_msec").has_value();
}

Result<std::vector<DroneTrack>> read_drone_zip(std::string_view bytes, const std::string& zip_name) {
  const auto zip = config::ZipFile::open(bytes, zip_name);
  if (!zip) return zip.error();
  std::vector<DroneTrack> out;
  std::set<std::string> names;
  Diagnostics diagnostics;
  std::uint64_t lines = 0;
  for (const config::ZipFile::Entry& entry : zip->entries()) {
    const std::string file = zip_name + "/" + entry.name;
    if (!entry.name.ends_with(".csv") && !entry.name.ends_with(".CSV")) {
      diagnostics.error({file, 0, 0}, "", "is no CSV file", "a zip of NAME.csv, one for each performer");
      continue;
    }
    const auto text = zip->read(entry, kMostDroneFileBytes);
    if (!text) return text.error();
    auto track = track_in(*text, performer_of(entry.name), file, diagnostics);
    if (!track) continue;
    if (track->points.empty() && !diagnostics.has_errors()) {
      diagnostics.error({file, 0, 0}, "", "no line says where anybody is", "Time_msec,x_m,y_m,z_m,R,G,B");
    }
    if (!names.insert(track->name).second) {
      diagnostics.error({file, 0, 0}, "", "a second file of performer " + config::in_quotes(track->name),
                        "one file for each performer");
    }
    lines += track->points.size();
    if (lines > kMostDroneLines) {
      return input_error(fmt::format("'{}' has more than {} lines", zip_name, kMostDroneLines));
    }
    out.push_back(*std::move(track));
  }
  if (diagnostics.has_errors()) return first_errors(diagnostics);
  if (out.empty())
    return input_error(fmt::format("'{}' is empty (a zip of NAME.csv, one for each performer)", zip_name));
  return out;
}

}  // namespace footlight::app
