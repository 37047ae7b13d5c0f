// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "config/score.hpp"

namespace footlight::config {

/// Tempo, time signatures and markers of a Standard MIDI file (RP-001, "Standard MIDI Files 1.0"): formats 0 and 1,
/// ticks of a quarter note or of SMPTE frames. Notes are passed over. With SMPTE ticks the time is what the file says,
/// and quarter notes follow from the tempos.
/// Errors, with the byte's number from 0: no MIDI file, format 2, a track or an event that does not end, a tempo of 0.
/// O(bytes)
[[nodiscard]] Result<ScoreEvents> read_midi(std::string_view bytes, const std::string& file);

}  // namespace footlight::config
