// SPDX-License-Identifier: Apache-2.0
#include "planner/crowd_measure.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "planner/measure.hpp"
#include "tests/support/plan_builder.hpp"

namespace footlight::planner {
namespace {

using tests::mark_at;

using Classes = std::vector<std::uint16_t>;

Plan plan_with_section(const Grid& grid, std::vector<std::vector<Mark>> tracks, double end_s) {
  Plan plan = tests::plan_of(grid, std::move(tracks));
  plan.sections.push_back({"all", kStart, instant_at(end_s), 100, {}, {}, {}});
  return plan;
}

TEST(MutualInformation, IsOfXusEquation11) {
  EXPECT_EQ(mutual_information_bits(Classes{}, Classes{}), 0);
  EXPECT_DOUBLE_EQ(mutual_information_bits(Classes{0, 0, 1, 1}, Classes{0, 1, 0, 1}), 0)
      << "one says nothing of the other";
  EXPECT_DOUBLE_EQ(mutual_information_bits(Classes{0, 1, 2, 3}, Classes{3, 2, 1, 0}), 2)
      << "one says the other: log2 4";
  // p(0,0) = 1/2, p(0,1) = 1/4, p(1,1) = 1/4; by hand.
  const double expected = 0.5 * std::log2(0.5 / (0.75 * 0.5)) + 0.25 * std::log2(0.25 / (0.75 * 0.5)) +
                          0.25 * std::log2(0.25 / (0.25 * 0.5));
  EXPECT_NEAR(mutual_information_bits(Classes{0, 0, 0, 1}, Classes{0, 0, 1, 1}), expected, 1e-12);
}

TEST(InformationClasses, AreOfXusEquations12To14) {
  const InformationClasses classes{{0, 0}, 2, 8, 1.6};
  EXPECT_EQ(classes.bin(0), 0);
  EXPECT_EQ(classes.bin(1.999), 0);
  EXPECT_EQ(classes.bin(2), 1);
  EXPECT_EQ(classes.bin(-1), 0) << "off the floor but for rounding";
  EXPECT_EQ(classes.sector({1, 0}), 0);
  EXPECT_EQ(classes.sector({1, 0.99}), 0);
  EXPECT_EQ(classes.sector({1, 1}), 1) << "45 degrees begin the second of eight";
  EXPECT_EQ(classes.sector({0, 1}), 2);
  EXPECT_EQ(classes.sector({-1, 0}), 4);
  EXPECT_EQ(classes.sector({1, -0.01}), 7);
  EXPECT_EQ(classes.pace(0.1), 0);
  EXPECT_EQ(classes.pace(0.2), 1);
  EXPECT_EQ(classes.pace(1.6), 7) << "the fastest belong to the last class";
}

TEST(PlaceInformation, IsTheMeanOfBothAxes) {
  // Left of the middle to the left: x says the direction, 1 bit; y says nothing; the standing one does not count.
  const std::vector<Point> position{{0.5, 0.5}, {0.5, 2.5}, {3.5, 0.5}, {3.5, 2.5}, {1, 1}};
  const std::vector<Point> velocity{{-1, 0}, {-1, 0}, {1, 0}, {1, 0}, {0, 0}};
  const PlaceInformation found = place_information(position, velocity, {{0, 0}, 2, 8, 1});
  EXPECT_DOUBLE_EQ(found.direction_bits, 0.5);
  EXPECT_DOUBLE_EQ(found.speed_bits, 0) << "all are as fast";
  EXPECT_EQ(found.moving, 4U);
  EXPECT_TRUE(std::isnan(place_information(position, std::vector<Point>(5), {}).direction_bits));
}

TEST(CrowdAt, ChanceHasInformationWhereFewPeopleWalk) {
  // Ten people in ten bins with directions at random: chance alone gives much, and a hundred times as many hardly any.
  Rng rng(3);
  const auto shuffled = [&](int people) {
    std::vector<Point> position;
    std::vector<Point> velocity;
    for (int p = 0; p < people; ++p) {
      position.push_back({20 * rng.uniform(), 20 * rng.uniform()});
      const double turn = 2 * std::numbers::pi * rng.uniform();
      velocity.push_back({std::cos(turn), std::sin(turn)});
    }
    const CrowdInstant found = crowd_at(position, velocity, position, {{0, 0}, 2, 8, 1}, 1);
    EXPECT_NEAR(found.information.direction_bits, found.shuffled_direction_bits, people < 100 ? 0.5 : 0.02)
        << "directions at random are as good as dealt out";
    return found.shuffled_direction_bits;
  };
  EXPECT_GT(shuffled(10), 1);
  EXPECT_LT(shuffled(1000), 0.1);
}

TEST(CrowdSeries, WhoAllWalkOneWayTellNothingOfTheirPlace) {
  const Grid grid = *Grid::make(GridKind::square, 20, 10, 1);
  std::vector<std::vector<Mark>> one_way;
  std::vector<std::vector<Mark>> apart;
  for (int row = 0; row < 10; row += 2) {
    for (const int column : {2, 17}) {
      one_way.push_back({mark_at(0, grid, column, row), mark_at(4, grid, column, row + 1)});
      const int to = column == 2 ? 1 : 18;
      apart.push_back({mark_at(0, grid, column, row), mark_at(4, grid, to, row)});
    }
  }
  const CrowdSeries calm = crowd_series(plan_with_section(grid, one_way, 4), 1);
  ASSERT_EQ(calm.time_s.size(), 5U);
  EXPECT_DOUBLE_EQ(calm.at[1].information.direction_bits, 0);
  EXPECT_TRUE(std::isnan(calm.at[4].information.direction_bits)) << "nobody walks any more";
  EXPECT_NEAR(calm.at[2].sigma_effort_m, 0, 1e-12) << "everybody as far as the others";
  EXPECT_NEAR(calm.at[0].sigma_nearest_m, 0, 1e-12);
  const CrowdSeries torn = crowd_series(plan_with_section(grid, apart, 4), 1);
  // Left of the middle to the left: x says the direction (1 bit), y nothing.
  EXPECT_DOUBLE_EQ(torn.at[1].information.direction_bits, 0.5);
}

TEST(CrowdSeries, PlacesTellHowFastPeopleWalkWhereOneSideHurries) {
  const Grid grid = *Grid::make(GridKind::square, 20, 10, 1);
  std::vector<std::vector<Mark>> even;
  std::vector<std::vector<Mark>> hurried;
  for (int row = 0; row < 10; row += 2) {
    for (const int column : {2, 15}) {
      even.push_back({mark_at(0, grid, column, row), mark_at(4, grid, column + 1, row)});
      hurried.push_back({mark_at(0, grid, column, row), mark_at(4, grid, column == 2 ? 3 : 19, row)});
    }
  }
  EXPECT_DOUBLE_EQ(crowd_series(plan_with_section(grid, even, 4), 1).at[1].information.speed_bits, 0);
  const CrowdSeries series = crowd_series(plan_with_section(grid, hurried, 4), 1);
  EXPECT_DOUBLE_EQ(series.at[1].information.speed_bits, 0.5) << "x says the speed (1 bit), y nothing";
  EXPECT_DOUBLE_EQ(series.at[1].information.direction_bits, 0) << "all go the same way";
  EXPECT_TRUE(std::isnan(series.at[4].information.speed_bits));
}

TEST(CrowdSeries, SigmasAreOfXusEquations24And26) {
  const Grid grid = *Grid::make(GridKind::square, 20, 10, 1);
  // Three people: nearest 1, 1 and 6 m; ways of 0, 0 and 2 m after two of four seconds.
  Plan plan = plan_with_section(grid,
                                {{mark_at(0, grid, 0, 0), mark_at(4, grid, 0, 0)},
                                 {mark_at(0, grid, 1, 0), mark_at(4, grid, 1, 0)},
                                 {mark_at(0, grid, 7, 0), mark_at(4, grid, 11, 0)}},
                                4);
  plan.formations.push_back({"all/1", SectionIndex(0), 1, kStart, {}, {}, 3});
  const CrowdSeries series = crowd_series(plan, 2);
  const auto sigma = [](double a, double b, double c) {
    const double mean = (a + b + c) / 3;
    return std::sqrt(((a - mean) * (a - mean) + (b - mean) * (b - mean) + (c - mean) * (c - mean)) / 3);
  };
  EXPECT_NEAR(series.at[0].sigma_nearest_m, sigma(1, 1, 6), 1e-12);
  EXPECT_NEAR(series.at[1].sigma_nearest_m, sigma(1, 1, 8), 1e-12);
  EXPECT_NEAR(series.at[1].sigma_effort_m, sigma(0, 0, 2), 1e-12);
}

TEST(CrowdFigures, AreMeansOverInstantsAtWhichSomebodyWalks) {
  const Grid grid = *Grid::make(GridKind::square, 20, 10, 1);
  // Two walk 4 m in 4 s while one stands; then nobody walks for 4 s.
  const Plan plan = plan_with_section(grid,
                                      {{mark_at(0, grid, 0, 0), mark_at(4, grid, 4, 0), mark_at(8, grid, 4, 0)},
                                       {mark_at(0, grid, 0, 2), mark_at(4, grid, 4, 2), mark_at(8, grid, 4, 2)},
                                       {mark_at(0, grid, 10, 9), mark_at(8, grid, 10, 9)}},
                                      8);
  const Measures found = measure(plan, {std::nullopt}).show;
  ASSERT_TRUE(found.crowd.has_value());
  EXPECT_EQ(found.crowd->instants, 8U) << "every half second from 0 s to 3.5 s";
  EXPECT_DOUBLE_EQ(found.crowd->moving, 2);
  EXPECT_DOUBLE_EQ(found.crowd->direction_bits, 0);
  // Efforts w, w and 0 have the deviation w sqrt(2) / 3; the mean of w is 1.75 m.
  EXPECT_NEAR(found.crowd->sigma_effort_m, 1.75 * std::sqrt(2) / 3, 1e-12);
}

TEST(CrowdFigures, OfPeopleWhoAllStandDoNotExist) {
  const Grid grid = *Grid::make(GridKind::square, 4, 4, 1);
  const Plan plan = plan_with_section(grid, {{mark_at(0, grid, 0, 0), mark_at(4, grid, 0, 0)}}, 4);
  EXPECT_FALSE(measure(plan, {std::nullopt}).show.crowd.has_value());
}

TEST(CrowdSeries, MeasuresEffortFromTheKeyFormationBefore) {
  const Grid grid = *Grid::make(GridKind::square, 20, 10, 1);
  Plan plan = plan_with_section(grid,
                                {{mark_at(0, grid, 0, 0), mark_at(4, grid, 4, 0), mark_at(8, grid, 8, 0)},
                                 {mark_at(0, grid, 0, 5), mark_at(8, grid, 0, 5)}},
                                8);
  plan.formations.push_back({"all/1", SectionIndex(0), 1, kStart, {}, {}, 2});
  plan.formations.push_back({"all/2", SectionIndex(0), 9, instant_at(4), {}, {}, 2, false});
  EXPECT_DOUBLE_EQ(crowd_series(plan, 2).at[3].sigma_effort_m, 3)
      << "6 m and 0 m: what is sampled between is no source";
  plan.formations[1].key = true;
  EXPECT_DOUBLE_EQ(crowd_series(plan, 2).at[3].sigma_effort_m, 1) << "2 m and 0 m since 4 s";
}

}  // namespace
}  // namespace footlight::planner
