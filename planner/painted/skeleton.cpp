// SPDX-License-Identifier: Apache-2.0
#include "planner/painted/skeleton.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

namespace footlight::planner {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

/// P2..P9 of the paper: from the north clockwise.
std::array<bool, 8> around(const PixelSet& set, int x, int y) {
  constexpr std::array<std::array<int, 2>, 8> kSteps{
      {{0, -1}, {1, -1}, {1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}}};
  std::array<bool, 8> out{};
  for (std::size_t i = 0; i < 8; ++i) {
    const int nx = x + kSteps[i][0];
    const int ny = y + kSteps[i][1];
    out[i] = set.inside(nx, ny) && set.at(nx, ny) != 0;
  }
  return out;
}

bool taken(const PixelSet& set, int x, int y, bool second_pass) {
  const auto p = around(set, x, y);
  const auto neighbours = std::count(p.begin(), p.end(), true);
  if (neighbours < 2 || neighbours > 6) return false;
  int rises = 0;
  for (std::size_t i = 0; i < 8; ++i) rises += !p[i] && p[(i + 1) % 8] ? 1 : 0;
  if (rises != 1) return false;
  const bool north = p[0];
  const bool east = p[2];
  const bool south = p[4];
  const bool west = p[6];
  if (second_pass) return !(north && east && west) && !(north && south && west);
  return !(north && east && south) && !(east && south && west);
}

struct Reached {
  std::vector<double> length;     // per pixel; infinite where not reached
  std::vector<std::size_t> from;  // the pixel before
  std::size_t farthest = 0;
};

/// Shortest ways over the skeleton from one pixel (Dijkstra); ties by the pixel's index.
Reached reach(const PixelSet& skeleton, std::size_t start) {
  Reached out{std::vector<double>(skeleton.cells.size(), kFar), std::vector<std::size_t>(skeleton.cells.size(), start),
              start};
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  out.length[start] = 0;
  open.emplace(0.0, start);
  while (!open.empty()) {
    const auto [length, at] = open.top();
    open.pop();
    if (length > out.length[at]) continue;
    if (length > out.length[out.farthest]) out.farthest = at;
    const int x = static_cast<int>(at % static_cast<std::size_t>(skeleton.width));
    const int y = static_cast<int>(at / static_cast<std::size_t>(skeleton.width));
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if ((dx == 0 && dy == 0) || !skeleton.inside(x + dx, y + dy) || skeleton.at(x + dx, y + dy) == 0) continue;
        const std::size_t next = skeleton.index(x + dx, y + dy);
        const double there = length + (dx != 0 && dy != 0 ? std::sqrt(2.0) : 1.0);
        if (there >= out.length[next]) continue;
        out.length[next] = there;
        out.from[next] = at;
        open.emplace(there, next);
      }
    }
  }
  return out;
}

}  // namespace

PixelSet thinned(PixelSet set) {
  std::vector<std::size_t> gone;
  bool changed = true;
  while (changed) {
    changed = false;
    for (const bool second_pass : {false, true}) {
      gone.clear();
      for (int y = 0; y < set.height; ++y) {
        for (int x = 0; x < set.width; ++x) {
          if (set.at(x, y) != 0 && taken(set, x, y, second_pass)) gone.push_back(set.index(x, y));
        }
      }
      for (const std::size_t at : gone) set.cells[at] = 0;
      changed = changed || !gone.empty();
    }
  }
  return set;
}

std::vector<Point> longest_way(const PixelSet& skeleton) {
  std::vector<char> seen(skeleton.cells.size(), 0);
  double longest = -1;
  Reached best;
  for (std::size_t i = 0; i < skeleton.cells.size(); ++i) {
    if (skeleton.cells[i] == 0 || seen[i] != 0) continue;
    // From anywhere to the farthest, from there to the farthest: a diameter of a tree.
    const Reached once = reach(skeleton, i);
    for (std::size_t k = 0; k < seen.size(); ++k) seen[k] = seen[k] != 0 || once.length[k] < kFar ? 1 : 0;
    Reached twice = reach(skeleton, once.farthest);
    if (twice.length[twice.farthest] <= longest) continue;
    longest = twice.length[twice.farthest];
    best = std::move(twice);
  }
  std::vector<Point> out;
  if (longest < 0) return out;
  for (std::size_t at = best.farthest;; at = best.from[at]) {
    const auto width = static_cast<std::size_t>(skeleton.width);
    out.push_back({static_cast<double>(at % width) + 0.5, static_cast<double>(at / width) + 0.5});
    if (best.from[at] == at) break;
  }
  return out;
}

}  // namespace footlight::planner
