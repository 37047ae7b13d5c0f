// SPDX-License-Identifier: Apache-2.0
#include <filesystem>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "config/starter_show.hpp"
#include "core/rng.hpp"
#include "tests/support/full.hpp"
#include "tests/support/program.hpp"

namespace footlight::app {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// The starter show, and what is made of it.
class ImportCommand : public testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(test::footlight({"new", folder_ / "show"}).status, 0); }

  [[nodiscard]] std::string path(const std::string& name) const { return folder_ / name; }
  void export_drone(const std::string& show, const std::string& zip) const {
    const test::Ran ran = test::footlight({"export", path(show) + "/show.yaml", "--drone", path(zip)});
    ASSERT_EQ(ran.status, 0) << ran.err;
  }
  static std::string without(std::string text, const std::string& part) {
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part)) text.erase(at, part.size());
    return text;
  }
  [[nodiscard]] std::string error_of(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "import");
    const test::Ran ran = test::footlight(std::move(arguments));
    EXPECT_EQ(ran.status, 2) << ran.out;
    return without(ran.err, folder_.path().string() + "/");
  }

  test::TemporaryFolder folder_;
};

TEST_F(ImportCommand, WhatWasExportedComesBackByteForByte) {
  export_drone("show", "a.zip");
  const test::Ran ran = test::footlight({"import", path("a.zip"), "-o", path("back"), "--tempo", "100", "--json"});
  ASSERT_EQ(ran.status, 0) << ran.err;
  const json told = json::parse(ran.out);
  EXPECT_EQ(told["kind"], "tracks");
  EXPECT_EQ(told["people"], 12);
  EXPECT_EQ(told["formations"], 3);
  EXPECT_EQ(told["plan"]["valid"], true);
  EXPECT_EQ(told["plan"]["as_in_file"], true);
  EXPECT_LT(told["plan"]["largest_difference_m"].get<double>(), 0.003);
  EXPECT_EQ(told["moved"]["places"], 0);
  export_drone("back", "b.zip");
  EXPECT_EQ(folder_.read("b.zip"), folder_.read("a.zip"));
  EXPECT_THAT(folder_.names(), ElementsAre("a.zip", "b.zip", "back", "show"));
}

TEST_F(ImportCommand, AShowLikeAnotherHasItsStagePeopleAndMusic) {
  export_drone("show", "a.zip");
  const test::Ran ran =
      test::footlight({"import", path("a.zip"), "-o", path("back"), "--like", path("show/show.yaml"), "--json"});
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_EQ(json::parse(ran.out)["plan"]["as_in_file"], true);
  for (const char* name : {"show", "back"}) {
    ASSERT_EQ(test::footlight({"export", path(name) + "/show.yaml", "--csv", path(std::string(name) + "-csv")}).status,
              0);
  }
  // Sections are named anew; everything else is the same.
  const auto marks = [&](const char* folder) {
    const test::Ran cut = test::run_program({"cut", "-d,", "-f1-8", path(std::string(folder) + "-csv/marks.csv")});
    EXPECT_EQ(cut.status, 0);
    return cut.out;
  };
  EXPECT_EQ(marks("back"), marks("show"));
}

TEST_F(ImportCommand, AFilmThatWasPlannedComesBackByteForByte) {
  std::filesystem::copy_file(FOOTLIGHT_TEST_DATA "/moving_square_40x30_12_frames_10fps.avi", path("show/square.avi"));
  folder_.write("show/show.yaml",
                "footlight: 1\ntitle: square\nstage: {grid: {columns: 20, rows: 15}, reserve: [A1:B15, S1:T15]}\n"
                "performers: {count: 30}\nsections:\n"
                "  - {name: sq, from: {video: square.avi}, start: count 5, duration: 60 counts, hold: 4 counts}\n");
  export_drone("show", "a.zip");
  const test::Ran ran = test::footlight({"import", path("a.zip"), "-o", path("back"), "--json"});
  ASSERT_EQ(ran.status, 0) << ran.err;
  const json told = json::parse(ran.out);
  EXPECT_EQ(told["plan"]["as_in_file"], true);
  EXPECT_GT(told["formations"], 9);
  export_drone("back", "b.zip");
  EXPECT_EQ(folder_.read("b.zip"), folder_.read("a.zip"));
}

