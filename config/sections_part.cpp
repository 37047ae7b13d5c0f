// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "config/motion_part.hpp"
#include "config/nearest.hpp"
#include "config/show_parts.hpp"

namespace footlight::config {
namespace {

/// "0-249" or "100-".
void read_frames(MappingReader& from, VideoSource& video) {
  const auto written = from.written("frames");
  if (!written) return;
  const std::size_t dash = written->text.find('-');
  const auto first = parse_integer(written->text.substr(0, dash));
  const bool to_end = dash != std::string::npos && dash + 1 == written->text.size();
  const auto last = dash == std::string::npos || to_end ? std::nullopt : parse_integer(written->text.substr(dash + 1));
  if (dash == std::string::npos || !first || *first < 0 || (!last && !to_end)) {
    return from.error(*written, in_quotes(written->text) + " is not a range of frames",
                      "write for example 0-249, or 100- for all from frame 100 on");
  }
  if (last && *last <= *first) {
    return from.error(*written, in_quotes(written->text) + " has fewer than two frames",
                      "the last frame comes after the first");
  }
  video.first_frame = *first;
  video.last_frame = last;
}

std::optional<ColourRange> read_colours(MappingReader& range) {
  std::array<std::optional<Colour>, 2> ends;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto written = range.written(i == 0 ? "from" : "to");
    if (!written) return std::nullopt;
    ends[i] = parse_colour(written->text);
    if (!ends[i]) range.error(*written, in_quotes(written->text) + " is not a colour", "write \"#RRGGBB\", in quotes");
  }
  if (!ends[0] || !ends[1]) return std::nullopt;
  const ColourRange out{*ends[0], *ends[1]};
  if (out.from.red > out.to.red || out.from.green > out.to.green || out.from.blue > out.to.blue) {
    range.error("to", "no colour lies between " + to_text(out.from) + " and " + to_text(out.to),
                "each of red, green and blue goes up from the one to the other");
    return std::nullopt;
  }
  return out;
}

/// How a video or an image lies on the floor, and which pixels are the picture.
PictureOptions read_fitted_picture(MappingReader& from) {
  PictureOptions out = read_picture(from);
  if (const auto fit = from.choice("fit")) out.fit = static_cast<Fit>(*fit);
  return out;
}

Source read_source(ShowReading& show, MappingReader from) {
  std::vector<std::string>& files = show.loaded.files;
  if (from.has("parts") || is_one_part(from)) {
    refuse_keys(from, {"frames", "fit"}, "it goes with a video, or with an image without a place or a size");
    return read_parts(show, from);
  }
  refuse_keys(from, {"at", "width", "height", "radius", "spacing", "turn", "rows", "angle", "turns", "font", "view"},
              "it goes with a shape, a text, a mesh or an image");
  if (from.has("video")) {
    refuse_keys(from, {"colour"}, "only an image has colours");
    VideoSource video;
    video.path = existing_file(from, "video", show.folder, files);
    read_frames(from, video);
    video.picture = read_fitted_picture(from);
    return video;
  }
  if (from.has("image")) {
    refuse_keys(from, {"frames"}, "only a video has frames");
    return ImageSource{existing_file(from, "image", show.folder, files), read_fitted_picture(from)};
  }
  refuse_keys(from, {"frames", "fit", "threshold", "invert", "colour"}, "it goes with a video or an image");
  if (from.has("painting")) return PaintingSource{existing_file(from, "painting", show.folder, files)};
  const std::string file = from.has("cells") ? existing_file(from, "cells", show.folder, files) : "";
  return file.empty() ? CellsSource{} : read_cells_csv(show, file);
}

Sampling read_sampling(MappingReader sampling) {
  Sampling out;
  if (const auto interval_s = sampling.quantity("interval")) out.interval = seconds(*interval_s);
  out.hash = sampling.number("hash").value_or(out.hash);
  out.snap_to_count = sampling.choice("snap").value_or(0) == 0;
  return out;
}

PlannerOptions read_planner(MappingReader& planner) {
  PlannerOptions out;
  if (const auto model = planner.choice("model")) {
    std::vector models{PlannerModel::joint, PlannerModel::hierarchical, PlannerModel::flat};
    for (const MotionModel& one : motion_models()) models.push_back(one.model);
    out.model = models.at(static_cast<std::size_t>(*model));
  }
  out.layers = planner.integer("layers").value_or(out.layers);
  out.cost = planner.choice("cost").value_or(0) == 0 ? PairingCost::squared : PairingCost::euclidean;
  out.effort = planner.number("effort").value_or(out.effort);
  if (auto region = planner.mapping("region")) {
    out.region_size = region->integer("size").value_or(out.region_size);
    out.region_variance_m2 = region->quantity("variance").value_or(out.region_variance_m2);
  }
  return out;
}

/// One section, and whether it is known well enough to be compared with others.
std::optional<Section> read_section(ShowReading& show, MappingReader& reader) {
  Section out;
  out.position = reader.position();
  const auto name = reader.text("name");
  const auto start = reader.quantity("start");
  const auto duration = reader.quantity("duration");
  const auto hold = reader.quantity("hold");
  if (auto from = reader.mapping("from")) out.from = read_source(show, std::move(*from));
  if (auto sampling = reader.mapping("sampling")) out.sampling = read_sampling(std::move(*sampling));
  if (auto planner = reader.mapping("planner")) {
    out.planner = read_planner(*planner);
    read_motion(show, reader, *planner, out);
  }
  out.max_speed_mps = reader.quantity("max_speed");
  if (out.motion == nullptr && !std::holds_alternative<VideoSource>(out.from)) {
    refuse_keys(reader, {"duration", "sampling"}, "it goes with a video; a single formation has a hold");
    refuse_keys(reader, {"keys"}, "only a video has key formations");
  }
  if (out.motion == nullptr && std::holds_alternative<CellsSource>(out.from)) {
    refuse_keys(reader, {"overrides", "regions"}, "write it into the CSV file");
  }
  if (std::holds_alternative<PartsSource>(out.from)) refuse_keys(reader, {"regions"}, "a part has a group");
  if (!name || !start || !hold) return std::nullopt;
  out.name = *name;
  out.start_count = *start;
  out.duration_counts = duration.value_or(0);
  out.hold_counts = *hold;
  if (out.motion == nullptr) read_by_hand(show, reader, out);
  return out;
}

}  // namespace

