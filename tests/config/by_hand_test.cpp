// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "config/show_file.hpp"
#include "tests/config/show_folder.hpp"

namespace footlight::config {
namespace {

/// Lines 1 to 4; what is asked follows from line 5 on.
constexpr std::string_view kHead =
    "footlight: 1\n"
    "title: t\n"
    "stage: {grid: {columns: 6, rows: 4}, blocked: [F4], reserve: [A1:A4]}\n"
    "performers: {count: 5, groups: [{name: odd, members: [1, 3, 5], colour: \"#FFFFFF\", max_speed: 0.9 m/s}, "
    "{name: even, members: [2], colour: \"#FF0000\", exchange: false}]}\n";

class ByHand : public testing::Test {
 protected:
  void SetUp() override {
    folder_.write("film.mp4", "x");
    folder_.write("a.csv", "group,cell\nodd,A1\nodd,A2\nodd,A3\neven,B1\n,B2\n");
  }
  Result<LoadedShow, Diagnostics> load(std::string_view more) {
    folder_.write("show.yaml", std::string(kHead) + std::string(more));
    return load_show(folder_.path("show.yaml"));
  }
  static std::string film(const std::string& rest) {
    return "sections:\n  - {name: s, from: {video: film.mp4}, start: count 9, duration: 16 counts, " + rest + "}\n";
  }
  Show show(const std::string& more) {
    const auto result = load(more);
    EXPECT_TRUE(result) << (result ? "" : result.error().to_text());
    return result ? result->show : Show();
  }
  std::string errors(const std::string& more) {
    const auto result = load(more);
    EXPECT_FALSE(result);
    return result ? "" : folder_.without_folder(result.error().to_text());
  }

