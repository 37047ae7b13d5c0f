// SPDX-License-Identifier: Apache-2.0
#include "config/show_file.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/config/show_folder.hpp"

namespace footlight::config {
namespace {

/// Lines 1 to 4 of every small show below.
constexpr std::string_view kHead =
    "footlight: 1\n"
    "title: t\n"
    "stage: {grid: {columns: 4, rows: 3}, blocked: [D3]}\n"
    "performers: {count: 2}\n";
constexpr std::string_view kSection = "sections: [{name: a, from: {cells: a.csv}, start: count 1}]\n";

class ShowFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_.write("a.csv", "performer,col,row\n1,0,0\n2,1,0\n");
    folder_.write("film.mp4", "x");
    folder_.write("picture.png", "x");
  }
  Result<LoadedShow, Diagnostics> load(const std::string& text) {
    folder_.write("show.yaml", text);
    return load_show(folder_.path("show.yaml"));
  }
  LoadedShow loaded(const std::string& text) {
    auto result = load(text);
    EXPECT_TRUE(result) << (result ? "" : result.error().to_text());
    if (!result) return LoadedShow();
    return *result;
  }
  std::string errors(const std::string& text) {
    const auto result = load(text);
    EXPECT_FALSE(result);
    return result ? "" : folder_.without_folder(result.error().to_text());
  }
  /// Errors of a show whose other lines are right.
  std::string errors_of(std::string_view more) { return errors(std::string(kHead) + std::string(more)); }
  std::string errors_with(std::string_view more) { return errors_of(std::string(kSection) + std::string(more)); }
  std::string errors_of_stage(const std::string& stage) {
    return errors("footlight: 1\ntitle: t\nstage: " + stage + "\nperformers: {count: 2}\n" + std::string(kSection));
  }
  std::string errors_of_performers(const std::string& performers) {
    return errors("footlight: 1\ntitle: t\nstage: {grid: {columns: 4, rows: 3}}\nperformers: " + performers + "\n" +
                  std::string(kSection));
  }
  std::string errors_of_section(const std::string& section) { return errors_of("sections:\n  - {" + section + "}\n"); }

  ShowFolder folder_;
};

TEST_F(ShowFile, FillsWhatIsNotWrittenWithDefaults) {
  const LoadedShow all = loaded(std::string(kHead) + std::string(kSection));
  const Show& show = all.show;
  EXPECT_EQ(show.stage.grid.pitch_m(), 1);
  EXPECT_EQ(show.stage.clearance_m, 0.5);
  EXPECT_EQ(show.stage.max_speed_mps, 1.4);
  EXPECT_EQ(show.stage.lag, milliseconds(200));
  EXPECT_EQ(show.tempo, TempoMap(120, 4));
  ASSERT_EQ(show.performers.size(), 2U);
  EXPECT_EQ(show.performers[1].id, "2");
  ASSERT_EQ(show.sections.size(), 1U);
  EXPECT_EQ(show.sections[0].planner.layers, 2);
  EXPECT_EQ(show.sections[0].planner.region_variance_m2, 30);
  EXPECT_EQ(show.sections[0].sampling.interval, milliseconds(3200));
  ASSERT_EQ(show.cues.size(), 1U);
  EXPECT_EQ(show.cues[0].number.to_text(), "1");
  EXPECT_EQ(show.looks.size(), static_cast<std::size_t>(kLampRoles));
  EXPECT_EQ(show.announce_counts, 4);
  EXPECT_EQ(show.time.source, "");
  EXPECT_EQ(show.time.start, Duration{});
  EXPECT_EQ(show.time.rate, FrameRate::fps25);
  EXPECT_EQ(show.time.lost, TimeLoss::next_hold);
  EXPECT_EQ(show.time.freewheel, milliseconds(2000));
  EXPECT_EQ(show.rig_file, "");
  EXPECT_EQ(all.files, (std::vector<std::string>{folder_.path("show.yaml").string(), folder_.path("a.csv").string()}));
}

TEST_F(ShowFile, TakesTheRulesForASourceOfTime) {
  const Show show = loaded(std::string(kHead) + std::string(kSection) +
                           "time: {source: \"ltc:tape.wav\", start: \"01:00:00;00\", frame_rate: 29.97df, "
                           "lost: continue, freewheel: 500 ms}\n")
                        .show;
  EXPECT_EQ(show.time.source, "ltc:tape.wav");
  EXPECT_EQ(show.time.start, time_of({1, 0, 0, 0, FrameRate::fps2997_drop}));
  EXPECT_EQ(show.time.rate, FrameRate::fps2997_drop);
  EXPECT_EQ(show.time.lost, TimeLoss::go_on);
  EXPECT_EQ(show.time.freewheel, milliseconds(500));
}

