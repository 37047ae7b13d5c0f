// SPDX-License-Identifier: Apache-2.0
#include "planner/formation/seats.hpp"

#include <algorithm>
#include <array>

namespace footlight::planner {
namespace {

/// Most drawings are content with the first; a picture's people may go farther within the picture.
constexpr std::array kReaches{1.6, 3.2, Seats::kReach, 4 * Seats::kReach};

}  // namespace

Seats::Seats(const Grid& grid, const CellFlags& usable, std::size_t people)
    : grid_(grid), usable_(usable), places_(people, static_cast<std::size_t>(grid.size())) {}

bool Seats::choose(const std::vector<Point>& points, const CellFlags& only, double reach) {
  bool all = true;
  const double pitch = grid_.pitch_m();
  for (std::uint32_t k = 0; k < points.size(); ++k) {
    std::vector<Choice> choices;
    for (const CellIndex cell : grid_.within(points[k], reach * pitch)) {
      if (usable_[cell.at()] == 0 || (!only.empty() && only[cell.at()] == 0)) continue;
      choices.push_back({cell, squared_length(grid_.centre(cell) - points[k]) / (pitch * pitch)});
    }
    all = all && !choices.empty();
    places_.choose(seated_ + k, std::move(choices));
  }
  return all;
}

bool Seats::add(const std::vector<Point>& points, const CellFlags& only) {
  const auto found = [&](double reach) { return choose(points, only, reach) && places_.seat_all(); };
  if (std::none_of(kReaches.begin(), kReaches.end() - (only.empty() ? 1 : 0), found)) return false;
  seated_ += static_cast<std::uint32_t>(points.size());
  return true;
}

std::vector<CellIndex> Seats::cells() const {
  std::vector<CellIndex> out;
  for (std::uint32_t k = 0; k < seated_; ++k) out.push_back(places_.place_of(k));
  return out;
}

}  // namespace footlight::planner
