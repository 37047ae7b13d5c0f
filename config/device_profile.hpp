// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/diagnostic.hpp"
#include "core/rig.hpp"

namespace footlight::config {

/// Reads drivers/profiles/*.yaml or a file of that kind; nothing after an error.
[[nodiscard]] std::optional<ModbusProfile> read_profile(const std::filesystem::path& file, Diagnostics& diagnostics);

/// The same for the lamps of a DMX line.
[[nodiscard]] std::optional<DmxFixture> read_fixture(const std::filesystem::path& file, Diagnostics& diagnostics);

/// Where a profile is. A name that ends in .yaml or .yml is a file relative to `folder`; another one is a shipped
/// profile: in $FOOTLIGHT_DATA/profiles, in ../share/footlight/profiles beside the program, or in the source tree.
/// Nothing when there is none.
[[nodiscard]] std::optional<std::filesystem::path> find_profile(const std::string& name,
                                                                const std::filesystem::path& folder);

/// Names of the shipped profiles, sorted.
[[nodiscard]] std::vector<std::string> shipped_profiles();

/// Our own marker, as drivers/profiles/footlight-marker.yaml has it: for rigs that need no file at all.
[[nodiscard]] ModbusProfile footlight_marker_profile();

}  // namespace footlight::config