TEST_F(ShowFile, RefusesRulesForASourceOfTimeThatNobodyCouldKeep) {
  const auto time = [&](const std::string& text) { return errors_with("time: {" + text + "}\n"); };
  EXPECT_EQ(time("start: \"01:00:00:25\""),
            "show.yaml:6:15: error: time.start: \"01:00:00:25\" is no timecode of 25 frames (hours, minutes, seconds "
            "and frames, as \"01:00:00:00\")\n");
  EXPECT_EQ(time("start: 3600"),
            "show.yaml:6:15: error: time.start: \"3600\" is no timecode of 25 frames (hours, minutes, seconds and "
            "frames, as \"01:00:00:00\")\n");
  EXPECT_EQ(time("frame_rate: 29.97df, start: \"00:01:00;00\""),
            "show.yaml:6:36: error: time.start: \"00:01:00;00\" is no timecode of 29.97 drop-frame frames (hours, "
            "minutes, seconds and frames, as \"01:00:00:00\")\n");
  EXPECT_EQ(time("frame_rate: 23"),
            "show.yaml:6:20: error: time.frame_rate: \"23\" is not one of the choices (did you mean \"24\"?)\n");
  EXPECT_EQ(time("lost: next"),
            "show.yaml:6:14: error: time.lost: \"next\" is not one of the choices (did you mean "
            "\"next-hold-point\"?)\n");
  EXPECT_EQ(
      time("freewheel: 2"),
      "show.yaml:6:19: error: time.freewheel: \"2\" has no unit (write for example \"3.2 s\"; units: s, ms, min)\n");
  EXPECT_EQ(time("freewheel: 0 s"), "show.yaml:6:19: error: time.freewheel: \"0 s\" is out of range (0.2 to 60 s)\n");
  EXPECT_EQ(time("sources: ltc"), "show.yaml:6:8: error: time.sources: unknown key (did you mean \"source\"?)\n");
}

TEST_F(ShowFile, KnowsEveryPlannerModel) {
  using enum PlannerModel;
  for (const auto& [text, model] : {std::pair{"flat", flat}, {"hierarchical", hierarchical}, {"joint", joint}}) {
    const LoadedShow all =
        loaded(std::string(kHead) +
               "sections:\n  - {name: s, from: {video: film.mp4}, start: count 1, duration: 8 counts, "
               "planner: {model: " +
               text + "}}\n");
    ASSERT_EQ(all.show.sections.size(), 1U);
    EXPECT_EQ(all.show.sections[0].planner.model, model) << text;
  }
}

TEST_F(ShowFile, PeopleWalkStraightOrOverCells) {
  using enum WalkKind;
  const std::string sections =
      "sections:\n  - {name: s, from: {video: film.mp4}, start: count 1, duration: 8 counts}\n";
  EXPECT_EQ(loaded(std::string(kHead) + sections).show.stage.walk, straight);
  EXPECT_EQ(loaded(std::string(kHead) + "walk: straight\n" + sections).show.stage.walk, straight);
  EXPECT_EQ(loaded(std::string(kHead) + "walk: cells\n" + sections).show.stage.walk, cells);
  EXPECT_EQ(errors(std::string(kHead) + "walk: cell\n" + sections),
            "show.yaml:5:7: error: walk: \"cell\" is not one of the choices (did you mean \"cells\"?)\n");
}

