// SPDX-License-Identifier: Apache-2.0
#include "config/decode_spots.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace footlight::config {
namespace {

constexpr double kSurroundings = 3;  // wider than the lamp
constexpr double kAboveNoise = 6;
constexpr float kLeastLight = 3;               // grey values
constexpr double kDeviationOfMedian = 1.4826;  // of a normal distribution: sigma / median absolute deviation
constexpr int kHistogramBins = 2048;           // of |difference|, 0..256
constexpr std::size_t kSampleEvery = 3;        // pixels, for the noise

/// Median of |value| of a picture whose values are about symmetric around 0.
double median_deviation(const cv::Mat& picture) {
  std::vector<std::size_t> histogram(kHistogramBins);
  std::size_t count = 0;
  for (int y = 0; y < picture.rows; ++y) {
    const auto* row = picture.ptr<float>(y);
    for (int x = static_cast<int>(static_cast<std::size_t>(y) % kSampleEvery); x < picture.cols;
         x += static_cast<int>(kSampleEvery)) {
      const int bin = static_cast<int>(std::abs(row[x]) * (kHistogramBins / 256.0F));
      ++histogram[static_cast<std::size_t>(std::min(bin, kHistogramBins - 1))];
      ++count;
    }
  }
  std::size_t below = 0;
  for (std::size_t bin = 0; bin < histogram.size(); ++bin) {
    below += histogram[bin];
    if (2 * below >= count) return (static_cast<double>(bin) + 0.5) * 256.0 / kHistogramBins;
  }
  return 0;
}

LightSpot centre_of(const cv::Mat& light, int x, int y) {
  double sum = 0;
  double sum_x = 0;
  double sum_y = 0;
  for (int v = std::max(0, y - 1); v <= std::min(light.rows - 1, y + 1); ++v) {
    for (int u = std::max(0, x - 1); u <= std::min(light.cols - 1, x + 1); ++u) {
      const double value = std::max(0.0F, light.at<float>(v, u));
      sum += value;
      sum_x += value * u;
      sum_y += value * v;
    }
  }
  return {static_cast<float>(sum_x / sum), static_cast<float>(sum_y / sum), light.at<float>(y, x)};
}

}  // namespace

std::vector<LightSpot> find_spots(const cv::Mat& grey, double radius_px, std::size_t most_spots) {
  cv::Mat frame;
  grey.convertTo(frame, CV_32F);
  cv::Mat light;
  cv::Mat surroundings;
  cv::GaussianBlur(frame, light, {}, radius_px, radius_px, cv::BORDER_REPLICATE);
  cv::GaussianBlur(light, surroundings, {}, kSurroundings * radius_px, kSurroundings * radius_px, cv::BORDER_REPLICATE);
  light -= surroundings;
  const auto threshold =
      std::max(kLeastLight, static_cast<float>(kAboveNoise * kDeviationOfMedian * median_deviation(light)));
  const int reach = std::max(1, static_cast<int>(std::lround(1.5 * radius_px)));
  cv::Mat highest;
  cv::dilate(light, highest, cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * reach + 1, 2 * reach + 1}));
  std::vector<LightSpot> spots;
  for (int y = 0; y < light.rows; ++y) {
    const auto* value = light.ptr<float>(y);
    const auto* top = highest.ptr<float>(y);
    for (int x = 0; x < light.cols; ++x) {
      if (value[x] < threshold || value[x] < top[x]) continue;
      spots.push_back(centre_of(light, x, y));
    }
  }
  std::ranges::stable_sort(spots, std::ranges::greater{}, &LightSpot::light);
  if (spots.size() > most_spots) spots.resize(most_spots);
  return spots;
}

}  // namespace footlight::config
