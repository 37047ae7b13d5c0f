// SPDX-License-Identifier: Apache-2.0
#include "planner/hierarchy/transport.hpp"

#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"
#include "planner/assignment/assignment.hpp"

namespace footlight::planner {
namespace {

TEST(Transport, SplitsARegionWhereTheSidesDiffer) {
  const std::vector<Load> from{{{0, 0}, 10}};
  const std::vector<Load> to{{{-5, 0}, 4}, {{5, 0}, 6}};
  EXPECT_EQ(transport(from, to, PairingCost::squared), (std::vector<Shipment>{{0, 0, 4}, {0, 1, 6}}));
}

TEST(Transport, IsAsCheapAsTheExactAssignmentOfEverySinglePerson) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    const auto loads = [&](int people) {
      std::vector<Load> out;
      while (people > 0) {
        const int here = std::min(people, static_cast<int>(rng.below(5)) + 1);
        out.push_back({{20 * rng.uniform(), 20 * rng.uniform()}, here});
        people -= here;
      }
      return out;
    };
    const int people = static_cast<int>(rng.below(20)) + 1;
    const auto from = loads(people);
    const auto to = loads(people);
    double cost = 0;
    int carried = 0;
    for (const Shipment& s : transport(from, to, PairingCost::squared)) {
      cost += s.people * squared_length(from[s.from].anchor - to[s.to].anchor);
      carried += s.people;
    }
    std::vector<Arc> arcs;
    std::uint32_t source = 0;
    for (const Load& a : from) {
      for (int i = 0; i < a.people; ++i, ++source) {
        std::uint32_t target = 0;
        for (const Load& b : to) {
          for (int j = 0; j < b.people; ++j) arcs.push_back({source, target++, squared_length(a.anchor - b.anchor)});
        }
      }
    }
    RC_ASSERT(carried == people);
    RC_ASSERT(std::abs(cost - assign_sparse(source, arcs)->cost) < 1e-6);
  }));
}

TEST(Transport, PlainDistanceLeavesInPlaceWhomTheSquaredOneMoves) {
  const std::vector<Load> from{{{0, 0}, 5}, {{3, 0}, 5}};
  const std::vector<Load> to{{{3, 0}, 5}, {{6, 1}, 5}};
  EXPECT_EQ(transport(from, to, PairingCost::euclidean), (std::vector<Shipment>{{0, 1, 5}, {1, 0, 5}}));
  EXPECT_EQ(transport(from, to, PairingCost::squared), (std::vector<Shipment>{{0, 0, 5}, {1, 1, 5}}));
}

}  // namespace
}  // namespace footlight::planner
