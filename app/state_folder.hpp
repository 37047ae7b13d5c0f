// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace footlight::app {

/// Where runs leave what the next command, or somebody who helps, wants to know: `chosen` where it is given, else
/// $STATE_DIRECTORY (of a systemd unit), $XDG_STATE_HOME/footlight, ~/.local/state/footlight.
[[nodiscard]] std::filesystem::path state_folder(const std::string& chosen);

}  // namespace footlight::app
