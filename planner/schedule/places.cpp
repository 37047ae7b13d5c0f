// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/places.hpp"

#include <algorithm>
#include <limits>
#include <queue>
#include <tuple>

namespace footlight::planner {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();

class Places {
 public:
  Places(const std::vector<std::vector<Choice>>& choices, std::size_t cells)
      : choices_(choices),
        holder_(cells, kNobody),
        price_(cells, 0),
        distance_(cells, kFar),
        from_(cells, kNobody),
        place_(choices.size()),
        has_place_(choices.size(), 0) {}

  bool seat(std::uint32_t person) {
    touched_.clear();
    settled_.clear();
    while (!open_.empty()) open_.pop();
    reach(person, 0, 0);
    CellIndex end{};
    double end_distance = kFar;
    while (!open_.empty()) {
      const auto [d, cell] = open_.top();
      open_.pop();
      if (d > distance_[cell.at()]) continue;
      if (holder_[cell.at()] == kNobody) {
        end = cell;
        end_distance = d;
        break;
      }
      settled_.push_back(cell);
      const std::uint32_t holder = holder_[cell.at()];
      reach(holder, d, cost_of(holder) - price_[cell.at()]);
    }
    const bool found = end_distance < kFar;
    if (found) {
      for (const CellIndex cell : settled_) price_[cell.at()] += distance_[cell.at()] - end_distance;
      pass_on(person, end);
    }
    for (const CellIndex cell : touched_) distance_[cell.at()] = kFar;
    return found;
  }

  [[nodiscard]] std::vector<CellIndex> take() { return std::move(place_); }

 private:
  /// Looks at a person's choices, `base` away; `own` is the reduced cost of the place she holds now.
  void reach(std::uint32_t person, double base, double own) {
    for (const Choice& choice : choices_[person]) {
      // Never below `base`: rounding must not make a way shorter by going around in a circle.
      const double d = base + std::max(0.0, choice.cost - price_[choice.cell.at()] - own);
      double& known = distance_[choice.cell.at()];
      if (d >= known - 1e-12) continue;
      if (known == kFar) touched_.push_back(choice.cell);
      known = d;
      from_[choice.cell.at()] = person;
      open_.emplace(d, choice.cell);
    }
  }
  [[nodiscard]] double cost_of(std::uint32_t person) const {
    for (const Choice& choice : choices_[person]) {
      if (choice.cell == place_[person]) return choice.cost;
    }
    return kFar;
  }
  void pass_on(std::uint32_t person, CellIndex cell) {
    for (;;) {
      const std::uint32_t mover = from_[cell.at()];
      const CellIndex left = place_[mover];
      const bool had_place = has_place_[mover] != 0;
      holder_[cell.at()] = mover;
      place_[mover] = cell;
      has_place_[mover] = 1;
      if (mover == person || !had_place) return;
      cell = left;
    }
  }

  using Entry = std::tuple<double, CellIndex>;
  const std::vector<std::vector<Choice>>& choices_;
  std::vector<std::uint32_t> holder_;
  std::vector<double> price_;  // <= 0; a free cell costs nothing
  std::vector<double> distance_;
  std::vector<std::uint32_t> from_;
  std::vector<CellIndex> place_;
  std::vector<char> has_place_;
  std::vector<CellIndex> touched_;
  std::vector<CellIndex> settled_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open_;
};

}  // namespace

std::optional<std::vector<CellIndex>> cheapest_places(const std::vector<std::vector<Choice>>& choices,
                                                      std::size_t cells) {
  Places places(choices, cells);
  for (std::uint32_t person = 0; person < choices.size(); ++person) {
    if (!places.seat(person)) return std::nullopt;
  }
  return places.take();
}

}  // namespace footlight::planner
