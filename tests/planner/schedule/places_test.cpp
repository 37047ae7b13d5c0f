// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/places.hpp"

#include <algorithm>
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

}  // namespace
}  // namespace footlight::planner
