// SPDX-License-Identifier: Apache-2.0
#include "app/commission/findings.hpp"

#include <algorithm>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"
#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

constexpr int kChannels = 8;

/// A floor of 12 x 8 lamps on nodes of eight, as it is, to be harmed.
struct Floor {
  Grid grid = Grid::make(GridKind::square, 12, 8, 1).value();
  Rig rig = tests::lamps_everywhere(grid, {BusKind::can, BusKind::serial}, 115'200, kChannels);
  std::vector<FloorLamp> lamps = lamps_of(rig);
  std::vector<std::optional<CellIndex>> seen;
  Floor() {
    for (const FloorLamp& lamp : lamps) seen.push_back(lamp.cell);
  }
  [[nodiscard]] Findings find(const std::vector<CellIndex>& unread = {}) const {
    return compare(rig, lamps, seen, unread);
  }
  /// Lamp `c` of a node.
  [[nodiscard]] static std::size_t lamp(std::size_t node, int c) {
    return node * kChannels + static_cast<std::size_t>(c);
  }
};

TEST(Findings, OfAFloorThatIsRightAreNone) {
  const Floor floor;
  EXPECT_TRUE(floor.find().clean());
  EXPECT_EQ(floor.find().right, floor.lamps.size());
}

TEST(Findings, ExchangedPairsAreFoundExactly) {
  EXPECT_TRUE(rc::check([] {
    Floor floor;
    Rng rng(*rc::gen::arbitrary<std::uint64_t>());
    // One lamp of every second node with one of another: no segment can explain them.
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (std::size_t node = 0; node + 1 < floor.rig.nodes.size(); node += 2) {
      if (rng.below(2) == 0) continue;
      const std::size_t a = Floor::lamp(node, static_cast<int>(rng.below(kChannels)));
      const std::size_t b = Floor::lamp(node + 1, static_cast<int>(rng.below(kChannels)));
      std::swap(floor.seen[a], floor.seen[b]);
      pairs.emplace_back(a, b);
    }
    const Findings found = floor.find();
    RC_ASSERT(found.exchanged == pairs);
    RC_ASSERT(found.turned.empty() && found.nodes.empty() && found.moved.empty() && found.dead.empty());
    RC_ASSERT(found.right == floor.lamps.size() - 2 * pairs.size());
  }));
}

TEST(Findings, ReversedAndRotatedSegmentsAreFoundExactly) {
  EXPECT_TRUE(rc::check([] {
    Floor floor;
    const auto node = *rc::gen::inRange<std::size_t>(0, floor.rig.nodes.size());
    const int first = *rc::gen::inRange(0, kChannels - 3);
    const int last = *rc::gen::inRange(first + 3, kChannels);
    const bool reversed = *rc::gen::arbitrary<bool>();
    const int length = last - first + 1;
    const int by = reversed ? 0 : *rc::gen::inRange(1, length);
    const auto before = floor.seen;
    for (int c = first; c <= last; ++c) {
      const int at = reversed ? first + last - c : first + (c - first + by) % length;
      floor.seen[Floor::lamp(node, c)] = before[Floor::lamp(node, at)];
    }
    const Findings found = floor.find();
    const TurnedLamps expected{NodeIndex::of(node), first, last, reversed, by};
    RC_ASSERT(found.turned == std::vector<TurnedLamps>{expected});
    RC_ASSERT(found.exchanged.empty() && found.moved.empty() && found.nodes.empty());
  }));
}

TEST(Findings, ATurnedNodeWithDeadLampsIsStillOne) {
  EXPECT_TRUE(rc::check([] {
    Floor floor;
    const auto node = *rc::gen::inRange<std::size_t>(0, floor.rig.nodes.size());
    for (int c = 0; c < kChannels; ++c) {
      floor.seen[Floor::lamp(node, c)] = floor.lamps[Floor::lamp(node, kChannels - 1 - c)].cell;
    }
    // Any but the two ends, without which a shorter segment explains as much.
    const auto dead = *rc::gen::inRange(1, kChannels - 1);
    floor.seen[Floor::lamp(node, dead)].reset();
    const Findings found = floor.find();
    RC_ASSERT(found.turned == (std::vector<TurnedLamps>{{NodeIndex::of(node), 0, kChannels - 1, true, 0}}));
    RC_ASSERT(found.dead == std::vector<std::size_t>{Floor::lamp(node, dead)});
  }));
}

TEST(Findings, ExchangedNodesAreFoundExactly) {
  EXPECT_TRUE(rc::check([] {
    Floor floor;
    const auto both =
        *rc::gen::unique<std::vector<std::size_t>>(2, rc::gen::inRange<std::size_t>(0, floor.rig.nodes.size()));
    const std::size_t a = std::min(both[0], both[1]);
    const std::size_t b = std::max(both[0], both[1]);
    for (int c = 0; c < kChannels; ++c) std::swap(floor.seen[Floor::lamp(a, c)], floor.seen[Floor::lamp(b, c)]);
    const int dead = *rc::gen::inRange(0, kChannels);
    floor.seen[Floor::lamp(a, dead)].reset();
    const Findings found = floor.find();
    RC_ASSERT(found.nodes == (std::vector<std::pair<NodeIndex, NodeIndex>>{{NodeIndex::of(a), NodeIndex::of(b)}}));
    RC_ASSERT(found.turned.empty() && found.exchanged.empty() && found.moved.empty());
    RC_ASSERT(found.dead == std::vector<std::size_t>{Floor::lamp(a, dead)});
  }));
}

TEST(Findings, EveryLampOfAnyPermutationIsAccountedForOnce) {
  EXPECT_TRUE(rc::check([] {
    Floor floor;
    Rng rng(*rc::gen::arbitrary<std::uint64_t>());
    for (std::size_t i = floor.seen.size() - 1; i > 0; --i) std::swap(floor.seen[i], floor.seen[rng.below(i + 1)]);
    const auto dead = *rc::gen::inRange<std::size_t>(0, 20);
    for (std::size_t i = 0; i < dead; ++i) floor.seen[rng.below(floor.seen.size())].reset();
    const Findings found = floor.find();
    std::size_t explained = found.right + 2 * found.exchanged.size() + found.moved.size() + found.dead.size();
    // A turned segment or node may hold lamps that are right or dead: count those that are neither.
    const auto wrong = [&](std::size_t i) { return floor.seen[i] && floor.seen[i] != floor.lamps[i].cell; };
    const auto wrong_of = [&](std::size_t node, int first, int last) {
      std::size_t sum = 0;
      for (int c = first; c <= last; ++c) sum += wrong(Floor::lamp(node, c)) ? 1 : 0;
      return sum;
    };
    for (const auto& turned : found.turned) explained += wrong_of(turned.node.at(), turned.first, turned.last);
    for (const auto& [a, b] : found.nodes) {
      explained += wrong_of(a.at(), 0, kChannels - 1) + wrong_of(b.at(), 0, kChannels - 1);
    }
    RC_ASSERT(explained == floor.lamps.size());
    // Whatever it is called: the rig that is written has every lamp that was seen where it was seen.
    const auto after = lamps_of(with_places(floor.rig, floor.lamps, floor.seen));
    for (std::size_t i = 0; i < after.size(); ++i) RC_ASSERT(!floor.seen[i] || after[i].cell == floor.seen[i]);
  }));
}

TEST(Findings, ALampThatIsNotSeenIsDeadOrUnreadable) {
  Floor floor;
  floor.seen[5].reset();
  floor.seen[9].reset();
  const Findings found = floor.find({*floor.lamps[9].cell});
  EXPECT_EQ(found.dead, std::vector<std::size_t>{5});
  EXPECT_EQ(found.unreadable, std::vector<std::size_t>{9});
}

TEST(Findings, ALampThatWasNeverAssignedIsFoundOrNowhere) {
  Floor floor;
  floor.lamps[5].cell.reset();
  floor.lamps[6].cell.reset();
  floor.seen[6].reset();
  const Findings found = floor.find();
  EXPECT_EQ(found.unassigned, (std::vector<std::pair<std::size_t, CellIndex>>{{5, *floor.seen[5]}}));
  EXPECT_EQ(found.nowhere, std::vector<std::size_t>{6});
  EXPECT_EQ(found.right, floor.lamps.size() - 2);
}

}  // namespace
}  // namespace footlight::app
