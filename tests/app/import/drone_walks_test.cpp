// SPDX-License-Identifier: Apache-2.0
#include "app/import/drone_walks.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/rng.hpp"

namespace footlight::app {
namespace {

using ::testing::ElementsAre;

DroneTrack track(const std::string& name, std::vector<DronePoint> points) {
  DroneTrack out{name, std::move(points), name + ".csv", {}};
  for (std::size_t i = 0; i < out.points.size(); ++i) out.lines.push_back(static_cast<int>(i) + 2);
  return out;
}
DronePoint at(std::int64_t ms, double x, double y, Colour colour = {9, 9, 9}) { return {ms, {x, y}, 0, colour}; }
WalkChoice at_120() { return {TempoMap(120), false, {}}; }
std::string error_of(const std::vector<DroneTrack>& tracks, const WalkChoice& choice = at_120()) {
  const auto walks = drone_walks(tracks, choice);
  if (!walks) return walks.error().message;
  const auto on = cells_of(walks->imported, walks->grid);
  return on ? "understood" : on.error().message;
}

TEST(DroneWalks, HoldsAndWalksBecomeFormations) {
  const auto walks = drone_walks({track("a", {at(0, 0.5, 0.5), at(2000, 0.5, 0.5), at(4000, 3.5, 0.5)}),
                                  track("b", {at(0, -0.5, 0.5), at(2000, -0.5, 0.5), at(4000, -2.5, 1.5)})},
                                 at_120());
  ASSERT_TRUE(walks) << walks.error();
  const auto& formations = walks->imported.formations;
  ASSERT_EQ(formations.size(), 2U);
  EXPECT_EQ(formations[0].count, 1);
  EXPECT_EQ(formations[0].hold_counts, 4);
  EXPECT_EQ(formations[1].count, 9);
  EXPECT_EQ(formations[1].places[1].at, (Point{-2.5, 1.5}));
  EXPECT_EQ(walks->grid.shift, Point{});
}

TEST(DroneWalks, SamplesOfStraightWalksAddNothing) {
  std::vector<DronePoint> a;
  std::vector<DronePoint> b;
  for (int k = 0; k <= 100;
       ++k) {  // 25 a second, walks of 2.8 m and back, rounded to millimetres as programs write them
    const double share = k <= 50 ? k / 50.0 : (100 - k) / 50.0;
    const auto rounded = [](double x) { return std::round(1000 * x) / 1000; };
    a.push_back(at(40 * k, rounded(0.7 + 2.8 * share), 0.7));
    b.push_back(at(40 * k, rounded(-0.7 - 2.8 * share), rounded(0.7 + 1.4 * share)));
  }
  const auto walks = drone_walks({track("a", a), track("b", b)}, at_120());
  ASSERT_TRUE(walks) << walks.error();
  ASSERT_EQ(walks->imported.formations.size(), 3U);
  EXPECT_EQ(walks->imported.formations[1].count, 5);
  EXPECT_NEAR(walks->imported.formations[1].places[0].at.x, 3.5, 1e-9);
}

TEST(DroneWalks, CellsThatSamplesHappenToLieOnAreNoFormations) {
  std::vector<DronePoint> a;
  for (int k = 0; k <= 16; ++k) a.push_back(at(250 * k, 0.5 + (k <= 8 ? k : 16 - k) / 2.0, 0.5));
  WalkChoice choice = at_120();
  choice.grid.pitch_m = 1;
  const auto walks = drone_walks({track("a", a)}, choice);
  ASSERT_TRUE(walks) << walks.error();
  ASSERT_EQ(walks->imported.formations.size(), 3U) << "every second sample is on a cell";
  EXPECT_EQ(walks->imported.formations[1].count, 5);
}

TEST(DroneWalks, ColoursAndHeightsThatAreNotKeptAreTold) {
  const auto walks = drone_walks(
      {track("a", {at(0, 0.5, 0.5, {}), {1000, {1.5, 0.5}, 2, {255, 0, 0}}, at(2000, 0.5, 0.5, {0, 0, 255})})},
      at_120());
  ASSERT_TRUE(walks) << walks.error();
  EXPECT_EQ(walks->imported.people[0].colour, (Colour{255, 0, 0}));
  EXPECT_EQ(walks->imported.dark, (std::vector<Point>{{0.5, 0.5}}));
  EXPECT_THAT(walks->imported.ignored,
              ElementsAre("heights (z_m): everybody stands on the floor",
                          "changes of colour, of 1 people: each has the first that is not black"));
}

TEST(DroneWalks, WhatIsNoShowIsRefused) {
  EXPECT_EQ(
      error_of({track("a", {at(0, 0.5, 0.5), at(2000, 1.5, 0.5)}), track("b", {at(0, 2.5, 0.5), at(1500, 2.5, 1.5)})}),
      "b.csv:3:1: error: b ends at 1500 ms, and a at 2000 ms (everybody's file covers the same time)");
  EXPECT_EQ(error_of({track("a", {at(0, 0.5, 0.5), at(2000, 1.5, 0.5)}),
                      track("b", {at(500, 2.5, 0.5), at(2000, 2.5, 1.5)})}),
            "b.csv:2:1: error: b begins at 500 ms, and a at 0 ms (everybody's file covers the same time)");
  EXPECT_EQ(
      error_of({track("a", {at(0, 0.5, 0.5), at(2000, 1.5, 0.5)}), track("b", {at(0, 2.5, 0.5), at(2000, 1.5, 0.5)})}),
      "b.csv:3:1: error: performers a and b both stand on G1 in formation 2 (count 5) (the first in a.csv:3; one "
      "person on each cell)");
  const std::vector<DroneTrack> between{track("a", {at(0, 0.5, 0.5), at(1300, 1.5, 0.5), at(2000, 0.5, 0.5)})};
  EXPECT_EQ(
      error_of(between),
      "a.csv: error: 1 of 3 formations begin or end on no count; the first is 1300 ms, count 3.6 (give the music's "
      "--tempo or its file, or keep the times as they are with --between-counts)");
  EXPECT_EQ(error_of(between, {TempoMap(120), true, {}}), "understood");
  WalkChoice pitch = at_120();
  pitch.grid.pitch_m = 1;
  EXPECT_EQ(error_of({track("a", {at(0, 0.5, 0.5), at(1000, 1.8, 0.5), at(2000, 0.5, 0.5)})}, pitch),
            "a.csv:3:1: error: x 1.8 m, y 0.5 m is no middle of a cell: F1 is 0.300 m away on a grid of 1 m (another "
            "--pitch, or --snap '0.30 m' to move people that far)");
}

TEST(DroneWalks, CountsHaveAsFewDecimalsAsTheMillisecondsAllow) {
  // A count at 97 a minute is 618.557 ms: nobody's milliseconds.
  const TempoMap tempo(97);
  std::vector<DronePoint> points;
  for (int count = 1; count <= 200; ++count) {
    points.push_back(at(std::llround(1000 * to_seconds(tempo.at(count))), 0.5 + count % 2, 0.5));
  }
  const auto walks = drone_walks({track("a", points)}, {tempo, false, {}});
  ASSERT_TRUE(walks) << walks.error();
  ASSERT_EQ(walks->imported.formations.size(), 200U);
  for (int k = 0; k < 200; ++k) EXPECT_EQ(walks->imported.formations[static_cast<std::size_t>(k)].count, k + 1);
}

}  // namespace
}  // namespace footlight::app
