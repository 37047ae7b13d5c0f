// SPDX-License-Identifier: Apache-2.0
#include "tests/contracts/preload_run.hpp"

#include <gtest/gtest.h>

namespace footlight::contracts {
namespace {

TEST(PreloadEfficiency, OfRtuIsNinetyPercentOfWhatSilenceAndTurnaroundAllow) {
  for (const int speed : {19'200, 115'200, 1'000'000}) {
    const PreloadRun run = preload_all(BusKind::modbus_rtu, speed, 28);
    EXPECT_EQ(run.receipts, 28) << speed;
    EXPECT_GE(run.efficiency(), 0.9) << speed;
    EXPECT_LE(run.efficiency(), 1.000001) << speed << ": nobody is faster than the wire";
  }
}

TEST(PreloadEfficiency, OfSerialIsNinetyPercentOfWhatTheTurnaroundAllows) {
  for (const int speed : {115'200, 1'000'000}) {
    const PreloadRun run = preload_all(BusKind::serial, speed, 28);
    EXPECT_EQ(run.receipts, 28) << speed;
    EXPECT_GE(run.efficiency(), 0.9) << speed;
    EXPECT_LE(run.efficiency(), 1.000001) << speed;
  }
}

TEST(PreloadEfficiency, OfCanIs95PercentOfTheLineRate) {
  for (const int speed : {125'000, 500'000, 1'000'000}) {
    const PreloadRun run = preload_all(BusKind::can, speed, 126);
    EXPECT_EQ(run.receipts, 126) << speed;
    // On a slow bus the nodes' own heartbeats, one a second each, take a share that is felt: they are frames, too.
    EXPECT_GE(speed < 500'000 ? run.efficiency() : run.of_line_rate(), 0.95) << speed;
    EXPECT_LE(run.efficiency(), 1.000001) << speed << ": nobody is faster than the wire";
  }
}

}  // namespace
}  // namespace footlight::contracts
