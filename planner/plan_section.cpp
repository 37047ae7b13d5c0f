// SPDX-License-Identifier: Apache-2.0
#include "planner/plan_section.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/parts.hpp"
#include "planner/motion_section.hpp"
#include "planner/parts_section.hpp"
#include "planner/picture_section.hpp"

namespace footlight::planner {
namespace {

Result<SectionPlan> cells_section(const Show& show, SectionIndex index, const CellsSource& source) {
  const Section& section = show.sections[index.at()];
  if (source.cells.size() != show.performers.size()) {
    return input_error(section_message(
        show, index,
        fmt::format("'{}' has cells for {} of {} performers", source.path, source.cells.size(), show.performers.size()),
        "one row for every performer"));
  }
  SectionPlan plan;
  Station station;
  station.section = index;
  station.count = section.start_count;
  station.arrive = show.tempo.at(section.start_count);
  station.depart = show.tempo.at(section.end_count());
  station.cells = source.cells;
  station.groups = source.groups;
  station.pinned = source.assigned;
  station.exact = true;
  for (const CellIndex cell : source.cells) {
    const bool waits = std::binary_search(show.stage.reserve.begin(), show.stage.reserve.end(), cell);
    station.in_picture += waits ? 0 : 1;
  }
  plan.section.reserve = show.stage.reserve;
  plan.stations.push_back(std::move(station));
  return plan;
}

}  // namespace

double section_speed(const Show& show, const Section& section) {
  double speed = section.max_speed_mps.value_or(show.stage.max_speed_mps);
  for (const Performer& performer : show.performers) {
    if (performer.max_speed_mps > 0) speed = std::min(speed, performer.max_speed_mps);
  }
  return speed;
}

std::string section_message(const Show& show, SectionIndex section, std::string text, std::string hint) {
  return message_at(show, show.sections[section.at()].position, fmt::format("sections[{}]", section.value()),
                    std::move(text), std::move(hint));
}

std::string message_at(const Show& show, const Position& position, std::string key_path, std::string text,
                       std::string hint) {
  Diagnostic diagnostic;
  diagnostic.position = position;
  if (diagnostic.position.file.empty()) diagnostic.position.file = show.file;
  diagnostic.key_path = std::move(key_path);
  diagnostic.text = std::move(text);
  diagnostic.hint = std::move(hint);
  return to_text(diagnostic);
}

Result<SectionPlan> plan_source(const Show& show, SectionIndex index, const std::optional<Film>& film, const Ways& ways,
                                const Station* before, const Progress& progress) {
  const Section& section = show.sections[index.at()];
  if (const auto* cells = std::get_if<CellsSource>(&section.from)) return cells_section(show, index, *cells);
  if (std::holds_alternative<PaintingSource>(section.from)) {
    return input_error(section_message(show, index,
                                       "a painting says how people move, and this section has no such model",
                                       "write planner: {model: painted}"));
  }
  const auto* parts = std::get_if<PartsSource>(&section.from);
  if ((parts == nullptr || needs_pictures(*parts)) && (!film || film->frames.empty())) {
    return internal_error("the frames of section '" + section.name + "' are missing");
  }
  if (parts != nullptr) return plan_parts(show, index, film, ways);
  return plan_pictures(show, index, *film, ways, before, progress);
}

Result<SectionPlan> plan_section(const Show& show, SectionIndex index, const std::optional<Film>& film,
                                 const Ways& ways, const Station* before, const Progress& progress) {
  const Section& section = show.sections[index.at()];
  auto plan = section.motion != nullptr ? plan_motion(show, index, film, ways, before, progress)
                                        : plan_source(show, index, film, ways, before, progress);
  if (!plan) return plan;
  plan->section.name = section.name;
  plan->section.start = show.tempo.at(section.start_count);
  plan->section.end = show.tempo.at(section.end_count());
  plan->section.max_speed_mps = section.max_speed_mps.value_or(show.stage.max_speed_mps);
  return plan;
}

}  // namespace footlight::planner
