// SPDX-License-Identifier: Apache-2.0
#include "app/import/drone_zip.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/full.hpp"
#include "tests/support/mutated.hpp"
#include "tests/support/program.hpp"
#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

using ::testing::HasSubstr;

TEST(DroneZip, IsReadBackEqual) {
  const tests::SmallShow cast = tests::random_show(24, 16, 30, 2, 4, 5);
  const auto tracks = drone_tracks(cast.plan, cast.show);
  ASSERT_EQ(tracks.size(), 30U);
  for (std::size_t p = 0; p < 30; ++p) {
    ASSERT_EQ(tracks[p].points.size(), cast.plan.tracks[p].size());
    for (const DronePoint& point : tracks[p].points) {
      const Instant at = Instant(milliseconds(point.time_ms));
      EXPECT_EQ(point.at, position_at(cast.plan.stage.grid, cast.plan.tracks[p], at));
    }
  }
  const auto zip = drone_zip(tracks);
  ASSERT_TRUE(zip) << zip.error();
  const auto back = read_drone_zip(*zip, "show.zip");
  ASSERT_TRUE(back) << back.error();
  EXPECT_EQ(*back, tracks);
  EXPECT_EQ(*drone_zip(tracks), *zip) << "the same tracks give the same bytes";
}

TEST(DroneZip, IsAZipForOtherProgramsToo) {
  const test::TemporaryFolder folder;
  const std::vector<DroneTrack> tracks{{"D1", {{0, {0.1, -2.5}, 0, {1, 2, 3}}, {1500, {7, 8}, 0, {0, 0, 0}}}},
                                       {"D10", {{0, {1, 1}, 0, {255, 255, 255}}}}};
  folder.write("show.zip", *drone_zip(tracks));
  const test::Ran ran = test::run_program({"python3", "-c",
                                           "import sys, zipfile\n"
                                           "z = zipfile.ZipFile(sys.argv[1])\n"
                                           "print(z.namelist(), z.testzip())\n"
                                           "print(z.read('D1.csv').decode())",
                                           folder / "show.zip"});
  EXPECT_EQ(ran.out,
            "['D1.csv', 'D10.csv'] None\nTime_msec,x_m,y_m,z_m,R,G,B\n0,0.1,-2.5,0,1,2,3\n1500,7,8,0,0,0,0\n\n")
      << ran.err;
}

TEST(DroneZip, WhatIsWrongIsToldWithItsPlace) {
  const auto error_of = [](const std::string& bytes) { return read_drone_zip(bytes, "x.zip").error().message; };
  EXPECT_THAT(error_of("no zip"), HasSubstr("'x.zip' is no zip that can be read: "));
  std::string whole = *drone_zip({{"a", {{0, {1, 1}, 0, {}}, {5, {1, 2}, 0, {}}}}});
  EXPECT_THAT(error_of(whole.substr(0, whole.size() / 2)), HasSubstr("'x.zip' is no zip that can be read: "));
  const auto late = drone_zip({{"a", {{5, {1, 1}, 0, {}}, {5, {1, 2}, 0, {}}}}});
  EXPECT_EQ(error_of(*late), "x.zip/a.csv:3:1: error: 5 ms is not later than the line before (times increase)");
}

/// A zip with any names and contents.
std::string zip_of(const test::TemporaryFolder& folder, const std::string& python) {
  const test::Ran ran = test::run_program(
      {"python3", "-c",
       "import sys, zipfile\nz = zipfile.ZipFile(sys.argv[1], 'w', zipfile.ZIP_DEFLATED)\n" + python + "\nz.close()\n",
       folder / "made.zip"});
  EXPECT_EQ(ran.status, 0) << ran.err;
  return folder.read("made.zip");
}

TEST(DroneZip, WhatWasMadeToHarmIsRefused) {
  const test::TemporaryFolder folder;
  const auto error_of = [&](const std::string& python) {
    const auto read = read_drone_zip(zip_of(folder, python), "x.zip");
    return read ? "read" : read.error().message;
  };
  const std::string harm = ", which is no name of a file inside of it (a zip that was made to harm?)";
  EXPECT_EQ(error_of("z.writestr('../../etc/passwd.csv', 'x')"), "'x.zip' holds \"../../etc/passwd.csv\"" + harm);
  EXPECT_EQ(error_of("z.writestr('/etc/a.csv', 'x')"), "'x.zip' holds \"/etc/a.csv\"" + harm);
  EXPECT_EQ(error_of("z.writestr('a/..\\\\b.csv', 'x')"), "'x.zip' holds \"a/..\\b.csv\"" + harm);
  // 64 MiB of nothing in 64 KiB.
  EXPECT_EQ(error_of("z.writestr('bomb.csv', b'0' * (64 << 20))"),
            "x.zip/bomb.csv: error: is more than 16777216 bytes when unpacked");
  EXPECT_EQ(error_of(""), "'x.zip' is empty (a zip of NAME.csv, one for each performer)");
  EXPECT_EQ(error_of("z.writestr('notes.txt', 'x')"),
            "x.zip/notes.txt: error: is no CSV file (a zip of NAME.csv, one for each performer)");
  const std::string header = "'Time_msec,x_m,y_m,z_m,R,G,B\\n";
  EXPECT_EQ(error_of("z.writestr('a.csv', " + header + "')"),
            "x.zip/a.csv: error: no line says where anybody is (Time_msec,x_m,y_m,z_m,R,G,B)");
  EXPECT_EQ(error_of("z.writestr('1/a.csv', " + header + "0,0,0,0,0,0,0')\nz.writestr('2/a.csv', " + header +
                     "0,0,0,0,0,0,0')"),
            "x.zip/2/a.csv: error: a second file of performer \"a\" (one file for each performer)");
  EXPECT_EQ(error_of("z.writestr('a.csv', " + header + "0,1,nan,0,0,0,256')"),
            "x.zip/a.csv:2:5: error: \"nan\" is no number of this column (-1000000 to 1000000)\n"
            "x.zip/a.csv:2:15: error: \"256\" is no number of this column (0 to 255)");
}

TEST(DroneZip, MutationsAreSurvived) {
  const tests::SmallShow cast = tests::random_show(12, 8, 6, 2, 3, 5);
  const std::string whole = *drone_zip(drone_tracks(cast.plan, cast.show));
  const std::uint64_t seeds = test::tries<std::uint64_t>(400, 20'000);
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const auto read = read_drone_zip(test::mutated(whole, Rng(seed)), "x.zip");
    if (!read) {
      EXPECT_NE(read.error().message.find("x.zip"), std::string::npos) << read.error();
    }
  }
}

TEST(DroneTracks, WhoWaitsInTheReserveIsBlack) {
  tests::SmallShow cast = tests::random_show(24, 16, 4, 1, 2, 5);
  cast.plan.sections[0].reserve = {cast.plan.tracks[0][0].cell};
  const auto tracks = drone_tracks(cast.plan, cast.show);
  EXPECT_EQ(tracks[0].points[0].colour, Colour{});
  EXPECT_EQ(tracks[0].points[1].colour, cast.show.groups[0].colour);
  EXPECT_EQ(tracks[1].points[0].colour, cast.show.groups[1].colour);
}

}  // namespace
}  // namespace footlight::app
