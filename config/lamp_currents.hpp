// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "config/mapping_reader.hpp"
#include "core/rig.hpp"

namespace footlight::config {

/// What lamps take, from a mapping of `currents_listing`.
[[nodiscard]] LampCurrents read_currents(MappingReader& reader);

}  // namespace footlight::config
