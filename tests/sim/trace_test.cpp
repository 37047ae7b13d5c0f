// SPDX-License-Identifier: Apache-2.0
#include "sim/trace.hpp"

#include <array>
#include <sstream>

#include <gtest/gtest.h>

namespace footlight::sim {
namespace {

TEST(Trace, ALineHasTimeBusDirectionBytesAndNote) {
  std::ostringstream out;
  Trace trace(&out);
  trace.line(Instant(Duration(1'234'567)), "left", '>', "0A0B", "lost by n7");
  trace.line(Instant(Duration(5)), "left", '*', "", "n7 holds");
  trace.line(Instant(Duration(-1)), "left", '<', "FF", "");
  trace.line(Instant(Duration(-1'500)), "left", '<', "FF", "");
  EXPECT_EQ(out.str(),
            "1234.567 left > 0A0B lost by n7\n"
            "0.005 left * - n7 holds\n"
            "-0.001 left < FF\n"
            "-1.500 left < FF\n");
}

TEST(Trace, BytesAreTwoDigitsEach) {
  const std::array<std::uint8_t, 3> bytes{0x00, 0xA5, 0x0F};
  EXPECT_EQ(to_hex(bytes), "00A50F");
}

}  // namespace
}  // namespace footlight::sim
