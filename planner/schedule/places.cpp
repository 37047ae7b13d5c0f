// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/places.hpp"

#include <algorithm>

namespace footlight::planner {
namespace {

/// Differences of costs below this are rounding.
constexpr double kRounding = 1e-9;

}  // namespace

Places::Places(std::size_t people, std::size_t cells)
    : choices_(people),
      place_(people),
      has_place_(people, 0),
      holder_(cells, kNobody),
      price_(cells, 0),
      distance_(cells, kFar),
      from_(cells, kNobody),
      step_(cells) {}

void Places::choose(std::uint32_t person, std::vector<Choice> choices) {
  if (has_place_[person] != 0) unseat(person);
  choices_[person] = std::move(choices);
}

void Places::close(CellIndex cell) {
  if (holder_[cell.at()] != kNobody) unseat(holder_[cell.at()]);
  price_[cell.at()] = -kFar;
}

void Places::open(CellIndex cell) { price_[cell.at()] = 0; }

bool Places::seat_all() {
  unseat_envious();
  for (std::uint32_t person = 0; person < choices_.size(); ++person) {
    if (has_place_[person] == 0 && !choices_[person].empty() && !seat(person)) return false;
  }
  return true;
}

void Places::unseat(std::uint32_t person) {
  const CellIndex left = place_[person].cell;
  has_place_[person] = 0;
  holder_[left.at()] = kNobody;
  price_[left.at()] = 0;
}

/// A cell that was left costs nothing again, so that others may want it more than what they have: unless they get up,
/// too, the prices do not prove that the places are the cheapest.
void Places::unseat_envious() {
  for (bool changed = true; changed;) {
    changed = false;
    for (std::uint32_t person = 0; person < choices_.size(); ++person) {
      if (has_place_[person] == 0) continue;
      const double own = place_[person].cost - price_[place_[person].cell.at()];
      const auto envied = [&](const Choice& c) { return c.cost - price_[c.cell.at()] < own - kRounding; };
      if (std::none_of(choices_[person].begin(), choices_[person].end(), envied)) continue;
      unseat(person);
      changed = true;
    }
  }
}

bool Places::seat(std::uint32_t person) {
  touched_.clear();
  settled_.clear();
  open_.clear();
  end_ = {kFar, CellIndex(0)};
  reach(person, 0, 0);
  while (!open_.empty()) {
    std::pop_heap(open_.begin(), open_.end(), std::greater<>());
    const Entry next = open_.back();
    open_.pop_back();
    if (next > end_) break;
    if (next.distance > distance_[next.cell.at()]) continue;
    settled_.push_back(next.cell);
    const std::uint32_t holder = holder_[next.cell.at()];
    reach(holder, next.distance, place_[holder].cost - price_[next.cell.at()]);
  }
  const bool found = end_.distance < kFar;
  if (found) {
    for (const CellIndex cell : settled_) price_[cell.at()] += distance_[cell.at()] - end_.distance;
    pass_on(person, end_.cell);
  }
  for (const CellIndex cell : touched_) distance_[cell.at()] = kFar;
  return found;
}

/// Looks at a person's choices, `base` away; `own` is the reduced cost of the place she holds now.
void Places::reach(std::uint32_t person, double base, double own) {
  for (const Choice& choice : choices_[person]) {
    const std::size_t at = choice.cell.at();
    // Never below `base`: rounding must not make a way shorter by going around in a circle.
    const double d = base + std::max(0.0, choice.cost - price_[at] - own);
    if (d >= distance_[at] - 1e-12 || Entry{d, choice.cell} > end_) continue;
    if (distance_[at] == kFar) touched_.push_back(choice.cell);
    distance_[at] = d;
    from_[at] = person;
    step_[at] = choice;
    if (holder_[at] == kNobody) {
      end_ = {d, choice.cell};
    } else {
      open_.push_back({d, choice.cell});
      std::push_heap(open_.begin(), open_.end(), std::greater<>());
    }
  }
}

void Places::pass_on(std::uint32_t person, CellIndex cell) {
  for (;;) {
    const std::uint32_t mover = from_[cell.at()];
    const CellIndex left = place_[mover].cell;
    holder_[cell.at()] = mover;
    place_[mover] = step_[cell.at()];
    has_place_[mover] = 1;
    if (mover == person) return;
    cell = left;
  }
}

std::optional<std::vector<CellIndex>> cheapest_places(const std::vector<std::vector<Choice>>& choices,
                                                      std::size_t cells) {
  Places places(choices.size(), cells);
  for (std::uint32_t person = 0; person < choices.size(); ++person) {
    if (choices[person].empty()) return std::nullopt;
    places.choose(person, choices[person]);
  }
  if (!places.seat_all()) return std::nullopt;
  std::vector<CellIndex> out;
  out.reserve(choices.size());
  for (std::uint32_t person = 0; person < choices.size(); ++person) out.push_back(places.place_of(person));
  return out;
}

}  // namespace footlight::planner
