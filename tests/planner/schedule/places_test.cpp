// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/places.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <set>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"

namespace footlight::planner {
namespace {

double cheapest_by_trying(const std::vector<std::vector<Choice>>& choices, std::size_t person,
                          std::set<CellIndex>& used) {
  if (person == choices.size()) return 0;
  double best = std::numeric_limits<double>::infinity();
  for (const Choice& choice : choices[person]) {
    if (!used.insert(choice.cell).second) continue;
    best = std::min(best, choice.cost + cheapest_by_trying(choices, person + 1, used));
    used.erase(choice.cell);
  }
  return best;
}

TEST(CheapestPlaces, AreTheBestOfAllWaysToSeatPeople) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    const std::size_t cells = 3 + rng.below(7);
    std::vector<std::vector<Choice>> choices(1 + rng.below(5));
    for (auto& list : choices) {
      for (std::size_t c = 0; c < cells; ++c) {
        if (rng.below(2) == 0) list.push_back({CellIndex::of(c), static_cast<double>(rng.below(20))});
      }
    }
    std::set<CellIndex> used;
    const double expected = cheapest_by_trying(choices, 0, used);
    const auto places = cheapest_places(choices, cells);
    RC_ASSERT(places.has_value() == (expected < std::numeric_limits<double>::infinity()));
    if (!places) return;
    double cost = 0;
    for (std::size_t p = 0; p < choices.size(); ++p) {
      RC_ASSERT(used.insert((*places)[p]).second);
      const auto found =
          std::find_if(choices[p].begin(), choices[p].end(), [&](const Choice& c) { return c.cell == (*places)[p]; });
      RC_ASSERT(found != choices[p].end());
      cost += found->cost;
    }
    RC_ASSERT(std::abs(cost - expected) < 1e-9);
  }));
}

TEST(CheapestPlaces, AreTheBestAgainAfterChoicesAndCellsChange) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    const std::size_t cells = 8 + rng.below(12);
    const std::size_t people = 2 + rng.below(7);
    Places places(people, cells);
    std::vector<std::vector<Choice>> choices(people);
    std::vector<char> closed(cells, 0);
    for (int round = 0; round < 6; ++round) {
      for (std::uint32_t p = 0; p < people; ++p) {
        if (round > 0 && rng.below(3) != 0) continue;
        choices[p].clear();
        for (std::size_t c = 0; c < cells; ++c) {
          if (rng.below(2) == 0) choices[p].push_back({CellIndex::of(c), static_cast<double>(rng.below(20))});
        }
        places.choose(p, choices[p]);
      }
      const std::size_t flipped = rng.below(cells);
      closed[flipped] = closed[flipped] == 0 ? 1 : 0;
      closed[flipped] != 0 ? places.close(CellIndex::of(flipped)) : places.open(CellIndex::of(flipped));
      std::vector<std::vector<Choice>> possible;
      for (const auto& list : choices) {
        if (list.empty()) continue;
        possible.emplace_back();
        std::copy_if(list.begin(), list.end(), std::back_inserter(possible.back()),
                     [&](const Choice& choice) { return closed[choice.cell.at()] == 0; });
      }
      const auto fresh = cheapest_places(possible, cells);
      RC_ASSERT(places.seat_all() == fresh.has_value());
      if (!fresh) continue;
      const auto cost = [](const std::vector<Choice>& list, CellIndex cell) {
        const auto found = std::find_if(list.begin(), list.end(), [&](const Choice& c) { return c.cell == cell; });
        RC_ASSERT(found != list.end());
        return found->cost;
      };
      std::set<CellIndex> used;
      double sum = 0;
      double least = 0;
      for (std::uint32_t p = 0, n = 0; p < people; ++p) {
        if (choices[p].empty()) continue;
        RC_ASSERT(used.insert(places.place_of(p)).second && closed[places.place_of(p).at()] == 0);
        sum += cost(choices[p], places.place_of(p));
        least += cost(possible[n], (*fresh)[n]);
        ++n;
      }
      RC_ASSERT(std::abs(sum - least) < 1e-9);
    }
  }));
}

}  // namespace
}  // namespace footlight::planner
