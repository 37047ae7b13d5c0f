// SPDX-License-Identifier: Apache-2.0
#include "planner/repair/lateness.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace footlight::planner {
namespace {

/// Wait or walk: stands at `origin` + clock x velocity for clocks in [first, last].
struct Piece {
  Point origin;
  Point velocity;  // m per whole time
  double first = 0;
  double last = 1;
};

struct Pieces {
  std::array<Piece, 3> at;
  int count = 0;
};

Pieces pieces_of(const TimedWalk& timed) {
  Pieces out;
  const auto add = [&](Piece piece) { out.at[static_cast<std::size_t>(out.count++)] = piece; };
  if (timed.start > 0) add({timed.walk.from, {}, 0, timed.start});
  const Point velocity = 1 / (timed.end - timed.start) * (timed.walk.to - timed.walk.from);
  add({timed.walk.from - timed.start * velocity, velocity, timed.start, timed.end});
  if (timed.end < 1) add({timed.walk.to, {}, timed.end, 1});
  return out;
}

/// Least |start + t way|^2 for t in [first, last]; infinity when that is empty.
double least_on_line(Point start, Point way, double first, double last) {
  if (first > last) return std::numeric_limits<double>::infinity();
  const double square = squared_length(way);
  const double t = square > 0 ? std::clamp(-dot(start, way) / square, first, last) : first;
  return squared_length(start + t * way);
}

double least_of_pieces(const Piece& a, const Piece& b, double share) {
  if (a.first > b.last + share || b.first > a.last + share) return std::numeric_limits<double>::infinity();
  const Point d = a.origin - b.origin;
  const Point v = a.velocity;
  const Point w = b.velocity;
  // Their paths cross: both may be at the crossing at once.
  const double cross = v.x * w.y - v.y * w.x;
  if (std::abs(cross) > 1e-12 * (squared_length(v) + squared_length(w))) {
    const double s = (w.x * d.y - w.y * d.x) / cross;
    const double u = (v.x * d.y - v.y * d.x) / cross;
    if (s >= a.first && s <= a.last && u >= b.first && u <= b.last && std::abs(s - u) <= share) return 0;
  }
  // One clock as late as it may be behind the other.
  const double ahead =
      least_on_line(d + share * v, v - w, std::max(b.first, a.first - share), std::min(b.last, a.last - share));
  const double behind =
      least_on_line(d - share * w, v - w, std::max(a.first, b.first - share), std::min(a.last, b.last - share));
  double least = std::min(ahead, behind);
  // One of the two at an end of its piece.
  for (const double s : {a.first, a.last}) {
    least =
        std::min(least, least_on_line(d + s * v, -1 * w, std::max(b.first, s - share), std::min(b.last, s + share)));
  }
  for (const double u : {b.first, b.last}) {
    least = std::min(least, least_on_line(d - u * w, v, std::max(a.first, u - share), std::min(a.last, u + share)));
  }
  return least;
}

}  // namespace

double least_squared_when_late_m2(const TimedWalk& a, const TimedWalk& b, double share) {
  const Pieces of_a = pieces_of(a);
  const Pieces of_b = pieces_of(b);
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < of_a.count; ++i) {
    for (int j = 0; j < of_b.count; ++j) {
      least = std::min(
          least, least_of_pieces(of_a.at[static_cast<std::size_t>(i)], of_b.at[static_cast<std::size_t>(j)], share));
    }
  }
  return least;
}

double least_squared_along_m2(std::span<const Knot> a, std::span<const Knot> b, double share) {
  const auto piece = [](const Knot& from, const Knot& to) {
    const Point velocity = 1 / (to.at - from.at) * (to.point - from.point);
    return Piece{from.point - from.at * velocity, velocity, from.at, to.at};
  };
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < a.size(); ++i) {
    for (std::size_t j = 0; j + 1 < b.size(); ++j) {
      if (b[j + 1].at + share < a[i].at) continue;
      if (b[j].at - share > a[i + 1].at) break;
      least = std::min(least, least_of_pieces(piece(a[i], a[i + 1]), piece(b[j], b[j + 1]), share));
    }
  }
  return least;
}

}  // namespace footlight::planner
