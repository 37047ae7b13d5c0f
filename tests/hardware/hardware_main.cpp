// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <cstdlib>

#include <gtest/gtest.h>

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  // It takes interfaces up and down and devices out: nobody's own machine is to be treated so.
  if (std::getenv("FOOTLIGHT_GUEST") == nullptr && !::testing::GTEST_FLAG(list_tests)) {
    std::fputs("error: this program runs in its guest alone (scripts/test-hardware)\n", stderr);
    return 2;
  }
  return RUN_ALL_TESTS();
}
