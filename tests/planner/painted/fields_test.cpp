// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include "planner/painted/gradient_vector_flow.hpp"
#include "planner/painted/grid_flow.hpp"
#include "planner/painted/way_field.hpp"

namespace footlight::planner {
namespace {

PixelSet block(int width, int height, int x0, int y0, int x1, int y1) {
  PixelSet out(width, height);
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) out.at(x, y) = 1;
  }
  return out;
}

TEST(GradientVectorFlow, TheMedianTakesDustAndLeavesEdges) {
  Raster<double> picture(9, 9, 0);
  picture.at(2, 2) = 1;
  for (int y = 0; y < 9; ++y) {
    for (int x = 6; x < 9; ++x) picture.at(x, y) = 1;
  }
  const auto out = median_filtered(picture);
  EXPECT_EQ(out.at(2, 2), 0);
  EXPECT_EQ(out.at(6, 4), 1);
  EXPECT_EQ(out.at(5, 4), 0);
}

TEST(GradientVectorFlow, TheEdgeMapIsOneOnTheEdgeAndNothingBesideIt) {
  Raster<double> picture(8, 5, 0);
  for (int y = 0; y < 5; ++y) {
    for (int x = 4; x < 8; ++x) picture.at(x, y) = 3;
  }
  const auto edges = edge_map(picture);
  EXPECT_EQ(edges.at(3, 2), 1);
  EXPECT_EQ(edges.at(4, 2), 1);
  EXPECT_EQ(edges.at(2, 2), 0);
  EXPECT_EQ(edges.at(6, 2), 0);
}

TEST(GradientVectorFlow, OneStepIsDiffusionAndTheHoldOfTheGradient) {
  Raster<double> edges(7, 3, 0);
  for (int y = 0; y < 3; ++y) edges.at(5, y) = 1;
  const auto v = gradient_vector_flow(edges, 0.2, 1);
  // grad f is 1/2 at x = 4, -1/2 at x = 6 (whose right neighbour counts as itself), 0 elsewhere; a step is 1/(4 mu +
  // 1/2).
  const double step = 1 / 1.3;
  EXPECT_NEAR(v.at(3, 1).x, step * 0.2 * 0.5, 1e-12);
  EXPECT_NEAR(v.at(4, 1).x, 0.5 + step * 0.2 * (0.5 + 0.5 - 4 * 0.5), 1e-12);
  EXPECT_NEAR(v.at(2, 1).x, 0, 1e-12);
}

TEST(GradientVectorFlow, PointsToTheEdgeFromFarAway) {
  Raster<double> edges(40, 9, 0);
  for (int y = 0; y < 9; ++y) edges.at(20, y) = 1;
  const auto v = gradient_vector_flow(edges, 0.2, 2000);
  EXPECT_GT(v.at(8, 4).x, 0);
  EXPECT_LT(v.at(32, 4).x, 0);
  EXPECT_GT(v.at(17, 4).x, v.at(8, 4).x);
}

TEST(BackgroundField, RepelsAndAttractsAndEndsAtItsReach) {
  const PixelSet wall = block(60, 40, 28, 10, 34, 30);
  const auto off = background_field(wall, true, 10);
  EXPECT_LT(off.at(25, 20).x, -0.3);
  EXPECT_GT(off.at(36, 20).x, 0.3);
  EXPECT_LT(off.at(31, 7).y, -0.3);
  EXPECT_EQ(off.at(5, 20), (Point{}));
  const auto to = background_field(wall, false, 10);
  EXPECT_GT(to.at(25, 20).x, 0.3);
  EXPECT_EQ(background_field(PixelSet(9, 9), true, 3).at(4, 4), (Point{}));
}

/// A channel of eight rows between walls, open at both ends; narrow in the middle.
Raster<GridFlow::Pixel> channel(bool narrow) {
  Raster<GridFlow::Pixel> out(76, 12, GridFlow::Pixel::wall);
  for (int y = 2; y < 10; ++y) {
    for (int x = 0; x < 76; ++x) {
      if (narrow && x >= 35 && x < 41 && (y < 4 || y >= 8)) continue;
      out.at(x, y) = x < 20 || x >= 56 ? GridFlow::Pixel::open : GridFlow::Pixel::fluid;
    }
  }
  return out;
}

