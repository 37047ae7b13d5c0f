// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/film.hpp"
#include "core/plan.hpp"
#include "core/show.hpp"
#include "planner/formation/formation.hpp"
#include "planner/plan_section.hpp"
#include "planner/schedule/ways.hpp"

namespace footlight::planner {

/// The instant at which the formation before is left: a section's last one is held until the section ends.
/// @param into not the first of the plan
[[nodiscard]] Instant start_of_move(const Plan& plan, FormationIndex into);
/// Where somebody is at `start` and at every mark of hers until `end`: at least one mark.
[[nodiscard]] std::vector<Mark> way_of(const std::vector<Mark>& track, Instant start, Instant end);

/// The show of those who come: its performers are those of the plan in their order, its lists of cells are the cells on
/// which they stand, its pins those of people who are there.
[[nodiscard]] Show show_of_those_who_come(const Show& show, const Plan& plan);

/// The drawings of a section as its formations' own frames ask for them, whatever the model: who can stand in the
/// picture when nobody has to come from anywhere (planner/formation), with what the director changes by hand. A list of
/// cells is its own drawing.
class Drawn {
 public:
  /// @param present show_of_those_who_come
  Drawn(const Show& present, const Plan& plan, const std::optional<Film>& film, SectionIndex section);

  [[nodiscard]] const Ways& ways() const { return ways_; }
  [[nodiscard]] std::size_t formations() const { return stations_.size(); }
  /// Number in the section, from 0, of one of its formations.
  [[nodiscard]] std::size_t number_of(FormationIndex index) const { return index.at() - first_; }
  /// Everybody's cells, the waiting ones included; who is pinned there; whether nobody may be elsewhere.
  [[nodiscard]] const Station& station(std::size_t number) const { return stations_[number]; }
  /// One flag a cell: a place of the drawing.
  [[nodiscard]] CellFlags places(std::size_t number) const;

 private:
  [[nodiscard]] std::vector<CellIndex> drawing(const Formation& at, const std::optional<Film>& film);
  void add_waiting();
  /// Of what is not drawn again, parts and the ways of a model of motion: people are where they are wanted.
  void take_planned(const Show& present, const Formation& at, Station& station) const;
  void change_by_hand(const Show& present);

  const Plan& plan_;
  SectionIndex section_;
  const Grid& grid_;
  Ways ways_;
  CellFlags usable_;
  std::vector<CellIndex> reserve_;
  std::vector<std::uint32_t> ranks_;
  std::vector<Drawing> drawings_;
  std::size_t first_ = 0;
  std::vector<Station> stations_;
};

}  // namespace footlight::planner
