// SPDX-License-Identifier: Apache-2.0
#include "controller/node_health.hpp"

#include <gtest/gtest.h>

namespace footlight::controller {
namespace {

std::string verdict(const std::vector<int>& percent) {
  std::vector<NodeHealth> health;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < percent.size(); ++i) {
    NodeHealth& node = health.emplace_back();
    node.asked = 100;
    node.answered = static_cast<std::uint64_t>(percent[i]);
    names.push_back("n" + std::to_string(i + 1));
  }
  return cable_verdict(health, names);
}

TEST(CableVerdict, ToTheEnd) { EXPECT_EQ(verdict({100, 99, 100}), "every node answers, to the end of the cable"); }

TEST(CableVerdict, Nobody) {
  EXPECT_EQ(verdict({0, 0, 0}),
            "nobody answers: look at the adapter, its direction, the two wires (exchanged?) and the supply");
}

TEST(CableVerdict, ABreakLiesBetweenTheLastThatAnswersAndTheFirstThatDoesNot) {
  EXPECT_EQ(verdict({100, 97, 0, 0, 0}),
            "the cable carries as far as n2; from n3 on nobody answers: look at the cable, the connector and the "
            "supply between these two");
}

TEST(CableVerdict, ASilentNodeAmongOthersIsItsOwnAffair) {
  EXPECT_EQ(verdict({100, 0, 100, 0, 100, 0}),
            "silent with neighbours that answer: n2, n4, n6: look at these nodes, their stubs, addresses and supplies; "
            "the cable goes on behind them");
  EXPECT_EQ(verdict({100, 100, 0}),
            "silent with neighbours that answer: n3: look at these nodes, their stubs, addresses and supplies; the "
            "cable goes on behind them")
      << "the last one alone may be the node as well as the cable";
}

TEST(CableVerdict, LossesTowardsTheEndAreTheTermination) {
  EXPECT_EQ(verdict({100, 100, 95, 80, 60}),
            "answers get lost from n3 to the end of the cable: look at the terminating resistors and the bias, then at "
            "the cable from there on");
  EXPECT_EQ(verdict({100, 90, 100}), "answers get lost of n2: look at these nodes and their stubs");
}

TEST(LatencyHistogram, CountsByClassesAndKeepsMeanAndLongest) {
  LatencyHistogram histogram;
  histogram.add(milliseconds(1));
  histogram.add(microseconds(1001));
  histogram.add(milliseconds(500));
  EXPECT_EQ(histogram.counts()[0], 1U);
  EXPECT_EQ(histogram.counts()[1], 1U);
  EXPECT_EQ(histogram.counts().back(), 1U);
  EXPECT_EQ(histogram.total(), 3U);
  EXPECT_EQ(histogram.longest(), milliseconds(500));
  EXPECT_EQ(histogram.mean(), (milliseconds(501) + microseconds(1001)) / 3);
}

}  // namespace
}  // namespace footlight::controller
