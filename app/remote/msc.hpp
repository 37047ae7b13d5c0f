// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "app/remote/remote_call.hpp"
#include "config/remote_file.hpp"

namespace footlight::app {

/// What a MIDI message says in MIDI Show Control.
struct MscHeard {
  std::optional<RemoteCall> call{};
  std::string why_not{};  ///< a command for us that is not carried out; empty beside no call: not for us
};

/// MIDI Show Control (MIDI 1.0 Recommended Practice RP-002, sections 2 to 4): F0 7F device 02 format command data F7.
/// GO, STOP, RESUME and LOAD with an optional cue number (cue list and path are left out of account: there is one),
/// FIRE by `settings.macros`, ALL_OFF as a hold (no lamp goes dark while people walk), RESET as the way to the top.
/// Heard are the device's own id, all-call, the own format and all types. Pure; any bytes will do.
[[nodiscard]] MscHeard hear_msc(std::span<const std::uint8_t> message, const config::MidiRemote& settings);

}  // namespace footlight::app
