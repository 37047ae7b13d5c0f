// SPDX-License-Identifier: Apache-2.0
#include "controller/supply_load.hpp"

#include <algorithm>
#include <memory>

#include <gtest/gtest.h>

#include "controller/cue_list.hpp"
#include "controller/cue_schedule.hpp"
#include "tests/controller/fake_driver.hpp"

namespace footlight::controller {
namespace {

constexpr LampCurrents kLamp{0.02, 0.01, 0.005, 0.1};

/// Two supplies with a node of four lamps each, a third node on none. Switch 0 is the opening, 1 and 2 belong to the
/// first cue, 3 to the second; five seconds each.
class Supplies : public testing::Test {
 protected:
  Supplies() {
    rig.file = "rig.yaml";
    rig.buses.push_back({"bus", BusKind::serial, "sim://serial", 115'200, std::nullopt, {}});
    rig.supplies = {{"P1", 1, Supply::Overload::refuse, {}, {"rig.yaml", 7, 5}},
                    {"P2", 1, Supply::Overload::refuse, {}, {"rig.yaml", 8, 5}}};
    rig.currents = kLamp;
    for (int n = 0; n < 3; ++n) {
      Node& node = rig.nodes.emplace_back();
      node.address = n + 1;
      node.channels.resize(4, {Channel::Kind::cell, CellIndex(0), {}});
      node.supply = n < 2 ? rig.supplies[static_cast<std::size_t>(n)].name : "";
    }
    drivers.push_back(std::make_unique<FakeDriver>(3, 4, false));
    for (const char* number : {"1", "2"}) {
      CuePlay play;
      play.cue.number = CueNumber::parse(number).value();
      play.cue.name = "cue " + std::string(number);
      plays.push_back(play);
    }
  }

  [[nodiscard]] CueSchedule schedule(const std::vector<LookIndex>& of_switch) const {
    std::vector<Switch> switches;
    std::vector<LookIndex> table;
    const std::vector<std::optional<std::size_t>> cues{std::nullopt, 0, 0, 1};
    for (std::size_t k = 0; k < of_switch.size(); ++k) {
      switches.push_back({kStart + static_cast<Duration::rep>(k) * seconds(5), "move " + std::to_string(k), false,
                          cues[std::min(k, cues.size() - 1)]});
      for (std::size_t n = 0; n < 3; ++n) {
        for (std::size_t c = 0; c < kChannelsPerNode; ++c) table.push_back(c < 4 ? of_switch[k] : kDark);
      }
    }
    return {looks, switches, 3, table, 0, {}};
  }
  [[nodiscard]] Result<CueSchedule> carried(const std::vector<LookIndex>& of_switch) const {
    return within_supplies(schedule(of_switch), rig, drivers, plays);
  }
  [[nodiscard]] std::string refused(const std::vector<LookIndex>& of_switch) const {
    const auto result = carried(of_switch);
    if (result) return "carried";
    EXPECT_EQ(result.error().kind, ErrorKind::refused);
    return result.error().message;
  }

  // Dark, white, red of half brightness, blinking white, nearly dark.
  std::vector<Look> looks{{{0, 0, 0}, Effect::steady, 0},
                          {{255, 255, 255}, Effect::steady, 255},
                          {{255, 0, 0}, Effect::steady, 102},
                          {{255, 255, 255}, Effect::blink, 255},
                          {{255, 255, 255}, Effect::steady, 5}};
  Rig rig;
  std::vector<std::unique_ptr<drivers::Driver>> drivers;
  std::vector<CuePlay> plays;
};

TEST_F(Supplies, ALampTakesItsColoursInProportionToItsBrightness) {
  EXPECT_DOUBLE_EQ(lamp_current(looks[1], kLamp), 0.035);
  EXPECT_DOUBLE_EQ(lamp_current(looks[2], kLamp), 0.008);
  EXPECT_DOUBLE_EQ(lamp_current(looks[0], kLamp), 0);
}

TEST_F(Supplies, EveryNodeCountsOnItsOwnSupply) {
  const auto built = carried({0, 1, 2, 3});
  ASSERT_TRUE(built) << built.error().message;
  ASSERT_EQ(built->supplies().size(), 2U);
  for (const SupplyLoad& load : built->supplies()) {
    EXPECT_EQ(load.nodes, 1);
    EXPECT_EQ(load.lamps, 4);
    EXPECT_DOUBLE_EQ(load.dark_a, 0.1);
    EXPECT_NEAR(load.peak_a, 0.1 + 4 * 0.035, 1e-12);
    EXPECT_EQ(load.peak_at, 1U) << "the first of those that take most";
    EXPECT_NEAR(load.mean_a, 0.1 + (0 + 4 * 0.035 + 4 * 0.008) / 3, 1e-12) << "the last switch has no end";
    EXPECT_NEAR(load.unguided_a, 0.1 + 4 * (0.02 + 0.01 * 191 / 255) * 40 / 255, 1e-12);
    EXPECT_TRUE(load.dimmed.empty());
  }
}

TEST_F(Supplies, BlinkingLampsCountInFullForTheLimitAndHalfOnAverage) {
  const auto built = carried({3, 3});
  ASSERT_TRUE(built);
  EXPECT_NEAR(built->supplies()[0].peak_a, 0.24, 1e-12);
  EXPECT_NEAR(built->supplies()[0].mean_a, 0.1 + 2 * 0.035, 1e-12);
}

TEST_F(Supplies, AnOverloadIsRefusedWithCueTimeAndAmperes) {
  rig.supplies[1].limit_a = 0.2;
  EXPECT_EQ(refused({0, 1, 2, 3}),
            "rig.yaml:8:5: error: supplies[1]: the supply \"P2\" is overloaded in cue 1 \"cue 1\" at 5.000 s (move 1): "
            "0.24 A, and its limit is 0.2 A; so it is at 2 of 4 switches (fewer or darker looks, `overload: dim`, or "
            "nodes on other supplies)");
}

TEST_F(Supplies, AnExactFitIsCarried) {
  rig.supplies[0].limit_a = rig.supplies[1].limit_a = 0.24;
  EXPECT_EQ(refused({0, 1}), "carried");
}

TEST_F(Supplies, WhatMarkersShowByThemselvesIsRefusedEvenWhereLooksAreDimmed) {
  rig.supplies[0].limit_a = 0.11;
  rig.supplies[0].overload = Supply::Overload::dim;
  EXPECT_EQ(
      refused({0, 0}),
      "rig.yaml:7:5: error: supplies[0]: the supply \"P1\" has to give 0.12 A as soon as it is switched on, and its "
      "limit is 0.11 A: 4 lamps that show NO-GUIDANCE by themselves, and 1 nodes (fewer nodes on it; nothing that "
      "a show does changes that)");
}

TEST_F(Supplies, AnOverloadedCueIsDimmedByOneFactorAndTheOthersAreNot) {
  rig.supplies[1].limit_a = 0.17;
  rig.supplies[1].overload = Supply::Overload::dim;
  const auto built = carried({2, 1, 2, 2});
  ASSERT_TRUE(built) << built.error().message;
  const SupplyLoad& load = built->supplies()[1];
  ASSERT_EQ(load.dimmed.size(), 1U);
  EXPECT_EQ(load.dimmed[0].cue, std::optional<std::size_t>(0));
  EXPECT_NEAR(load.dimmed[0].factor, 0.5, 1e-3);
  EXPECT_NEAR(load.dimmed[0].asked_a, 0.24, 1e-12);
  EXPECT_LE(load.peak_a, 0.17 + 1e-9);
  EXPECT_GT(load.peak_a, 0.165);
  const auto look = [&](std::size_t k, std::size_t node) {
    return built->looks()[built->looks_of(k, NodeIndex::of(node))[0]];
  };
  EXPECT_EQ(look(1, 1), (Look{{255, 255, 255}, Effect::steady, 127}));
  EXPECT_EQ(look(2, 1), (Look{{255, 0, 0}, Effect::steady, 51})) << "of the same cue, by the same factor";
  EXPECT_EQ(look(0, 1), looks[2]) << "the opening is another cue";
  EXPECT_EQ(look(3, 1), looks[2]);
  EXPECT_EQ(look(1, 0), looks[1]) << "of another supply";
  EXPECT_EQ(look(1, 2), looks[1]) << "of none";
}

TEST_F(Supplies, ADimmedScheduleKeepsTheNumbersByWhichWaysBackAreLit) {
  rig.supplies[1].limit_a = 0.17;
  rig.supplies[1].overload = Supply::Overload::dim;
  CueSchedule whole = schedule({2, 1, 2, 2});
  whole.set_numbers({{1, 0}, {1, 2}});
  const auto built = within_supplies(std::move(whole), rig, drivers, plays);
  ASSERT_TRUE(built) << built.error().message;
  EXPECT_EQ(built->numbers().pattern, (std::vector<std::uint8_t>{1, 0}));
  ASSERT_EQ(built->numbers().of_entry, (std::vector<LookIndex>{1, 2}));
  EXPECT_EQ(built->looks()[1], looks[1]);
  EXPECT_EQ(built->looks()[2], looks[2]);
}

TEST_F(Supplies, DimmedLampsNeverGetDark) {
  rig.supplies[1].limit_a = 0.126;
  rig.supplies[1].overload = Supply::Overload::dim;
  looks[2] = {{255, 255, 255}, Effect::steady, 20};
  std::vector<LookIndex> row{1, 1};
  const auto built = carried(row);
  ASSERT_TRUE(built) << built.error().message;
  for (std::size_t k = 0; k < 2; ++k) {
    for (std::size_t c = 0; c < 4; ++c) {
      EXPECT_GE(built->looks()[built->looks_of(k, NodeIndex(1))[c]].brightness, 13);
    }
    for (std::size_t c = 4; c < kChannelsPerNode; ++c) EXPECT_EQ(built->looks_of(k, NodeIndex(1))[c], kDark);
  }
  EXPECT_LE(built->supplies()[1].peak_a, 0.126 + 1e-9);
}

TEST_F(Supplies, WhatIsDarkerThanATwentiethStaysAsItIs) {
  rig.supplies[0].limit_a = rig.supplies[1].limit_a = 0.2;
  rig.supplies[0].overload = rig.supplies[1].overload = Supply::Overload::dim;
  const auto built = carried({0, 4, 1, 4});
  ASSERT_TRUE(built) << built.error().message;
  EXPECT_EQ(built->looks()[built->looks_of(1, NodeIndex(0))[0]], looks[4]);
}

TEST_F(Supplies, OnOffLampsCountAsTheyShineAndCannotBeDimmed) {
  auto relays = std::make_unique<FakeDriver>(3, 4, false);
  relays->relays = true;
  drivers[0] = std::move(relays);
  const auto built = carried({2, 2});
  ASSERT_TRUE(built);
  EXPECT_NEAR(built->supplies()[0].peak_a, 0.24, 1e-12) << "red of half brightness is simply on";
  rig.supplies[0].limit_a = 0.2;
  rig.supplies[0].overload = Supply::Overload::dim;
  EXPECT_EQ(
      refused({2, 2}),
      "rig.yaml:7:5: error: supplies[0]: the supply \"P1\" is overloaded in the opening at 0.000 s (move 0): 0.24 "
      "A, and its limit is 0.2 A; so it is at 2 of 2 switches (its lamps cannot be dimmed so far: they go down to "
      "a twentieth, on-off lamps not at all; nodes on other supplies)");
}

TEST_F(Supplies, ARigWithoutListedSuppliesIsNotLookedAt) {
  rig.supplies.clear();
  const auto built = carried({0, 1});
  ASSERT_TRUE(built);
  EXPECT_TRUE(built->supplies().empty());
}

TEST_F(Supplies, DimmedLooksMustFitIntoTheLookTable) {
  looks.resize(1);
  for (int i = 1; i < 254; ++i) looks.push_back({{255, 255, static_cast<std::uint8_t>(i)}, Effect::steady, 255});
  rig.supplies[0].limit_a = 0.2;
  rig.supplies[0].overload = Supply::Overload::dim;
  EXPECT_EQ(refused({1, 2}),
            "rig.yaml: error: supplies: dimmed looks and the show's own are 255 together, and a marker's look table "
            "holds 254 (darker looks from the start, or more supplies that carry them as they are)");
}

TEST_F(Supplies, NodesOfAStaggeredSupplyHaveTheirTurnsInTheOrderOfTheRig) {
  rig.supplies[0].stagger = milliseconds(20);
  rig.nodes[2].supply = "P1";
  const auto turns = switch_on_of(rig);
  ASSERT_EQ(turns.size(), 3U);
  EXPECT_EQ(turns[0].turn, milliseconds(0));
  EXPECT_EQ(turns[1].turn, milliseconds(0)) << "another supply";
  EXPECT_EQ(turns[1].stagger, Duration{});
  EXPECT_EQ(turns[2].turn, milliseconds(20));
  EXPECT_EQ(turns[2].stagger, milliseconds(20));
}

}  // namespace
}  // namespace footlight::controller
