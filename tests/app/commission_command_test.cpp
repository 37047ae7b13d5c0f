// SPDX-License-Identifier: Apache-2.0
//
// `footlight commission` as a technician meets it: answers on stdin, films in files, rigs that are written.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "app/commission/wipe_record.hpp"
#include "app/planar_frame.hpp"
#include "app/video_writer.hpp"
#include "config/rig_file.hpp"
#include "tests/app/commission/filmed_floor.hpp"
#include "tests/support/program.hpp"

namespace footlight {
namespace {

using nlohmann::json;
using test::footlight;
using test::Ran;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* kShow =
    "footlight: 1\n"
    "title: A floor\n"
    "stage: {grid: {columns: 12, rows: 7, pitch: 1 m}, blocked: [F1:G1]}\n"
    "performers: {count: 4}\n"
    "rig: rig.yaml\n"
    "sections:\n"
    "  - {name: line, from: {cells: line.csv}, start: count 1, hold: 8 counts}\n";

constexpr const char* kRig =
    "rig: 1\n"
    "buses:\n"
    "  - {name: left, url: \"can://can0\"}\n"
    "  - {name: right, url: \"sim://serial\"}\n"
    "nodes:\n"
    "  - {name: odd, bus: right, address: 40, channels: [L7, unused]}\n"
    "floor: {buses: [left, right], channels_per_node: 8}\n";

class Commission : public testing::Test {
 protected:
  Commission() {
    folder_.write("show.yaml", kShow);
    folder_.write("rig.yaml", kRig);
    folder_.write("line.csv", "performer,cell\n1,A1\n2,B1\n3,C1\n4,D1\n");
  }
  /// Runs it in the show's folder, with these lines on stdin.
  Ran run(const std::vector<std::string>& arguments, const std::string& typed = "") {
    folder_.write("typed", typed);
    std::string command = "cd '" + folder_.path().string() + "' && '" FOOTLIGHT_PROGRAM "' commission";
    for (const std::string& argument : arguments) command += " '" + argument + "'";
    return test::run_program({"sh", "-c", command + " < typed"});
  }
  [[nodiscard]] Rig read(const std::string& name) const {
    Show show;
    show.stage.grid = grid_;
    show.stage.blocked = {grid_.index({5, 0}), grid_.index({6, 0})};
    Diagnostics diagnostics;
    std::vector<std::string> files;
    Rig rig = config::read_rig(folder_ / name, show, true, diagnostics, files);
    EXPECT_FALSE(diagnostics.has_errors()) << diagnostics.to_text();
    return rig;
  }
  [[nodiscard]] bool is_there(const std::string& name) const { return std::filesystem::exists(folder_ / name); }

