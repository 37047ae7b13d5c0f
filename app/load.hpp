// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/session.hpp"
#include "config/show_file.hpp"
#include "core/film.hpp"
#include "core/plan.hpp"
#include "core/result.hpp"

namespace footlight::app {

/// Films of a show, one for each section; absent for explicit cells.
using Films = std::vector<std::optional<Film>>;

/// Reads a show with its rig and tells its warnings. Errors: all of its lines in one message.
[[nodiscard]] Result<config::LoadedShow> read_show(Session& session, const std::string& file);

/// Decodes every section's film, gives a video without a duration its own length, and looks again whether sections
/// overlap. All that is wrong is reported at once, each at its section.
/// @param known  lengths of films that nobody needs to decode; empty: none
[[nodiscard]] Result<Films> decode_films(Session& session, config::LoadedShow& loaded,
                                         const std::vector<std::optional<config::FilmLength>>& known = {});

/// Refuses an output that would overwrite a file that the show reads.
[[nodiscard]] Status<> spare_inputs(const config::LoadedShow& loaded, const std::string& output);

/// Gives videos without a duration the length they have in a plan of this very show, without decoding them.
void take_durations(Show& show, const Plan& plan);

/// These people do not come either, besides whom the show file says. Errors: an id that nobody has; nobody is left.
[[nodiscard]] Status<> mark_absent(Show& show, const std::vector<std::string>& ids);

/// "4=zoe": performer 4 is absent, and zoe, an understudy or a performer, takes the whole way. Errors: nobody is called
/// so, somebody covers two people or is absent herself.
[[nodiscard]] Status<> mark_covers(Show& show, const std::vector<std::string>& covers);

/// Leaves out of the show, and of its rig, whom the plan does without, so that people have the same numbers in both:
/// who is absent, her own places and pins, her wearable. Lists of cells without names lose places that stay empty.
void take_people(config::LoadedShow& loaded, const Plan& plan);

}  // namespace footlight::app
