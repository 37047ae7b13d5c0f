// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "config/score.hpp"

namespace footlight::config {

/// Tempo marks, time signatures and rehearsal marks of a MusicXML score (MusicXML 4.0, score-partwise), with repeats
/// and their endings played out. A tempo is `sound tempo`, or else the metronome mark beside it. Measures are as long
/// as the notes in them.
/// Errors as file:line:col: no well-formed XML, another kind of score, no divisions before the first note, da capo and
/// dal segno, numbers that are none. No entity of a document type is ever followed. O(bytes)
[[nodiscard]] Result<ScoreEvents> read_music_xml(std::string_view bytes, const std::string& file);

/// The same of a compressed score (.mxl): a zip whose META-INF/container.xml names the score.
[[nodiscard]] Result<ScoreEvents> read_compressed_music_xml(std::string_view bytes, const std::string& file);
[[nodiscard]] bool is_compressed_music_xml(std::string_view bytes);

}  // namespace footlight::config
