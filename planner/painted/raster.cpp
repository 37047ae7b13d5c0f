// SPDX-License-Identifier: Apache-2.0
#include "planner/painted/raster.hpp"

#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace footlight::planner {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

/// min over q of (p - q)^2 + f(q) for each p, and the q. Parabolas of infinite height are left out.
void lower_envelope(std::span<const double> f, std::span<double> out, std::span<int> from) {
  const int n = static_cast<int>(f.size());
  std::vector<int> site;
  std::vector<double> begins;
  for (int q = 0; q < n; ++q) {
    if (std::isinf(f[static_cast<std::size_t>(q)])) continue;
    double meet = -kFar;
    while (!site.empty()) {
      const int p = site.back();
      const double fq = f[static_cast<std::size_t>(q)] + double(q) * q;
      const double fp = f[static_cast<std::size_t>(p)] + double(p) * p;
      meet = (fq - fp) / (2.0 * (q - p));
      if (meet > begins.back()) break;
      site.pop_back();
      begins.pop_back();
      meet = -kFar;
    }
    site.push_back(q);
    begins.push_back(meet);
  }
  std::size_t k = 0;
  for (int p = 0; p < n; ++p) {
    const auto at = static_cast<std::size_t>(p);
    if (site.empty()) {
      out[at] = kFar;
      from[at] = -1;
      continue;
    }
    while (k + 1 < site.size() && begins[k + 1] < p) ++k;
    const double away = p - site[k];
    out[at] = away * away + f[static_cast<std::size_t>(site[k])];
    from[at] = site[k];
  }
}

/// Marks all pixels that hang together with the first one. @return how many
std::size_t label_component(const PixelSet& set, std::size_t first, std::int32_t label, Raster<std::int32_t>& labels) {
  std::vector<std::size_t> open{first};
  labels.cells[first] = label;
  std::size_t size = 0;
  while (!open.empty()) {
    const std::size_t at = open.back();
    open.pop_back();
    ++size;
    const int x = static_cast<int>(at % static_cast<std::size_t>(set.width));
    const int y = static_cast<int>(at / static_cast<std::size_t>(set.width));
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (!set.inside(x + dx, y + dy) || set.at(x + dx, y + dy) == 0 || labels.at(x + dx, y + dy) >= 0) continue;
        labels.at(x + dx, y + dy) = label;
        open.push_back(set.index(x + dx, y + dy));
      }
    }
  }
  return size;
}

}  // namespace

NearestPixels nearest_pixels(const PixelSet& set) {
  const int w = set.width;
  const int h = set.height;
  Raster<double> column_square(w, h, kFar);
  Raster<int> row_of(w, h, -1);
  std::vector<double> f(static_cast<std::size_t>(h));
  std::vector<double> g(static_cast<std::size_t>(h));
  std::vector<int> from(static_cast<std::size_t>(h));
  for (int x = 0; x < w; ++x) {
    for (int y = 0; y < h; ++y) f[static_cast<std::size_t>(y)] = set.at(x, y) != 0 ? 0 : kFar;
    lower_envelope(f, g, from);
    for (int y = 0; y < h; ++y) {
      column_square.at(x, y) = g[static_cast<std::size_t>(y)];
      row_of.at(x, y) = from[static_cast<std::size_t>(y)];
    }
  }
  NearestPixels out{Raster<std::int32_t>(w, h, -1), Raster<double>(w, h, kFar)};
  g.resize(static_cast<std::size_t>(w));
  from.resize(static_cast<std::size_t>(w));
  for (int y = 0; y < h; ++y) {
    const std::span<const double> row(column_square.cells.data() + column_square.index(0, y),
                                      static_cast<std::size_t>(w));
    lower_envelope(row, g, from);
    for (int x = 0; x < w; ++x) {
      const int column = from[static_cast<std::size_t>(x)];
      if (column < 0) continue;
      out.pixel.at(x, y) = static_cast<std::int32_t>(set.index(column, row_of.at(column, y)));
      out.distance_px.at(x, y) = std::sqrt(g[static_cast<std::size_t>(x)]);
    }
  }
  return out;
}

std::vector<PixelSet> components(const PixelSet& set, double least_share) {
  constexpr std::size_t kMost = 64;
  Raster<std::int32_t> labels(set.width, set.height, -1);
  std::vector<std::pair<std::size_t, std::int32_t>> sizes;
  for (std::size_t i = 0; i < set.cells.size(); ++i) {
    if (set.cells[i] == 0 || labels.cells[i] >= 0) continue;
    const auto label = static_cast<std::int32_t>(sizes.size());
    sizes.emplace_back(label_component(set, i, label, labels), label);
  }
  std::stable_sort(sizes.begin(), sizes.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<PixelSet> out;
  for (const auto& [size, label] : sizes) {
    if (out.size() == kMost || double(size) < least_share * double(sizes.front().first)) break;
    PixelSet& one = out.emplace_back(set.width, set.height);
    for (std::size_t i = 0; i < set.cells.size(); ++i) one.cells[i] = labels.cells[i] == label ? 1 : 0;
  }
  return out;
}

std::size_t count(const PixelSet& set) {
  return static_cast<std::size_t>(std::count_if(set.cells.begin(), set.cells.end(), [](auto c) { return c != 0; }));
}

}  // namespace footlight::planner
