// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "core/film.hpp"
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

/// A full floor of 4 : 3 with a hole that wanders: whoever makes room for it moves others, far around, so that a
/// longest walk that binds is felt far away.
[[nodiscard]] Instance wandering_hole(int people);

/// Distance from the middle of a flower of five petals, in petals: the flower of size s is where this is below s.
[[nodiscard]] double outside_of_flower(double x, double y, double turn);
/// The flower as large as the frame is high, turned by `turn` radians.
[[nodiscard]] Mask flower_picture(int width, int height, double turn);

}  // namespace footlight::bench
