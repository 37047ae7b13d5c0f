// SPDX-License-Identifier: Apache-2.0
#include "app/commission/floor_fit.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <Eigen/Dense>
#include <fmt/format.h>

#include "core/rng.hpp"

namespace footlight::app {
namespace {

constexpr double kAgrees = 0.3;   // pitches between a light and the lamp that it is
constexpr double kOnCell = 0.45;  // pitches between a light and the centre of its cell
constexpr int kTries = 3000;
constexpr double kLeastAgree = 0.35;  // of the lamps that the rig has somewhere
constexpr std::size_t kLeastAgreeing = 6;
constexpr double kLeastOnCells = 0.8;  // of the lights, each on a cell of its own
constexpr int kRounds = 8;

struct Match {
  Point picture;
  Point floor;
};

/// Moves the centre of points to the origin and their mean distance to sqrt(2).
Eigen::Matrix3d normalising(const std::vector<Match>& matches, Point Match::*which) {
  Point centre{};
  for (const Match& match : matches) centre = centre + match.*which;
  centre = 1.0 / static_cast<double>(matches.size()) * centre;
  double mean = 0;
  for (const Match& match : matches) mean += distance(match.*which, centre);
  mean /= static_cast<double>(matches.size());
  const double scale = mean > 0 ? std::sqrt(2.0) / mean : 1;
  Eigen::Matrix3d out;
  out << scale, 0, -scale * centre.x, 0, scale, -scale * centre.y, 0, 0, 1;
  return out;
}

/// Direct linear transformation; nothing where the points do not determine it.
std::optional<FloorView> solve(const std::vector<Match>& matches) {
  if (matches.size() < 4) return std::nullopt;
  const Eigen::Matrix3d from = normalising(matches, &Match::picture);
  const Eigen::Matrix3d to = normalising(matches, &Match::floor);
  Eigen::Matrix<double, 9, 9> sum = Eigen::Matrix<double, 9, 9>::Zero();
  for (const Match& match : matches) {
    const Eigen::Vector3d p = from * Eigen::Vector3d(match.picture.x, match.picture.y, 1);
    const Eigen::Vector3d q = to * Eigen::Vector3d(match.floor.x, match.floor.y, 1);
    Eigen::Matrix<double, 9, 1> a;
    a << -p.x(), -p.y(), -1, 0, 0, 0, q.x() * p.x(), q.x() * p.y(), q.x();
    sum += a * a.transpose();
    a << 0, 0, 0, -p.x(), -p.y(), -1, q.y() * p.x(), q.y() * p.y(), q.y();
    sum += a * a.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> solver(sum);
  if (solver.info() != Eigen::Success || solver.eigenvalues()(1) < 1e-9 * solver.eigenvalues()(8)) return std::nullopt;
  const Eigen::Matrix<double, 9, 1> h = solver.eigenvectors().col(0);
  Eigen::Matrix3d normal;
  normal << h(0), h(1), h(2), h(3), h(4), h(5), h(6), h(7), h(8);
  const Eigen::Matrix3d all = to.inverse() * normal * from;
  if (!all.allFinite()) return std::nullopt;
  FloorView view;
  for (int i = 0; i < 9; ++i) view.m[static_cast<std::size_t>(i)] = all(i / 3, i % 3);
  return view;
}

/// The cells on which a lamp may be, for nearest ones.
class Cells {
 public:
  explicit Cells(const Stage& stage) : stage_(stage) {
    for (int i = 0; i < stage.grid.size(); ++i) {
      const CellIndex cell = CellIndex::of(i);
      if (std::ranges::binary_search(stage.blocked, cell)) continue;
      const Point centre = stage.grid.centre(cell);
      at_[key(centre)].push_back(cell);
    }
  }
  /// The cell whose centre is the nearest, within `pitches`.
  [[nodiscard]] std::optional<CellIndex> nearest(Point point, double pitches) const {
    std::optional<CellIndex> best;
    double least = pitches * stage_.grid.pitch_m();
    if (!(std::abs(point.x) < kFar_m && std::abs(point.y) < kFar_m)) return best;
    const auto [column, row] = key(point);
    for (int v = -1; v <= 1; ++v) {
      for (int u = -1; u <= 1; ++u) {
        const auto found = at_.find({column + u, row + v});
        if (found == at_.end()) continue;
        for (const CellIndex cell : found->second) {
          const double away = distance(point, stage_.grid.centre(cell));
          if (away > least) continue;
          least = away;
          best = cell;
        }
      }
    }
    return best;
  }

 private:
  static constexpr double kFar_m = 1e6;
  [[nodiscard]] std::pair<int, int> key(Point point) const {
    return {static_cast<int>(std::floor(point.x / stage_.grid.pitch_m())),
            static_cast<int>(std::floor(point.y / stage_.grid.pitch_m()))};
  }
  const Stage& stage_;
  std::map<std::pair<int, int>, std::vector<CellIndex>> at_;
};

Point picture_of(const SeenLight& light) { return {light.place.x, light.place.y}; }

double cross(Point a, Point b, Point c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

/// The floor as somebody above it sees it, not as in a mirror: y goes down in a picture and up on the floor plan.
bool from_above(const FloorView& view, Point picture) {
  const Point at = view.of(picture.x, picture.y);
  const Point right = view.of(picture.x + 1, picture.y);
  const Point down = view.of(picture.x, picture.y + 1);
  return cross(at, right, down) < 0;
}

/// The side of the floor that is the lowest in the picture.
Viewpoint side_of(const FloorView& view, Point picture) {
  const Point at = view.of(picture.x, picture.y);
  const Point down = view.of(picture.x, picture.y + 1) - at;
  if (std::abs(down.y) >= std::abs(down.x)) return down.y < 0 ? Viewpoint::audience : Viewpoint::upstage;
  return down.x > 0 ? Viewpoint::stage_left : Viewpoint::stage_right;
}

Point middle_of(const std::vector<SeenLight>& lights) {
  Point sum{};
  for (const SeenLight& light : lights) sum = sum + picture_of(light);
  return 1.0 / static_cast<double>(std::max<std::size_t>(1, lights.size())) * sum;
}

/// Lights that are where the rig says.
std::vector<Match> agreeing(const FloorView& view, const std::vector<Match>& claims, double pitch_m) {
  std::vector<Match> out;
  for (const Match& claim : claims) {
    if (distance(view.of(claim.picture.x, claim.picture.y), claim.floor) < kAgrees * pitch_m) out.push_back(claim);
  }
  return out;
}

std::optional<FloorView> by_the_rig(const FilmReading& reading, const std::vector<FloorLamp>& lamps, const Stage& stage,
                                    const FitChoice& choice) {
  const Point middle = middle_of(reading.lights);
  std::vector<Match> claims;
  std::size_t assigned = 0;
  for (const SeenLight& light : reading.lights) {
    if (!light.lamp || !lamps[*light.lamp].cell) continue;
    claims.push_back({picture_of(light), stage.grid.centre(*lamps[*light.lamp].cell)});
    ++assigned;
  }
  const auto needed =
      std::max<std::size_t>(kLeastAgreeing, static_cast<std::size_t>(kLeastAgree * static_cast<double>(assigned)));
  if (claims.size() < needed) return std::nullopt;
  Rng rng(1);
  std::optional<FloorView> best;
  std::size_t most = 0;
  for (int attempt = 0; attempt < kTries && most * 10 < claims.size() * 9; ++attempt) {
    std::vector<Match> four;
    for (int i = 0; i < 4; ++i) four.push_back(claims[rng.below(claims.size())]);
    const auto view = solve(four);
    if (!view || !from_above(*view, middle) || (choice.from && side_of(*view, middle) != *choice.from)) continue;
    const std::size_t agree = agreeing(*view, claims, stage.grid.pitch_m()).size();
    if (agree <= most) continue;
    most = agree;
    best = view;
  }
  for (int round = 0; round < kRounds && best; ++round) {
    const auto agree = agreeing(*best, claims, stage.grid.pitch_m());
    const auto better = solve(agree);
    if (!better || agreeing(*better, claims, stage.grid.pitch_m()).size() < agree.size()) break;
    best = better;
  }
  if (!best || agreeing(*best, claims, stage.grid.pitch_m()).size() < needed) return std::nullopt;
  return best;
}

/// Convex hull, counter-clockwise in coordinates with y upwards (clockwise as a picture shows them).
std::vector<Point> hull_of(std::vector<Point> points) {
  std::ranges::sort(points, {}, [](Point p) { return std::pair(p.x, p.y); });
  std::vector<Point> out;
  for (int side = 0; side < 2; ++side) {
    const std::size_t begin = out.size();
    for (const Point point : points) {
      while (out.size() >= begin + 2 && cross(out[out.size() - 2], out.back(), point) <= 0) out.pop_back();
      out.push_back(point);
    }
    if (!out.empty()) out.pop_back();
    std::ranges::reverse(points);
  }
  return out;
}

/// Where the lines a b and c d meet.
std::optional<Point> meeting(Point a, Point b, Point c, Point d) {
  const double det = (b.x - a.x) * (d.y - c.y) - (b.y - a.y) * (d.x - c.x);
  if (std::abs(det) < 1e-9) return std::nullopt;
  const double t = ((c.x - a.x) * (d.y - c.y) - (c.y - a.y) * (d.x - c.x)) / det;
  return Point{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
}

/// The quadrangle around a hull: again and again the side goes whose neighbours, made longer, add the least area. So a
/// corner whose lamp is dead is found all the same.
std::optional<std::array<Point, 4>> quadrangle(std::vector<Point> hull) {
  while (hull.size() > 4) {
    double least = 1e300;
    std::size_t gone = 0;
    Point corner{};
    for (std::size_t i = 0; i < hull.size(); ++i) {
      const std::size_t n = hull.size();
      const Point a = hull[(i + n - 1) % n];
      const Point b = hull[i];
      const Point c = hull[(i + 1) % n];
      const Point d = hull[(i + 2) % n];
      const auto meet = meeting(a, b, d, c);
      // Beyond b as seen from a, or the neighbours do not meet on this side.
      if (!meet || dot(*meet - b, b - a) < 0) continue;
      const double area = std::abs(cross(b, *meet, c));
      if (area >= least) continue;
      least = area;
      gone = i;
      corner = *meet;
    }
    if (least >= 1e300) return std::nullopt;
    hull[gone] = corner;
    hull.erase(hull.begin() + static_cast<std::ptrdiff_t>((gone + 1) % hull.size()));
  }
  if (hull.size() != 4) return std::nullopt;
  return std::array<Point, 4>{hull[0], hull[1], hull[2], hull[3]};
}

/// Centres of the outermost places of lamps: downstage right, downstage left, upstage left, upstage right (stage
/// right is the smaller x).
std::array<Point, 4> outermost(const Stage& stage) {
  Point low{1e300, 1e300};
  Point high{-1e300, -1e300};
  for (int i = 0; i < stage.grid.size(); ++i) {
    if (std::ranges::binary_search(stage.blocked, CellIndex::of(i))) continue;
    const Point centre = stage.grid.centre(CellIndex::of(i));
    low = {std::min(low.x, centre.x), std::min(low.y, centre.y)};
    high = {std::max(high.x, centre.x), std::max(high.y, centre.y)};
  }
  return {low, {high.x, low.y}, high, {low.x, high.y}};
}

/// Lights on cells, one for each cell: the nearest.
std::vector<Match> on_cells(const FloorView& view, const FilmReading& reading, const Stage& stage, const Cells& cells) {
  std::map<CellIndex, std::pair<double, Match>> nearest;
  for (const SeenLight& light : reading.lights) {
    const Point at = view.of(light.place.x, light.place.y);
    const auto cell = cells.nearest(at, kOnCell);
    if (!cell) continue;
    const Point centre = stage.grid.centre(*cell);
    const double away = distance(at, centre);
    const auto [known, is_new] = nearest.try_emplace(*cell, away, Match{picture_of(light), centre});
    if (!is_new && away < known->second.first) known->second = {away, {picture_of(light), centre}};
  }
  std::vector<Match> out;
  for (const auto& [cell, match] : nearest) out.push_back(match.second);
  return out;
}

/// Improves a view until no more lights come onto cells. @return nothing when too few are
std::optional<FloorView> settle(FloorView view, const FilmReading& reading, const Stage& stage, const Cells& cells) {
  std::size_t before = 0;
  for (int round = 0; round < kRounds; ++round) {
    const auto matches = on_cells(view, reading, stage, cells);
    if (round > 0 && matches.size() < before) break;
    before = matches.size();
    const auto better = solve(matches);
    if (!better) break;
    view = *better;
  }
  const auto on = static_cast<double>(on_cells(view, reading, stage, cells).size());
  if (on < kLeastOnCells * static_cast<double>(reading.lights.size())) return std::nullopt;
  return view;
}

/// The corners of the quadrangle in the order of `outermost`, as somebody at `viewpoint` sees them, to whom side `near`
/// of it is the near one: along that side from left to right, then on around the floor.
std::array<Point, 4> as_seen_from(const std::array<Point, 4>& quad, std::size_t near, Viewpoint viewpoint) {
  const auto turned = static_cast<std::size_t>(viewpoint);  // a quarter turn each
  const bool left_first = quad[near].x < quad[(near + 1) % 4].x;
  std::array<Point, 4> out;
  for (std::size_t i = 0; i < 4; ++i) {
    out[(i + turned) % 4] = quad[left_first ? (near + i) % 4 : (near + 1 + 4 - i) % 4];
  }
  return out;
}

/// Sides of the quadrangle that may be the near one: the lowest in the picture, then its neighbours, for whoever stands
/// aside. Not the one across: a floor fits as well from there.
std::vector<std::size_t> near_sides(const std::array<Point, 4>& quad) {
  const auto height = [&](std::size_t k) { return quad[k % 4].y + quad[(k + 1) % 4].y; };
  std::size_t lowest = 0;
  for (std::size_t i = 1; i < 4; ++i) lowest = height(i) > height(lowest) ? i : lowest;
  const std::size_t before = (lowest + 3) % 4;
  const std::size_t after = (lowest + 1) % 4;
  if (height(before) > height(after)) return {lowest, before, after};
  return {lowest, after, before};
}

FloorFit fit_with(const FloorView& view, std::string by, const FilmReading& reading, const Stage& stage,
                  const Cells& cells) {
  FloorFit out;
  out.view = view;
  out.by = std::move(by);
  out.from = side_of(view, middle_of(reading.lights));
  std::vector<double> errors;
  for (const SeenLight& light : reading.lights) {
    const Point at = view.of(light.place.x, light.place.y);
    out.cell.push_back(cells.nearest(at, kOnCell));
    if (out.cell.back()) errors.push_back(distance(at, stage.grid.centre(*out.cell.back())));
  }
  if (!errors.empty()) {
    const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
    std::ranges::nth_element(errors, middle);
    out.error_m = *middle;
  }
  return out;
}

}  // namespace

std::string_view to_text(Viewpoint viewpoint) {
  switch (viewpoint) {
    case Viewpoint::audience:
      return "audience";
    case Viewpoint::stage_left:
      return "stage-left";
    case Viewpoint::upstage:
      return "upstage";
    case Viewpoint::stage_right:
      return "stage-right";
  }
  return "";
}

Point FloorView::of(double x_px, double y_px) const {
  const double w = m[6] * x_px + m[7] * y_px + m[8];
  return {(m[0] * x_px + m[1] * y_px + m[2]) / w, (m[3] * x_px + m[4] * y_px + m[5]) / w};
}

Result<FloorFit> fit_floor(const FilmReading& reading, const std::vector<FloorLamp>& lamps, const Stage& stage,
                           const FitChoice& choice) {
  const Cells cells(stage);
  const std::array<Point, 4> corners = outermost(stage);
  const auto from_corners = [&](const std::array<Point, 4>& seen) {
    std::vector<Match> four;
    for (std::size_t i = 0; i < 4; ++i) four.push_back({seen[i], corners[i]});
    const auto view = solve(four);
    return view ? settle(*view, reading, stage, cells) : std::nullopt;
  };
  if (choice.corners) {
    if (const auto view = from_corners(*choice.corners)) return fit_with(*view, "the corners", reading, stage, cells);
    return input_error(fmt::format(
        "the corners do not bring the {} lights onto the {} x {} cells of the stage (pixels of the frame at "
        "{:.2f} s: A1, the last cell of row 1, the last cell of all, the last cell of column A)",
        reading.lights.size(), stage.grid.columns(), stage.grid.rows(), reading.reference_s));
  }
  if (const auto view = by_the_rig(reading, lamps, stage, choice))
    return fit_with(*view, "the rig", reading, stage, cells);
  std::vector<Point> points;
  for (const SeenLight& light : reading.lights) points.push_back(picture_of(light));
  if (const auto quad = quadrangle(hull_of(points))) {
    for (const std::size_t near : near_sides(*quad)) {
      const auto view = from_corners(as_seen_from(*quad, near, choice.from.value_or(Viewpoint::audience)));
      if (view) return fit_with(*view, "the grid", reading, stage, cells);
    }
  }
  return input_error(fmt::format(
      "the {} lights of the film do not come onto the {} x {} cells of the stage, neither by the rig nor by "
      "their grid (--corners tells where the corners are in the frame at {:.2f} s, --from where the film "
      "was taken)",
      reading.lights.size(), stage.grid.columns(), stage.grid.rows(), reading.reference_s));
}

SeenPlaces places_of(const FilmReading& reading, const FloorFit& fit, std::size_t lamps) {
  SeenPlaces out;
  out.cell.resize(lamps);
  std::vector<float> light(lamps, -1);
  for (std::size_t i = 0; i < reading.lights.size(); ++i) {
    const SeenLight& seen = reading.lights[i];
    if (!seen.lamp) {
      if (fit.cell[i]) out.unread.push_back(*fit.cell[i]);
      continue;
    }
    if (!fit.cell[i]) {
      ++out.beside;
      continue;
    }
    if (light[*seen.lamp] >= 0) ++out.reflections;
    if (seen.place.light <= light[*seen.lamp]) continue;
    light[*seen.lamp] = seen.place.light;
    out.cell[*seen.lamp] = fit.cell[i];
  }
  std::map<CellIndex, int> lamps_on;
  for (const auto& cell : out.cell) {
    if (cell) ++lamps_on[*cell];
  }
  for (auto& cell : out.cell) {
    if (!cell || lamps_on[*cell] < 2) continue;
    out.unread.push_back(*cell);
    cell.reset();
  }
  std::ranges::sort(out.unread);
  out.unread.erase(std::unique(out.unread.begin(), out.unread.end()), out.unread.end());
  return out;
}

}  // namespace footlight::app
