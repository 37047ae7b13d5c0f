// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include <opencv2/core.hpp>

#include "config/decode_spots.hpp"
#include "config/lamp_film.hpp"
#include "core/grid.hpp"
#include "core/rng.hpp"

namespace footlight::tests {

/// A telephone that films the floor, held by somebody in the audience.
struct PhoneChoice {
  int width = 400;
  int height = 226;
  double fps = 30;
  double clock_rate = 1;   ///< film seconds per second: 4 is a slow motion of four times
  double begins_s = -1.5;  ///< of the lamps' time
  double ends_s = 1e9;     ///< at most; and 1.5 s after the lamps
  double shake_px = 0;     ///< amplitude of the hand
  double noise = 2;        ///< standard deviation, grey values
  double light = 140;      ///< of a lamp, grey values above its surroundings
  double blur_px = 1.2;    ///< of a lamp's light
  double exposure_s = 0.02;
  double readout_s = 0.015;  ///< the last row is exposed so much later than the first
  double height_m = 8;       ///< of the camera
  double away_m = 8;         ///< from the downstage edge
  double aside_m = 2;        ///< from the centre line
  bool from_upstage = false;
  double reflection = 0;  ///< share of the light that a glossy floor gives back, a bit nearer to the camera
  int steady_lights = 0;  ///< exit signs
  std::uint64_t seed = 1;
};

class Phone {
 public:
  /// How bright a lamp is at an instant of the lamps' time, 0..1.
  using Lit = std::function<double(std::size_t lamp, double at_s)>;

