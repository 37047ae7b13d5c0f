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

}  // namespace
}  // namespace footlight::contracts
