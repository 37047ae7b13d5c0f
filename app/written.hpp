// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/paper/stamp.hpp"

namespace footlight::app {

/// {"title", "version", "show", "plan", "valid", "footlight"}: what a stamp says.
[[nodiscard]] nlohmann::ordered_json json_of(const Stamp& stamp);

/// What a command says that has written files: the stamp, and "files" as they were named or made.
[[nodiscard]] nlohmann::ordered_json written_json(const Stamp& stamp, const std::vector<std::string>& files);

}  // namespace footlight::app