/// People on random cells who may have to wait for each other: what cannot be kept is told, what can is kept.
TEST_F(ImportCommand, WhetherThePlanIsTheFileIsSaidAndTrue) {
  std::size_t same = 0;
  for (std::uint64_t seed = 0; seed < test::tries<std::uint64_t>(4, 40); ++seed) {
    Rng rng(seed);
    std::string yaml =
        "footlight: 1\ntitle: t\nstage:\n  grid: {columns: 11, rows: 8, pitch: 80 cm}\n  max_speed: 3 m/s\n"
        "performers: {count: 9, groups: [{name: a, members: 1-4, colour: \"#FF0000\"}]}\nmusic: {tempo: "
        "90}\nsections:\n";
    for (int s = 0; s < 4; ++s) {
      std::vector<int> cells(88);
      for (int c = 0; c < 88; ++c) cells[static_cast<std::size_t>(c)] = c;
      std::string csv = "performer,col,row\n";
      for (std::uint64_t p = 0; p < 9; ++p) {
        std::swap(cells[p], cells[p + rng.below(88 - p)]);
        csv += std::to_string(p + 1) + "," + std::to_string(cells[p] % 11) + "," + std::to_string(cells[p] / 11) + "\n";
      }
      folder_.write("show/" + std::to_string(s) + ".csv", csv);
      yaml += "  - {name: s" + std::to_string(s) + ", from: {cells: " + std::to_string(s) + ".csv}, start: count " +
              std::to_string(1 + 20 * s) + ", hold: 4 counts}\n";
    }
    folder_.write("show/show.yaml", yaml);
    const std::string n = std::to_string(seed);
    if (test::footlight({"plan", path("show/show.yaml")}).status != 0) continue;
    export_drone("show", n + "a.zip");
    const test::Ran ran = test::footlight(
        {"import", path(n + "a.zip"), "-o", path(n), "--like", path("show/show.yaml"), "--between-counts", "--json"});
    ASSERT_EQ(ran.status, 0) << ran.err;
    const json told = json::parse(ran.out);
    ASSERT_EQ(test::footlight({"export", path(n) + "/show.yaml", "--drone", path(n + "b.zip")}).status, 0);
    const bool equal = folder_.read(n + "a.zip") == folder_.read(n + "b.zip");
    if (equal) {
      EXPECT_EQ(told["plan"]["as_in_file"], true) << "seed " << n;
      ++same;
    }
    if (!told["plan"]["as_in_file"].get<bool>()) {
      EXPECT_FALSE(equal) << "seed " << n;
    }
  }
  EXPECT_GT(same, 0U);
}

TEST_F(ImportCommand, DrillCoordinatesWithTheirMusicMakeAShow) {
  folder_.write("field.csv",
                "Label,Set,Counts,Side 1-Side 2,Front-Back\n"
                "B1,1,0,Side 1: 4.0 steps outside 45 yd ln,On Front Hash (CH)\n"
                "B1,2,16,Side 1: On 45 yd ln,4.0 steps behind Front Hash (CH)\n"
                "B2,1,0,Side 2: 4.0 steps outside 45 yd ln,On Front Hash (CH)\n"
                "B2,2,16,Side 2: On 45 yd ln,4.0 steps behind Front Hash (CH)\n");
  folder_.write(
      "march.musicxml",
      "<score-partwise><part-list/><part id=\"P1\"><measure number=\"1\"><attributes><divisions>1</divisions>"
      "<time><beats>2</beats><beat-type>4</beat-type></time></attributes><sound tempo=\"120\"/><note><rest/>"
      "<duration>2</duration></note></measure>"
      "<measure number=\"2\"><direction><direction-type><words>rit.</words></direction-type></direction><note>"
      "<rest/><duration>2</duration></note></measure>" +
          [] {
            std::string more;
            for (int k = 3; k <= 12; ++k) {
              more += "<measure>";
              if (k == 9) {
                more +=
                    "<direction><direction-type><rehearsal>A</rehearsal></direction-type></direction><sound "
                    "tempo=\"96\"/>";
              }
              more += "<note><rest/><duration>2</duration></note></measure>";
            }
            return more;
          }() +
          "</part></score-partwise>");
  const test::Ran ran = test::footlight({"import", path("field.csv"), path("march.musicxml"), "-o", path("drill")});
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_EQ(without(ran.out, folder_.path().string() + "/"),
            "march.musicxml: 24 counts, 0:13.0, 1 changes of tempo, 0 of meter, 1 rehearsal marks\n"
            "2 people, 2 formations to count 17; 29 x 39 cells of 0.5715 m\n"
            "everything lies 0.28575 m farther upstage than in the file\n"
            "drill/show.yaml\n\nnext:\n  footlight check drill/show.yaml\n  footlight plan drill/show.yaml\n");
  EXPECT_EQ(ran.err, "note: not kept: \"rit.\": words do not change the tempo, marks do\n");
  EXPECT_THAT(folder_.read("drill/show.yaml"),
              HasSubstr("  - {name: \"A (set 2)\", from: {cells: formations/002.csv}, start: count 17}\n"));
  const test::Ran plan = test::footlight({"plan", path("drill/show.yaml"), "--json"});
  EXPECT_EQ(plan.status, 0) << plan.err;
}

