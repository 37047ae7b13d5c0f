// SPDX-License-Identifier: Apache-2.0
//
// Films and pictures as a director meets them, decoded again by another program.
#include <algorithm>
#include <cmath>
#include <csignal>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/paper/preview.hpp"
#include "config/plan_file.hpp"
#include "tests/support/starter_show.hpp"

namespace footlight {
namespace {

using test::footlight;
using test::Ran;
using ::testing::EndsWith;
using ::testing::HasSubstr;

constexpr int kWidth = 640;
constexpr int kHeight = 480;
constexpr double kRate = 5;

class PreviewCommand : public test::PlannedStarterShow {};

/// Middles of the coloured blobs of a frame, red, green and blue by turns.
std::vector<Point> dots_in(const std::string& frame) {
  std::vector<bool> bright(static_cast<std::size_t>(kWidth) * kHeight);
  for (std::size_t i = 0; i < bright.size(); ++i) {
    const auto channel = [&](std::size_t c) { return static_cast<int>(static_cast<unsigned char>(frame[3 * i + c])); };
    const auto [low, high] = std::minmax({channel(0), channel(1), channel(2)});
    bright[i] = high - low > 100;
  }
  std::vector<Point> out;
  for (std::size_t first = 0; first < bright.size(); ++first) {
    if (!bright[first]) continue;
    std::vector<std::size_t> left{first};
    bright[first] = false;
    double x = 0;
    double y = 0;
    double n = 0;
    while (!left.empty()) {
      const std::size_t i = left.back();
      left.pop_back();
      x += static_cast<double>(i % kWidth) + 0.5;
      y += static_cast<double>(i / kWidth) + 0.5;
      ++n;
      for (const std::size_t j : {i - 1, i + 1, i - kWidth, i + kWidth}) {
        if (j >= bright.size() || !bright[j]) continue;
        bright[j] = false;
        left.push_back(j);
      }
    }
    if (n > 50) out.push_back({x / n, y / n});
  }
  return out;
}

TEST_F(PreviewCommand, FirstMiddleAndLastFrameHaveEverybodyInPlace) {
  const std::string film = folder_ / "show.mp4";
  const Ran ran = footlight({"preview", show_, "-o", film, "--size", "640x480", "--rate", "5"});
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("show.mp4: plan "));
  const Ran decoded = test::run_program(
      {"ffmpeg", "-loglevel", "error", "-i", film, "-f", "rawvideo", "-pix_fmt", "rgb24", folder_ / "raw"});
  ASSERT_EQ(decoded.status, 0) << decoded.err;
  const std::string raw = folder_.read("raw");
  constexpr std::size_t kBytes = std::size_t{3} * kWidth * kHeight;
  ASSERT_EQ(raw.size() % kBytes, 0U);
  const std::size_t frames = raw.size() / kBytes;
  const Plan plan = config::load_plan(plan_).value();
  const double last_s = to_seconds(plan.sections.back().end);
  ASSERT_EQ(frames, static_cast<std::size_t>(std::floor(last_s * kRate + 1e-9)) + 1);
  // The groups' colours, as another program decodes them: #FF69B4 and #00A0FF.
  const auto pixel_at = [&](Point at) {
    const std::size_t i = 3 * (static_cast<std::size_t>(at.y) * kWidth + static_cast<std::size_t>(at.x));
    return std::vector<int>{static_cast<unsigned char>(raw[i]), static_cast<unsigned char>(raw[i + 1]),
                            static_cast<unsigned char>(raw[i + 2])};
  };
  const app::Stamp stamp(plan);
  Show show;
  const app::PreviewFrame drawn(plan, show, stamp, {}, {}, kWidth, kHeight);
  const auto looks_like = [&](std::size_t who, const std::vector<int>& colour) {
    const std::vector<int> seen =
        pixel_at(drawn.preview().view().at(position_at(plan.stage.grid, plan.tracks[who], kStart)));
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], colour[c], 8) << "performer " << who << ", channel " << c;
  };
  looks_like(0, {0xFF, 0x69, 0xB4});
  looks_like(11, {0x00, 0xA0, 0xFF});
  for (const std::size_t frame : {std::size_t{0}, frames / 2, frames - 1}) {
    const std::vector<Point> dots = dots_in(raw.substr(frame * kBytes, kBytes));
    EXPECT_EQ(dots.size(), 12U) << "frame " << frame;
    for (const auto& track : plan.tracks) {
      const Point there = position_at(plan.stage.grid, track, instant_at(static_cast<double>(frame) / kRate));
      const Point at = drawn.preview().view().at(there);
      const auto near = std::ranges::count_if(dots, [&](Point dot) { return distance(dot, at) < 1; });
      EXPECT_EQ(near, 1) << "frame " << frame << ", " << at.x << " " << at.y;
    }
  }
}

TEST_F(PreviewCommand, DrawsPicturesAsPngAndSvg) {
  const Ran png = footlight({"preview", show_, "-o", folder_ / "a.png", "--view", "audience", "--formation", "ring/1"});
  EXPECT_EQ(png.status, 0) << png.err;
  EXPECT_EQ(folder_.read("a.png").substr(1, 3), "PNG");
  const Ran svg = footlight({"preview", show_, "-o", folder_ / "a.svg", "--contact-sheet", "--size", "800x600"});
  EXPECT_EQ(svg.status, 0) << svg.err;
  EXPECT_THAT(folder_.read("a.svg"), HasSubstr("<svg"));
  const Ran again = footlight({"preview", show_, "-o", folder_ / "b.svg", "--contact-sheet", "--size", "800x600"});
  EXPECT_EQ(again.status, 0);
  EXPECT_EQ(folder_.read("a.svg"), folder_.read("b.svg"));
}

