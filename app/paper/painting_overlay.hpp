// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/show.hpp"
#include "planner/painted/scene.hpp"

namespace footlight::app {

/// One of the arrows that stand for a field.
struct FieldArrow {
  Point at;   ///< its middle, metres
  Point way;  ///< where it points on the floor; as long as the field is strong, 0..1
};
struct FieldArrows {
  std::vector<FieldArrow> strokes;     ///< of each stroke by itself, also where two cross
  std::vector<FieldArrow> background;  ///< away from walls, or towards outlines that attract
};
/// The fields where they are at least `least` strong, on squares of this side over the whole floor. O(squares x
/// strokes)
[[nodiscard]] FieldArrows field_arrows(const planner::PaintedScene& scene, double side_m, double least = 0.15);

struct PaintingTask {
  const Show* show = nullptr;
  SectionIndex section;
  const planner::PaintedScene* scene = nullptr;
  planner::RgbPicture picture;
};

/// What was understood of a painting over the painting itself, faint, on white: shapes with their number and people,
/// everybody's place in the first and last of them, strokes with their skeleton, width, tail and arrows towards the
/// head, the fields as arrows on squares, walls hatched; beside it the groups in words, warnings and what the marks
/// mean. Marks differ by form and not by colour alone; the colours are Okabe and Ito's. A PNG, or an SVG.
[[nodiscard]] std::string painting_overlay(const PaintingTask& task, bool svg);

/// "front-right: 100 people".
[[nodiscard]] std::string party_name(const Show& show, const planner::PaintedScene::Party& party);
/// Of each of its shapes and strokes.
[[nodiscard]] std::vector<std::string> party_lines(const planner::PaintedScene& scene,
                                                   const planner::PaintedScene::Party& party);
[[nodiscard]] double area_m2(const planner::PaintedScene& scene, const planner::PixelSet& shape);
/// Mean along its line.
[[nodiscard]] double mean_width_m(const planner::PaintedScene& scene, const planner::Stroke& stroke);

}  // namespace footlight::app
