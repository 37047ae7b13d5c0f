// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "config/show_parts.hpp"
#include "core/motion.hpp"

namespace footlight::config {

/// A model of motion as a show file names it: `planner: {model: NAME, NAME: {...}}`.
struct MotionModel {
  std::string_view name;
  PlannerModel model = PlannerModel::srd;
  std::string_view doc;  ///< one sentence, after the name
  const Listing& (*listing)() = nullptr;
  /// Of the mapping named after the model; an empty one where there is none, so that defaults come out of its listing.
  MotionOptions (*read)(ShowReading& show, MappingReader reader) = nullptr;
};

/// All of them, in the order of the documentation.
[[nodiscard]] const std::vector<MotionModel>& motion_models();

// Of each model, in config/motion/NAME.cpp: `const Listing& NAME_listing()` and
// `MotionOptions read_NAME(ShowReading& show, MappingReader reader)`.
[[nodiscard]] const Listing& srd_listing();
[[nodiscard]] MotionOptions read_srd(ShowReading& show, MappingReader reader);
[[nodiscard]] const Listing& collective_listing();
[[nodiscard]] MotionOptions read_collective(ShowReading& show, MappingReader reader);
[[nodiscard]] const Listing& swarm_listing();
[[nodiscard]] MotionOptions read_swarm(ShowReading& show, MappingReader reader);
[[nodiscard]] const Listing& painted_listing();
[[nodiscard]] MotionOptions read_painted(ShowReading& show, MappingReader reader);
/// `paint` of a section: what the colours of its painting mean.
[[nodiscard]] Field paint_field();
[[nodiscard]] std::vector<Paint> read_paint(ShowReading& show, MappingReader& section);

/// Keys of a section that go with a model of motion, beside `planner`; `paths`, `obstacles`, `marks` and `seed` in this
/// order.
[[nodiscard]] std::vector<Field> motion_fields();

/// Reads what moves people through a section, and refuses what does not go with a model of motion, or without one.
/// @param planner the section's mapping, missing or not, with its model read
void read_motion(ShowReading& show, MappingReader& section, MappingReader& planner, Section& out);

}  // namespace footlight::config
