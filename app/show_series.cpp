// SPDX-License-Identifier: Apache-2.0
#include "app/show_series.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "app/paper/drawn_floor.hpp"
#include "planner/judge/drawing.hpp"
#include "planner/validate.hpp"

namespace footlight::app {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr int kBins = 10;
constexpr int kSectors = 8;
constexpr int kPaces = 8;

double deviation(const std::vector<double>& values) {
  if (values.empty()) return kNone;
  double mean = 0;
  for (const double value : values) mean += value;
  mean /= static_cast<double>(values.size());
  double sum = 0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// Distance from everybody to whoever is nearest; nobody else: left out.
std::vector<double> nearest_of(const Grid& grid, const std::vector<Point>& where) {
  std::vector<std::vector<std::size_t>> on_cell(static_cast<std::size_t>(grid.size()));
  for (std::size_t p = 0; p < where.size(); ++p) on_cell[grid.nearest(where[p]).at()].push_back(p);
  const double across = distance(grid.centre(CellIndex(0)), grid.centre(CellIndex::of(grid.size() - 1)));
  std::vector<double> out;
  for (std::size_t p = 0; p < where.size(); ++p) {
    double best = std::numeric_limits<double>::infinity();
    for (double radius = 2 * grid.pitch_m();; radius *= 2) {
      for (const CellIndex cell : grid.within(where[p], radius)) {
        for (const std::size_t other : on_cell[cell.at()]) {
          if (other != p) best = std::min(best, distance(where[p], where[other]));
        }
      }
      // Whoever is not on these cells is farther away than the radius less a cell.
      if (best <= radius - grid.pitch_m() || radius > 2 * across) break;
    }
    if (std::isfinite(best)) out.push_back(best);
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

/// Which of equal classes a share of a whole falls into; what is on an edge but for rounding is on it.
int class_of(double share, int classes) {
  constexpr double kRounding = 1e-9;
  return std::clamp(static_cast<int>(std::floor(share * classes + kRounding)), 0, classes - 1);
}

/// What places tell of how those walk who walk. Not a number: nobody does.
struct Information {
  double direction = kNone;
  double pace = kNone;
};

Information information_of(const Plan& plan, const std::vector<Point>& where, Instant at, const Frame& floor,
                           double fastest_mps) {
  using Pairs = std::vector<std::pair<int, int>>;
  const double bin_m = std::max(floor.high.x - floor.low.x, floor.high.y - floor.low.y) / kBins;
  Pairs across_direction;
  Pairs up_direction;
  Pairs across_pace;
  Pairs up_pace;
  for (std::size_t p = 0; p < where.size(); ++p) {
    const Point velocity = velocity_at(plan.stage.grid, plan.tracks[p], at);
    if (velocity == Point{}) continue;
    const double turn = (std::atan2(velocity.y, velocity.x) + std::numbers::pi) / (2 * std::numbers::pi);
    const int sector = std::min(kSectors - 1, static_cast<int>(turn * kSectors));
    const int pace = class_of(length(velocity) / fastest_mps, kPaces);
    const auto across = static_cast<int>((where[p].x - floor.low.x) / bin_m);
    const auto up = static_cast<int>((where[p].y - floor.low.y) / bin_m);
    across_direction.emplace_back(across, sector);
    up_direction.emplace_back(up, sector);
    across_pace.emplace_back(across, pace);
    up_pace.emplace_back(up, pace);
  }
  if (across_direction.empty()) return {};
  const auto mean = [](const Pairs& a, const Pairs& b) {
    return (mutual_information_bits(a) + mutual_information_bits(b)) / 2;
  };
  return {mean(across_direction, up_direction), mean(across_pace, up_pace)};
}

}  // namespace

double mutual_information_bits(const std::vector<std::pair<int, int>>& pairs) {
  std::map<int, double> first;
  std::map<int, double> second;
  std::map<std::pair<int, int>, double> both;
  for (const auto& [a, b] : pairs) {
    ++first[a];
    ++second[b];
    ++both[{a, b}];
  }
  const double n = static_cast<double>(pairs.size());
  double out = 0;
  for (const auto& [pair, count] : both) {
    out += count / n * std::log2(count * n / (first[pair.first] * second[pair.second]));
  }
  return out;
}

DrawingSeries drawing_series(const Plan& plan, const Films& films) {
  DrawingSeries out;
  const planner::judge::Walks walks(plan);
  for (std::size_t s = 0; s < plan.sections.size() && s < films.size(); ++s) {
    const PlanSection& section = plan.sections[s];
    if (!films[s] || !section.film) continue;
    const planner::judge::DrawingJudge judge(plan.stage.grid, section, walks, *films[s]);
    planner::judge::DrawingJudge::Scratch scratch;
    // The line is not drawn on between two films.
    if (!out.time_s.empty()) {
      out.time_s.push_back(to_seconds(section.start));
      out.dev.push_back(kNone);
      out.miss.push_back(kNone);
    }
    const auto add = [&](double time_s, const planner::judge::FrameJudgement& judged) {
      out.time_s.push_back(time_s);
      out.dev.push_back(judged.dev.value_or(kNone));
      out.miss.push_back(judged.miss.value_or(kNone));
    };
    for (const std::size_t frame : judge.frames()) {
      const auto judged = judge.judge(frame, scratch);
      const double since =
          static_cast<double>(films[s]->first_frame + static_cast<int>(frame) - section.film->first_frame);
      const double fps = section.film->show_fps;
      add(to_seconds(section.start) + (fps > 0 ? since / fps : 0), judged);
      if (fps == 0) add(to_seconds(section.end), judged);  // an image stands as long as its section
    }
  }
  return out;
}

ClearanceSeries clearance_series(const Plan& plan, double stretch_s) {
  ClearanceSeries out;
  const Instant end = plan.sections.back().end;
  for (Instant from = plan.sections.front().start; from < end; from += seconds(stretch_s)) {
    const auto nearest = planner::closest_approach(plan, from, std::min(end, from + seconds(stretch_s)));
    out.time_s.push_back(to_seconds(from));
    out.least_m.push_back(nearest.distance_m);
    out.a.push_back(nearest.a);
    out.b.push_back(nearest.b);
    out.at_s.push_back(to_seconds(nearest.at));
  }
  return out;
}

CrowdSeries crowd_series(const Plan& plan, double step_s) {
  CrowdSeries out;
  const Grid& grid = plan.stage.grid;
  const Frame floor(grid, {}, 1, 1);
  const Instant end = plan.sections.back().end;
  std::vector<Point> where(plan.tracks.size());
  std::vector<Point> source(plan.tracks.size());
  const std::vector<double> fastest = way_figures(plan).fastest_mps;
  const double fastest_mps = fastest.empty() ? 0 : *std::ranges::max_element(fastest);
  std::size_t formation = 0;
  bool sourced = false;
  for (Instant at = plan.sections.front().start; at <= end; at += seconds(step_s)) {
    while (formation + 1 < plan.formations.size() && plan.formations[formation + 1].time <= at) {
      ++formation;
      sourced = false;
    }
    const Instant since = formation < plan.formations.size() ? plan.formations[formation].time : at;
    std::vector<double> effort;
    for (std::size_t p = 0; p < where.size(); ++p) {
      where[p] = position_at(grid, plan.tracks[p], at);
      if (!sourced) source[p] = position_at(grid, plan.tracks[p], since);
      effort.push_back(distance(source[p], where[p]));
    }
    sourced = true;
    out.time_s.push_back(to_seconds(at));
    const Information information = information_of(plan, where, at, floor, fastest_mps);
    out.information.push_back(information.direction);
    out.pace_information.push_back(information.pace);
    out.sigma_nearest_m.push_back(deviation(nearest_of(grid, where)));
    out.sigma_effort_m.push_back(deviation(effort));
  }
  return out;
}

WayFigures way_figures(const Plan& plan) {
  WayFigures out;
  for (const auto& track : plan.tracks) {
    double walked = 0;
    double fastest = 0;
    for (std::size_t k = 1; k < track.size(); ++k) {
      const double way = distance(plan.stage.grid.centre(track[k - 1].cell), plan.stage.grid.centre(track[k].cell));
      walked += way;
      fastest = std::max(fastest, way / to_seconds(track[k].time - track[k - 1].time));
    }
    out.walked_m.push_back(walked);
    out.fastest_mps.push_back(fastest);
  }
  return out;
}

}  // namespace footlight::app
