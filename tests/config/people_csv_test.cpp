// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "config/show_file.hpp"
#include "tests/config/show_folder.hpp"

namespace footlight::config {
namespace {

constexpr const char* kShow =
    "footlight: 1\n"
    "title: t\n"
    "stage: {grid: {columns: 4, rows: 3}, blocked: [D3]}\n"
    "performers: {from: roster.csv}\n"
    "sections: [{name: a, from: {cells: a.csv}, start: count 1}]\n";

class PeopleCsv : public testing::Test {
 protected:
  Result<LoadedShow, Diagnostics> load(const std::string& roster, const std::string& cells, const std::string& show) {
    folder_.write("roster.csv", roster);
    folder_.write("a.csv", cells);
    folder_.write("show.yaml", show);
    return load_show(folder_.path("show.yaml"));
  }
  Show loaded(const std::string& roster, const std::string& cells, const std::string& show = kShow) {
    const auto result = load(roster, cells, show);
    EXPECT_TRUE(result) << (result ? "" : result.error().to_text());
    return result ? result.value().show : Show();
  }
  std::string errors(const std::string& roster, const std::string& cells, const std::string& show = kShow) {
    const auto result = load(roster, cells, show);
    EXPECT_FALSE(result);
    return result ? "" : folder_.without_folder(result.error().to_text());
  }
  ShowFolder folder_;
};

TEST_F(PeopleCsv, ReadsARoster) {
  const Show show = loaded(
      "# who is in it\r\n"
      "id,name,call_name,group,cast,cover,radius,speed,wearable\r\n"
      "amy,\"Pond, Amelia \"\"Amy\"\"\",,left,A,rory,,,W1\r\n"
      "\r\n"
      " rory ,Rory Williams,Rory,right,A,,60 cm,0.9 m/s,\r\n"
      "river,,,left,B,,,,W2\r\n",
      "performer,cell\namy,A1\nriver,c2\nrory,B1\n");
  ASSERT_EQ(show.performers.size(), 3U);
  EXPECT_EQ(show.performers[0].name, "Pond, Amelia \"Amy\"");
  EXPECT_EQ(show.performers[0].wearable, "W1");
  EXPECT_EQ(show.performers[1].id, "rory");
  EXPECT_EQ(show.performers[1].name, "Rory");
  EXPECT_DOUBLE_EQ(show.performers[1].radius_m, 0.6);
  EXPECT_DOUBLE_EQ(show.performers[1].max_speed_mps, 0.9);
  EXPECT_EQ(show.performers[2].name, "river");
  ASSERT_EQ(show.groups.size(), 2U);
  EXPECT_EQ(show.groups[1].name, "right");
  EXPECT_NE(show.groups[0].colour, show.groups[1].colour);
  EXPECT_EQ(show.performers[2].group, GroupIndex(0));
  const auto& source = std::get<CellsSource>(show.sections[0].from);
  EXPECT_EQ(source.cells, (std::vector<CellIndex>{CellIndex(0), CellIndex(1), CellIndex(6)}));
  EXPECT_TRUE(source.assigned);
}

TEST_F(PeopleCsv, TakesCellsWithoutNamesForThePlannerToDealOut) {
  const Show show = loaded("id\na\nb\n", "col,row\n3,1\n0,0\n");
  const auto& source = std::get<CellsSource>(show.sections[0].from);
  EXPECT_FALSE(source.assigned);
  EXPECT_EQ(source.cells, (std::vector<CellIndex>{CellIndex(7), CellIndex(0)}));
  EXPECT_EQ(errors("id\na\nb\n", "col,row\n3,1\n"),
            "a.csv: error: 1 cells for 2 performers (one row for every performer)\n");
  EXPECT_EQ(errors("id\na\nb\n", "col,row\n3,1\n3,1\n0,0\n"),
            "a.csv: error: 3 cells for 2 performers (one row for every performer)\n"
            "a.csv:3:1: error: the cell D2 stands here for the second time (first in line 2)\n");
}

TEST_F(PeopleCsv, SaysWithLineAndColumnWhatIsWrongWithCells) {
  EXPECT_EQ(errors("id\na\nb\nc\nd\ne\nf\n",
                   "performer, col, row\n"
                   "a,0,0\n"
                   "a,1,0\n"
                   "b,0,0\n"
                   "c, 3, 2\n"
                   "d,4,0\n"
                   "x,1,1\n"
                   "e,1.5,1\n"
                   "f,1\n"),
            "a.csv: error: performer f has no cell (one row for every performer)\n"
            "a.csv:3:1: error: performer a stands here for the second time (first in line 2)\n"
            "a.csv:4:3: error: performers a and b both stand on A1 (first in line 2)\n"
            "a.csv:5:4: error: the cell D3 is blocked (nobody can stand on a blocked cell)\n"
            "a.csv:6:3: error: column 4, row 0 is off the grid (columns 0 to 3, rows 0 to 2)\n"
            "a.csv:7:1: error: no performer has the id \"x\" (ids run from a to f)\n"
            "a.csv:8:3: error: \"1.5\" is not a whole number (columns and rows count from 0)\n"
            "a.csv:9:1: error: 2 fields (as many as the header has: 3)\n");
  EXPECT_EQ(errors("id\na\n", "performer,cell\na,E9\n"), "a.csv:2:3: error: the cell E9 is off the grid (A1 to D3)\n");
  EXPECT_EQ(errors("id\na\n", "performer,cell\na,1A\n"),
            "a.csv:2:3: error: \"1A\" is not a cell (write for example A1)\n");
}

TEST_F(PeopleCsv, SaysWhatIsWrongWithAHeader) {
  EXPECT_EQ(errors("id\na\n", "performer,colum,row\na,1,1\n"),
            "a.csv:1:1: error: the place of a performer is one column \"cell\" or the two columns \"col\" and \"row\" "
            "(performer,col,row with numbers from 0, or performer,cell with names as A1)\n"
            "a.csv:1:11: error: unknown column \"colum\" (did you mean \"col\"?)\n");
  EXPECT_EQ(errors("name,name\na,b\n", "performer,col,row\n"),
            "roster.csv:1:1: error: the column \"id\" is missing (only id is needed: id,name,group ...)\n"
            "roster.csv:1:6: error: the column \"name\" stands here for the second time (keep one of the two)\n");
  EXPECT_EQ(
      errors("", "performer,col,row\n"),
      "roster.csv: error: the file is empty (it begins with a header of: id, name, call_name, group, cast, cover, "
      "radius, speed, agility, reaction, wearable)\n");
  EXPECT_EQ(errors("id\n", "performer,col,row\n"),
            "roster.csv: error: nobody is in the roster (one row for every performer)\n");
}

TEST_F(PeopleCsv, SaysWhatIsWrongWithARoster) {
  EXPECT_EQ(errors("id,radius,speed,wearable\n"
                   "ä,0.4,,W1\n"
                   "ä,,,\n"
                   ",,,\n"
                   "b,,30 m/s,W1\n",
                   "performer,col,row\nä,0,0\nb,1,0\n"),
            "roster.csv:2:3: error: \"0.4\" has no unit (write for example \"0.5 m\"; units: m, cm, mm, ft, in)\n"
            "roster.csv:3:1: error: the id \"ä\" stands here for the second time (first in line 2)\n"
            "roster.csv:4:1: error: the id is empty (every performer has an id of her own)\n"
            "roster.csv:5:4: error: \"30 m/s\" is out of range (above 0, at most 20 m/s)\n"
            "roster.csv:5:11: error: the wearable \"W1\" stands here for the second time (first in line 2)\n");
}

TEST_F(PeopleCsv, PeopleStepAsideAndReactEachInHerOwnWay) {
  const Show read =
      loaded("id,agility,reaction\na,1.5,200 ms\nb,0,0 s\nc,,\n", "performer,col,row\na,0,0\nb,1,0\nc,2,0\n");
  EXPECT_EQ(read.performers[0].agility, 1.5);
  EXPECT_EQ(read.performers[0].reaction_s, 0.2);
  EXPECT_EQ(read.performers[1].agility, 0.0);
  EXPECT_EQ(read.performers[1].reaction_s, 0.0);
  EXPECT_EQ(read.performers[2].agility, std::nullopt);
  EXPECT_EQ(read.performers[2].reaction_s, std::nullopt);
}

TEST_F(PeopleCsv, SaysWhatIsWrongWithAgilityAndReaction) {
  EXPECT_EQ(errors("id,agility,reaction\na,quick,0.2\nb,4.1,11 s\nc,-1,\n", "performer,col,row\na,0,0\nb,1,0\nc,2,0\n"),
            "roster.csv:2:3: error: \"quick\" is not a number (0 to 4)\n"
            "roster.csv:2:9: error: \"0.2\" has no unit (write for example \"3.2 s\"; units: s, ms, min)\n"
            "roster.csv:3:3: error: \"4.1\" is out of range (0 to 4)\n"
            "roster.csv:3:7: error: \"11 s\" is out of range (0 to 10 s)\n"
            "roster.csv:4:3: error: \"-1\" is out of range (0 to 4)\n");
}

TEST_F(PeopleCsv, WantsTheGroupsOfTheShowFileWhereThereAreAny) {
  const std::string show =
      "footlight: 1\ntitle: t\nstage: {grid: {columns: 4, rows: 3}}\n"
      "performers: {from: roster.csv, groups: [{name: left, colour: \"#112233\"}]}\n"
      "sections: [{name: a, from: {cells: a.csv}, start: count 1}]\n";
  EXPECT_EQ(errors("id,group\na,left\nb,lft\n", "performer,col,row\na,0,0\nb,1,0\n", show),
            "roster.csv:3:3: error: no group has the name \"lft\" (did you mean \"left\"?)\n");
}

TEST_F(PeopleCsv, RowsThatAreWrongInTheSameWayAreToldOnce) {
  std::string roster = "id,radius\n";
  std::string cells = "performer,cell\n";
  for (int i = 1; i <= 400; ++i) {
    roster += std::to_string(i) + "," + (i == 200 ? "99 m" : "0." + std::to_string(i)) + "\n";
    cells += std::to_string(i) + ",Z" + std::to_string(i) + "\n";
  }
  EXPECT_EQ(errors(roster, cells),
            "a.csv:2:3: error: the cell Z1 is off the grid (A1 to D3)\n"
            "a.csv:3:3: error: the cell Z2 is off the grid (A1 to D3)\n"
            "a.csv:4:3: error: the cell Z3 is off the grid (A1 to D3)\n"
            "a.csv:5:3: error: and 397 more like this: the cell Z4 is off the grid; the last in line 401 (A1 to D3)\n"
            "roster.csv:2:3: error: \"0.1\" has no unit (write for example \"0.5 m\"; units: m, cm, mm, ft, in)\n"
            "roster.csv:3:3: error: \"0.2\" has no unit (write for example \"0.5 m\"; units: m, cm, mm, ft, in)\n"
            "roster.csv:4:3: error: \"0.3\" has no unit (write for example \"0.5 m\"; units: m, cm, mm, ft, in)\n"
            "roster.csv:5:3: error: and 396 more like this: \"0.4\" has no unit; the last in line 401 (write for "
            "example \"0.5 m\"; units: m, cm, mm, ft, in)\n"
            "roster.csv:201:5: error: \"99 m\" is out of range (above 0, at most 10 m)\n"
            "show.yaml:4:20: error: performers.from: 400 performers and only 11 cells that are not blocked (a larger "
            "grid, or fewer people)\n");
}

TEST_F(PeopleCsv, RefusesWhatIsNoText) {
  EXPECT_EQ(errors(std::string("id\na\0\n", 6), "performer,col,row\n"),
            "roster.csv:2:2: error: a NUL byte (a CSV file is UTF-8 text)\n");
  EXPECT_EQ(errors("id\n\"a\n", "performer,col,row\n"),
            "roster.csv:2:1: error: this quote does not end where the field ends (double the quotes inside of a "
            "field)\n");
}

}  // namespace
}  // namespace footlight::config