TEST_F(ShowFile, TakesEveryKey) {
  folder_.write("rig.yaml", "rig: 1\nbuses: [{name: c, url: \"sim://can\"}]\nfloor: {buses: [c]}\n");
  const LoadedShow all = loaded(R"(# yaml-language-server: $schema=../docs/schema/show.schema.json
footlight: 1
title: "Everything"
version: 3.10
stage:
  grid: {kind: hexagonal, columns: 30, rows: 20, pitch: 80 cm}
  blocked: [A1, C3:B2]
  reserve: [AA1:AD20]
  clearance: 2 ft
  max_speed: 5.4 km/h
  lag: 150 ms
performers:
  count: 9
  groups: [{name: odd, members: [1-3, 5], colour: "#7CFC00"}, {name: even, members: 6-7, colour: "#FF69B4"}]
  colour: "#102030"
music: {meter: 3/4, pickup: 2 counts, changes: [{at: count 1, tempo: 90}, {at: count 31, tempo: 60}, {at: count 33, meter: 5/4}]}
sections:
  - name: bow
    from: {image: picture.png, fit: contain, invert: true}
    start: count 300
    hold: 8 counts
    max_speed: 1 m/s
  - name: film
    from: {video: film.mp4, frames: 10-99, fit: cover, threshold: 90}
    start: count 1.5
    duration: 224 counts
    sampling: {interval: 2 s, hash: 0.2, snap: none}
    planner: {model: flat, layers: 3, region: {size: 40, variance: 12 m2}, cost: euclidean, effort: 2}
cues:
  - {number: "2.5", section: bow, name: Bow, notes: slowly}
  - {number: "1", section: film, continue: auto-follow, pre_wait: 500 ms, post_wait: 2 s}
looks:
  here: {colour: "#FFFFFF", effect: pulse, brightness: 128}
announce: 6 counts
rig: rig.yaml
)");
  const Show& show = all.show;
  EXPECT_EQ(show.version, "3.10") << "a text, not a number";
  EXPECT_EQ(show.stage.grid.kind(), GridKind::hexagonal);
  EXPECT_EQ(show.stage.grid.pitch_m(), 0.8);
  EXPECT_EQ(show.stage.blocked.size(), 5U);
  EXPECT_EQ(show.stage.reserve.size(), 80U);
  EXPECT_DOUBLE_EQ(show.stage.clearance_m, 0.6096);
  EXPECT_DOUBLE_EQ(show.stage.max_speed_mps, 1.5);
  EXPECT_EQ(show.performers[4].group, GroupIndex(0));
  EXPECT_EQ(show.performers[3].group, std::nullopt);
  EXPECT_EQ(show.performers[6].group, GroupIndex(1));
  EXPECT_EQ(show.default_colour, (Colour{0x10, 0x20, 0x30}));
  TempoMap tempo = TempoMap::from({{1, 90}, {31, 60}}, 3, 2).value();
  ASSERT_TRUE(tempo.change_meter(33, 5));
  EXPECT_EQ(show.tempo, tempo);
  ASSERT_EQ(show.sections.size(), 2U);
  EXPECT_EQ(show.sections[0].name, "film") << "sections are sorted by start";
  const auto& video = std::get<VideoSource>(show.sections[0].from);
  EXPECT_EQ(video.first_frame, 10);
  EXPECT_EQ(video.last_frame, 99);
  EXPECT_EQ(video.picture.fit, Fit::cover);
  EXPECT_EQ(video.picture.threshold, 90);
  EXPECT_EQ(show.sections[0].start_count, 1.5);
  EXPECT_EQ(show.sections[0].duration_counts, 224);
  EXPECT_FALSE(show.sections[0].sampling.snap_to_count);
  EXPECT_EQ(show.sections[0].planner.model, PlannerModel::flat);
  EXPECT_EQ(show.sections[0].planner.cost, PairingCost::euclidean);
  EXPECT_TRUE(std::get<ImageSource>(show.sections[1].from).picture.invert);
  EXPECT_EQ(show.sections[1].max_speed_mps, 1);
  EXPECT_EQ(show.cues[0].name, "film") << "cues are sorted by number, and named as their section";
  EXPECT_EQ(show.cues[0].section, SectionIndex(0));
  EXPECT_EQ(show.cues[0].continue_mode, ContinueMode::auto_follow);
  EXPECT_EQ(show.cues[0].pre_wait, milliseconds(500));
  EXPECT_EQ(show.cues[1].section, SectionIndex(1));
  EXPECT_EQ(show.cues[1].notes, "slowly");
  EXPECT_EQ(show.looks.at(LampRole::here).colour, (Colour{255, 255, 255}));
  EXPECT_EQ(show.looks.at(LampRole::here).brightness, 128);
  EXPECT_EQ(show.announce_counts, 6);
  EXPECT_EQ(all.rig.nodes.size(), 19U);  // 595 lamps
  EXPECT_TRUE(all.warnings.empty());
}

TEST_F(ShowFile, TakesAVideoWithoutDurationAsItsOwnLength) {
  Show show = loaded(std::string(kHead) +
                     "sections: [{name: a, from: {video: film.mp4}, start: count 1}, "
                     "{name: b, from: {cells: a.csv}, start: count 21}]\n")
                  .show;
  EXPECT_EQ(show.sections[0].duration_counts, 0);
  ASSERT_TRUE(settle_film_lengths(show, {FilmLength{251, 25}, std::nullopt}));
  EXPECT_DOUBLE_EQ(show.sections[0].duration_counts, 20);
  show.sections[0].duration_counts = 0;
  EXPECT_EQ(folder_.without_folder(settle_film_lengths(show, {FilmLength{276, 25}, std::nullopt}).error().to_text()),
            "show.yaml:5:64: error: sections[1].start: section \"b\" starts at count 21, and section \"a\" lasts until "
            "count 23 "
            "(start it at count 23 or later)\n");
}

