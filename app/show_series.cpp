// SPDX-License-Identifier: Apache-2.0
#include "app/show_series.hpp"

#include <algorithm>
#include <limits>

#include "planner/judge/drawing.hpp"
#include "planner/validate.hpp"

namespace footlight::app {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

}  // namespace

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