  test::TemporaryFolder folder_;
  Grid grid_ = Grid::make(GridKind::square, 12, 7, 1).value();
};

TEST_F(Commission, AWalkAsksWritesAndGoesOnAfterAKill) {
  const Ran first = run({"walk", "show.yaml", "--sim", "-o", "new.yaml"}, "\nB9\nB2\nd\nq\n");
  EXPECT_EQ(first.status, 0) << first.err;
  EXPECT_EQ(first.out,
            "1 of 83: left-1/0 should be on A1\n"
            "2 of 83: left-1/1 should be on B1\n"
            "2 of 83: left-1/1 should be on B1\n"
            "3 of 83: left-1/2 should be on C1\n"
            "4 of 83: left-1/3 should be on D1\n");
  EXPECT_EQ(first.err,
            "note: the lamps are simulated\n"
            "note: B9 is beyond the stage (its last cell is L7)\n"
            "note: 3 of 83 lamps have their answers, in new.yaml.walk: the same command goes on\n");
  EXPECT_FALSE(is_there("new.yaml"));
  // A kill in the middle of a line.
  std::ofstream(folder_ / "new.yaml.walk", std::ios::app) << "3 left-1/";

  std::string rest;
  for (int i = 4; i <= 83; ++i) {
    if (i == 21) {
      rest += "B1\n";  // it should be on B2, where left-1/1 shines
    } else {
      rest += i == 83 ? "d\n" : "\n";
    }
  }
  const Ran second = run({"walk", "show.yaml", "--sim", "-o", "new.yaml", "--json"}, rest);
  EXPECT_EQ(second.status, 0) << second.err;
  EXPECT_THAT(second.err, HasSubstr("note: goes on after 3 of 83 lamps (new.yaml.walk)\n"));
  const json report = json::parse(second.out);
  EXPECT_EQ(report["exchanged"].size(), 1U) << second.out;
  EXPECT_EQ(report["dead"], json({"left-1/2"}));
  EXPECT_EQ(report["nowhere"], json({"odd/1"}));
  const Rig rig = read("new.yaml");
  EXPECT_EQ(rig.nodes[0].channels[1].cell, grid_.index({1, 1}));
  EXPECT_EQ(rig.nodes[0].channels[2].cell, grid_.index({2, 0})) << "a dead lamp keeps its cell";
  EXPECT_EQ(run({"walk", "show.yaml", "--sim", "-o", "new.yaml"}).err,
            "error: -o 'new.yaml' is there already (another name: no rig is ever overwritten)\n");
}

TEST_F(Commission, AWalkWhoseStdinClosesKeepsWhatWasSaid) {
  const Ran ran = run({"walk", "show.yaml", "--sim", "-o", "new.yaml", "--order", "bus"}, "\n\n");
  EXPECT_EQ(ran.status, 0);
  EXPECT_EQ(ran.err,
            "note: the lamps are simulated\n"
            "note: 2 of 83 lamps have their answers, in new.yaml.walk: the same command goes on\n");
  const Ran other = run({"walk", "show.yaml", "--sim", "-o", "new.yaml"});
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, StartsWith("note: the lamps are simulated\nerror: new.yaml.walk:1: it is the walk \""));
}

TEST_F(Commission, WipesAreKeptAndTellWhenTheRigHasChanged) {
  const Ran whole = run({"wipes", "show.yaml", "--sim"}, "a\n\n\n");
  EXPECT_EQ(whole.status, 0) << whole.err;
  EXPECT_EQ(whole.out, "all rows and columns are whole; not kept, for the lamps were simulated\n");
  const Ran broken = run({"wipes", "show.yaml", "--sim"}, "8\n3, 7\nAA\nC\n");
  EXPECT_EQ(broken.status, 4);
  EXPECT_EQ(broken.out, "");
  EXPECT_EQ(broken.err,
            "note: the lamps are simulated\n"
            "note: were all 7 rows whole? Enter: yes; a: again; numbers of rows: these were not\n"
            "note: \"8\" are no rows of this stage (as 3 7)\n"
            "note: were all 12 columns whole? Enter: yes; a: again; letters of columns: these were not\n"
            "note: \"AA\" are no columns of this stage (as C AA)\n"
            "error: not whole: row 3, row 7, column C (footlight commission gray or walk finds which lamps)\n");

  const std::string show = folder_ / "show.yaml";
  setenv("XDG_STATE_HOME", folder_.path().c_str(), 1);
  EXPECT_EQ(footlight({"devices", "list", show}).err, "") << "nobody has ever confirmed anything";
  ASSERT_TRUE(app::record_wipe(folder_.path() / "footlight", show, read("rig.yaml")));
  EXPECT_EQ(footlight({"devices", "list", show}).err, "");
  folder_.write("rig.yaml", std::string(kRig).replace(std::string(kRig).find("L7"), 2, "K7"));
  EXPECT_EQ(
      footlight({"devices", "list", show}).err,
      "note: the rig has changed since somebody saw all rows and columns of its lamps (footlight commission wipes " +
          show + ")\n");
  unsetenv("XDG_STATE_HOME");
}

TEST_F(Commission, TheSequenceIsPlayedOnSimulatedBuses) {
  const Ran ran = run({"gray", "show.yaml", "--sim"});
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_EQ(ran.out,
            "83 lamps have flashed their words of 15 bits in 17.6 s, 400 ms a step\n"
            "footlight commission gray show.yaml --film FILM -o RIG.yaml\n");
  const Ran dead = run({"gray", "show.yaml", "--sim", "--faults", "dead=1", "--seed", "3", "--step", "500ms"});
  EXPECT_EQ(dead.status, 4);
  EXPECT_THAT(dead.err, HasSubstr("note: 1 nodes do not say that they are dark: are they there?\n"));
}

TEST_F(Commission, WrongInputIsSaid) {
  const auto expect_error = [&](const std::vector<std::string>& arguments, const std::string& message) {
    const Ran ran = run(arguments);
    EXPECT_EQ(ran.status, 2) << ran.err;
    EXPECT_EQ(ran.err, "error: " + message + "\n");
    EXPECT_EQ(ran.out, "");
  };
  expect_error(
      {"gray", "show.yaml"},
      "no wire for these buses: right (a real URL in the rig or in --transport-map; --sim tries it on simulated "
      "lamps)");
  expect_error({"gray", "show.yaml", "--film", "nothing.mp4"}, "cannot read 'nothing.mp4': No such file or directory");
  expect_error(
      {"gray", "show.yaml", "--film", "show.yaml"},
      "'show.yaml' cannot be decoded as a video (a whole file is needed: MP4, MOV, Matroska, WebM, AVI, Ogg, GIF "
      "or MPEG, with a video stream)");
  expect_error({"gray", "show.yaml", "-o", "x.yaml"}, "-o: a rig is written from a film (--film FILM)");
  expect_error({"gray", "show.yaml", "--film", "f.mp4", "-o", "rig.yaml"},
               "-o 'rig.yaml' is there already (another name: no rig is ever overwritten)");
  expect_error({"gray", "show.yaml", "--film", "f.mp4", "-o", "nowhere/x.yaml"},
               "cannot write 'nowhere/x.yaml': No such file or directory");
  expect_error({"gray", "show.yaml", "--film", "f.mp4", "-o", "x.txt"}, "-o 'x.txt': a rig file ends in .yaml");
  expect_error({"gray", "show.yaml", "--film", "f.mp4", "--step", "1 ms"},
               "--step 1 ms: the buses and a film need 400 ms");
  expect_error({"gray", "show.yaml", "--film", "f.mp4", "--step", "soon"},
               "--step: \"soon\" is not a time (a time, as 400 ms, at most 10 s)");
  expect_error({"gray", "show.yaml", "--film", "f.mp4", "--from", "above"},
               "--from: \"above\" is no side of the stage (audience, stage-left, upstage, stage-right)");
  expect_error({"gray", "show.yaml", "--film", "f.mp4", "--corners", "1,2 3,4"},
               "--corners: \"1,2 3,4\" are not four places in pixels (as 102,655 1180,640 870,90 410,95)");
  expect_error({"walk", "show.yaml", "--faults", "loss=5%", "-o", "x.yaml"},
               "--faults: only simulated nodes have faults by name (with --sim)");
  EXPECT_FALSE(is_there("x.yaml.walk"));
}

/// A film as a telephone writes it: compressed, in a file.
void write_film(const tests::FilmedFloor& floor, const Grid& grid, const tests::PhoneChoice& choice,
                const std::string& file) {
  app::VideoWriter::Shape shape;
  shape.width = choice.width;
  shape.height = choice.height;
  shape.rate = choice.fps;
  auto writer = app::VideoWriter::open(file, shape);
  ASSERT_TRUE(writer) << writer.error().message;
  tests::Phone phone(choice, grid, floor.really());
  std::vector<unsigned char> planar;
  phone.film(
      floor.length_s(), [&](std::size_t lamp, double at_s) { return floor.lit(lamp, at_s); },
      [&](double, const cv::Mat& grey) {
        cv::Mat pixels;
        cv::cvtColor(grey, pixels, cv::COLOR_GRAY2BGRA);
        app::to_planar({pixels.data, pixels.total() * 4}, choice.width, choice.height, planar);
        ASSERT_TRUE(writer->write(planar));
      });
  ASSERT_TRUE(writer->finish());
}

TEST_F(Commission, AFilmTellsWhatIsExchangedTurnedAndDeadAndGivesTheRig) {
  const Rig rig = read("rig.yaml");
  const auto lamps = app::lamps_of(rig);
  const auto at = [&](const std::string& name) {
    for (std::size_t i = 0; i < lamps.size(); ++i) {
      if (app::lamp_name(rig, lamps[i].place) == name) return i;
    }
    ADD_FAILURE() << name;
    return std::size_t{0};
  };
  std::vector<CellIndex> really;
  for (const auto& lamp : lamps) really.push_back(lamp.cell.value_or(grid_.index({11, 6})));
  // The lamp of L7 was never assigned: it hangs on the other channel of its node; that one is dead.
  std::swap(really[at("left-1/3")], really[at("right-1/2")]);
  for (int c = 0; c < 4; ++c) {
    std::swap(really[at("left-3/" + std::to_string(c))], really[at("left-3/" + std::to_string(7 - c))]);
  }
  const tests::FilmedFloor floor(rig, grid_, really, {at("left-2/5"), at("odd/0")});
  tests::PhoneChoice choice;
  choice.width = 640;
  choice.height = 360;
  choice.fps = 25;
  choice.shake_px = 5;
  choice.noise = 4;
  write_film(floor, grid_, choice, folder_ / "phone.mp4");

  const Ran ran = run({"gray", "show.yaml", "--film", "phone.mp4", "-o", "new.yaml"});
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("lamps      83: 81 seen, 70 of them where the rig says\n"
                                 "turned     left-3: its lamps 0 to 7 hang the other way round\n"
                                 "exchanged  left-1/3 is on "));
  EXPECT_THAT(ran.out, HasSubstr("found      odd/1 is on L7, the rig did not know it\n"));
  EXPECT_THAT(ran.out, HasSubstr("dead       left-2/5 on "));
  EXPECT_THAT(ran.out, HasSubstr("rig        new.yaml\n"));
  EXPECT_THAT(ran.out, HasSubstr("seen from audience, placed by the rig"));
  const auto after = app::lamps_of(read("new.yaml"));
  for (std::size_t i = 0; i < lamps.size(); ++i) {
    if (i == at("odd/0")) {
      EXPECT_EQ(after[i].cell, std::nullopt) << "its cell is another lamp's";
    } else {
      EXPECT_EQ(after[i].cell, really[i]) << app::lamp_name(rig, lamps[i].place);
    }
  }