TEST_F(ShowFile, NamesTheNearestKnownKey) {
  EXPECT_EQ(
      errors_of_stage("{grid: {columns: 4, rows: 3}, clearence: 1 m, colour: x}"),
      "show.yaml:3:38: error: stage.clearence: unknown key (did you mean \"clearance\"?)\n"
      "show.yaml:3:54: error: stage.colour: unknown key (known keys: grid, blocked, obstacles, reserve, clearance, "
      "max_speed, lag, terrain)\n");
}

TEST_F(ShowFile, SaysWhereAKeyIsMissing) {
  EXPECT_EQ(errors("footlight: 1\nstage: {grid: {columns: 4}}\nperformers: {}\nsections:\n  - {name: a}\n"),
            "show.yaml:1:1: error: title: the key is missing (For people.)\n"
            "show.yaml:2:9: error: stage.grid.rows: the key is missing (Cells from downstage to upstage.)\n"
            "show.yaml:3:1: error: performers: one of the keys count, from is missing (give exactly one of them)\n"
            "show.yaml:5:5: error: sections[0].from: the key is missing (The formations.)\n"
            "show.yaml:5:5: error: sections[0].start: the key is missing (Everybody stands in the first formation at "
            "this count.)\n");
}

TEST_F(ShowFile, WantsUnitsAndRanges) {
  EXPECT_EQ(errors_of_stage("{grid: {columns: 0, rows: 3.5, pitch: 1}, clearance: 200 m, max_speed: 0 m/s, lag: -1 s}"),
            "show.yaml:3:25: error: stage.grid.columns: \"0\" is out of range (1 to 4096)\n"
            "show.yaml:3:34: error: stage.grid.rows: \"3.5\" is not a whole number (1 to 4096)\n"
            "show.yaml:3:46: error: stage.grid.pitch: \"1\" has no unit (write for example \"0.5 m\"; units: m, cm, "
            "mm, ft, in)\n"
            "show.yaml:3:61: error: stage.clearance: \"200 m\" is out of range (0 to 100 m)\n"
            "show.yaml:3:79: error: stage.max_speed: \"0 m/s\" is out of range (above 0, at most 20 m/s)\n"
            "show.yaml:3:91: error: stage.lag: \"-1 s\" is out of range (0 to 10 s)\n");
}

TEST_F(ShowFile, WantsAllKindsOfValuesWhereTheyBelong) {
  EXPECT_EQ(
      errors("footlight: 2\ntitle: \"\"\nstage: big\nperformers: [x]\nmusic:\nsections: {}\n"),
      "show.yaml:1:12: error: footlight: \"2\" is out of range (1)\n"
      "show.yaml:2:8: error: title: the text is empty (write one, or leave the key out)\n"
      "show.yaml:3:8: error: stage: a single value stands where a mapping belongs (keys: grid, blocked, obstacles, "
      "reserve, "
      "clearance, max_speed, lag, terrain)\n"
      "show.yaml:4:13: error: performers: a list stands where a mapping belongs (keys: count, from, groups, "
      "understudies, colour)\n"
      "show.yaml:5:1: error: music: nothing stands where a mapping belongs (keys: tempo, changes, meter, pickup)\n"
      "show.yaml:6:11: error: sections: a mapping stands where a list belongs (write [...] or lines that begin "
      "with -)\n");
}

TEST_F(ShowFile, WantsAVersionThatIsAText) {
  const auto error = [&](const std::string& value) {
    const std::string text = errors(std::string(kHead) + "version: " + value + "\n" + std::string(kSection));
    return text.substr(0, text.find('\n') + 1);
  };
  EXPECT_EQ(error("[2]"), "show.yaml:5:10: error: version: a list stands where a single value belongs\n");
  EXPECT_EQ(error("\"\""), "show.yaml:5:10: error: version: the text is empty (write one, or leave the key out)\n");
}

