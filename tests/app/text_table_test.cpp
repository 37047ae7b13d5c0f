// SPDX-License-Identifier: Apache-2.0
#include "app/text_table.hpp"

#include <gtest/gtest.h>

namespace footlight::app {
namespace {

TEST(TextTable, AlignsTheFirstColumnLeftAndTheOthersRight) {
  TextTable table({"section", "m"});
  table.add({"a", "12"});
  table.add({"a long name", "3"});
  EXPECT_EQ(table.to_text(),
            "section       m\n"
            "a            12\n"
            "a long name   3\n");
}

TEST(TextTable, CountsCharactersNotBytes) {
  TextTable table({"n", "m"});
  table.add({"\xC3\xA9t\xC3\xA9", "1"});
  table.add({"abc", "2"});
  EXPECT_EQ(table.to_text(), "n    m\n\xC3\xA9t\xC3\xA9  1\nabc  2\n");
}

TEST(TextTable, LeavesNoBlanksAtTheEndsOfLines) {
  TextTable table({"section", "counts"});
  table.add({"show", ""});
  EXPECT_EQ(table.to_text(), "section  counts\nshow\n");
}

}  // namespace
}  // namespace footlight::app