TEST_F(ImportCommand, MusicAloneIsPrintedAsAKey) {
  const test::Ran made =
      test::run_program({"/usr/bin/python3", "-c",
                         "import sys\ntry:\n  import mido\nexcept ImportError: sys.exit(77)\n"
                         "m = mido.MidiFile(ticks_per_beat=480); t = mido.MidiTrack(); m.tracks.append(t)\n"
                         "t.append(mido.MetaMessage('set_tempo', tempo=500000)); "
                         "t.append(mido.MetaMessage('time_signature', numerator=3, denominator=4))\n"
                         "t.append(mido.MetaMessage('marker', text='B', time=480 * 6)); "
                         "t.append(mido.MetaMessage('set_tempo', tempo=600000))\n"
                         "t.append(mido.MetaMessage('end_of_track', time=480 * 6)); m.save(sys.argv[1])\n",
                         path("song.mid")});
  if (made.status == 77) GTEST_SKIP() << "python3-mido is not here";
  ASSERT_EQ(made.status, 0) << made.err;
  const test::Ran ran = test::footlight({"import", path("song.mid")});
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_EQ(without(ran.out, folder_.path().string() + "/"),
            "song.mid: 12 counts, 0:06.6, 1 changes of tempo, 0 of meter, 1 rehearsal marks\n\n"
            "music:\n  meter: 3/4\n  changes:\n    - {at: count 1, tempo: 120}\n    - {at: count 7, tempo: 100}\n"
            "  # count 7 (measure 3:1): B\n");
  const json told = json::parse(test::footlight({"import", path("song.mid"), "--json"}).out);
  EXPECT_EQ(told["kind"], "music");
  EXPECT_EQ(told["music"]["rehearsal_marks"][0]["measure"], "3:1");
  EXPECT_EQ(told["music"]["changes"][1]["time_s"], 3.0);
}

TEST_F(ImportCommand, WrongInputIsRefusedAndLeavesNothing) {
  folder_.write("a.csv", "name,x,y\na,0.5,0.5\nb,0.5,0.5\n");
  folder_.write("off.csv", "name,x,y\na,0.5,0.5\nb,1.8,0.5\n");
  folder_.write("t.csv", "Time_msec,x_m,y_m,z_m,R,G,B\n0,0.5,0.5,0,1,1,1\n1300,1.5,0.5,0,1,1,1\n");
  const auto before = folder_.names();
  EXPECT_EQ(error_of({path("a.csv"), "-o", path("new")}),
            "a.csv:3:3: error: performers a and b both stand on D1 in formation 1 (count 1) (the first in a.csv:2; "
            "one person on each cell)\n");
  EXPECT_EQ(error_of({path("off.csv"), "-o", path("new"), "--pitch", "1 m"}),
            "off.csv:3:3: error: x 1.8 m, y 0.5 m is no middle of a cell: F1 is 0.300 m away on a grid of 1 m "
            "(another --pitch, or --snap '0.30 m' to move people that far)\n");
  EXPECT_THAT(error_of({path("t.csv"), "-o", path("new")}), HasSubstr("the first is 1300 ms, count 3.6"));
  EXPECT_EQ(error_of({path("t.csv"), path("off.csv"), "-o", path("new")}),
            "error: 'off.csv' is a list of places, and 't.csv' is somebody's track (one or the other)\n");
  EXPECT_EQ(error_of({path("off.csv")}), "error: say where the show belongs: -o FOLDER\n");
  EXPECT_EQ(error_of({path("off.csv"), "-o", path("show")}),
            "error: 'show' is there already (an imported show wants a new folder)\n");
  EXPECT_THAT(error_of({path("off.csv"), "-o", path("new"), "--snap", "1"}), HasSubstr("--snap: \"1\" has no unit"));
  EXPECT_THAT(error_of({path("missing.csv"), "-o", path("new")}), HasSubstr("missing.csv"));
  EXPECT_THAT(error_of({path("t.csv"), "-o", path("new"), "--like", path("show/show.yaml"), "--between-counts"}),
              HasSubstr("does not say where performer 1 of"));
  EXPECT_EQ(folder_.names(), before);
}

TEST_F(ImportCommand, AFolderThatCannotBeMadeIsTold) {
  folder_.write("a.csv", "name,x,y\na,0.5,0.5\nb,1.5,0.5\n");
  const test::Ran ran = test::footlight({"import", path("a.csv"), "-o", "/proc/no/show"});
  EXPECT_EQ(ran.status, 2);
  EXPECT_THAT(ran.err, HasSubstr("cannot make the folder '/proc/no/show': "));
}

}  // namespace
}  // namespace footlight::app
