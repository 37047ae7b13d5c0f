// SPDX-License-Identifier: Apache-2.0
#include "planner/why/drawn.hpp"

#include <algorithm>

#include "core/check.hpp"
#include "planner/by_hand.hpp"
#include "planner/casting.hpp"
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

Show show_of_those_who_come(const Show& show, const Plan& plan) {
  Show present = show;
  constexpr std::uint32_t kAway = 0xFFFFFFFFU;
  std::vector<std::uint32_t> number(show.performers.size(), kAway);
  present.performers.clear();
  for (std::size_t p = 0; p < show.performers.size(); ++p) {
    const std::size_t next = present.performers.size();
    if (next == plan.performers.size() || plan.performers[next] != show.performers[p].id) continue;
    number[p] = static_cast<std::uint32_t>(next);
    present.performers.push_back(show.performers[p]);
  }
  FL_CHECK(present.performers.size() == plan.tracks.size());
  for (const Formation& formation : plan.formations) {
    auto* list = std::get_if<CellsSource>(&present.sections[formation.section.at()].from);
    if (list == nullptr) continue;
    list->cells = formation.cells;
    if (list->groups.empty()) continue;
    list->groups.clear();
    for (const Performer& performer : present.performers) list->groups.push_back(performer.group);
  }
  for (Section& section : present.sections) {
    for (Override& hand : section.overrides) {
      std::erase_if(hand.pin, [&](const Override::Pin& pin) { return number[pin.performer.at()] == kAway; });
      for (Override::Pin& pin : hand.pin) pin.performer = PerformerIndex(number[pin.performer.at()]);
    }
  }
  return present;
}

Drawn::Drawn(const Show& present, const Plan& plan, const std::optional<Film>& film, SectionIndex section)
    : plan_(plan), section_(section), grid_(plan.stage.grid), ways_(plan.stage, plan.stage.clearance_m / 2) {
  usable_ = ways_.standable();
  for (const CellIndex cell : plan.sections[section.at()].reserve) {
    if (usable_[cell.at()] != 0) reserve_.push_back(cell);
    usable_[cell.at()] = 0;
  }
  const Section& asked = present.sections[section.at()];
  const auto* listed = std::get_if<CellsSource>(&asked.from);
  const bool drawn_again = asked.motion == nullptr && (listed != nullptr || plan.sections[section.at()].film);
  for (std::size_t k = 0; k < plan.formations.size(); ++k) {
    const Formation& at = plan.formations[k];
    if (at.section != section) continue;
    if (stations_.empty()) first_ = k;
    Station& station = stations_.emplace_back();
    station.section = section;
    station.count = at.count;
    station.frame = at.frame;
    station.arrive = station.depart = at.time;
    if (!drawn_again) {
      take_planned(present, at, station);
      continue;
    }
    station.cells = listed != nullptr ? listed->cells : drawing(at, film);
    station.pinned = listed != nullptr && listed->assigned;
    if (listed != nullptr) station.groups = listed->groups;
    station.key = at.key;
    station.exact = !at.frame || stations_.size() == 1 || (at.key && !asked.keys.empty());
  }
  if (listed == nullptr && drawn_again) add_waiting();
  change_by_hand(present);
}

void Drawn::take_planned(const Show& present, const Formation& at, Station& station) const {
  station.cells = at.cells;
  station.exact = at.key;
  station.follows = present.sections[section_.at()].motion != nullptr;
  const std::vector<char> bound = bound_groups(present);
  if (std::find(bound.begin(), bound.end(), 1) == bound.end()) return;
  for (const Performer& performer : present.performers) station.groups.push_back(performer.group);
}

void Drawn::change_by_hand(const Show& present) {
  SectionPlan drawn;
  drawn.stations = stations_;
  // Where somebody who does not come would have been moved there may be nobody to move.
  if (!apply_overrides(present, section_, ways_, drawn)) stations_ = std::move(drawn.stations);
}

CellFlags Drawn::places(std::size_t number) const {
  CellFlags flags(static_cast<std::size_t>(grid_.size()), 0);
  for (const CellIndex cell : stations_[number].cells) flags[cell.at()] = 1;
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
  for (std::size_t n = 0; n < stations_.size(); ++n) {
    stations_[n].cells.insert(stations_[n].cells.end(), waiting[n].begin(), waiting[n].end());
  }
}

}  // namespace footlight::planner
