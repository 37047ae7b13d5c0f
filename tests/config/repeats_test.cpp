// SPDX-License-Identifier: Apache-2.0
#include "config/repeats.hpp"

#include <gtest/gtest.h>

namespace footlight::config {
namespace {

/// Measures as "a", with "|:a", "a:|", "a:3|" (three times), "[1a" for an ending and "a]" for its end; "[1,2a" for
/// both.
std::string played(const std::vector<std::string>& written) {
  std::vector<MeasureTurn> turns;
  std::string names;
  for (std::string text : written) {
    MeasureTurn turn;
    if (text.starts_with("|:")) {
      turn.forward = true;
      text.erase(0, 2);
    }
    if (text.starts_with("[")) {
      std::size_t i = 1;
      for (; text[i] == ',' || (text[i] >= '0' && text[i] <= '9'); ++i) {
        if (text[i] != ',') turn.ending_start |= std::uint64_t{1} << static_cast<unsigned>(text[i] - '0');
      }
      text.erase(0, i);
    }
    names += text.front();
    turn.ending_stop = text.ends_with("]");
    if (turn.ending_stop) text.pop_back();
    if (text.ends_with("|")) {
      turn.backward = true;
      if (text.size() == 4) turn.times = text[2] - '0';
    }
    turns.push_back(turn);
  }
  const auto order = played_order(turns);
  EXPECT_TRUE(order);
  std::string out;
  for (const std::size_t i : *order) out += names[i];
  return out;
}

TEST(PlayedOrder, WithoutRepeatsIsAsWritten) { EXPECT_EQ(played({"a", "b", "c"}), "abc"); }

TEST(PlayedOrder, RepeatsFromTheBeginningOrTheLastBeginningOfARepeat) {
  EXPECT_EQ(played({"a", "b:|", "c"}), "ababc");
  EXPECT_EQ(played({"a", "|:b", "c:|", "d"}), "abcbcd");
  EXPECT_EQ(played({"|:a:|", "|:b:|", "c:|"}), "aabbcc");
  EXPECT_EQ(played({"a", "|:b:3|", "c"}), "abbbc");
}

TEST(PlayedOrder, TakesTheEndingOfEachTime) {
  EXPECT_EQ(played({"a", "[1b:|]", "[2c]", "d"}), "abacd");
  EXPECT_EQ(played({"|:a", "[1,2b:|]", "[3c]", "d"}), "ababacd");
  EXPECT_EQ(played({"|:a", "[1b", "c:|]", "[2d", "e]", "f", "|:g:|"}), "abcadefgg");
  EXPECT_EQ(played({"|:a", "[1b:|]", "[2c:|]", "[3d]", "e"}), "abacade");
}

TEST(PlayedOrder, IsBounded) {
  std::vector<MeasureTurn> turns(10'000);
  turns.back().backward = true;
  turns.back().times = 32;
  EXPECT_EQ(played_order(turns).error(), input_error("repeats make more than 100000 measures"));
}

}  // namespace
}  // namespace footlight::config
