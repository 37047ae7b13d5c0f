// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "core/index.hpp"

namespace footlight::planner {

/// A cell that somebody can take, at a cost >= 0.
struct Choice {
  CellIndex cell;
  double cost = 0;
};

/// Gives everybody who has choices a cell of her own among them at the least total cost; more cells than people are
/// normal. Successive shortest paths with potentials (Jonker, Volgenant 1987, the augmenting part). After a change of
/// somebody's choices only those are seated anew whose places it concerns; the total is the least again.
class Places {
 public:
  /// Nobody has choices yet, everybody may take any cell.
  Places(std::size_t people, std::size_t cells);

  /// What a person can choose from now on; an empty list: she needs no place.
  void choose(std::uint32_t person, std::vector<Choice> choices);
  /// Nobody may take this cell, or everybody may again.
  void close(CellIndex cell);
  void open(CellIndex cell);
  /// Seats whoever has choices and no place. @return false: there are too few cells; what is seated stays so.
  /// O(people to seat x choices log choices) in practice, since paths stay short, and O(all choices)
  [[nodiscard]] bool seat_all();
  /// Of a person with choices, after `seat_all`.
  [[nodiscard]] CellIndex place_of(std::uint32_t person) const { return place_[person].cell; }

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();
  static constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();
  struct Entry {
    double distance = 0;
    CellIndex cell;
    friend bool operator>(const Entry& a, const Entry& b) {
      return a.distance > b.distance || (a.distance == b.distance && a.cell > b.cell);
    }
  };

  void unseat(std::uint32_t person);
  void unseat_envious();
  bool seat(std::uint32_t person);
  void reach(std::uint32_t person, double base, double own);
  void pass_on(std::uint32_t person, CellIndex cell);

  std::vector<std::vector<Choice>> choices_;
  std::vector<Choice> place_;
  std::vector<char> has_place_;
  std::vector<std::uint32_t> holder_;
  std::vector<double> price_;  ///< <= 0; a free cell costs nothing, a closed one more than anybody can pay
  // Of one search:
  std::vector<double> distance_;
  std::vector<std::uint32_t> from_;
  std::vector<Choice> step_;  ///< how `from_` takes the cell
  std::vector<CellIndex> touched_;
  std::vector<CellIndex> settled_;
  std::vector<Entry> open_;
  Entry end_;  ///< the nearest free cell so far
};

/// Everybody at once. @param choices for each person; an empty list has no answer
/// @return nothing when there are too few cells
[[nodiscard]] std::optional<std::vector<CellIndex>> cheapest_places(const std::vector<std::vector<Choice>>& choices,
                                                                    std::size_t cells);

}  // namespace footlight::planner
