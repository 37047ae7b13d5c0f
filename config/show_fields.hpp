// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "config/field.hpp"

namespace footlight::config {

inline constexpr double kMostCounts = 1e6;  ///< a show of a day at 700 counts a minute

/// `sections[]` of a show.
[[nodiscard]] const Listing& section_listing();

}  // namespace footlight::config