GridFlow::State after(const GridFlow& flow, int steps) {
  GridFlow::State now = flow.begin();
  for (int k = 0; k < steps; ++k) {
    GridFlow::State next = now;
    flow.step(now, next, 0.1);
    now = next;
  }
  return now;
}

TEST(GridFlow, AStraightChannelFlowsAsItIsDriven) {
  const GridFlow flow(channel(false), Raster<Point>(76, 12, {2, 0}), 0.5);
  const auto state = after(flow, 100);
  EXPECT_NEAR(flow.velocity(state, {38, 6}).x, 2, 1e-3);
  EXPECT_NEAR(flow.velocity(state, {38, 6}).y, 0, 1e-6);
  EXPECT_TRUE(state.steady);
}

TEST(GridFlow, TheFirstStepIsTheForceAlone) {
  const GridFlow flow(channel(false), Raster<Point>(76, 12, {2, 0}), 0.5);
  // From rest, wanted 2 px/s, 0.1 s of a reaction of 0.5 s, implicitly: 0.2 x 2 / 1.2.
  EXPECT_NEAR(flow.velocity(after(flow, 1), {38, 6}).x, 0.4 / 1.2, 1e-6);
}

TEST(GridFlow, NothingIsGainedOrLostInANarrowingWhereItFlowsFaster) {
  const GridFlow flow(channel(true), Raster<Point>(76, 12, {2, 0}), 0.5);
  const auto state = after(flow, 200);
  EXPECT_LT(flow.divergence(state), 1e-5);
  EXPECT_GT(flow.velocity(state, {38, 6}).x, 1.6 * flow.velocity(state, {24, 6}).x);
  EXPECT_EQ(flow.velocity(state, {38, 2.5}), (Point{}));
  const auto through = [&](int x) {
    double sum = 0;
    for (int y = 0; y < 12; ++y) sum += state.across.at(x, y);
    return sum;
  };
  EXPECT_NEAR(through(24), through(38), 1e-4);
}

TEST(GridFlow, WithoutAnOpeningNothingFlows) {
  Raster<GridFlow::Pixel> box(10, 10, GridFlow::Pixel::wall);
  for (int y = 3; y < 7; ++y) {
    for (int x = 3; x < 7; ++x) box.at(x, y) = GridFlow::Pixel::fluid;
  }
  const GridFlow flow(std::move(box), Raster<Point>(10, 10, {1, 0}), 0.5);
  const auto state = after(flow, 20);
  EXPECT_NEAR(flow.velocity(state, {5, 5}).x, 0, 1e-4);
}

TEST(WayField, GoesAroundWhatIsBlocked) {
  const PixelSet wall = block(30, 20, 14, 0, 16, 15);
  const WayField way = way_field(wall, block(30, 20, 28, 2, 30, 4));
  EXPECT_GT(way.direction.at(10, 5).y, 0);
  EXPECT_EQ(way.length_px.at(28, 2), 0);
  EXPECT_TRUE(std::isinf(way.length_px.at(14, 5)));
  EXPECT_GT(way.length_px.at(4, 3), 2 * 12);
}

TEST(WayField, OnAnOpenFloorItIsNearlyTheStraightDistance) {
  const WayField way = way_field(PixelSet(60, 60), block(60, 60, 5, 5, 6, 6));
  EXPECT_NEAR(way.length_px.at(45, 5), 40, 1e-9);
  EXPECT_NEAR(way.length_px.at(45, 35), 50, 2.5);
}

TEST(WayField, NobodySeesThroughAWall) {
  const PixelSet wall = block(30, 20, 14, 0, 16, 15);
  const auto away = nearest_pixels(wall).distance_px;
  EXPECT_FALSE(sees(away, {4, 5}, {26, 5}));
  EXPECT_TRUE(sees(away, {4, 18}, {26, 18}));
  EXPECT_TRUE(sees(nearest_pixels(PixelSet(30, 20)).distance_px, {4, 5}, {26, 5}));
}

}  // namespace
}  // namespace footlight::planner
