// SPDX-License-Identifier: Apache-2.0
#include "planner/formation/best_single.hpp"

#include <algorithm>
#include <cmath>

#include "planner/formation/cell_shares.hpp"
#include "planner/parallel.hpp"
#include "planner/schedule/ways.hpp"

namespace footlight::planner {

SingleBest best_single(const SingleTask& task) {
  std::vector<double> shares;
  for (std::size_t i = 0; i < task.shares->size(); ++i) {
    if ((*task.usable)[i] != 0) shares.push_back((*task.shares)[i]);
  }
  std::sort(shares.begin(), shares.end(), std::greater<>());
  SingleBest now{0, 0, task.area};
  std::optional<SingleBest> best;
  const int most = std::min(task.most, static_cast<int>(shares.size()));
  const int least = std::min(task.least, most);
  for (int n = 0; n <= most; ++n) {
    if (n > 0) now.covered += shares[static_cast<std::size_t>(n) - 1];
    now.people = n;
    if (n >= least && (!best || now.dev() + now.iou() < best->dev() + best->iou())) best = now;
  }
  return *best;
}

std::optional<SingleFigures> best_of_frames(const Plan& plan, SectionIndex index, const Film& film) {
  const PlanSection& section = plan.sections[index.at()];
  if (!section.film || film.frames.empty()) return std::nullopt;
  const Grid& grid = plan.stage.grid;
  const StageToFrame& map = section.film->stage_to_frame;
  const double cell_px = grid.cell_area_m2() * std::abs(map[0] * map[4] - map[1] * map[3]);
  const double widest_m = plan.radius_m.empty() ? 0 : *std::max_element(plan.radius_m.begin(), plan.radius_m.end());
  const Ways ways(plan.stage, std::max(plan.stage.clearance_m / 2, widest_m));
  CellFlags usable = ways.standable();
  int waiting = 0;
  for (const CellIndex cell : section.reserve) {
    waiting += usable[cell.at()];
    usable[cell.at()] = 0;
  }
  const int people = static_cast<int>(plan.tracks.size());
  const std::size_t frames = section.film->show_fps > 0 ? film.frames.size() : 1;
  std::vector<SingleBest> best(frames);
  for_each_index(frames, "best", {}, [&](std::size_t f) {
    const auto shares = cell_shares(film.frames[f], grid, map);
    best[f] = best_single({&shares, &usable, static_cast<double>(picture_area(film.frames[f])) / cell_px,
                           std::max(0, people - waiting), people});
  });
  SingleFigures sum;
  int peopled = 0;
  int drawn = 0;
  int either = 0;
  for (const SingleBest& one : best) {
    sum.theta_dev += one.dev();
    sum.theta_miss += one.miss();
    sum.theta_iou += one.iou();
    peopled += one.people > 0 ? 1 : 0;
    drawn += one.area > 0 ? 1 : 0;
    either += one.people > 0 || one.area > 0 ? 1 : 0;
  }
  sum.theta_dev /= std::max(1, peopled);
  sum.theta_miss /= std::max(1, drawn);
  sum.theta_iou /= std::max(1, either);
  return sum;
}

}  // namespace footlight::planner
