// SPDX-License-Identifier: Apache-2.0
#include "app/import/import_sources.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "app/natural_order.hpp"
#include "config/output_file.hpp"

namespace footlight::app {
namespace {

constexpr std::size_t kMostZipBytes = std::size_t{512} << 20U;
constexpr std::size_t kMostListBytes = std::size_t{64} << 20U;

std::optional<Error> take_score(const std::string& bytes, const std::string& file, ImportSources& out) {
  if (out.score) {
    return input_error(fmt::format("'{}' and '{}' are both music (a show has one)", out.score_file, file));
  }
  if (bytes.size() > config::kMostScoreBytes) {
    return input_error(
        fmt::format("'{}' has {} bytes (music at most {})", file, bytes.size(), config::kMostScoreBytes));
  }
  auto score = config::read_score(bytes, file);
  if (!score) return score.error();
  out.score = *std::move(score);
  out.score_file = file;
  return std::nullopt;
}

std::optional<Error> take(const std::string& file, ImportSources& out, bool& has_zip) {
  auto bytes = config::read_file(file, kMostZipBytes);
  if (!bytes) return bytes.error();
  if (config::looks_like_score(*bytes)) return take_score(*bytes, file, out);
  if (bytes->starts_with("PK")) {
    if (std::exchange(has_zip, true) || !out.tracks.empty()) {
      return input_error(fmt::format("'{}' comes besides other tracks (one zip holds everybody's)", file));
    }
    auto tracks = read_drone_zip(*bytes, file);
    if (!tracks) return tracks.error();
    out.tracks = *std::move(tracks);
    return std::nullopt;
  }
  if (bytes->size() > kMostListBytes) {
    return input_error(fmt::format("'{}' has {} bytes (a list at most {})", file, bytes->size(), kMostListBytes));
  }
  if (!is_drone_csv(*bytes)) {
    out.lists.push_back({file, *std::move(bytes)});
    return std::nullopt;
  }
  if (has_zip) return input_error(fmt::format("'{}' comes besides a zip (one zip holds everybody's)", file));
  auto track = read_drone_csv(*bytes, file);
  if (!track) return track.error();
  out.tracks.push_back(*std::move(track));
  return std::nullopt;
}

}  // namespace

Result<ImportSources> read_import_sources(const std::vector<std::string>& files) {
  ImportSources out;
  bool has_zip = false;
  for (const std::string& file : files) {
    if (auto error = take(file, out, has_zip)) return *error;
  }
  if (!out.tracks.empty() && !out.lists.empty()) {
    return input_error(fmt::format("'{}' is a list of places, and '{}' is somebody's track (one or the other)",
                                   out.lists.front().name, out.tracks.front().file));
  }
  if (!has_zip) {
    std::sort(out.tracks.begin(), out.tracks.end(),
              [](const DroneTrack& a, const DroneTrack& b) { return natural_less(a.name, b.name); });
    const auto twice = std::adjacent_find(out.tracks.begin(), out.tracks.end(),
                                          [](const DroneTrack& a, const DroneTrack& b) { return a.name == b.name; });
    if (twice != out.tracks.end()) {
      return input_error(fmt::format("'{}' and '{}' are both performer {} (one file each)", twice->file,
                                     std::next(twice)->file, twice->name));
    }
  }
  if (out.tracks.size() > 100'000) return input_error(fmt::format("{} performers (at most 100000)", out.tracks.size()));
  return out;
}

}  // namespace footlight::app