TEST_F(ShowFile, KeepsCellsOnTheGridAndTheWingsFree) {
  EXPECT_EQ(errors_of_stage("{grid: {columns: 4, rows: 3}, blocked: [E1, A1:A4, 7], reserve: B2}"),
            "show.yaml:3:48: error: stage.blocked[0]: the cell E1 is off the grid (A1 to D3)\n"
            "show.yaml:3:52: error: stage.blocked[1]: the cell A4 is off the grid (A1 to D3)\n"
            "show.yaml:3:59: error: stage.blocked[2]: \"7\" is not a cell or a range of cells (write for example A1 or "
            "A1:J48)\n");
  EXPECT_EQ(errors_of_stage("{grid: {columns: 4, rows: 3}, blocked: [C2:D3], reserve: [D3]}"),
            "show.yaml:3:65: error: stage.reserve: the cell D3 is blocked (nobody can stand on a blocked cell)\n");
  EXPECT_EQ(errors_of_stage("{grid: {columns: 4000, rows: 4000}}"),
            "show.yaml:3:9: error: stage.grid: 4000 x 4000 cells are too many (a grid has at most 4,000,000 cells)\n");
}

TEST_F(ShowFile, WantsACellForEverybody) {
  EXPECT_EQ(errors_of_performers("{count: 13}"),
            "a.csv: error: 11 performers have no cell, the first is 3 (one row for every performer)\n"
            "show.yaml:4:21: error: performers.count: 13 performers and only 12 cells that are not blocked (a larger "
            "grid, or fewer people)\n");
  EXPECT_EQ(errors_of_performers("{count: 2, from: x.csv}"),
            "show.yaml:4:24: error: performers.from: does not go with \"count\" (give exactly one of count, from)\n"
            "show.yaml:4:30: error: performers.from: the file \"x.csv\" is missing (looked for x.csv)\n");
}

TEST_F(ShowFile, PutsNobodyIntoTwoGroups) {
  EXPECT_EQ(errors_of_performers("{count: 2, groups: [{name: g, members: 1-2, colour: red}, {name: h, members: [2, 3, "
                                 "2-1, x], colour: \"#112233\"}, {name: g, colour: \"#000000\"}]}"),
            "show.yaml:4:65: error: performers.groups[0].colour: \"red\" is not a colour (write \"#RRGGBB\", in "
            "quotes)\n"
            "show.yaml:4:91: error: performers.groups[1].members[0]: performer 2 is already in the group \"g\" "
            "(everybody is in one group at most)\n"
            "show.yaml:4:94: error: performers.groups[1].members[1]: no performer has the id \"3\" (ids run from 1 to "
            "2)\n"
            "show.yaml:4:97: error: performers.groups[1].members[2]: \"2-1\" runs backwards (the smaller number stands "
            "first)\n"
            "show.yaml:4:102: error: performers.groups[1].members[3]: no performer has the id \"x\" (ids run from 1 to "
            "2)\n"
            "show.yaml:4:133: error: performers.groups[2].name: a second group has the name \"g\" (names of groups are "
            "unique)\n");
}

TEST_F(ShowFile, NamesNobodyTwiceInAGroup) {
  EXPECT_EQ(errors_of_performers("{count: 2, groups: [{name: g, members: [1-2, 1-2], colour: \"#112233\"}]}"),
            "show.yaml:4:58: error: performers.groups[0].members[1]: performer 1 is already in the group \"g\" "
            "(everybody is in one group at most)\n");
}

TEST_F(ShowFile, NamesBothSectionsThatOverlap) {
  EXPECT_EQ(
      errors_of("sections:\n"
                "  - {name: growth, from: {video: film.mp4}, start: count 1, duration: 224 counts}\n"
                "  - {name: bow, from: {cells: a.csv}, start: count 200}\n"
                "  - {name: bow, from: {cells: a.csv}, start: count 300}\n"
                "  - {name: end, from: {cells: a.csv}, start: count 200}\n"),
      "show.yaml:7:5: error: sections[1].start: section \"bow\" starts at count 200, and section \"growth\" lasts "
      "until "
      "count 225 (start it at count 225 or later)\n"
      "show.yaml:8:12: error: sections[2].name: a second section has the name \"bow\" (first in line 7; names of "
      "sections are unique)\n"
      "show.yaml:9:5: error: sections[2].start: section \"end\" starts at count 200, and section \"bow\" lasts until "
      "count 200 (start it later)\n");
}