  folder_.write("rig.yaml", std::string(kRig).replace(std::string(kRig).find("address: 40"), 11, "address: 41"));
  const Ran other = run({"gray", "show.yaml", "--film", "phone.mp4"});
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, StartsWith("error: 'phone.mp4' shows the flash sequence of another rig: "));
}

TEST_F(Commission, FilmsOfNothingAndFilmsThatAreTooShortAreRefused) {
  const Rig rig = read("rig.yaml");
  std::vector<CellIndex> really;
  for (const auto& lamp : app::lamps_of(rig)) really.push_back(lamp.cell.value_or(grid_.index({11, 6})));
  const tests::FilmedFloor floor(rig, grid_, really);
  tests::PhoneChoice choice;
  choice.ends_s = 3.5;
  choice.fps = 20;
  write_film(floor, grid_, choice, folder_ / "short.mp4");
  EXPECT_EQ(
      run({"gray", "show.yaml", "--film", "short.mp4"}).err,
      "error: 'short.mp4' is too short: 5.0 s, and the sequence takes 17.6 s (film from before the first flash until "
      "after the last one)\n");
  choice.light = 0;
  write_film(floor, grid_, choice, folder_ / "dark.mp4");
  EXPECT_EQ(
      run({"gray", "show.yaml", "--film", "dark.mp4"}).err,
      "error: 'dark.mp4' shows no lamps: not a single point of light in 101 frames (the whole floor in the picture, "
      "the hall dark, the exposure fixed)\n");
}

}  // namespace
}  // namespace footlight
