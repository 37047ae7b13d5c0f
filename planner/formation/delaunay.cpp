// SPDX-License-Identifier: Apache-2.0
#include "planner/formation/delaunay.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <boost/polygon/voronoi.hpp>

namespace footlight::planner {
namespace {

constexpr double kQuanta = 1 << 30U;
constexpr double kDiagonal = 1e-4;

/// A point's place as the sweep has it, and its number.
struct Site {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::uint32_t number = 0;

  friend auto operator<=>(const Site&, const Site&) = default;
  [[nodiscard]] bool same_place(const Site& other) const { return x == other.x && y == other.y; }
};

std::vector<Site> rounded(std::span<const Point> points) {
  Point low = points.front();
  Point high = low;
  for (const Point p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const double extent = std::max(high.x - low.x, high.y - low.y);
  const double scale = extent > 0 ? kQuanta / extent : 0;
  std::vector<Site> out;
  out.reserve(points.size());
  for (const Point p : points) {
    out.push_back({static_cast<std::int32_t>(std::lround((p.x - low.x) * scale)),
                   static_cast<std::int32_t>(std::lround((p.y - low.y) * scale)),
                   static_cast<std::uint32_t>(out.size())});
  }
  std::sort(out.begin(), out.end());
  return out;
}

DelaunayEdge between(const Site& one, const Site& other) {
  return {std::min(one.number, other.number), std::max(one.number, other.number)};
}

using Diagram = boost::polygon::voronoi_diagram<double>;

/// Whether a side of the Voronoi diagram is so short that only rounding made it.
bool is_diagonal(const Diagram::edge_type& side, const Site& one, const Site& other) {
  if (!side.is_finite()) return false;
  const double along = std::hypot(side.vertex1()->x() - side.vertex0()->x(), side.vertex1()->y() - side.vertex0()->y());
  const double apart = std::hypot(static_cast<double>(one.x) - other.x, static_cast<double>(one.y) - other.y);
  return along < kDiagonal * apart;
}

}  // namespace

std::vector<DelaunayEdge> delaunay_edges(std::span<const Point> points) {
  std::vector<DelaunayEdge> out;
  if (points.size() < 2) return out;
  std::vector<Site> sites;
  std::vector<boost::polygon::point_data<std::int32_t>> places;
  for (const Site& site : rounded(points)) {
    if (!sites.empty() && sites.back().same_place(site)) {
      out.push_back(between(sites.back(), site));
      continue;
    }
    sites.push_back(site);
    places.emplace_back(site.x, site.y);
  }
  Diagram diagram;
  boost::polygon::construct_voronoi(places.begin(), places.end(), &diagram);
  for (const auto& side : diagram.edges()) {
    const std::size_t here = side.cell()->source_index();
    const std::size_t there = side.twin()->cell()->source_index();
    if (here > there || is_diagonal(side, sites[here], sites[there])) continue;  // each side is there twice
    out.push_back(between(sites[here], sites[there]));
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace footlight::planner