  /// @param places where the lamps really are
  Phone(const PhoneChoice& choice, const Grid& grid, const std::vector<CellIndex>& places)
      : choice_(choice), rng_(choice.seed) {
    for (const CellIndex cell : places) floor_.push_back(grid.centre(cell));
    Point low{1e9, 1e9};
    Point high{-1e9, -1e9};
    for (int i = 0; i < grid.size(); ++i) {
      const Point p = grid.centre(CellIndex::of(i));
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    const Point middle = 0.5 * (low + high);
    eye_ = {choice.aside_m, choice.from_upstage ? high.y + choice.away_m : low.y - choice.away_m};
    // Looks at the middle of the floor.
    const double forward = std::hypot(middle.x - eye_.x, middle.y - eye_.y);
    yaw_ = std::atan2(middle.x - eye_.x, middle.y - eye_.y);
    pitch_ = std::atan2(choice.height_m, forward);
    // As large as fits: the corners decide.
    focal_ = 1;
    offset_ = {0, 0};
    Point p0{1e9, 1e9};
    Point p1{-1e9, -1e9};
    for (const Point corner : {low, high, Point{low.x, high.y}, Point{high.x, low.y}}) {
      const Point p = project(corner);
      p0 = {std::min(p0.x, p.x), std::min(p0.y, p.y)};
      p1 = {std::max(p1.x, p.x), std::max(p1.y, p.y)};
    }
    focal_ = 0.86 * std::min(choice.width / (p1.x - p0.x), choice.height / (p1.y - p0.y));
    offset_ = Point{choice.width / 2.0, choice.height / 2.0} - focal_ * (0.5 * (p0 + p1));
    for (int i = 0; i < choice.steady_lights; ++i) {
      steady_.push_back({rng_.uniform() * choice.width, rng_.uniform() * choice.height});
    }
  }

  /// Pixels of a place on the floor when the hand is still.
  [[nodiscard]] Point project(Point floor) const {
    const double x = floor.x - eye_.x;
    const double y = floor.y - eye_.y;
    const double right = x * std::cos(yaw_) - y * std::sin(yaw_);
    const double ahead = x * std::sin(yaw_) + y * std::cos(yaw_);
    const double depth = ahead * std::cos(pitch_) + choice_.height_m * std::sin(pitch_);
    const double down = choice_.height_m * std::cos(pitch_) - ahead * std::sin(pitch_);
    return focal_ * Point{right / depth, down / depth} + offset_;
  }

  /// One frame as the sensor sees it, at an instant of the lamps' time.
  [[nodiscard]] cv::Mat frame(double at_s, const Lit& lit) {
    cv::Mat out(choice_.height, choice_.width, CV_32F);
    cv::RNG noise(rng_.next());
    noise.fill(out, cv::RNG::NORMAL, 18, choice_.noise);
    for_lights(at_s, lit, [&](Point at, double light) { splat(out, at, light); });
    cv::Mat grey;
    out.convertTo(grey, CV_8U);
    return grey;
  }

  /// Frames one after the other, with their time in the film.
  void film(double lamps_end_s, const Lit& lit, const std::function<void(double film_s, const cv::Mat&)>& take) {
    const double end_s = std::min(choice_.ends_s, lamps_end_s + 1.5);
    for (int i = 0;; ++i) {
      const double film_s = i / choice_.fps;
      const double at_s = choice_.begins_s + film_s / choice_.clock_rate;
      if (at_s > end_s) return;
      take(film_s, frame(at_s, lit));
    }
  }

  /// What the decoder would find in such a film.
  [[nodiscard]] config::LampFilm spots(double lamps_end_s, const Lit& lit, double radius_px) {
    config::LampFilm out;
    out.width = choice_.width;
    out.height = choice_.height;
    film(lamps_end_s, lit, [&](double film_s, const cv::Mat& grey) {
      out.frames.push_back({film_s, config::find_spots(grey, radius_px, 3 * floor_.size() + 100)});
    });
    return out;
  }

 private:
  /// The hand, relative to where it was at first.
  [[nodiscard]] Point hand(double at_s) const {
    const double a = choice_.shake_px;
    return {a * (0.6 * std::sin(2.1 * at_s + 1) + 0.3 * std::sin(6.7 * at_s) + 0.1 * std::sin(19 * at_s)),
            a * (0.6 * std::cos(1.7 * at_s) + 0.3 * std::sin(7.9 * at_s + 2) + 0.1 * std::cos(23 * at_s))};
  }
  template <class Put>
  void for_lights(double at_s, const Lit& lit, Put put) {
    constexpr int kSamples = 4;
    const Point hand = this->hand(at_s);
    for (std::size_t i = 0; i < floor_.size(); ++i) {
      const Point at = project(floor_[i]) + hand;
      const double row_s = at_s + choice_.readout_s * at.y / choice_.height;
      double share = 0;
      for (int k = 0; k < kSamples; ++k) share += lit(i, row_s + (k + 0.5) / kSamples * choice_.exposure_s) / kSamples;
      if (share <= 0) continue;
      put(at, share * choice_.light);
      if (choice_.reflection > 0) {
        put(project(floor_[i] + Point{0.2, choice_.from_upstage ? 12.0 : -12.0}) + hand,
            share * choice_.light * choice_.reflection);
      }
    }
    for (const Point at : steady_) put(at + hand, choice_.light);
  }
  void splat(cv::Mat& out, Point at, double light) const {
    const int reach = static_cast<int>(std::ceil(3 * choice_.blur_px));
    const int x0 = static_cast<int>(std::lround(at.x));
    const int y0 = static_cast<int>(std::lround(at.y));
    for (int y = std::max(0, y0 - reach); y <= std::min(out.rows - 1, y0 + reach); ++y) {
      for (int x = std::max(0, x0 - reach); x <= std::min(out.cols - 1, x0 + reach); ++x) {
        const double squared = (x - at.x) * (x - at.x) + (y - at.y) * (y - at.y);
        out.at<float>(y, x) += static_cast<float>(light * std::exp(-squared / (2 * choice_.blur_px * choice_.blur_px)));
      }
    }
  }

  PhoneChoice choice_;
  Rng rng_;
  std::vector<Point> floor_;
  std::vector<Point> steady_;
  Point eye_;
  double yaw_ = 0;
  double pitch_ = 0;
  double focal_ = 1;
  Point offset_;
};

}  // namespace footlight::tests