TEST_F(ShowFile, FindsEveryFileThatIsMissing) {
  EXPECT_EQ(errors_of("sections:\n"
                      "  - {name: a, from: {video: no.mp4}, start: count 1, duration: 2 counts}\n"
                      "  - {name: b, from: {image: pictures/no.png}, start: count 10}\n"
                      "  - {name: c, from: {cells: .}, start: count 20}\n"
                      "rig: no.yaml\n"),
            "show.yaml:6:29: error: sections[0].from.video: the file \"no.mp4\" is missing (looked for no.mp4)\n"
            "show.yaml:7:29: error: sections[1].from.image: the file \"pictures/no.png\" is missing (looked for "
            "pictures/no.png)\n"
            "show.yaml:8:29: error: sections[2].from.cells: \".\" is not a file (looked at )\n"
            "show.yaml:9:6: error: rig: the file \"no.yaml\" is missing (looked for no.yaml)\n");
}

TEST_F(ShowFile, RefusesKeysThatMeanNothingForTheSource) {
  EXPECT_EQ(errors_of_section("name: a, from: {cells: a.csv, fit: area}, start: count 1, duration: 4 counts"),
            "show.yaml:6:36: error: sections[0].from.fit: the key has no meaning here (it goes with a video or an "
            "image)\n"
            "show.yaml:6:64: error: sections[0].duration: the key has no meaning here (it goes with a video; a single "
            "formation has a hold)\n");
  EXPECT_EQ(errors_of_section("name: a, from: {video: film.mp4, image: picture.png}, start: count 1"),
            "show.yaml:6:39: error: sections[0].from.image: does not go with \"video\" (give exactly one of video, "
            "image, cells, parts, shape, text, mesh, painting)\n");
}

TEST_F(ShowFile, RefusesWrongNumbersInASection) {
  EXPECT_EQ(
      errors_of_section("name: a, from: {video: film.mp4, frames: 9-9, threshold: 300, invert: yes, fit: covr}, "
                        "start: count 0, duration: 0 counts, sampling: {interval: 0 s, hash: 2, snap: beat}, "
                        "planner: {model: flt, layers: 7, region: {size: 0, variance: -1}, effort: 0}"),
      "show.yaml:6:47: error: sections[0].from.frames: \"9-9\" has fewer than two frames (the last frame comes after "
      "the first)\n"
      "show.yaml:6:63: error: sections[0].from.threshold: \"300\" is not a threshold (0 to 255, or otsu)\n"
      "show.yaml:6:76: error: sections[0].from.invert: \"yes\" is neither true nor false (write true or false)\n"
      "show.yaml:6:86: error: sections[0].from.fit: \"covr\" is not one of the choices (did you mean \"cover\"?)\n"
      "show.yaml:6:100: error: sections[0].start: \"count 0\" is out of range (1 to 1000000)\n"
      "show.yaml:6:119: error: sections[0].duration: \"0 counts\" is out of range (above 0, at most 1000000 counts)\n"
      "show.yaml:6:150: error: sections[0].sampling.interval: \"0 s\" is out of range (above 0, at most 3600 s)\n"
      "show.yaml:6:161: error: sections[0].sampling.hash: \"2\" is out of range (above 0, at most 1)\n"
      "show.yaml:6:170: error: sections[0].sampling.snap: \"beat\" is not one of the choices (choices: count, none)\n"
      "show.yaml:6:194: error: sections[0].planner.model: \"flt\" is not one of the choices (did you mean \"flat\"?)\n"
      "show.yaml:6:207: error: sections[0].planner.layers: \"7\" is out of range (1 to 6)\n"
      "show.yaml:6:225: error: sections[0].planner.region.size: \"0\" is out of range (1 to 100000)\n"
      "show.yaml:6:238: error: sections[0].planner.region.variance: \"-1\" is out of range (above 0, at most 1000000 "
      "m2)\n"
      "show.yaml:6:251: error: sections[0].planner.effort: \"0\" is out of range (0.01 to 100)\n");
}

TEST_F(ShowFile, WantsQuotedAndUniqueCueNumbers) {
  EXPECT_EQ(errors_with("cues:\n"
                        "  - {number: \"12.1\", section: a}\n"
                        "  - {number: \"12.10\", section: a}\n"
                        "  - {number: 12.5, section: a}\n"
                        "  - {number: \"twelve\", section: a}\n"),
            "show.yaml:8:14: error: cues[1].number: a second cue has the number 12.1 (12.10 equals 12.1; first in line "
            "7)\n"
            "show.yaml:9:14: error: cues[2].number: the cue number 12.5 is not quoted (write \"12.5\": unquoted, 12.10 "
            "and 12.1 would be numbers)\n"
            "show.yaml:10:14: error: cues[3].number: \"twelve\" is not a cue number (write for example \"12.5\": "
            "digits, at most one point and six decimals)\n");
}

