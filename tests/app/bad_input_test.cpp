// SPDX-License-Identifier: Apache-2.0
//
// Each kind of bad input as a user meets it: one message with a place, whole, on stderr; nothing on stdout; nothing
// written. What the parts behind it refuse in detail has tests beside them (tests/config, planner, controller).
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/program.hpp"
#include "tests/support/starter_show.hpp"

namespace footlight {
namespace {

using nlohmann::json;
using test::footlight;
using test::Ran;
using ::testing::MatchesRegex;

constexpr const char* kRing = "{cells: ring.csv}, start: count 25, hold: 8 counts";

class BadInput : public test::StarterShow {
 protected:
  void replace_show(const std::string& text) { folder_.write("s/show.yaml", text); }
  /// The ring becomes a film of the test data. @param rest  more keys of `from`
  void ring_is_film(const std::string& file, const std::string& rest = "") {
    if (!file.empty()) std::filesystem::copy_file(FOOTLIGHT_TEST_DATA "/" + file, folder_ / "s/film.avi");
    replace(kRing, "{video: film.avi" + rest + "}, start: count 25, duration: 8 counts");
    as_made_ = files();
  }
  /// A show of one film and nothing else.
  void one_film(int people, const std::string& reserve) {
    std::filesystem::copy_file(FOOTLIGHT_TEST_DATA "/moving_square_40x30_12_frames_10fps.avi", folder_ / "s/film.avi");
    replace_show(
        "footlight: 1\n"
        "title: One film\n"
        "stage: {grid: {columns: 12, rows: 8}, reserve: [" +
        reserve + "]}\nperformers: {count: " + std::to_string(people) +
        "}\nsections:\n"
        "  - {name: film, from: {video: film.avi}, start: count 1, duration: 8 counts}\n");
    as_made_ = files();
  }
  void rig(const std::string& text) {
    folder_.write("s/rig.yaml", text);
    replace("# rig: rig.yaml", "rig: rig.yaml");
    as_made_ = files();
  }