TEST_F(PreviewCommand, SaysAsJsonWhatItWrote) {
  const Ran film = footlight({"preview", show_, "-o", folder_ / "a.mp4", "--size", "64x64", "--rate", "2", "--from",
                              "9", "--to", "19", "--json"});
  ASSERT_EQ(film.status, 0) << film.err;
  const auto told = nlohmann::json::parse(film.out);
  EXPECT_EQ(told["files"], nlohmann::json{folder_ / "a.mp4"});
  EXPECT_EQ(told["plan"], app::Stamp(config::load_plan(plan_).value()).plan);
  EXPECT_EQ(told["frames"], 13) << "six seconds of ten counts";
  EXPECT_NEAR(told["from_s"].get<double>(), 4.8, 1e-9);
  const auto picture =
      nlohmann::json::parse(footlight({"preview", show_, "-o", folder_ / "a.png", "--at", "9", "--json"}).out);
  EXPECT_NEAR(picture["at_s"].get<double>(), 4.8, 1e-9);
  EXPECT_FALSE(picture.contains("frames"));
}

TEST_F(PreviewCommand, SaysWhatIsWrongAndLeavesNothing) {
  const auto fails = [&](std::vector<std::string> more, const std::string& message) {
    more.insert(more.begin(), {"preview", show_});
    const Ran ran = footlight(more);
    EXPECT_EQ(ran.status, 2);
    EXPECT_EQ(ran.err, "error: " + message + "\n");
  };
  const std::string film = folder_ / "s/x.mp4";
  fails({"-o", folder_ / "s/x.gif"},
        "'" + (folder_ / "s/x.gif") + "': a preview is a file that ends with .mp4, .png or .svg");
  fails({"-o", film, "--size", "12"}, "--size: \"12\" is no size (WIDTHxHEIGHT as 1280x720, each 64 to 7680)");
  fails({"-o", film, "--size", "641x480"}, "--size: 641x480 is odd (a film's width and height are even)");
  fails({"-o", film, "--at", "3"},
        "--at, --formation and --contact-sheet are for pictures (.png, .svg), --from and --to for films");
  fails({"-o", film, "--from", "300"},
        "nothing of the show is in the range of --from and --to (it goes from count 1 to count 57)");
  fails({"-o", folder_ / "s/x.png", "--formation", "rin/1"},
        "--formation: there is no formation \"rin/1\" (did you mean \"ring/1\"?)");
  fails({"-o", folder_ / "nowhere/x.mp4"},
        "cannot write '" + (folder_ / "nowhere/x.mp4") + "': No such file or directory");
  expect_no_half_file();
}

TEST_F(PreviewCommand, WithoutFfmpegItSaysWhatToInstall) {
  const Ran ran =
      test::run_program({"env", "PATH=/nowhere", FOOTLIGHT_PROGRAM, "preview", show_, "-o", folder_ / "s/x.mp4"});
  EXPECT_EQ(ran.status, 2);
  EXPECT_EQ(ran.err, "error: cannot write '" + (folder_ / "s/x.mp4") +
                         "': the program ffmpeg is not installed (apt-get install ffmpeg)\n");
  expect_no_half_file();
}

TEST_F(PreviewCommand, AFullDiskIsToldAndLeavesNoHalfFile) {
  const Ran ran = test::run_program({"sh", "-c", "ulimit -f 8; exec \"$0\" \"$@\"", FOOTLIGHT_PROGRAM, "preview", show_,
                                     "--size", "320x240", "--rate", "10", "-o", folder_ / "s/x.mp4"});
  EXPECT_EQ(ran.status, 2);
  EXPECT_THAT(ran.err, HasSubstr("cannot write '" + (folder_ / "s/x.mp4") + "': ffmpeg: "));
  expect_no_half_file();
}

TEST_F(PreviewCommand, ADiskThatFillsUpIsNamed) {
  const std::string disk = folder_ / "disk";
  std::filesystem::create_directory(disk);
  const std::string mount = "mount -t tmpfs -o size=64k tmpfs " + disk;
  if (test::run_program({"unshare", "-rm", "sh", "-c", mount}).status != 0) GTEST_SKIP() << "no disk can be made here";
  const Ran ran =
      test::run_program({"unshare", "-rm", "sh", "-c", mount + " && \"$0\" \"$@\"; s=$?; ls -A " + disk + "; exit $s",
                         FOOTLIGHT_PROGRAM, "preview", show_, "--rate", "10", "-o", disk + "/x.mp4"});
  EXPECT_EQ(ran.status, 2);
  EXPECT_THAT(ran.err, HasSubstr("cannot write '" + disk + "/x.mp4': ffmpeg: "));
  EXPECT_THAT(ran.err, HasSubstr("No space left on device"));
  EXPECT_EQ(ran.out, "") << "no half file";
}

TEST_F(PreviewCommand, AnInterruptionLeavesNothing) {
  const Ran ran = test::run_program(
      {FOOTLIGHT_PROGRAM, "preview", show_, "-o", folder_ / "s/x.mp4", "--size", "3840x2160", "--rate", "120"}, {},
      [&](pid_t pid) {
        const Names before = files();
        const auto begun = [&] { return files() != before; };
        for (int i = 0; i < 2000 && !begun(); ++i) usleep(5000);
        kill(pid, SIGINT);
      });
  EXPECT_EQ(ran.status, 130);
  EXPECT_EQ(ran.err, "error: interrupted while filming; nothing was written\n");
  expect_no_half_file();
}

}  // namespace
}  // namespace footlight
