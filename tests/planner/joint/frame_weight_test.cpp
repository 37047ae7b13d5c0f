// SPDX-License-Identifier: Apache-2.0
#include "planner/joint/frame_weight.hpp"

#include <gtest/gtest.h>

#include "planner/formation/best_single.hpp"

namespace footlight::planner {
namespace {

double loss(double people, double covered, double area) {
  return 1 - covered / people + kIouWeight * (1 - covered / (area + people - covered));
}

TEST(FrameWeight, IsTheGradientOfBothFigures) {
  const FrameWeight weight = frame_weight(300, 240, 280);
  const double step = 1e-4;
  const double rho = 0.4;
  const double gained = loss(300, 240, 280) - loss(300 + step, 240 + rho * step, 280);
  EXPECT_NEAR(gained / step, weight.alpha * rho - weight.beta, 1e-6);
}

TEST(FrameWeight, AsksForMostOfACellFromWhoComesToAPerfectDrawing) {
  const FrameWeight weight = frame_weight(100, 100, 100);
  EXPECT_NEAR(weight.beta / weight.alpha, (1 + kIouWeight) / (1 + 2 * kIouWeight), 1e-12);
}

TEST(BestSingle, TakesAsManyPeopleAsHelp) {
  const std::vector<double> shares{1, 1, 0.9, 0.1, 0};
  const CellFlags usable(5, 1);
  const SingleBest best = best_single({&shares, &usable, 3.0, 0, 5});
  EXPECT_EQ(best.people, 3);
  EXPECT_NEAR(best.covered, 2.9, 1e-12);
  EXPECT_NEAR(best.dev(), 0.1 / 3, 1e-12);
  EXPECT_NEAR(best.miss(), 0.1 / 3, 1e-12);
  EXPECT_NEAR(best.iou(), 0.2 / 3.1, 1e-12);
}

TEST(BestSingle, KeepsWhoHasNowhereElseToBe) {
  const std::vector<double> shares{1, 0, 0};
  const CellFlags usable(3, 1);
  EXPECT_EQ(best_single({&shares, &usable, 1.0, 3, 3}).people, 3);
  const std::vector<double> blank{0, 0, 0};
  EXPECT_EQ(best_single({&blank, &usable, 0.0, 0, 3}).people, 0);
}

}  // namespace
}  // namespace footlight::planner