TEST_F(ShowFile, WantsCuesInTheOrderOfTheirSections) {
  EXPECT_EQ(errors_of("sections:\n"
                      "  - {name: b, from: {cells: a.csv}, start: count 9}\n"
                      "  - {name: a, from: {cells: a.csv}, start: count 1}\n"
                      "  - {name: c, from: {cells: a.csv}, start: count 17}\n"
                      "cues:\n"
                      "  - {number: \"3\", section: b}\n"
                      "  - {number: \"1\", section: a}\n"
                      "  - {number: \"2.5\", section: c}\n"
                      "  - {number: \"4\", section: c}\n"),
            "show.yaml:10:28: error: cues[0].section: cue 3 plays section \"b\", which does not come after section "
            "\"c\" of cue 2.5 (cues play their sections in the order of the show, each section once)\n"
            "show.yaml:13:28: error: cues[3].section: cue 4 plays section \"c\", which does not come after section "
            "\"c\" of cue 2.5 (cues play their sections in the order of the show, each section once)\n");
}

TEST_F(ShowFile, CuesNeedGatesOfTheShow) {
  const Show show = loaded(std::string(kHead) + std::string(kSection) +
                           "gates: [trap closed, lift level]\n"
                           "cues: [{number: \"1\", section: a, gates: [lift level, trap closed]}]\n")
                        .show;
  EXPECT_EQ(show.gates, (std::vector<std::string>{"trap closed", "lift level"}));
  EXPECT_EQ(show.cues[0].gates, 3U);
}

TEST_F(ShowFile, WantsGatesThatTheShowListsOnce) {
  EXPECT_EQ(
      errors_with("gates: [trap closed, trap closed, \"\"]\n"
                  "cues: [{number: \"1\", section: a, gates: [trap close, x]}]\n"),
      "show.yaml:6:22: error: gates[1]: a second gate has the name \"trap closed\" (once will do)\n"
      "show.yaml:6:35: error: gates[2]: a gate without a name (such as \"trap closed\")\n"
      "show.yaml:7:42: error: cues[0].gates[0]: no gate has the name \"trap close\" (did you mean \"trap closed\"?)\n"
      "show.yaml:7:54: error: cues[0].gates[1]: no gate has the name \"x\" (gates: trap closed)\n");
  EXPECT_EQ(errors_with("cues: [{number: \"1\", section: a, gates: trap}]\n"),
            "show.yaml:6:41: error: cues[0].gates: no gate has the name \"trap\" (the show lists them: gates: "
            "[\"trap\"])\n");
  std::string many = "gates: [";
  for (int g = 0; g < 33; ++g) many += (g > 0 ? ", g" : "g") + std::to_string(g);
  EXPECT_EQ(errors_with(many + "]\n"),
            "show.yaml:6:159: error: gates[32]: more than 32 gates (one that stands for several, by their contacts in "
            "series)\n");
}

TEST_F(ShowFile, KnowsWhichSectionsThereAre) {
  EXPECT_EQ(errors_of("sections: [{name: growth, from: {cells: a.csv}, start: count 1}]\n"
                      "cues: [{number: \"1\", section: grwth}, {number: \"2\", section: x, continue: auto}]\n"),
            "show.yaml:6:31: error: cues[0].section: no section has the name \"grwth\" (did you mean \"growth\"?)\n"
            "show.yaml:6:62: error: cues[1].section: no section has the name \"x\" (sections: growth)\n"
            "show.yaml:6:75: error: cues[1].continue: \"auto\" is not one of the choices (did you mean "
            "\"auto-continue\"?)\n");
  EXPECT_EQ(errors_with("cues: [{number: \"2\", section: x}]\n"),
            "show.yaml:6:31: error: cues[0].section: no section has the name \"x\" (sections: a)\n");
}

TEST_F(ShowFile, DoesNotEchoASectionThatCouldNotBeRead) {
  EXPECT_EQ(errors_of("sections: [{name: growth, from: {cells: a.csv}, start: 1}]\n"
                      "cues: [{number: \"1\", section: growth}]\n"),
            "show.yaml:5:56: error: sections[0].start: \"1\" is not a count of the music (write for example \"count "
            "233\"; the music begins at count 1)\n");
}