  /// `message` may name the show's folder as @. Everything that plans must refuse alike.
  void expect_refused(int status, std::string message,
                      const std::vector<std::string>& commands = {"check", "plan", "export", "dryrun"}) {
    for (std::size_t at = message.find('@'); at != std::string::npos; at = message.find('@')) {
      message.replace(at, 1, folder_ / "s");
    }
    for (const std::string& command : commands) {
      std::vector<std::string> arguments = {command, show_};
      if (command != "check" && command != "plan") arguments.emplace_back("-q");
      if (command == "export") arguments.insert(arguments.end(), {"--csv", folder_ / "s/csv"});
      if (command == "dryrun") arguments.insert(arguments.end(), {"--trace", folder_ / "s/trace"});
      const Ran ran = footlight(arguments);
      EXPECT_EQ(ran.status, status) << command;
      EXPECT_EQ(ran.err, message + "\n") << command;
      // A plan that could be made but is refused is told all the same: its table says where it fails.
      if (status == 2) {
        EXPECT_EQ(ran.out, "") << command;
      }
      EXPECT_EQ(files(), as_made_) << command;
    }
  }
};

TEST_F(BadInput, AMissingVideo) {
  ring_is_film("");
  expect_refused(2,
                 "@/show.yaml:26:32: error: sections[1].from.video: the file \"film.avi\" is missing (looked for "
                 "@/film.avi)");
}

TEST_F(BadInput, AVideoThatCannotBeDecoded) {
  folder_.write("s/film.avi", "this is no film");
  ring_is_film("");
  expect_refused(2,
                 "@/show.yaml:26:5: error: sections[1].from.video: '@/film.avi' cannot be decoded as a video (a whole "
                 "file is needed: MP4, MOV, Matroska, WebM, AVI, Ogg, GIF or MPEG, with a video stream)");
}

TEST_F(BadInput, AFrameSizeOfZero) {
  ring_is_film("two_frames_of_0x0.avi");
  expect_refused(2,
                 "@/show.yaml:26:5: error: sections[1].from.video: '@/film.avi' has frames of 0 x 0 pixels (at least "
                 "1 x 1 is needed)");
}

TEST_F(BadInput, AVideoWithFewerThanTwoFrames) {
  ring_is_film("one_frame_8x8.avi");
  expect_refused(2,
                 "@/show.yaml:26:5: error: sections[1].from.video: '@/film.avi' gives 1 frame here (a video needs at "
                 "least two; a single picture is an image)");
}

TEST_F(BadInput, ARangeBeyondTheEndOfAVideo) {
  ring_is_film("moving_square_40x30_12_frames_10fps.avi", ", frames: 3-12");
  expect_refused(2,
                 "@/show.yaml:26:5: error: sections[1].from.video: '@/film.avi' has 12 frames, frames 3 to 12 reach "
                 "beyond its end (frames count from 0, the last is 11)");
}

TEST_F(BadInput, MorePeopleThanThePictureAndTheReserveHold) {
  one_film(60, "A1:B4");
  expect_refused(2,
                 "@/show.yaml:6:5: error: sections[0]: 60 performers, but the largest picture of '@/film.avi' holds "
                 "36 and the reserve 8 (at least 16 more reserve cells, a larger floor, fit: area, or fewer "
                 "performers)");
}

TEST_F(BadInput, MorePeopleThanTheFloorHolds) {
  one_film(97, "A1:B4");
  expect_refused(2,
                 "@/show.yaml:4:21: error: performers.count: 97 performers and only 96 cells that are not blocked (a "
                 "larger grid, or fewer people)");
}

TEST_F(BadInput, ASectionThatCannotBeWalkedAtItsSpeed) {
  make_unwalkable();
  expect_refused(3,
                 "@/show.yaml:26:5: error: sections[1]: performer 8 would walk 6.1 m from H2 to G8 between count 9 and "
                 "count 10 at 10.1 m/s, 7.2 times the limit of 1.4 m/s (start the section 7 counts later, hold the one "
                 "before shorter, or slow the music to 13 counts a minute)");
}

TEST_F(BadInput, SectionsThatOverlap) {
  replace("start: count 25", "start: count 8.5");
  expect_refused(2,
                 "@/show.yaml:26:5: error: sections[1].start: section \"ring\" starts at count 8.5, and section "
                 "\"line\" lasts until count 9 (start it at count 9 or later)");
}

TEST_F(BadInput, ACellOffTheGrid) {
  replace("  clearance: 0.5 m ", "  blocked: [A1, M2]\n  clearance: 0.5 m ");
  expect_refused(2, "@/show.yaml:12:17: error: stage.blocked[1]: the cell M2 is off the grid (A1 to L8)");
}

TEST_F(BadInput, ACellOffTheGridInACellsFile) {
  std::string cells = folder_.read("s/ring.csv");
  const std::size_t second = cells.find("\n2,");
  ASSERT_NE(second, std::string::npos);
  folder_.write("s/ring.csv", cells.replace(second, cells.find('\n', second + 1) - second, "\n2,12,0"));
  expect_refused(2, "@/ring.csv:4:3: error: column 12, row 0 is off the grid (columns 0 to 11, rows 0 to 7)");
}

TEST_F(BadInput, AMarkerGivenTwice) {
  rig("rig: 1\nbuses: [{name: a, url: \"sim://can\"}]\nnodes:\n"
      "  - {bus: a, address: 1, channels: [A1, B1]}\n"
      "  - {bus: a, address: 2, channels: [B1]}\n"
      "floor: {buses: a}\n");
  expect_refused(2,
                 "@/rig.yaml:5:37: error: nodes[1].channels[0]: the cell B1 is given a second lamp (the first stands "
                 "in line 4)");
}

TEST_F(BadInput, ANodeWith33Channels) {
  rig("rig: 1\nbuses: [{name: a, url: \"sim://can\"}]\nnodes:\n"
      "  - {bus: a, address: 1, channels: [A1:K3]}\n"
      "floor: {buses: a}\n");
  expect_refused(2,
                 "@/rig.yaml:4:36: error: nodes[0].channels: the node has 33 channels (at most 32; give the others to "
                 "another node)");
}

TEST_F(BadInput, ABusThatCannotCarryItsCuesInTime) {
  rig("rig: 1\nbuses: [{name: a, url: \"sim://rtu\", bits_per_second: 1200}]\nfloor: {buses: a}\n");
  const std::string cannot =
      "@/rig.yaml:2:9: error: buses[0]: the modbus-rtu bus \"a\" at 1200 bit/s cannot carry switch 3 \"ring at "
      "count 9\" (count 9, 4.800 s) in time: preloads of 3 nodes that change 1595.0 ms + 3 receipts of the "
      "switch before 880.0 ms + 2 latches 339.2 ms + 10 heartbeats ";
  const std::string before =
      "; the switch before is 2400.0 ms earlier, of which 1680.0 ms may be used and 30 % stay in reserve; 4 of 7 "
      "switches do not fit (raise the bit rate, which does not shorten silences and turnarounds";
  expect_refused(
      3, cannot + "1512.5 ms = 4326.7 ms" + before + ", or leave 49.37 counts between these switches instead of 4.00)",
      {"dryrun"});
  // A run says besides who leads, and that alone takes more than the line has.
  expect_refused(3, cannot + "3208.3 ms = 6022.5 ms" + before + ")", {"check"});
}

TEST_F(BadInput, EveryBusThatCannotCarryItsCuesIsNamed) {
  rig("rig: 1\nbuses:\n  - {name: a, url: \"sim://rtu\", bits_per_second: 1200}\n"
      "  - {name: b, url: \"sim://rtu\"}\n  - {name: c, url: \"sim://rtu\", bits_per_second: 1200}\n"
      "floor: {buses: [a, b, c], channels_per_node: 4}\n");
  const Ran ran = footlight({"check", show_});
  EXPECT_EQ(ran.status, 3);
  EXPECT_THAT(ran.err,
              MatchesRegex(".*/rig.yaml:3:5: error: buses\\[0\\]: .*\n.*/rig.yaml:5:5: error: buses\\[2\\]: .*\n"));
  EXPECT_EQ(json::parse(footlight({"check", "--json", show_}).out)["ok"], false);
}

TEST_F(BadInput, ACueThatPlaysAnEarlierSection) {
  replace("section: arrow, name: Arrow", "section: line, name: Arrow");
  expect_refused(2,
                 "@/show.yaml:34:28: error: cues[2].section: cue 3 plays section \"line\", which does not come after "
                 "section \"ring\" of cue 2 (cues play their sections in the order of the show, each section once)");
}

TEST_F(BadInput, AnAliasThatContainsItself) {
  replace_show("footlight: 1\nstage: &x [*x]\n");
  expect_refused(2,
                 "@/show.yaml:2:12: error: this alias stands inside of what it repeats (an alias cannot contain "
                 "itself)");
}

TEST_F(BadInput, AnAliasBomb) {
  std::string text = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i <= 20; ++i) {
    const std::string below = "*a" + std::to_string(i - 1);
    text += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [";
    for (int k = 0; k < 9; ++k) text += below + ", ";
    text += below + "]\n";
  }
  replace_show(text);
  expect_refused(2,
                 "@/show.yaml:6:10: error: the file has more than 200000 values, aliases expanded (long data belong in "
                 "CSV files)");
}

TEST_F(BadInput, YamlThatIsNestedTooDeep) {
  replace_show("stage: " + std::string(100'000, '['));
  expect_refused(2,
                 "@/show.yaml:1:32: error: lists and mappings are nested too deep (at most 24 levels and 256 KiB; long "
                 "data belong in CSV files)");
}

TEST_F(BadInput, AShowOf100Megabytes) {
  replace_show("");
  std::filesystem::resize_file(show_, 100'000'000);  // a hole: no block of it is on the disk
  expect_refused(
      2,
      "@/show.yaml: error: the file \"@/show.yaml\" has 100000000 bytes, more than 1048576 (long data belong "
      "in CSV files)");
}

}  // namespace
}  // namespace footlight