  ShowFolder folder_;
};

TEST_F(ByHand, KeysAreCountsOrTimesOfTheVideo) {
  const Section section = show(film("keys: [count 9, count 17.5, 2400 ms]")).sections.at(0);
  ASSERT_EQ(section.keys.size(), 3U);
  EXPECT_EQ(section.keys[0].count, 9);
  EXPECT_EQ(section.keys[1].count, 17.5);
  EXPECT_EQ(section.keys[2].count, std::nullopt);
  EXPECT_EQ(section.keys[2].film_s, 2.4);
}

TEST_F(ByHand, KeysThatAreNoneAreReportedEach) {
  EXPECT_EQ(errors(film("keys: [17, count 8, count 26, count x, -1 s, 2 s, 2000 ms]")),
            "show.yaml:6:84: error: sections[0].keys[0]: \"17\" is neither a count nor a time of the video (write for "
            "example count 17, or 2.4 s: seconds of the video's file)\n"
            "show.yaml:6:88: error: sections[0].keys[1]: \"count 8\" is outside of the section (its video runs from "
            "count 9 to count 25)\n"
            "show.yaml:6:97: error: sections[0].keys[2]: \"count 26\" is outside of the section (its video runs from "
            "count 9 to count 25)\n"
            "show.yaml:6:107: error: sections[0].keys[3]: \"count x\" is not a count of the music (write for example "
            "\"count 233\"; the music begins at count 1)\n"
            "show.yaml:6:116: error: sections[0].keys[4]: \"-1 s\" is before the video begins (0 s is its first "
            "frame)\n"
            "show.yaml:6:127: error: sections[0].keys[6]: \"2000 ms\" stands here for the second time (once will "
            "do)\n");
}

TEST_F(ByHand, OnlyAVideoHasKeys) {
  EXPECT_EQ(errors("sections: [{name: s, from: {cells: a.csv}, start: count 1, keys: [count 1], overrides: [{at: count "
                   "1}]}]\n"),
            "show.yaml:5:60: error: sections[0].keys: the key has no meaning here (only a video has key formations)\n"
            "show.yaml:5:77: error: sections[0].overrides: the key has no meaning here (write it into the CSV file)\n");
}

TEST_F(ByHand, OverridesMoveAddRemoveAndPin) {
  const Section section =
      show(film("overrides: [{at: count 17, move: [B2 -> C2, B3->C3], add: D1, remove: [E1], pin: [2 -> C2]}, "
                "{formation: 3, add: [C1]}]"))
          .sections.at(0);
  ASSERT_EQ(section.overrides.size(), 2U);
  const Override& first = section.overrides[0];
  EXPECT_EQ(first.count, 17);
  ASSERT_EQ(first.move.size(), 2U);
  EXPECT_EQ(first.move[1].from.value(), 13U);
  EXPECT_EQ(first.move[1].to.value(), 14U);
  EXPECT_EQ(first.add.at(0).cell.value(), 3U);
  EXPECT_EQ(first.remove.at(0).cell.value(), 4U);
  EXPECT_EQ(first.pin.at(0).performer.value(), 1U);
  EXPECT_EQ(first.pin.at(0).cell.value(), 8U);
  EXPECT_EQ(section.overrides[1].count, std::nullopt);
  EXPECT_EQ(section.overrides[1].number, 3);
}

TEST_F(ByHand, OverridesThatCannotBeReadAreReportedEach) {
  EXPECT_EQ(
      errors(film("overrides: [{move: [B2, G1 -> C2, 7 -> A1], add: F4, pin: [9 -> C2]}, {at: count 9, formation: "
                  "0}]")),
      "show.yaml:6:89: error: sections[0].overrides[0]: one of the keys at, formation is missing (give exactly "
      "one of them)\n"
      "show.yaml:6:97: error: sections[0].overrides[0].move[0]: \"B2\" has no arrow (write for example B4 -> "
      "C4)\n"
      "show.yaml:6:101: error: sections[0].overrides[0].move[1]: the cell G1 is off the grid (A1 to F4)\n"
      "show.yaml:6:111: error: sections[0].overrides[0].move[2]: \"7\" is not a cell (write for example A1)\n"
      "show.yaml:6:126: error: sections[0].overrides[0].add: the cell F4 is blocked (nobody can stand on a "
      "blocked cell)\n"
      "show.yaml:6:136: error: sections[0].overrides[0].pin[0]: no performer has the id \"9\" (ids run from 1 to "
      "5)\n"
      "show.yaml:6:161: error: sections[0].overrides[1].formation: does not go with \"at\" (give exactly one of "
      "at, formation)\n"
      "show.yaml:6:172: error: sections[0].overrides[1].formation: \"0\" is out of range (1 to 100000)\n");
}

TEST_F(ByHand, RegionsBelongToOneGroupEach) {
  const Section section = show(film("regions: [{group: even, cells: [B1:C2, E4]}]")).sections.at(0);
  ASSERT_EQ(section.regions.size(), 1U);
  EXPECT_EQ(section.regions[0].group.value(), 1U);
  EXPECT_EQ(section.regions[0].cells.size(), 5U);
  EXPECT_EQ(errors(film("regions: [{group: evn, cells: [B1]}, {group: odd, cells: [B1:C2]}, {group: even, cells: "
                        "[C2]}]")),
            "show.yaml:6:95: error: sections[0].regions[0].group: no group has the name \"evn\" (did you mean "
            "\"even\"?)\n"
            "show.yaml:6:165: error: sections[0].regions[2].cells: a cell stands in the regions of two groups (a cell "
            "belongs to one group at most)\n");
}

TEST_F(ByHand, GroupsHaveASpeedAndMayKeepToThemselves) {
  const Show read = show(film("hold: 1 count"));
  EXPECT_EQ(read.performers[0].max_speed_mps, 0.9);
  EXPECT_EQ(read.performers[1].max_speed_mps, 0);
  EXPECT_TRUE(read.groups[0].exchange);
  EXPECT_FALSE(read.groups[1].exchange);
}

TEST_F(ByHand, ARostersOwnSpeedGoesBeforeTheGroups) {
  folder_.write("roster.csv", "id,group,speed\namy,slow,1.1 m/s\nrory,slow,\n");
  folder_.write("show.yaml",
                "footlight: 1\ntitle: t\nstage: {grid: {columns: 6, rows: 4}}\n"
                "performers: {from: roster.csv, groups: [{name: slow, colour: \"#FFFFFF\", max_speed: 0.5 m/s}]}\n"
                "sections: [{name: s, from: {video: film.mp4}, start: count 1}]\n");
  const auto result = load_show(folder_.path("show.yaml"));
  ASSERT_TRUE(result) << result.error().to_text();
  EXPECT_EQ(result->show.performers[0].max_speed_mps, 1.1);
  EXPECT_EQ(result->show.performers[1].max_speed_mps, 0.5);
}

TEST_F(ByHand, ARostersOwnAgilityAndReactionGoBeforeTheGroups) {
  folder_.write("roster.csv", "id,group,agility,reaction\namy,slow,0,0 s\nrory,slow,,\nriver,,2,\n");
  folder_.write(
      "show.yaml",
      "footlight: 1\ntitle: t\nstage: {grid: {columns: 6, rows: 4}}\n"
      "performers: {from: roster.csv, groups: [{name: slow, colour: \"#FFFFFF\", agility: 0.5, reaction: 1.2 s}]}\n"
      "sections: [{name: s, from: {video: film.mp4}, start: count 1}]\n");
  const auto result = load_show(folder_.path("show.yaml"));
  ASSERT_TRUE(result) << result.error().to_text();
  const auto& people = result->show.performers;
  EXPECT_EQ(people[0].agility, 0.0);
  EXPECT_EQ(people[0].reaction_s, 0.0);
  EXPECT_EQ(people[1].agility, 0.5);
  EXPECT_EQ(people[1].reaction_s, 1.2);
  EXPECT_EQ(people[2].agility, 2.0);
  EXPECT_EQ(people[2].reaction_s, std::nullopt);
}

TEST_F(ByHand, SaysWhatIsWrongWithAGroupsAgilityAndReaction) {
  folder_.write(
      "show.yaml",
      "footlight: 1\ntitle: t\nstage: {grid: {columns: 6, rows: 4}}\n"
      "performers: {count: 2, groups: [{name: a, members: 1, colour: \"#FFFFFF\", agility: 5, reaction: 1}]}\n"
      "sections: [{name: s, from: {video: film.mp4}, start: count 1}]\n");
  const auto result = load_show(folder_.path("show.yaml"));
  ASSERT_FALSE(result);
  EXPECT_EQ(
      folder_.without_folder(result.error().to_text()),
      "show.yaml:4:83: error: performers.groups[0].agility: \"5\" is out of range (0 to 4)\n"
      "show.yaml:4:96: error: performers.groups[0].reaction: \"1\" has no unit (write for example \"3.2 s\"; units: "
      "s, ms, min)\n");
}

TEST_F(ByHand, CellsMayNameGroupsInsteadOfPeople) {
  const Show read = show("sections: [{name: s, from: {cells: a.csv}, start: count 1}]\n");
  const auto& cells = std::get<CellsSource>(read.sections.at(0).from);
  EXPECT_FALSE(cells.assigned);
  ASSERT_EQ(cells.groups.size(), 5U);
  EXPECT_EQ(cells.groups[0], GroupIndex(0));
  EXPECT_EQ(cells.groups[3], GroupIndex(1));
  EXPECT_EQ(cells.groups[4], std::nullopt);
}

TEST_F(ByHand, CellsOfGroupsAreAsManyAsTheirPeople) {
  const std::string section = "sections: [{name: s, from: {cells: a.csv}, start: count 1}]\n";
  folder_.write("a.csv", "group,cell\nodd,A1\nodd,A2\neven,A3\neven,B1\n,B2\n");
  EXPECT_EQ(errors(section),
            "a.csv: error: 2 cells for 3 performers of the group \"odd\" (one row for every performer)\n"
            "a.csv: error: 2 cells for 1 performers of the group \"even\" (one row for every performer)\n");
  folder_.write("a.csv", "group,cell\nood,A1\nodd,A2\n");
  EXPECT_EQ(errors(section),
            "a.csv: error: 2 cells for 5 performers (one row for every performer)\n"
            "a.csv:2:1: error: no group has the name \"ood\" (did you mean \"odd\"?)\n");
  folder_.write("a.csv", "performer,group,cell\n1,odd,A1\n");
  EXPECT_EQ(errors(section),
            "a.csv:1:11: error: the columns \"performer\" and \"group\" do not go together (who stands where by name, "
            "or whose places they are)\n");
}

TEST_F(ByHand, UnderstudiesHaveIdsOfTheirOwn) {
  const auto load_with = [&](const std::string& list) {
    std::string text = std::string(kHead) + film("hold: 1 count");
    folder_.write("show.yaml", text.replace(text.find("{count: 5"), 9, "{count: 5, understudies: " + list));
    return load_show(folder_.path("show.yaml"));
  };
  const auto loaded = load_with("[{id: zoe, name: Zoe Q, covers: [1, 3-4], max_speed: 2 m/s}, {id: b, radius: 40 cm}]");
  ASSERT_TRUE(loaded) << loaded.error().to_text();
  const Show& read = loaded->show;
  ASSERT_EQ(read.understudies.size(), 2U);
  EXPECT_EQ(read.understudies[0].name, "Zoe Q");
  EXPECT_EQ(read.understudies[0].covers, (std::vector{PerformerIndex(0), PerformerIndex(2), PerformerIndex(3)}));
  EXPECT_EQ(read.understudies[0].max_speed_mps, 2);
  EXPECT_EQ(read.understudies[1].name, "b");
  EXPECT_EQ(read.understudies[1].radius_m, 0.4);
  const auto wrong = load_with("[{id: 3}, {id: z, covers: [9]}, {id: z}, {name: x}]");
  ASSERT_FALSE(wrong);
  EXPECT_EQ(
      folder_.without_folder(wrong.error().to_text()),
      "show.yaml:4:44: error: performers.understudies[0].id: somebody else has the id \"3\" (ids of performers and "
      "understudies are unique)\n"
      "show.yaml:4:65: error: performers.understudies[1].covers[0]: no performer has the id \"9\" (ids run from 1 to "
      "5)\n"
      "show.yaml:4:75: error: performers.understudies[2].id: somebody else has the id \"z\" (ids of performers and "
      "understudies are unique)\n"
      "show.yaml:4:79: error: performers.understudies[3].id: the key is missing (Unique, and no performer's.)\n");
}

TEST_F(ByHand, AbsentPeopleAreNamedOnce) {
  const Show read = show(film("hold: 1 count") + "absent: [1, 3-4]\n");
  std::vector<bool> absent;
  for (const Performer& performer : read.performers) absent.push_back(performer.absent);
  EXPECT_EQ(absent, (std::vector<bool>{true, false, true, true, false}));
  EXPECT_EQ(errors(film("hold: 1 count") + "absent: [7, 2, 1-2]\n"),
            "show.yaml:7:10: error: absent[0]: no performer has the id \"7\" (ids run from 1 to 5)\n"
            "show.yaml:7:16: error: absent[2]: performer 2 is absent already (once will do)\n");
  EXPECT_EQ(errors(film("hold: 1 count") + "absent: 1-5\n"),
            "show.yaml:7:9: error: absent: nobody is left (somebody has to come)\n");
}

}  // namespace
}  // namespace footlight::config
