// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>

#include "core/result.hpp"

namespace footlight::app {

/// Whether a file or folder can come into being there, before long work for it begins. Errors: its folder is not there
/// or takes no files, with the system's reason.
[[nodiscard]] Status<> can_write(const std::filesystem::path& output);

/// Makes a folder and those above it.
[[nodiscard]] Status<> make_folder(const std::filesystem::path& folder);

/// Letters of every language, digits, '_' and '-' stay, anything else becomes '-'; a name that is taken already gets a
/// number. The result is added to `taken`.
[[nodiscard]] std::string file_name_of(std::string_view name, std::set<std::string>& taken);

}  // namespace footlight::app
