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
/// @param currents takes what its lamps take, where it says so
[[nodiscard]] std::optional<ModbusProfile> read_profile(const std::filesystem::path& file, Diagnostics& diagnostics,
                                                        std::optional<LampCurrents>* currents = nullptr);

/// The same for the lamps of a DMX line.
[[nodiscard]] std::optional<DmxFixture> read_fixture(const std::filesystem::path& file, Diagnostics& diagnostics,
                                                     std::optional<LampCurrents>* currents = nullptr);

/// The same for the modules of a CANopen bus.
[[nodiscard]] std::optional<OutputModule> read_output_module(const std::filesystem::path& file,
                                                             Diagnostics& diagnostics,
                                                             std::optional<LampCurrents>* currents = nullptr);

/// Where a profile is. A name that ends in .yaml or .yml is a file relative to `folder`; another one is a shipped
/// profile: in $FOOTLIGHT_DATA/profiles, in ../share/footlight/profiles beside the program, or in the source tree.
/// Nothing when there is none.
[[nodiscard]] std::optional<std::filesystem::path> find_profile(const std::string& name,
                                                                const std::filesystem::path& folder);

/// Names of the shipped profiles, sorted.
[[nodiscard]] std::vector<std::string> shipped_profiles();

}  // namespace footlight::config
