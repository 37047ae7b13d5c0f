// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/film.hpp"
#include "core/plan.hpp"
#include "core/show.hpp"
#include "planner/progress.hpp"
#include "planner/schedule/ways.hpp"

namespace footlight::planner {

/// An instant at which everybody should stand in one formation.
struct Station {
  SectionIndex section;
  double count = 1;
  Instant arrive;
  Instant depart;                ///< later than `arrive` while the formation is held
  std::optional<int> frame;      ///< of the video's file
  std::vector<CellIndex> cells;  ///< distinct, one for each performer; in the order of performers when `pinned`
  bool pinned = false;           ///< who stands where is given
  bool exact = false;            ///< nobody may be elsewhere; else the drawing gives way where walking takes too long
  bool follows = false;          ///< cells[i] is for who stood on cells[i] of the station before
  int in_picture = 0;            ///< how many of the cells are in the picture
  bool key = true;               ///< a key formation
  int moved = 0;                 ///< people moved by hand
  /// Whose place each cell is, nothing: of who is in no group; empty: places are nobody's in particular.
  std::vector<std::optional<GroupIndex>> groups;
  std::vector<std::pair<PerformerIndex, CellIndex>> pins;  ///< who stands where by name
};

/// Where people are in the first formation of a section.
enum class Begin {
  as_drawn,     ///< wherever its picture says
  where_best,   ///< where it is best for the whole film, unless the formation before is too far away
  from_before,  ///< as near to that as they can be in time from the formation before
};

/// What one section asks for, before anybody walks.
struct SectionPlan {
  PlanSection section;
  Begin begin = Begin::as_drawn;
  std::vector<Station> stations;  ///< ascending by time
};

/// Largest speed at which everybody may walk in a section, m/s: the section's limit (or the stage's), and nobody's own.
[[nodiscard]] double section_speed(const Show& show, const Section& section);
/// "file:line:col: error: sections[i]: text (hint)"
[[nodiscard]] std::string section_message(const Show& show, SectionIndex section, std::string text, std::string hint);

/// The same with a place and key of its own.
[[nodiscard]] std::string message_at(const Show& show, const Position& position, std::string key_path, std::string text,
                                     std::string hint);

/// The formations that a section's source gives, as drawn; of a section with a model of motion the one at its end.
/// @return as `plan_section`
[[nodiscard]] Result<SectionPlan> plan_source(const Show& show, SectionIndex section, const std::optional<Film>& film,
                                              const Ways& ways, const Station* before, const Progress& progress);

/// Turns a section's source into formations of exactly as many cells as there are performers.
/// @param film of a video or an image, else absent
/// @param before the last formation of the section before, if any
/// @return ErrorKind::input, positioned, when the floor, or the largest picture with the reserve, cannot hold
/// everybody; interrupted when told to stop. Pure.
[[nodiscard]] Result<SectionPlan> plan_section(const Show& show, SectionIndex section, const std::optional<Film>& film,
                                               const Ways& ways, const Station* before, const Progress& progress);

}  // namespace footlight::planner
