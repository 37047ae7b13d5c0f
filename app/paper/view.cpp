// SPDX-License-Identifier: Apache-2.0
#include "app/paper/view.hpp"

#include <algorithm>
#include <limits>

namespace footlight::app {
namespace {

constexpr double kTallest_m = 2;  // people, so that nobody upstage is cut off

}  // namespace

View::View(Seat seat, const Grid& grid, Point corner, double width, double height)
    : seat_(seat), frame_(grid, corner, width, height) {
  if (seat == Seat::above) {
    frame_.corner = corner + Point{(width - frame_.width()) / 2, (height - frame_.height()) / 2};
    return;
  }
  const double across = frame_.high.x - frame_.low.x;
  const double deep = frame_.high.y - frame_.low.y;
  const double far = std::max(across, deep);
  eye_ = {-0.75 * far, 0.5 * far};
  const Point ahead = Point{frame_.low.y + 0.4 * deep, 0} - eye_;
  look_ = (1 / length(ahead)) * ahead;
  double left = std::numeric_limits<double>::infinity();
  double low = left;
  double right = -left;
  double high = -left;
  for (const double x : {frame_.low.x, frame_.high.x}) {
    for (const double y : {frame_.low.y, frame_.high.y}) {
      for (const double z : {0.0, kTallest_m}) {
        const Ray ray = ray_to({x, y}, z);
        left = std::min(left, ray.across);
        right = std::max(right, ray.across);
        low = std::min(low, ray.up);
        high = std::max(high, ray.up);
      }
    }
  }
  scale_ = std::min(width / (right - left), height / (high - low));
  middle_ = corner + Point{width / 2 - scale_ * (left + right) / 2, height / 2 + scale_ * (low + high) / 2};
}

View::Ray View::ray_to(Point floor, double height_m) const {
  const Point to = Point{floor.y, height_m} - eye_;
  const double depth = dot(to, look_);
  return {floor.x / depth, (to.y * look_.x - to.x * look_.y) / depth, depth};
}

Point View::at(Point floor, double height_m) const {
  if (seat_ == Seat::above) return frame_.at(floor);
  const Ray ray = ray_to(floor, height_m);
  return {middle_.x + scale_ * ray.across, middle_.y - scale_ * ray.up};
}

double View::scale_at(Point floor) const {
  return seat_ == Seat::above ? frame_.scale : scale_ / ray_to(floor, 0).depth;
}

double View::depth_of(Point floor) const { return seat_ == Seat::above ? 0 : ray_to(floor, 0).depth; }

}  // namespace footlight::app
