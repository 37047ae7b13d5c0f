// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "core/result.hpp"
#include "core/rig.hpp"
#include "core/show.hpp"

namespace footlight::config {

/// The text of a rig file that reads as `rig`. What the rig's own file says besides its lamps (buses, supplies, every
/// key of a node) is kept as it stands there, its comments are not; the lamps of `rig` take the place of `nodes` and
/// `floor`, an entry for each node. A rig without a file, made for the stage, gives its buses by name, URL and speed.
/// @param output where the text will be: profiles that stand beside the rig's own file are named from there
/// Errors: ErrorKind::input when the rig's own file cannot be read any more.
[[nodiscard]] Result<std::string> rig_text(const Rig& rig, const Show& show, const std::filesystem::path& output);

/// Channels as a rig file writes them: runs of cells of one row as a range. "A1:H1, unused, C4"
[[nodiscard]] std::string channels_text(const Node& node, const Show& show);

}  // namespace footlight::config
