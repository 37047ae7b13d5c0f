// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/instances.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <tuple>

#include "core/rng.hpp"

namespace footlight::bench {
namespace {

/// The cells with the lowest score; ties fall by chance, the same on every run.
std::vector<Point> lowest(int people, double reach, const std::function<double(double, double)>& score) {
  const int side = static_cast<int>(std::ceil(reach));
  std::vector<std::tuple<double, std::uint64_t, int, int>> cells;
  Rng rng(1);
  for (int y = -side; y <= side; ++y) {
    for (int x = -side; x <= side; ++x) cells.emplace_back(score(x, y), rng.next(), x, y);
  }
  const auto end = cells.begin() + people;
  std::ranges::nth_element(cells, end);
  std::sort(cells.begin(), end);
  std::vector<Point> points;
  for (auto cell = cells.begin(); cell != end; ++cell) {
    points.push_back({static_cast<double>(std::get<2>(*cell)), static_cast<double>(std::get<3>(*cell))});
  }
  return points;
}

/// How far outside of the ink of "HI" over "OK", drawn in squares of `scale` cells.
double outside_of_letters(double x, double y, double scale) {
  static constexpr std::array<std::string_view, 11> kInk{"x.x.xxx", "x.x..x.", "xxx..x.", "x.x..x.",
                                                         "x.x.xxx", ".......", "xxx.x.x", "x.x.x.x",
                                                         "x.x.xx.", "x.x.x.x", "xxx.x.x"};
  double nearest = 1e9;
  for (std::size_t row = 0; row < kInk.size(); ++row) {
    for (std::size_t column = 0; column < kInk[row].size(); ++column) {
      if (kInk[row][column] != 'x') continue;
      const double dx = std::abs(x - scale * (static_cast<double>(column) - 3)) - scale / 2;
      const double dy = std::abs(y - scale * (static_cast<double>(row) - 5)) - scale / 2;
      nearest = std::min(nearest, std::max({dx, dy, 0.0}));
    }
  }
  return nearest;
}

}  // namespace

double outside_of_flower(double x, double y, double turn) {
  const double angle = std::atan2(y, x) + turn;
  return std::sqrt(x * x + y * y) / (0.28 + 0.14 * std::cos(5 * angle) + 0.03 * std::sin(11 * angle + 1));
}

Mask flower_picture(int width, int height, double turn) {
  Mask mask(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (outside_of_flower(x + 0.5 - width / 2.0, y + 0.5 - height / 2.0, turn) < height) mask.set(x, y);
    }
  }
  return mask;
}

std::string_view to_text(Scene scene) {
  switch (scene) {
    case Scene::disk_to_ring:
      return "disk_to_ring";
    case Scene::block_to_letters:
      return "block_to_letters";
    case Scene::flower_turned:
      return "flower_turned";
  }
  return "?";
}

Instance make_instance(Scene scene, int people) {
  const double size = std::sqrt(static_cast<double>(people));
  switch (scene) {
    case Scene::disk_to_ring:
      return {lowest(people, size + 3, [](double x, double y) { return x * x + y * y; }),
              lowest(people, size + 3,
                     [&](double x, double y) { return std::abs(std::sqrt(x * x + y * y) - 0.5455 * size); })};
    case Scene::block_to_letters: {
      const double scale = std::sqrt(people / 43.0);
      return {lowest(people, size + 3, [](double x, double y) { return std::max(std::abs(x) * 0.75, std::abs(y)); }),
              lowest(people, 6 * scale + 3, [&](double x, double y) { return outside_of_letters(x, y, scale); })};
    }
    case Scene::flower_turned:
      return {lowest(people, 1.1 * size + 4, [](double x, double y) { return outside_of_flower(x, y, 0); }),
              lowest(people, 1.1 * size + 4,
                     [&](double x, double y) { return outside_of_flower(x - 0.04 * size, y, 0.17); })};
  }
  return {};
}

Instance wandering_hole(int people) {
  const double size = std::sqrt(static_cast<double>(people));
  const auto floor = [&](double hole_x, double hole_y) {
    return lowest(people, size, [=](double x, double y) {
      const bool in_hole = std::hypot(x - hole_x * size, y - hole_y * size) < 0.2 * size;
      return std::max(std::abs(x) * 0.75, std::abs(y)) + (in_hole ? 10 * size : 0);
    });
  };
  return {floor(-0.2, 0), floor(0.16, 0.09)};
}

}  // namespace footlight::bench
