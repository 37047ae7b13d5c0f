// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "core/grid.hpp"

namespace footlight::bench {

/// Two formations of the same people on cells of one metre.
struct Instance {
  std::vector<Point> sources;
  std::vector<Point> targets;
};

enum class Scene {
  disk_to_ring,      ///< a filled disk opens into a ring; half of the cells are common
  block_to_letters,  ///< a block of 4 : 3 becomes two lines of two letters
  flower_turned,     ///< five petals, turned by ten degrees and shifted; three quarters of the cells are common
};
inline constexpr Scene kScenes[] = {Scene::disk_to_ring, Scene::block_to_letters, Scene::flower_turned};

[[nodiscard]] std::string_view to_text(Scene scene);
[[nodiscard]] Instance make_instance(Scene scene, int people);

}  // namespace footlight::bench
