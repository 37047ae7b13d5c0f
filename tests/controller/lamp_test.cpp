// SPDX-License-Identifier: Apache-2.0
// Row by row: docs/looks.md.
#include "controller/lamp.hpp"

#include <set>

#include <gtest/gtest.h>

namespace footlight::controller {
namespace {

constexpr PerformerIndex kA{1};
constexpr PerformerIndex kB{2};
constexpr PerformerIndex kC{3};

CellUse use(std::optional<PerformerIndex> stands, std::optional<PerformerIndex> walks_to,
            std::optional<PerformerIndex> announced) {
  return {stands, walks_to, announced, {}, {}};
}
const auto kNobody = std::nullopt;
Lamp lit(LampRole role, PerformerIndex whose) { return {role, whose}; }

TEST(FloorMarker, OfNobodyIsDark) { EXPECT_EQ(lamp_of(use(kNobody, kNobody, kNobody), false), Lamp{}); }

TEST(FloorMarker, OfWhoStandsAndStaysIsHere) {
  EXPECT_EQ(lamp_of(use(kA, kNobody, kNobody), false), lit(LampRole::here, kA));
}

TEST(FloorMarker, OfWhoWalksToItIsArrive) {
  EXPECT_EQ(lamp_of(use(kNobody, kA, kNobody), false), lit(LampRole::arrive, kA));
}

TEST(FloorMarker, BelongsToWhoWalksUntilSheHasBeenThere) {
  EXPECT_EQ(lamp_of(use(kNobody, kA, kB), false), lit(LampRole::arrive, kA));
}

TEST(FloorMarker, OfTheNextMoveIsNext) {
  EXPECT_EQ(lamp_of(use(kNobody, kNobody, kB), false), lit(LampRole::next, kB));
}

TEST(FloorMarker, OfOnePersonNowAndAnotherNextIsAHandoverToWhoComes) {
  EXPECT_EQ(lamp_of(use(kA, kNobody, kB), false), lit(LampRole::handover, kB));
}

TEST(FloorMarker, OfWhoStandsWhileAnotherWalksToItIsAHandoverToWhoWalks) {
  EXPECT_EQ(lamp_of(use(kA, kB, kNobody), false), lit(LampRole::handover, kB));
  EXPECT_EQ(lamp_of(use(kA, kB, kC), false), lit(LampRole::handover, kB));
}

TEST(FloorMarker, InTheReserveIsDarkForWhoStandsThere) { EXPECT_EQ(lamp_of(use(kA, kNobody, kNobody), true), Lamp{}); }

TEST(FloorMarker, InTheReserveIsLitForWhoComes) {
  EXPECT_EQ(lamp_of(use(kNobody, kA, kNobody), true), lit(LampRole::arrive, kA));
  EXPECT_EQ(lamp_of(use(kNobody, kNobody, kA), true), lit(LampRole::next, kA));
  EXPECT_EQ(lamp_of(use(kA, kNobody, kB), true), lit(LampRole::next, kB));
  EXPECT_EQ(lamp_of(use(kA, kB, kNobody), true), lit(LampRole::arrive, kB));
}

Doing doing(std::optional<CellIndex> goal, std::optional<CellIndex> next) {
  return {CellIndex(7), goal, next, kStart, kStart};
}

TEST(Wearable, ShowsItsPerformersOwnState) {
  const CellIndex there(9);
  EXPECT_EQ(wearable_of(kA, doing(there, there), false), lit(LampRole::arrive, kA));
  EXPECT_EQ(wearable_of(kA, doing(there, kNobody), true), lit(LampRole::arrive, kA));
  EXPECT_EQ(wearable_of(kA, doing(kNobody, there), false), lit(LampRole::next, kA));
  EXPECT_EQ(wearable_of(kA, doing(kNobody, there), true), lit(LampRole::next, kA));
  EXPECT_EQ(wearable_of(kA, doing(kNobody, kNobody), false), lit(LampRole::here, kA));
  EXPECT_EQ(wearable_of(kA, doing(kNobody, kNobody), true), Lamp{});
}

TEST(CellUses, OfTwoWhoComeTheFirstToArriveCounts) {
  std::vector<Doing> two(2, doing(CellIndex(3), CellIndex(4)));
  two[0].cell = CellIndex(0);
  two[1].cell = CellIndex(1);
  two[0].arrives = instant_at(5);
  two[1].arrives = instant_at(4);
  two[0].next_arrives = instant_at(6);
  two[1].next_arrives = instant_at(6);
  std::vector<CellUse> uses;
  uses_of(two, 10, uses);
  EXPECT_EQ(uses[3].walks_to, PerformerIndex(1));
  EXPECT_EQ(uses[4].announced, PerformerIndex(0)) << "the lower number among equals";
  EXPECT_FALSE(uses[0].stands || uses[1].stands) << "a cell that somebody has left is nobody's place";
}

TEST(Pattern, ZeroIsTheShowsOwnLook) {
  const Look look{{10, 200, 30}, Effect::blink, 99};
  EXPECT_EQ(with_pattern(look, 0), look);
}

TEST(Pattern, IsDifferentForEveryEffectAndAnyColour) {
  for (const Colour colour : {Colour{0, 0, 0}, Colour{255, 255, 255}, Colour{255, 105, 180}, Colour{0, 0, 255}}) {
    for (int effect = 0; effect < 5; ++effect) {
      std::set<Look> looks;
      for (int pattern = 0; pattern < kPatterns; ++pattern) {
        looks.insert(with_pattern({colour, static_cast<Effect>(effect), 255}, pattern));
      }
      EXPECT_EQ(looks.size(), static_cast<std::size_t>(kPatterns)) << to_text(colour) << " effect " << effect;
    }
  }
}

TEST(Look, DefaultsAreThoseOfTheTable) {
  const auto effect = [](LampRole role) { return default_choice(role).effect; };
  EXPECT_EQ(effect(LampRole::here), Effect::steady);
  EXPECT_EQ(effect(LampRole::arrive), Effect::steady);
  EXPECT_EQ(effect(LampRole::next), Effect::count_down);
  EXPECT_EQ(effect(LampRole::handover), Effect::double_blink);
  for (int role = 0; role < kLampRoles; ++role) {
    EXPECT_FALSE(default_choice(static_cast<LampRole>(role)).colour.has_value()) << "the group's colour";
    EXPECT_EQ(default_choice(static_cast<LampRole>(role)).brightness, 255);
  }
}

}  // namespace
}  // namespace footlight::controller
