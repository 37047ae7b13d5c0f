// SPDX-License-Identifier: Apache-2.0
#include "app/edit/told_list.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace footlight::app {
namespace {

using testing::ElementsAre;

TEST(ToldList, WhoWasNotTickedIsThereInTheNextRunOfTheShow) {
  const test::TemporaryFolder folder;
  {
    ToldList list(folder.path(), "show.yaml");
    EXPECT_EQ(list.size(), 0U);
    EXPECT_TRUE(list.add({"10", "9", "zoe"}));
    EXPECT_TRUE(list.add({"9", "1"}));
    EXPECT_TRUE(list.tick("10"));
    EXPECT_THAT(*list.people(), ElementsAre("1", "9", "zoe"));
  }
  ToldList list(folder.path(), "show.yaml");
  EXPECT_THAT(*list.people(), ElementsAre("1", "9", "zoe"));
  EXPECT_EQ(ToldList(folder.path(), "another.yaml").size(), 0U) << "people of another show";
  EXPECT_TRUE(list.tick_all());
  EXPECT_EQ(ToldList(folder.path(), "show.yaml").size(), 0U);
}

TEST(ToldList, AFileThatIsNoneIsAnEmptyList) {
  const test::TemporaryFolder folder;
  for (const char* text : {"", "[1,2", "{\"show\": 3}", "{\"untold\": [\"1\"]}", "null"}) {
    folder.write("untold.json", text);
    EXPECT_EQ(ToldList(folder.path(), "show.yaml").size(), 0U) << text;
  }
}

TEST(ToldList, WhatCannotBeWrittenIsKeptAllTheSame) {
  ToldList list("/nowhere/at/all", "show.yaml");
  EXPECT_FALSE(list.add({"1"}));
  EXPECT_THAT(*list.people(), ElementsAre("1"));
}

}  // namespace
}  // namespace footlight::app
