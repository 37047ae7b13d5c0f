// SPDX-License-Identifier: Apache-2.0
#include "planner/painted/walls.hpp"

#include <algorithm>
#include <variant>

#include "core/motion.hpp"
#include "planner/formation/placement.hpp"

namespace footlight::planner {
namespace {

constexpr int kLooks = 7;              // points a side of a cell
constexpr double kCoveredShare = 0.1;  // of a cell's points: it is blocked

}  // namespace

PictureFloor lay_down(const Stage& stage, int width, int height) {
  const Box room = picture_floor(stage);
  const double pixel = std::min(room.width() / width, room.height() / height);
  return {{(room.x0 + room.x1) / 2 - width * pixel / 2, (room.y0 + room.y1) / 2 + height * pixel / 2}, pixel};
}

std::vector<CellIndex> covered_cells(const Stage& stage, const RgbPicture& picture, const PaintedOptions& options) {
  std::vector<CellIndex> out;
  if (options.background != PaintedOptions::Background::repel) return out;
  const PictureFloor floor = lay_down(stage, picture.width, picture.height);
  const Raster<std::int16_t> marks = read_marks(picture, options);
  for (int i = 0; i < stage.grid.size(); ++i) {
    const Point centre = stage.grid.centre(CellIndex::of(i));
    int grey = 0;
    for (int k = 0; k < kLooks * kLooks; ++k) {
      const Point offset{(k % kLooks + 0.5) / kLooks - 0.5, (k / kLooks + 0.5) / kLooks - 0.5};
      const Point pixel = floor.to_pixel(centre + stage.grid.pitch_m() * offset);
      if (!marks.contains(pixel)) continue;
      grey += marks.at(static_cast<int>(pixel.x), static_cast<int>(pixel.y)) == kBackgroundMark ? 1 : 0;
    }
    if (grey > kCoveredShare * kLooks * kLooks) out.push_back(CellIndex::of(i));
  }
  return out;
}

std::optional<Show> with_painted_walls(const Show& show, const std::vector<std::optional<Film>>& films) {
  std::optional<Show> out;
  for (std::size_t s = 0; s < show.sections.size(); ++s) {
    const Section& section = show.sections[s];
    const auto* painted = section.motion == nullptr ? nullptr : std::get_if<PaintedOptions>(&section.motion->options);
    if (painted == nullptr || !films[s] || films[s]->rgb.empty()) continue;
    const auto walls = covered_cells(show.stage, picture_of(*films[s]), *painted);
    if (walls.empty()) continue;
    if (!out) out = show;
    std::vector<CellIndex>& blocked = out->stage.blocked;
    std::vector<CellIndex> both;
    std::set_union(blocked.begin(), blocked.end(), walls.begin(), walls.end(), std::back_inserter(both));
    blocked = std::move(both);
  }
  return out;
}

}  // namespace footlight::planner
