// SPDX-License-Identifier: Apache-2.0
#include "app/commission/flash_sequence.hpp"

#include <gtest/gtest.h>

#include "app/commission/floor_lights.hpp"
#include "tests/app/commission/filmed_floor.hpp"
#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

const Grid kGrid = Grid::make(GridKind::square, 12, 8, 1).value();

TEST(FlashSequence, EveryLampShinesInABitOrItsComplement) {
  const FlashSequence sequence(LampCode(96, 3));
  for (std::size_t p = 0; p < sequence.parts().size(); ++p) {
    const FlashPart& part = sequence.parts()[p];
    if (part.kind != FlashPart::Kind::bit || part.complement) continue;
    EXPECT_EQ(sequence.parts()[p + 1].bit, part.bit);
    for (std::size_t lamp = 0; lamp < 96; ++lamp) {
      EXPECT_NE(sequence.lit(p, lamp), sequence.lit(p + 1, lamp));
      EXPECT_EQ(sequence.lit(p, lamp), sequence.code().bit(lamp, part.bit));
    }
  }
}

TEST(FlashSequence, ItsPartsFollowWithoutGaps) {
  const FlashSequence sequence(LampCode(96, 3));
  int at = 0;
  for (const FlashPart& part : sequence.parts()) {
    EXPECT_EQ(part.begins, at);
    at += part.steps;
  }
  EXPECT_EQ(at, sequence.steps());
  EXPECT_EQ(sequence.parts().front().kind, FlashPart::Kind::dark);
  EXPECT_EQ(sequence.parts().back().kind, FlashPart::Kind::dark);
}

TEST(FlashSequence, OnTheBusesEveryLampShowsItsWordInTime) {
  for (const BusKind kind : {BusKind::can, BusKind::serial, BusKind::modbus_rtu, BusKind::modbus_tcp}) {
    const Rig rig = tests::lamps_everywhere(kGrid, {kind, kind}, 115'200, 8);
    const tests::FilmedFloor floor(rig, kGrid, tests::cells_of(rig));
    const FlashSequence& sequence = floor.sequence();
    int wrong = 0;
    for (std::size_t p = 0; p < sequence.parts().size(); ++p) {
      const FlashPart& part = sequence.parts()[p];
      for (const double share : {0.1, 0.5, 0.9}) {
        const double at = (part.begins + share * part.steps) * floor.step_s();
        for (std::size_t lamp = 0; lamp < floor.lamps().size(); ++lamp) {
          wrong += (floor.lit(lamp, at) > 0) == sequence.lit(p, lamp) || p + 1 == sequence.parts().size() ? 0 : 1;
        }
      }
    }
    EXPECT_EQ(wrong, 0) << to_text(kind);
  }
}

TEST(ShortestStep, GrowsWithTheNodesOfABusAndIsNeverBelowFilms) {
  const auto step = [](int columns, int bits_per_second) {
    const Grid grid = Grid::make(GridKind::square, columns, 8, 1).value();
    const Rig rig = tests::lamps_everywhere(grid, {BusKind::serial}, bits_per_second, 32);
    const auto lights = FloorLights::open(rig, {.simulated = true, .faults = {}, .seed = 1}, nullptr);
    return shortest_step(rig, (*lights)->drivers());
  };
  EXPECT_EQ(step(12, 115'200), milliseconds(400));
  EXPECT_GT(step(96, 19'200), milliseconds(800));
}

TEST(LampWhite, IsNoBrighterThanTheSuppliesBear) {
  Rig rig = tests::lamps_everywhere(kGrid, {BusKind::can}, 115'200, 32);
  EXPECT_EQ(lamp_white(rig).brightness, 255);
  rig.currents = {0.02, 0.02, 0.02, 0.04};
  Supply supply;
  supply.name = "P1";
  supply.limit_a = 3;
  rig.supplies.push_back(supply);
  for (Node& node : rig.nodes) node.supply = "P1";
  const Look white = lamp_white(rig);
  EXPECT_LT(white.brightness, 255);
  EXPECT_LE(96 * 0.06 * white.brightness / 255 + 3 * 0.04, 3);
  EXPECT_GT(96 * 0.06 * (white.brightness + 1) / 255 + 3 * 0.04, 3);
}

}  // namespace
}  // namespace footlight::app
