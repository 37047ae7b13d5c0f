// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/result.hpp"
#include "core/rig.hpp"

namespace footlight::app {

/// Keeps in the state folder (`wipes.json`) that somebody has seen every row and column of a show's floor whole, with
/// the digest of where its lamps are. Errors (ErrorKind::input): the folder takes nothing.
[[nodiscard]] Status<> record_wipe(const std::filesystem::path& state, const std::string& show, const Rig& rig);

/// What to say before the lamps of a show are believed: its rig has changed since the last wipe. Nothing when it has
/// not, when no wipe was ever recorded for the show, and for rigs of which every bus is simulated.
[[nodiscard]] std::optional<std::string> wipe_note(const std::filesystem::path& state, const std::string& show,
                                                   const Rig& rig);

}  // namespace footlight::app
