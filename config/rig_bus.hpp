// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "config/mapping_reader.hpp"
#include "core/rig.hpp"

namespace footlight::config {

/// One bus of a rig, but for its supply.
/// @param folder of the rig, for profiles  @param files takes the profile that was read
[[nodiscard]] Bus read_bus_keys(MappingReader& reader, const std::filesystem::path& folder,
                                std::vector<std::string>& files);

}  // namespace footlight::config
