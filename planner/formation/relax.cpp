// SPDX-License-Identifier: Apache-2.0
#include "planner/formation/relax.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "core/check.hpp"
#include "core/rng.hpp"
#include "planner/formation/cell_shares.hpp"
#include "planner/motion/neighbours.hpp"

namespace footlight::planner {
namespace {

constexpr int kSteps = 120;
constexpr double kReach = 1.4;       // even distances
constexpr double kFirstStep = 0.25;  // even distances, of the strongest push

bool inside(const Mask& picture, Point p) {
  const double x = std::floor(p.x);
  const double y = std::floor(p.y);
  return x >= 0 && y >= 0 && x < picture.width() && y < picture.height() &&
         picture.at(static_cast<int>(x), static_cast<int>(y));
}

/// A square of the picture's plane.
struct Tile {
  Point corner;
  int pixels = 0;  ///< that are in the picture
  std::optional<Point> point;
};

/// Draws squares with a chance in proportion to their weights, each at most once.
class Wheel {
 public:
  Wheel(std::vector<double> weights, Rng rng) : weight_(std::move(weights)), sum_(weight_.size()), rng_(rng) {
    add_up();
  }

  std::size_t turn() {
    // Those drawn before still lie on the wheel until they take up half of it.
    if (drawn_ > sum_.back() / 2) add_up();
    for (;;) {
      const double at = rng_.uniform() * sum_.back();
      const auto found = std::upper_bound(sum_.begin(), sum_.end(), at);
      const auto n = static_cast<std::size_t>(std::min(found, sum_.end() - 1) - sum_.begin());
      if (weight_[n] <= 0) continue;
      drawn_ += std::exchange(weight_[n], 0.0);
      return n;
    }
  }

 private:
  void add_up() {
    std::partial_sum(weight_.begin(), weight_.end(), sum_.begin());
    drawn_ = 0;
  }

  std::vector<double> weight_;
  std::vector<double> sum_;
  double drawn_ = 0;
  Rng rng_;
};

std::vector<Tile> tiles_of(const Mask& picture, double side) {
  const auto columns = static_cast<std::size_t>(std::ceil(picture.width() / side));
  const auto rows = static_cast<std::size_t>(std::ceil(picture.height() / side));
  std::vector<Tile> out(columns * rows);
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      if (!picture.at(x, y)) continue;
      const auto column = std::min(columns - 1, static_cast<std::size_t>((x + 0.5) / side));
      const auto row = std::min(rows - 1, static_cast<std::size_t>((y + 0.5) / side));
      Tile& tile = out[row * columns + column];
      tile.corner = {static_cast<double>(column) * side, static_cast<double>(row) * side};
      ++tile.pixels;
    }
  }
  std::erase_if(out, [](const Tile& tile) { return tile.pixels == 0; });
  for (Tile& tile : out) {
    const Point middle = tile.corner + Point{side / 2, side / 2};
    if (inside(picture, middle)) tile.point = middle;
  }
  return out;
}

/// Somewhere in the picture in this square.
Point somewhere(const Mask& picture, const Tile& tile, double side, Rng& rng) {
  constexpr int kTries = 64;
  for (int n = 0; n < kTries; ++n) {
    const Point p = tile.corner + Point{side * rng.uniform(), side * rng.uniform()};
    if (inside(picture, p)) return p;
  }
  // Little of the square is in the picture: any of these pixels.
  std::vector<Point> middles;
  const auto first = [](double at) { return static_cast<int>(std::ceil(at - 0.5)); };
  for (int y = first(tile.corner.y); y + 0.5 < tile.corner.y + side; ++y) {
    for (int x = first(tile.corner.x); x + 0.5 < tile.corner.x + side; ++x) {
      const Point middle{x + 0.5, y + 0.5};
      if (inside(picture, middle)) middles.push_back(middle);
    }
  }
  FL_CHECK(!middles.empty());
  return middles[rng.below(middles.size())];
}

/// Density sampling, then the roulette wheel.
std::vector<Point> sampled(const Mask& picture, int people, double side, Rng rng) {
  std::vector<Tile> tiles = tiles_of(picture, side);
  const auto count = [&] {
    return static_cast<int>(
        std::count_if(tiles.begin(), tiles.end(), [](const Tile& t) { return t.point.has_value(); }));
  };
  const auto weights = [&](bool filled) {
    const double whole = side * side;
    std::vector<double> out;
    for (const Tile& tile : tiles) {
      const double weight = filled ? std::max(0.0, whole - tile.pixels) + 1 : tile.pixels;
      out.push_back(tile.point.has_value() == filled ? weight : 0.0);
    }
    return out;
  };
  if (int more = count() - people; more > 0) {
    for (Wheel wheel(weights(true), rng.split(0)); more > 0; --more) tiles[wheel.turn()].point.reset();
  }
  std::vector<Point> out;
  for (const Tile& tile : tiles) {
    if (tile.point) out.push_back(*tile.point);
  }
  Rng where = rng.split(1);
  while (static_cast<int>(out.size()) < people) {
    // A round gives every empty square a point at most; more people than squares take several.
    const auto empty = static_cast<int>(tiles.size()) - count();
    int missing = std::min(people - static_cast<int>(out.size()), empty);
    if (missing == 0) {
      for (Tile& tile : tiles) tile.point.reset();
      continue;
    }
    for (Wheel wheel(weights(false), rng.split(2 + out.size())); missing > 0; --missing) {
      Tile& tile = tiles[wheel.turn()];
      tile.point = somewhere(picture, tile, side, where);
      out.push_back(*tile.point);
    }
  }
  return out;
}

/// One step of everybody from where all are now.
void push_apart(const Mask& picture, double even, double step, const Neighbours& near, std::vector<Point>& points) {
  const std::vector<Point> now = points;
  for (std::size_t i = 0; i < now.size(); ++i) {
    Point push;
    near.visit(now[i], kReach * even, [&](std::uint32_t j, double squared) {
      if (j == i || squared <= 0) return;
      const double away = std::sqrt(squared);
      push = push + ((1 - away / (kReach * even)) / away) * (now[i] - now[j]);
    });
    const double strength = length(push);
    if (strength <= 0) continue;
    const Point move = (step * even * std::min(1.0, strength) / strength) * push;
    // Along the edge where the picture ends.
    for (const Point by : {move, Point{move.x, 0}, Point{0, move.y}}) {
      if (!inside(picture, now[i] + by)) continue;
      points[i] = now[i] + by;
      break;
    }
  }
}

}  // namespace

std::vector<Point> fill_picture(const Mask& picture, int people, std::uint64_t seed) {
  const auto area = static_cast<double>(picture_area(picture));
  FL_CHECK(area > 0 && people > 0);
  const double even = std::sqrt(area / people);
  std::vector<Point> points = sampled(picture, people, std::max(even, 1.0), Rng(seed));
  Neighbours near;
  for (int step = 0; step < kSteps; ++step) {
    near.sort(points, kReach * even);
    push_apart(picture, even, kFirstStep * (1 - static_cast<double>(step) / kSteps), near, points);
  }
  return points;
}

}  // namespace footlight::planner