TEST_F(ShowFile, RefusesWrongLooksAndMusic) {
  EXPECT_EQ(errors_with("looks: {here: {colour: red, effect: blnk, brightness: 256}, there: {}}\n"
                        "music: {tempo: 0, meter: 4}\n"
                        "announce: 4\n"),
            "show.yaml:6:24: error: looks.here.colour: \"red\" is not a colour (group, or \"#RRGGBB\" in quotes)\n"
            "show.yaml:6:37: error: looks.here.effect: \"blnk\" is not one of the choices (did you mean \"blink\"?)\n"
            "show.yaml:6:55: error: looks.here.brightness: \"256\" is out of range (0 to 255)\n"
            "show.yaml:6:61: error: looks.there: unknown key (did you mean \"here\"?)\n"
            "show.yaml:7:16: error: music.tempo: \"0\" is out of range (1 to 1000)\n"
            "show.yaml:7:26: error: music.meter: \"4\" is not a meter (write for example 4/4; 1 to 64 counts a "
            "measure)\n"
            "show.yaml:8:11: error: announce: \"4\" has no unit (write for example \"8 counts\"; units: counts, "
            "count)\n");
  EXPECT_EQ(errors_with("music: {tempo: 120, changes: [{at: count 2, tempo: 90}]}\n"),
            "show.yaml:6:9: error: music.tempo: does not go with \"changes\" (give one tempo or a list of changes)\n"
            "show.yaml:6:36: error: music.changes[0].at: the first tempo begins at count 2 (it begins at count 1)\n");
  EXPECT_EQ(errors_with("music: {changes: [{at: count 1, tempo: 90}, {at: count 1, tempo: 80}]}\n"),
            "show.yaml:6:50: error: music.changes[1].at: count 1 does not come after count 1 (the counts increase down "
            "the list)\n");
  const auto changes = [&](const std::string& more) {
    return errors_with("music: {changes: [{at: count 1, tempo: 90}, " + more + "]}\n");
  };
  EXPECT_EQ(changes("{at: count 6, meter: 3/4}"),
            "show.yaml:6:66: error: music.changes[1].meter: no measure begins here; the next one does at count 9 (a "
            "meter changes where a measure begins)\n");
  EXPECT_EQ(changes("{at: count 5, meter: 3}"),
            "show.yaml:6:66: error: music.changes[1].meter: \"3\" is not a meter (write for example 4/4; 1 to 64 "
            "counts a measure)\n");
  EXPECT_EQ(changes("{at: count 5}"),
            "show.yaml:6:45: error: music.changes[1]: nothing changes (give a tempo or a meter)\n");
  EXPECT_EQ(errors_with("music: {changes: [{at: count 1, meter: 3/4}]}\n"),
            "show.yaml:6:19: error: music.changes[0]: no tempo at count 1 (the first change gives the first tempo; the "
            "first meter is music.meter)\n");
  EXPECT_EQ(errors_with("music: {changes: [{at: count 1, tempo: 90, meter: 3/4}]}\n"),
            "show.yaml:6:19: error: music.changes[0]: a meter at count 1 (the first change gives the first tempo; the "
            "first meter is music.meter)\n");
  EXPECT_EQ(errors_with("music: {meter: 3/4, pickup: 3 counts}\n"),
            "show.yaml:6:29: error: music.pickup: a pick-up of 3 counts is no shorter than a measure (fewer than 3 "
            "counts)\n");
}

TEST_F(ShowFile, WantsASectionAtLeast) {
  EXPECT_EQ(errors_of("sections: []\n"),
            "show.yaml:5:11: error: sections: the list is empty (at least one is needed)\n");
}

TEST_F(ShowFile, IsRefusedUnreadWhenItIsTooLarge) {
  folder_.write("show.yaml", std::string(2U << 20U, '#'));
  EXPECT_EQ(folder_.without_folder(load_show(folder_.path("show.yaml")).error().to_text()),
            "show.yaml: error: the file \"show.yaml\" has 2097152 bytes, more than 1048576 (long data belong in CSV "
            "files)\n");
  EXPECT_EQ(folder_.without_folder(load_show(folder_.path("none.yaml")).error().to_text()),
            "none.yaml: error: the file \"none.yaml\" is missing\n");
}

TEST_F(ShowFile, ShowsTheFirstErrorsOfVeryMany) {
  std::string text(kHead);
  for (int i = 0; i < 5000; ++i) text += "key" + std::to_string(i) + ": 1\n";
  const std::string all = errors(text);
  EXPECT_EQ(std::count(all.begin(), all.end(), '\n'), 201);
  EXPECT_EQ(all.substr(0, all.find('\n')), "show.yaml: error: 4801 more errors are not shown (the first 200 follow)");
}

}  // namespace
}  // namespace footlight::config
