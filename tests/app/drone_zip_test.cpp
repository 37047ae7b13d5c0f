// SPDX-License-Identifier: Apache-2.0
#include "app/drone_zip.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
