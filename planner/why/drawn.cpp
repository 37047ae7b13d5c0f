// SPDX-License-Identifier: Apache-2.0
#include "planner/why/drawn.hpp"

#include <algorithm>

#include "core/check.hpp"
#include "planner/formation/summed_area.hpp"

namespace footlight::planner {

Instant start_of_move(const Plan& plan, FormationIndex into) {
  FL_CHECK(into.at() > 0 && into.at() < plan.formations.size());
  const Formation& before = plan.formations[into.at() - 1];
  const Formation& after = plan.formations[into.at()];
  if (before.section == after.section) return before.time;
  // Sections that touch are walked in the millisecond that the later one begins after the earlier one's end.
  return std::min(std::max(before.time, plan.sections[before.section.at()].end), after.time);
}

std::vector<Mark> way_of(const std::vector<Mark>& track, Instant start, Instant end) {
  std::vector<Mark> way;
  for (const Mark& mark : track) {
    if (mark.time <= start) way.assign(1, mark);
    if (mark.time > start && mark.time <= end) way.push_back(mark);
  }
  return way;
}

Drawn::Drawn(const Show& show, const Plan& plan, const std::optional<Film>& film, SectionIndex section)
    : plan_(plan), section_(section), grid_(plan.stage.grid), ways_(plan.stage, plan.stage.clearance_m / 2) {
  usable_ = ways_.standable();
  for (const CellIndex cell : plan.sections[section.at()].reserve) {
    if (usable_[cell.at()] != 0) reserve_.push_back(cell);
    usable_[cell.at()] = 0;
  }
  const auto* listed = std::get_if<CellsSource>(&show.sections[section.at()].from);
  for (std::size_t k = 0; k < plan.formations.size(); ++k) {
    if (plan.formations[k].section != section) continue;
    if (cells_.empty()) first_ = k;
    cells_.push_back(listed != nullptr ? listed->cells : drawing(plan.formations[k], film));
  }
  if (listed == nullptr) add_waiting();
}

CellFlags Drawn::places(std::size_t number) const {
  CellFlags flags(static_cast<std::size_t>(grid_.size()), 0);
  for (const CellIndex cell : cells_[number]) flags[cell.at()] = 1;
  for (const CellIndex cell : plan_.sections[section_.at()].reserve) flags[cell.at()] = 0;
  return flags;
}

std::vector<CellIndex> Drawn::drawing(const Formation& at, const std::optional<Film>& film) {
  FL_CHECK(film && !film->frames.empty() && plan_.sections[section_.at()].film);
  if (ranks_.empty()) ranks_ = even_ranks(grid_);
  const int frame = std::clamp(at.frame.value_or(film->first_frame) - film->first_frame, 0,
                               static_cast<int>(film->frames.size()) - 1);
  const SummedArea picture(film->frames[static_cast<std::size_t>(frame)]);
  const auto shares = cell_shares(picture, grid_, plan_.sections[section_.at()].film->stage_to_frame);
  std::vector<CellIndex> now;  // a blank picture keeps people where they are
  for (const CellIndex cell : at.cells) {
    if (usable_[cell.at()] != 0) now.push_back(cell);
  }
  const int people = static_cast<int>(plan_.tracks.size());
  const int least = std::max(0, people - static_cast<int>(reserve_.size()));
  drawings_.push_back(draw({&grid_, &shares, &usable_, &ranks_, people, least, now}));
  return drawings_.back().cells;
}

void Drawn::add_waiting() {
  const auto waiting = waiting_places({&grid_, &reserve_, &drawings_, static_cast<int>(plan_.tracks.size())});
  for (std::size_t n = 0; n < cells_.size(); ++n) {
    cells_[n].insert(cells_[n].end(), waiting[n].begin(), waiting[n].end());
  }
}

}  // namespace footlight::planner
