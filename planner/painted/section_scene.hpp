// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/film.hpp"
#include "planner/painted/scene.hpp"

namespace footlight::planner {

/// What a show's planning understands of the painting of a section, walls of all of its paintings among what is
/// blocked, without planning it.
/// @param section of the model `painted`, its film decoded  @param films one for each section
/// @return errors as `read_painting`
[[nodiscard]] Result<PaintedScene> section_scene(const Show& show, SectionIndex section,
                                                 const std::vector<std::optional<Film>>& films,
                                                 const Progress& progress);

}  // namespace footlight::planner
