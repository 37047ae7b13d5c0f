// SPDX-License-Identifier: Apache-2.0
#include "config/nearest.hpp"

#include <gtest/gtest.h>

namespace footlight::config {
namespace {

TEST(Nearest, CountsEditsAndTranspositions) {
  EXPECT_EQ(edit_distance("clearance", "clearance"), 0);
  EXPECT_EQ(edit_distance("claerance", "clearance"), 1);
  EXPECT_EQ(edit_distance("clearence", "Clearance"), 1);
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
}

TEST(Nearest, SuggestsOnlyWhatIsNear) {
  const std::vector<std::string> keys{"grid", "blocked", "reserve", "clearance"};
  EXPECT_EQ(suggestion("reserved", keys, "known keys"), "did you mean \"reserve\"?");
  EXPECT_EQ(suggestion("colour", keys, "known keys"), "known keys: grid, blocked, reserve, clearance");
  EXPECT_EQ(suggestion("gridded floor", keys, "known keys"), "did you mean \"grid\"?");
  EXPECT_EQ(suggestion("b", keys, "known keys"), "known keys: grid, blocked, reserve, clearance");
  EXPECT_EQ(suggestion("colour", {}, "known keys"), "");
}

TEST(Nearest, ShortensLongTextBetweenCharacters) {
  EXPECT_EQ(in_quotes("a\nb"), "\"a b\"");
  EXPECT_EQ(in_quotes(std::string(59, 'x') + "ää"), "\"" + std::string(59, 'x') + "...\"");
}

}  // namespace
}  // namespace footlight::config
