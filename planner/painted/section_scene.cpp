// SPDX-License-Identifier: Apache-2.0
#include "planner/painted/section_scene.hpp"

#include "core/check.hpp"
#include "core/motion.hpp"
#include "planner/painted/walls.hpp"
#include "planner/wide_people.hpp"

namespace footlight::planner {

Result<PaintedScene> section_scene(const Show& show, SectionIndex section,
                                   const std::vector<std::optional<Film>>& films, const Progress& progress) {
  FL_CHECK(films.size() == show.sections.size() && films[section.at()]);
  const Motion* motion = show.sections[section.at()].motion.get();
  FL_CHECK(motion != nullptr);
  const auto* options = std::get_if<PaintedOptions>(&motion->options);
  FL_CHECK(options != nullptr);
  const auto walled = with_painted_walls(show, films);
  const Show& whole = walled ? *walled : show;
  const Ways ways = ways_of(whole, WidePeople(whole));
  const RgbPicture picture = picture_of(*films[section.at()]);
  return read_painting({&whole, section, options, &picture, &ways, motion->seed}, progress);
}

}  // namespace footlight::planner
