// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "config/field.hpp"

namespace footlight::config {

inline constexpr double kMostCounts = 1e6;  ///< a show of a day at 700 counts a minute

/// `stage` of a show.
[[nodiscard]] const Listing& stage_listing();
/// `sections[]` of a show.
[[nodiscard]] const Listing& section_listing();
/// `sections[].from.parts[]`, and its keys that may stand in `from` itself where one drawing is the whole formation.
[[nodiscard]] const Listing& part_listing();
[[nodiscard]] std::vector<Field> drawing_fields();  ///< what is drawn: shape, text, mesh
[[nodiscard]] std::vector<Field> picture_fields();  ///< which pixels are the picture
[[nodiscard]] std::vector<Field> size_fields();     ///< how large and where

}  // namespace footlight::config
