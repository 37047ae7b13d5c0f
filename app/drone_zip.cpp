// SPDX-License-Identifier: Apache-2.0
#include "app/drone_zip.hpp"

#include <charconv>
#include <cmath>
#include <memory>
#include <set>

#include <fmt/format.h>
#include <zip.h>

#include "app/export_files.hpp"
#include "app/numbers.hpp"
#include "app/output_place.hpp"
#include "config/csv.hpp"
#include "config/nearest.hpp"

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
  const auto field = [&](const char* name) -> const config::CsvField& { return row[*table.column(name)]; };
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
  DroneTrack out{name, {}};
  for (const auto& row : table->rows) read_row(*table, row, out, diagnostics);
  return out;
}

/// The bytes of one file in a zip; nothing when it cannot be unpacked.
std::optional<std::string> unpacked(zip_t* zip, zip_uint64_t index, zip_uint64_t size) {
  const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> file(zip_fopen_index(zip, index, 0), zip_fclose);
  if (!file) return std::nullopt;
  std::string out(size, '\0');
  if (zip_fread(file.get(), out.data(), size) != static_cast<zip_int64_t>(size)) return std::nullopt;
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

Result<std::vector<DroneTrack>> read_drone_zip(std::string_view bytes, const std::string& zip_name) {
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* whole = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error);
  const Zip zip(whole == nullptr ? nullptr : zip_open_from_source(whole, ZIP_RDONLY, &error));
  if (!zip) {
    if (whole != nullptr) zip_source_free(whole);
    return input_error(fmt::format("'{}' is no zip that can be read: {}", zip_name, zip_error_strerror(&error)));
  }
  std::vector<DroneTrack> out;
  Diagnostics diagnostics;
  std::uint64_t left = kMostDroneBytes;
  for (zip_int64_t i = 0; i < zip_get_num_entries(zip.get(), 0); ++i) {
    zip_stat_t about;
    zip_stat_init(&about);
    if (zip_stat_index(zip.get(), static_cast<zip_uint64_t>(i), 0, &about) != 0) continue;
    const std::string inside = about.name;
    if (inside.ends_with('/')) continue;
    const std::string file = zip_name + "/" + inside;
    if (!inside.ends_with(".csv")) {
      diagnostics.error({file, 0, 0}, "", "is no CSV file", "a zip of NAME.csv, one for each performer");
      continue;
    }
    if (about.size > left) {
      return input_error(fmt::format("'{}' holds more than {} bytes", zip_name, kMostDroneBytes));
    }
    left -= about.size;
    const auto text = unpacked(zip.get(), static_cast<zip_uint64_t>(i), about.size);
    if (!text) {
      diagnostics.error({file, 0, 0}, "", "cannot be unpacked", "a zip that is whole");
      continue;
    }
    const std::size_t slash = inside.rfind('/') + 1;
    if (auto track = track_in(*text, inside.substr(slash, inside.size() - slash - 4), file, diagnostics)) {
      out.push_back(*std::move(track));
    }
  }
  if (diagnostics.has_errors()) {
    std::string text = diagnostics.to_text();
    text.pop_back();
    return input_error(text);
  }
  return out;
}

}  // namespace footlight::app
