// SPDX-License-Identifier: Apache-2.0
#include "app/paper/film_view.hpp"

#include <algorithm>
#include <cmath>

namespace footlight::app {

FilmView::FilmView(const Plan& plan, SectionIndex section, const Film* film)
    : section_(plan.sections.at(section.at())), film_(film), pitch_m_(plan.stage.grid.pitch_m()) {}

const Mask* FilmView::of_frame(int frame) const {
  if (film_ == nullptr || film_->frames.empty() || !section_.film) return nullptr;
  const int k = frame - film_->first_frame;
  return k >= 0 && k < static_cast<int>(film_->frames.size()) ? &film_->frames[static_cast<std::size_t>(k)] : nullptr;
}

const Mask* FilmView::at(Instant instant) const {
  if (film_ == nullptr || !section_.film || instant < section_.start) return nullptr;
  const FilmPlacement& placement = *section_.film;
  if (placement.show_fps == 0) return of_frame(film_->first_frame);  // an image
  const auto since = std::lround(to_seconds(instant - section_.start) * placement.show_fps);
  return of_frame(std::min(placement.last_frame, placement.first_frame + static_cast<int>(since)));
}

bool FilmView::shows(const Mask& picture, Point centre) const {
  constexpr int kProbes = 5;  // a side
  const StageToFrame& m = placement();
  for (int i = 0; i < kProbes * kProbes; ++i) {
    const int across = i % kProbes - kProbes / 2;
    const int up = i / kProbes - kProbes / 2;
    const double x = centre.x + across * pitch_m_ / kProbes;
    const double y = centre.y + up * pitch_m_ / kProbes;
    const int column = static_cast<int>(std::floor(m[0] * x + m[1] * y + m[2]));
    const int row = static_cast<int>(std::floor(m[3] * x + m[4] * y + m[5]));
    if (column < 0 || row < 0 || column >= picture.width() || row >= picture.height()) continue;
    if (picture.at(column, row)) return true;
  }
  return false;
}

}  // namespace footlight::app