PictureOptions read_picture(MappingReader& from) {
  PictureOptions out;
  out.invert = from.boolean("invert").value_or(false);
  if (from.has("colour")) {
    refuse_keys(from, {"threshold"}, "the colours say what is the picture");
    if (auto range = from.mapping("colour")) out.colour = read_colours(*range);
    return out;
  }
  const auto threshold = from.written("threshold");
  if (threshold && threshold->text != "otsu") {
    out.threshold = parse_integer(threshold->text);
    if (!out.threshold || *out.threshold < 0 || *out.threshold > 255) {
      from.error(*threshold, in_quotes(threshold->text) + " is not a threshold", "0 to 255, or otsu");
    }
  }
  return out;
}

void refuse_keys(MappingReader& from, std::initializer_list<std::string_view> keys, const std::string& hint) {
  for (const std::string_view key : keys) {
    if (from.has(key)) from.error(from.key_position(key), from.path(key), "the key has no meaning here", hint);
  }
}

std::string section_path(const std::vector<Section>& sections, const Section& section) {
  const auto place = std::count_if(sections.begin(), sections.end(),
                                   [&](const Section& other) { return other.position < section.position; });
  return "sections[" + std::to_string(place) + "]";
}

void check_overlaps(const std::vector<Section>& sections, Diagnostics& diagnostics) {
  for (std::size_t i = 1; i < sections.size(); ++i) {
    const Section& before = sections[i - 1];
    const Section& after = sections[i];
    const bool same_start = after.start_count <= before.start_count;
    if (!same_start && after.start_count >= before.end_count()) continue;
    const std::string end = plain(before.end_count());
    diagnostics.error(after.position, section_path(sections, after) + ".start",
                      "section " + in_quotes(after.name) + " starts at count " + plain(after.start_count) +
                          ", and section " + in_quotes(before.name) + " lasts until count " + end,
                      same_start && before.end_count() <= before.start_count
                          ? "start it later"
                          : "start it at count " + end + " or later");
  }
}

void read_sections(ShowReading& show, MappingReader& root) {
  std::vector<Section>& out = show.show().sections;
  std::map<std::string, int> lines;
  auto readers = root.mappings("sections");
  show.has_all_sections = true;
  for (MappingReader& reader : readers) {
    auto section = read_section(show, reader);
    show.has_all_sections = show.has_all_sections && section;
    if (!section) continue;
    const auto [first, is_new] = lines.emplace(section->name, section->position.line);
    if (!is_new) {
      reader.error("name", "a second section has the name " + in_quotes(section->name),
                   "first in line " + std::to_string(first->second) + "; names of sections are unique");
      continue;
    }
    out.push_back(std::move(*section));
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const Section& a, const Section& b) { return a.start_count < b.start_count; });
  check_overlaps(out, root.reading().diagnostics);
}

}  // namespace footlight::config
