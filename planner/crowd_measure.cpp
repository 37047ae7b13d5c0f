// SPDX-License-Identifier: Apache-2.0
#include "planner/crowd_measure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <tbb/parallel_for.h>

#include "core/check.hpp"
#include "core/rng.hpp"

namespace footlight::planner {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr int kBins = 10;
constexpr int kSectors = 8;
constexpr int kDeals = 4;

double deviation(std::span<const double> values) {
  if (values.empty()) return kNone;
  double mean = 0;
  for (const double value : values) mean += value;
  mean /= static_cast<double>(values.size());
  double sum = 0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// Distance from everybody to whoever is nearest; nothing for one person alone. Sorted along x, so that nobody is
/// looked at who is farther away by x alone.
std::vector<double> nearest_of(std::span<const Point> where) {
  if (where.size() < 2) return {};
  std::vector<std::size_t> order(where.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return where[a].x < where[b].x; });
  std::vector<double> out(where.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const Point here = where[order[k]];
    double best = std::numeric_limits<double>::infinity();
    const auto look = [&](std::size_t other) {
      const Point away = where[order[other]] - here;
      best = std::min(best, squared_length(away));
      return away.x * away.x < best;
    };
    for (std::size_t other = k; other-- > 0 && look(other);) {
    }
    for (std::size_t other = k + 1; other < order.size() && look(other); ++other) {
    }
    out[order[k]] = std::sqrt(best);
  }
  return out;
}

/// Metres a second; zero for who stands.
Point velocity_at(const Grid& grid, const std::vector<Mark>& track, Instant instant) {
  const auto after =
      std::upper_bound(track.begin(), track.end(), instant, [](Instant t, const Mark& mark) { return t < mark.time; });
  if (after == track.begin() || after == track.end()) return {};
  const Mark& from = *std::prev(after);
  return (1 / to_seconds(after->time - from.time)) * (grid.centre(after->cell) - grid.centre(from.cell));
}

/// The ways of walking of those who walk, dealt out anew among them.
std::vector<Point> dealt(std::span<const Point> velocity, Rng rng) {
  std::vector<Point> out(velocity.begin(), velocity.end());
  std::vector<std::size_t> who;
  for (std::size_t p = 0; p < out.size(); ++p) {
    if (out[p] != Point{}) who.push_back(p);
  }
  for (std::size_t i = who.size(); i > 1; --i) std::swap(out[who[i - 1]], out[who[rng.below(i)]]);
  return out;
}

/// When the transform began that somebody sees at each instant, ascending.
std::vector<Instant> sources_of(const Plan& plan) {
  std::vector<Instant> out;
  for (std::size_t s = 0; s < plan.sections.size(); ++s) {
    bool key = false;
    for (const Formation& formation : plan.formations) {
      if (formation.section.at() != s || !formation.key) continue;
      // The last formation of a transform is where the next one begins.
      key = key || formation.time < plan.sections[s].end;
      out.push_back(formation.time);
    }
    if (!key) out.push_back(plan.sections[s].start);
  }
  if (!plan.sections.empty()) out.push_back(plan.sections.front().start);
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

CrowdInstant crowd_at(std::span<const Point> position, std::span<const Point> velocity, std::span<const Point> source,
                      const InformationClasses& classes, std::uint64_t deal) {
  FL_CHECK(position.size() == velocity.size() && position.size() == source.size());
  CrowdInstant out;
  out.information = place_information(position, velocity, classes);
  const Rng rng(deal);
  for (std::uint64_t k = 0; k < kDeals; ++k) {
    const PlaceInformation chance = place_information(position, dealt(velocity, rng.split(k)), classes);
    out.shuffled_direction_bits += chance.direction_bits / kDeals;
    out.shuffled_speed_bits += chance.speed_bits / kDeals;
  }
  out.sigma_nearest_m = deviation(nearest_of(position));
  std::vector<double> effort(position.size());
  for (std::size_t p = 0; p < effort.size(); ++p) effort[p] = distance(source[p], position[p]);
  out.sigma_effort_m = deviation(effort);
  return out;
}

InformationClasses classes_of(const Grid& grid, double fastest_mps) {
  const double half_m = grid.pitch_m() / 2;
  Point low = grid.centre(CellIndex(0));
  Point high = low;
  // Rows and columns are straight but for the shift of every second one.
  for (const int row : {0, std::min(1, grid.rows() - 1), std::max(0, grid.rows() - 2), grid.rows() - 1}) {
    for (const int column : {0, std::min(1, grid.columns() - 1), std::max(0, grid.columns() - 2), grid.columns() - 1}) {
      const Point at = grid.centre(Cell{column, row});
      low = {std::min(low.x, at.x), std::min(low.y, at.y)};
      high = {std::max(high.x, at.x), std::max(high.y, at.y)};
    }
  }
  const double longer_m = std::max(high.x - low.x, high.y - low.y) + 2 * half_m;
  return {{low.x - half_m, low.y - half_m}, longer_m / kBins, kSectors, fastest_mps};
}

double fastest_walk_mps(const Plan& plan) {
  double fastest = 0;
  for (const auto& track : plan.tracks) {
    for (std::size_t k = 1; k < track.size(); ++k) {
      const double way_m = distance(plan.stage.grid.centre(track[k - 1].cell), plan.stage.grid.centre(track[k].cell));
      fastest = std::max(fastest, way_m / to_seconds(track[k].time - track[k - 1].time));
    }
  }
  return fastest;
}

CrowdSeries crowd_series(const Plan& plan, double step_s) {
  CrowdSeries out;
  const Grid& grid = plan.stage.grid;
  out.classes = classes_of(grid, fastest_walk_mps(plan));
  if (plan.sections.empty()) return out;
  std::vector<Instant> times;
  for (Instant at = plan.sections.front().start; at <= plan.sections.back().end; at += seconds(step_s)) {
    times.push_back(at);
    out.time_s.push_back(to_seconds(at));
  }
  out.at.resize(times.size());
  const std::vector<Instant> sources = sources_of(plan);
  const std::size_t people = plan.tracks.size();
  tbb::parallel_for(std::size_t{0}, times.size(), [&](std::size_t k) {
    const Instant since = *std::prev(std::upper_bound(sources.begin(), sources.end(), times[k]));
    std::vector<Point> position(people);
    std::vector<Point> velocity(people);
    std::vector<Point> source(people);
    for (std::size_t p = 0; p < people; ++p) {
      position[p] = position_at(grid, plan.tracks[p], times[k]);
      velocity[p] = velocity_at(grid, plan.tracks[p], times[k]);
      source[p] = position_at(grid, plan.tracks[p], since);
    }
    out.at[k] = crowd_at(position, velocity, source, out.classes, k);
  });
  return out;
}

std::optional<CrowdFigures> crowd_figures(const CrowdSeries& series, double from_s, double until_s) {
  CrowdFigures sum;
  for (std::size_t k = 0; k < series.at.size(); ++k) {
    const CrowdInstant& at = series.at[k];
    if (series.time_s[k] < from_s || series.time_s[k] >= until_s || at.information.moving == 0) continue;
    ++sum.instants;
    sum.moving += at.information.moving;
    sum.direction_bits += at.information.direction_bits;
    sum.speed_bits += at.information.speed_bits;
    sum.shuffled_direction_bits += at.shuffled_direction_bits;
    sum.shuffled_speed_bits += at.shuffled_speed_bits;
    sum.sigma_nearest_m += at.sigma_nearest_m;
    sum.sigma_effort_m += at.sigma_effort_m;
  }
  if (sum.instants == 0) return std::nullopt;
  for (double CrowdFigures::*figure : {&CrowdFigures::moving, &CrowdFigures::direction_bits, &CrowdFigures::speed_bits,
                                       &CrowdFigures::shuffled_direction_bits, &CrowdFigures::shuffled_speed_bits,
                                       &CrowdFigures::sigma_nearest_m, &CrowdFigures::sigma_effort_m}) {
    sum.*figure /= static_cast<double>(sum.instants);
  }
  return sum;
}

}  // namespace footlight::planner
