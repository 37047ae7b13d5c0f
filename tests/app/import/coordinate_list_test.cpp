// SPDX-License-Identifier: Apache-2.0
#include "app/import/coordinate_list.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/rng.hpp"
#include "tests/support/full.hpp"
#include "tests/support/mutated.hpp"

namespace footlight::app {
namespace {

using ::testing::ElementsAre;

constexpr double kStep = 0.5715;
const std::string kHeader = "Symbol,Label,Set,Measure,Counts,Side 1-Side 2,Front-Back\n";

Imported read(const std::string& text, const ListChoice& choice = {}) {
  auto out = read_coordinate_lists({{"list.csv", text}}, choice);
  EXPECT_TRUE(out) << out.error();
  return *std::move(out);
}
std::string error_of(const std::string& text) {
  return read_coordinate_lists({{"list.csv", text}}, {}).error().message;
}

TEST(CoordinateList, PeopleTimesSetsAsDrillProgramsListThem) {
  const Imported list = read(kHeader +
                             "T,10,1,0,0,Side 1: 2.5 steps outside 40 yd ln,8.0 steps behind Front Hash (HS)\n"
                             "T,10,1A,1-2,8,On 50 yd ln,On Front side line\n"
                             "T,10,2,3-6,16,Side 2: On 45 yd ln,On Back Hash (HS)\n"
                             "T,2,1,0,0,Side 2: On 40 yd ln,On Front Hash (HS)\n"
                             "T,2,1A,1-2,8,Side 2: On 40 yd ln,On Front Hash (HS)\n"
                             "T,2,2,3-6,16,Side 2: On 35 yd ln,On Front Hash (HS)\n");
  ASSERT_EQ(list.people.size(), 2U);
  EXPECT_EQ(list.people[0].name, "T2") << "natural order: T2 before T10";
  EXPECT_EQ(list.people[1].name, "T10");
  ASSERT_EQ(list.formations.size(), 3U);
  EXPECT_EQ(list.formations[1].name, "set 1A");
  EXPECT_EQ(list.formations[0].count, 1);
  EXPECT_EQ(list.formations[1].count, 9);
  EXPECT_EQ(list.formations[2].count, 25);
  EXPECT_EQ(list.formations[0].places[1].at, (Point{-18.5 * kStep, 36 * kStep}));
  EXPECT_EQ(list.formations[2].places[0].at, (Point{24 * kStep, 28 * kStep}));
  EXPECT_EQ(list.position(list.formations[0].places[0]), (Position{"list.csv", 5, 11}));
  EXPECT_THAT(list.ignored, ElementsAre("the column \"Measure\""));
}

TEST(CoordinateList, PlainNumbersInAnyUnit) {
  EXPECT_EQ(read("name,x_m,y_m,z_m,R,G,B\nD1,1.5,2,0,255,0,0\n").formations[0].places[0].at, (Point{1.5, 2}));
  EXPECT_EQ(read("name,x,y\nD1,1.5,2\n", {{}, 0.3048}).formations[0].places[0].at, (Point{1.5 * 0.3048, 2 * 0.3048}));
  EXPECT_EQ(read("name,set,count,X Steps,Y Steps\nD1,1,1,2,4\nD1,2,17,0,0\n").formations[1].count, 17);
}

TEST(CoordinateList, OneFileForEachPerformer) {
  const auto list = read_coordinate_lists(
      {{"out/D10.csv", "set,counts,x,y\n1,0,0,0\n2,8,1,0\n"}, {"out/D2.csv", "set,counts,x,y\n1,0,1,1\n2,8,2,1\n"}},
      {});
  ASSERT_TRUE(list) << list.error();
  EXPECT_EQ(list->people[0].name, "D2");
  EXPECT_EQ(list->formations[1].places[0].at, (Point{2, 1}));
  EXPECT_EQ(list->position(list->formations[1].places[0]).file, "out/D2.csv");
}

TEST(CoordinateList, WordsThatCannotBeUnderstoodAreToldWithTheirPlace) {
  EXPECT_EQ(
      error_of("Label,Set,Counts,Side to Side,Front to Back\n"
               "1,1,0,2 steps outside 40 yd ln,On Front Hash (HS)\n"
               "2,1,0,Side 1: on 41 yd ln,Behind Front Hash (HS)\n"),
      "list.csv:2:7: error: no side is told (Side 1 or Side 2, unless on the 50 yard line)\n"
      "list.csv:3:18: error: 41 is no yard line (0, 5, 10 .. 50)\n"
      "list.csv:3:27: error: \"behind\" stands where a number of steps, or \"on\", belongs (for example: 8.0 steps "
      "behind Front Hash (HS))");
}

TEST(CoordinateList, WhatDoesNotFitTogetherIsTold) {
  EXPECT_EQ(error_of("name,set,counts,x,y\na,1,0,0,0\na,2,8,1,0\nb,1,0,0,1\n"),
            "list.csv:4:7: error: performer b has 1 sets, a has 2 (everybody has the same sets in the same order)");
  EXPECT_EQ(
      error_of("name,set,counts,x,y\na,1,0,0,0\na,2,8,1,0\nb,1,0,0,1\nb,2,16,0,1\n"),
      "list.csv:5:5: error: 16 counts for performer b, 8 for a (line 3) (a set has the same counts for everybody)");
  EXPECT_EQ(
      error_of("name,set,counts,x,y\na,1,0,0,0\na,2,8,1,0\nb,2,0,0,1\nb,1,8,0,1\n"),
      "list.csv:4:7: error: performer b has set \"2\" where a has set \"1\" (everybody has the same sets in the same "
      "order)");
  EXPECT_EQ(error_of("name,set,counts,x,y\na,1,0,0,0\na,1,8,1,0\n"),
            "list.csv:3:7: error: performer a is in set \"1\" for the second time (one row for each person and set)");
  EXPECT_EQ(
      error_of("name,set,count,x,y\na,1,9,0,0\na,2,9,1,0\n"),
      "list.csv:3:7: error: set 2 is at count 9, no later than the set before (sets stand in the order in which they "
      "are walked)");
  EXPECT_EQ(
      error_of("name,set,x,y\na,1,0,0\n"),
      "list.csv:1:1: error: no column says when the sets are (counts: of the walk into the set; count: of the show, "
      "from 1)");
  EXPECT_EQ(error_of("name,x\na,1\n"),
            "list.csv:1:1: error: the place of a performer is \"side to side\" and \"front-back\", or x and y "
            "(Set,Counts,Side 1-Side 2,Front-Back or set,counts,x_m,y_m)");
  EXPECT_EQ(error_of("name,x,y\n,1,1\n"), "list.csv:2:1: error: nobody is named (a name or label in every row)");
  EXPECT_EQ(error_of("name,x,y\na,1,inf\n"),
            "list.csv:2:5: error: \"inf\" is no number of this column (a decimal number)");
  EXPECT_EQ(error_of("name,x,y\n"), "list.csv: error: no row says where anybody is (one row for each person and set)");
}

TEST(CoordinateList, MutationsAreSurvived) {
  const std::string whole = kHeader +
                            "T,10,1,0,0,Side 1: 2.5 steps outside 40 yd ln,8.0 steps behind Front Hash (HS)\n"
                            "T,10,2,1-2,8,On 50 yd ln,On Front side line\n"
                            "T,2,1,0,0,Side 2: On 40 yd ln,On Front Hash (HS)\n"
                            "T,2,2,1-2,8,Side 2: On 40 yd ln,On Front Hash (HS)\n";
  for (std::uint64_t seed = 0; seed < test::tries<std::uint64_t>(1'500, 100'000); ++seed) {
    const auto list =
        read_coordinate_lists({{"list.csv", test::mutated(whole, Rng(seed), ",\"\n#:;0159.-e \xC3")}}, {});
    if (!list) {
      EXPECT_TRUE(list.error().message.starts_with("list.csv")) << list.error();
    }
  }
}

}  // namespace
}  // namespace footlight::app
