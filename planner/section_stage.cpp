// SPDX-License-Identifier: Apache-2.0
#include "planner/section_stage.hpp"

#include <algorithm>

#include "core/check.hpp"

namespace footlight::planner {
namespace {

void add_picture(StageHash& hash, const Section& section) {
  const auto* video = std::get_if<VideoSource>(&section.from);
  const auto* image = std::get_if<ImageSource>(&section.from);
  FL_CHECK(video != nullptr || image != nullptr);
  hash.add(std::string_view(video != nullptr ? video->path : image->path));
  hash.add((video != nullptr ? video->picture : image->picture).fit);
}

/// Where one can walk, and how far apart people keep.
void add_floor(StageHash& hash, const Show& show) {
  const Stage& stage = show.stage;
  hash.add(stage.grid.kind()).add(stage.grid.columns()).add(stage.grid.rows()).add(stage.grid.pitch_m());
  hash.list(stage.blocked).add(stage.clearance_m);
  double widest_m = 0;
  for (const Performer& performer : show.performers) widest_m = std::max(widest_m, performer.radius_m);
  hash.add(widest_m);
}

std::int64_t ns(Instant instant) { return instant.time_since_epoch().count(); }
Instant instant_of(std::int64_t count_ns) { return Instant(Duration(count_ns)); }

}  // namespace

StageKey section_key(const Show& show, SectionIndex index, const std::string& film_id, const Station* before) {
  const Section& section = show.sections[index.at()];
  StageHash hash("section");
  hash.add(std::string_view(film_id)).add(std::string_view(section.name)).add(index.value());
  add_picture(hash, section);
  add_floor(hash, show);
  hash.list(show.stage.reserve).add(show.performers.size());
  hash.add(section_speed(show, section)).add(section.max_speed_mps.value_or(show.stage.max_speed_mps));
  hash.add(section.start_count).add(section.duration_counts).add(section.hold_counts);
  hash.add(section.sampling.interval.count()).add(section.sampling.hash).add(section.sampling.snap_to_count);
  const PlannerOptions& options = section.planner;
  hash.add(options.model)
      .add(options.layers)
      .add(options.region_size)
      .add(options.region_variance_m2)
      .add(options.effort);
  hash.add(options.cost).add(section.regions.empty());
  for (const TempoChange& change : show.tempo.changes()) hash.add(change.count).add(change.bpm);
  for (const SectionKey& key : section.keys) hash.add(key.count.has_value()).add(key.count.value_or(key.film_s));
  if (before != nullptr) hash.list(before->cells).add(ns(before->depart));
  return hash.key();
}

StageKey begin_key(const Show& show, SectionIndex index, const Station& before, const Station& first) {
  StageHash hash("begin");
  add_floor(hash, show);
  hash.add(section_speed(show, show.sections[index.at()])).add((first.arrive - before.depart).count());
  return hash.list(before.cells).list(first.cells).key();
}

std::string encode_section(const SectionPlan& plan) {
  StageWriter out;
  const PlanSection& section = plan.section;
  out.text(section.name).add(ns(section.start)).add(ns(section.end)).add(section.max_speed_mps);
  out.add(section.film.has_value());
  if (section.film) {
    const FilmPlacement& film = *section.film;
    out.text(film.path).add(film.first_frame).add(film.last_frame).add(film.show_fps).add(film.width);
    out.add(film.height).add(film.threshold).add(film.inverted).add(film.stage_to_frame);
  }
  out.list(section.reserve).add(section.notes.size());
  for (const std::string& note : section.notes) out.text(note);
  out.add(plan.begin).add(plan.stations.size());
  for (const Station& station : plan.stations) {
    out.add(station.count).add(ns(station.arrive)).add(ns(station.depart));
    out.add(station.frame.has_value()).add(station.frame.value_or(0)).list(station.cells);
    out.add(station.exact).add(station.follows).add(station.in_picture).add(station.key);
  }
  return out.take();
}

SectionPlan decode_section(StageReader& reader, SectionIndex index) {
  SectionPlan plan;
  PlanSection& section = plan.section;
  section.name = reader.text();
  section.start = instant_of(reader.get<std::int64_t>());
  section.end = instant_of(reader.get<std::int64_t>());
  section.max_speed_mps = reader.get<double>();
  if (reader.get<bool>()) {
    FilmPlacement film;
    film.path = reader.text();
    film.first_frame = reader.get<int>();
    film.last_frame = reader.get<int>();
    film.show_fps = reader.get<double>();
    film.width = reader.get<int>();
    film.height = reader.get<int>();
    film.threshold = reader.get<int>();
    film.inverted = reader.get<bool>();
    film.stage_to_frame = reader.get<StageToFrame>();
    section.film = film;
  }
  section.reserve = reader.list<CellIndex>();
  for (auto notes = reader.get<std::size_t>(); notes > 0 && !reader.failed(); --notes) {
    section.notes.push_back(reader.text());
  }
  plan.begin = reader.get<Begin>();
  for (auto stations = reader.get<std::size_t>(); stations > 0 && !reader.failed(); --stations) {
    Station station;
    station.section = index;
    station.count = reader.get<double>();
    station.arrive = instant_of(reader.get<std::int64_t>());
    station.depart = instant_of(reader.get<std::int64_t>());
    const bool has_frame = reader.get<bool>();
    const int frame = reader.get<int>();
    if (has_frame) station.frame = frame;
    station.cells = reader.list<CellIndex>();
    station.exact = reader.get<bool>();
    station.follows = reader.get<bool>();
    station.in_picture = reader.get<int>();
    station.key = reader.get<bool>();
    plan.stations.push_back(std::move(station));
  }
  return plan;
}

}  // namespace footlight::planner
