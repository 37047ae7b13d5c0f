// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "config/score.hpp"
#include "core/show.hpp"
#include "core/tempo_map.hpp"

namespace footlight::app {

/// The files of a show whose sections are lists of cells with names, name and content: show.yaml, its schema, a roster
/// and a CSV file for each section. What is read back (config::load_show) has the same stage, people, music and
/// sections. Looks, cues and rig are left to their defaults.
/// @param remarks lines of comment at the top, without "#"
[[nodiscard]] std::vector<std::pair<std::string, std::string>> show_files(const Show& show,
                                                                          const std::vector<std::string>& remarks);

/// The key `music` of a show file. @param rehearsals comments behind it, a line each
[[nodiscard]] std::string music_yaml(const TempoMap& tempo, const std::vector<config::Score::Rehearsal>& rehearsals);

}  // namespace footlight::app
