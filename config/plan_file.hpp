// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "core/plan.hpp"
#include "core/result.hpp"

namespace footlight::config {

/// Writes an SQLite file (application_id 0x464C5054 "FLPT", user_version 4) under a temporary name and renames it; a
/// failure or an interruption leaves an older file as it was. A hash over the whole content is kept inside.
[[nodiscard]] Status<> save_plan(const Plan& plan, const std::filesystem::path& file);

/// load(save(p)) == p. Anything else than an unharmed file of this version is refused with the reason.
[[nodiscard]] Result<Plan> load_plan(const std::filesystem::path& file);

/// Hex SHA-256 over names and contents of the files, in the given order. ErrorKind::input when one cannot be read.
[[nodiscard]] Result<std::string> hash_files(std::span<const std::string> files);

}  // namespace footlight::config
