// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "planner/painted/scene.hpp"

namespace footlight::planner {

/// How the maps of a party's shapes lie, so that who is in front on the way is in front when she comes, and who is on
/// the left stays there: of the eight turns the one whose lattice, seen along the way where it leaves one shape and
/// where it comes to the next, agrees best, and that the shape's proportions suit. The ways are those of the legs'
/// strokes, or straight. The paper leaves open which neuron of one shape is which in the next. O(shapes x people)
[[nodiscard]] std::vector<LatticeTurn> lattice_turns(const PaintedScene::Party& party, const Lattice& lattice);

/// Width over height of a shape's bounding box.
[[nodiscard]] double aspect(const PixelSet& shape);

}  // namespace footlight::planner
