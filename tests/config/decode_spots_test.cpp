// SPDX-License-Identifier: Apache-2.0
#include "config/decode_spots.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace footlight::config {
namespace {

/// A round light of a Gaussian profile.
void add_light(cv::Mat& frame, double x, double y, double radius, double grey) {
  for (int v = 0; v < frame.rows; ++v) {
    for (int u = 0; u < frame.cols; ++u) {
      const double squared = ((u - x) * (u - x) + (v - y) * (v - y)) / (2 * radius * radius);
      frame.at<float>(v, u) += static_cast<float>(grey * std::exp(-squared));
    }
  }
}

cv::Mat as_filmed(const cv::Mat& frame, double noise, int seed) {
  cv::Mat noisy(frame.size(), CV_32F);
  cv::RNG rng(static_cast<std::uint64_t>(seed));
  rng.fill(noisy, cv::RNG::NORMAL, 0, noise);
  noisy += frame;
  cv::Mat out;
  noisy.convertTo(out, CV_8U);
  return out;
}

TEST(Spots, AreFoundWhereTheLightsAre) {
  cv::Mat frame(120, 160, CV_32F, cv::Scalar(20));
  add_light(frame, 40.3, 30.7, 2, 120);
  add_light(frame, 50.0, 30.0, 2, 60);
  add_light(frame, 100.5, 90.2, 2, 30);
  const auto spots = find_spots(as_filmed(frame, 2, 1), 2, 10);
  ASSERT_EQ(spots.size(), 3U);
  EXPECT_NEAR(spots[0].x, 40.3, 0.35);
  EXPECT_NEAR(spots[0].y, 30.7, 0.35);
  EXPECT_NEAR(spots[1].x, 50.0, 0.35);
  EXPECT_NEAR(spots[2].y, 90.2, 0.5);
  EXPECT_GT(spots[0].light, spots[1].light);
  EXPECT_GT(spots[1].light, spots[2].light);
}

TEST(Spots, ADarkNoisyFrameHasNextToNone) {
  const cv::Mat frame(240, 320, CV_32F, cv::Scalar(30));
  for (int seed = 1; seed <= 5; ++seed) {
    EXPECT_LE(find_spots(as_filmed(frame, 8, seed), 2, 1000).size(), 2U) << seed;
  }
}

TEST(Spots, ALightThatFadesOverTheWholeFrameIsNone) {
  cv::Mat frame(120, 160, CV_32F);
  for (int v = 0; v < frame.rows; ++v) {
    for (int u = 0; u < frame.cols; ++u) frame.at<float>(v, u) = static_cast<float>(u);
  }
  EXPECT_TRUE(find_spots(as_filmed(frame, 1, 3), 2, 1000).empty());
}

TEST(Spots, OfTooManyTheBrightestAreKept) {
  cv::Mat frame(120, 160, CV_32F, cv::Scalar(0));
  for (int i = 0; i < 5; ++i) add_light(frame, 20 + 25 * i, 60, 2, 60 + 30 * i);
  const auto spots = find_spots(as_filmed(frame, 1, 3), 2, 2);
  ASSERT_EQ(spots.size(), 2U);
  EXPECT_NEAR(spots[0].x, 120, 0.4);
  EXPECT_NEAR(spots[1].x, 95, 0.4);
}

}  // namespace
}  // namespace footlight::config
