// SPDX-License-Identifier: Apache-2.0
#include "planner/measure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "core/check.hpp"
#include "planner/judge/approach.hpp"
#include "planner/judge/drawing.hpp"
#include "planner/judge/walks.hpp"
#include "planner/parallel.hpp"
#include "planner/validate.hpp"

namespace footlight::planner {
namespace {

using judge::DrawingJudge;
using judge::FrameJudgement;
using judge::Walks;

std::optional<double> mean_of(std::span<const FrameJudgement> frames, std::optional<double> FrameJudgement::*what) {
  double sum = 0;
  int count = 0;
  for (const FrameJudgement& frame : frames) {
    if (!(frame.*what)) continue;
    sum += *(frame.*what);
    ++count;
  }
  return count > 0 ? std::optional(sum / count) : std::nullopt;
}

void sum_up(std::span<const FrameJudgement> frames, Measures& out) {
  out.theta_dev = mean_of(frames, &FrameJudgement::dev);
  out.theta_miss = mean_of(frames, &FrameJudgement::miss);
  out.theta_iou = mean_of(frames, &FrameJudgement::iou);
  if (!out.theta_dev) return;
  double squares = 0;
  for (const FrameJudgement& frame : frames) {
    if (!frame.dev) continue;
    squares += (*frame.dev - *out.theta_dev) * (*frame.dev - *out.theta_dev);
    ++out.frames;
  }
  out.theta_dev_var = squares / out.frames;
}

/// What somebody walked.
struct Way {
  double walked_m = 0;
  double max_speed_m_s = 0;
  std::uint64_t direction_changes = 0;
  std::uint64_t arrivals = 0;
};

/// Nobody calls less than this a change of direction: cos 30 degrees.
const double kSameDirection = std::sqrt(3.0) / 2;

/// The walks that end in (after, until]; the direction before the first of them is remembered, too.
Way way_of(const std::vector<judge::Stand>& track, Instant after, Instant until) {
  Way way;
  Point direction;  // of the last walk; no length: none yet
  for (std::size_t k = 1; k < track.size() && track[k].time <= until; ++k) {
    const Point walk = track[k].at - track[k - 1].at;
    const double walk_m = length(walk);
    if (walk_m == 0) continue;
    const Point before = std::exchange(direction, (1 / walk_m) * walk);
    if (track[k].time <= after) continue;
    way.walked_m += walk_m;
    way.max_speed_m_s = std::max(way.max_speed_m_s, walk_m / to_seconds(track[k].time - track[k - 1].time));
    ++way.arrivals;
    const bool walked_before = squared_length(before) > 0;
    way.direction_changes += walked_before && dot(before, direction) < kSameDirection - 1e-9 ? 1 : 0;
  }
  return way;
}

/// Of distances, ascending. (2 sum(i x_i) / sum(x) - n - 1) / n, i from 1.
double gini_of(std::span<const double> ascending, double total) {
  if (total <= 0) return 0;
  double weighted = 0;
  for (std::size_t i = 0; i < ascending.size(); ++i) weighted += static_cast<double>(i + 1) * ascending[i];
  const double people = static_cast<double>(ascending.size());
  return std::max(0.0, (2 * weighted / total - people - 1) / people);
}

/// Distances, speeds and turns of the walks that end in (after, until].
void add_walks(const Walks& walks, Instant after, Instant until, Measures& out) {
  std::vector<double> walked_m(walks.people());
  for (std::uint32_t i = 0; i < walks.people(); ++i) {
    const Way way = way_of(walks.track(i), after, until);
    walked_m[i] = way.walked_m;
    out.total_distance_m += way.walked_m;
    out.longest_distance_m = std::max(out.longest_distance_m, way.walked_m);
    out.max_speed_m_s = std::max(out.max_speed_m_s, way.max_speed_m_s);
    out.direction_changes += way.direction_changes;
    out.arrivals += way.arrivals;
  }
  if (walked_m.empty()) return;
  std::sort(walked_m.begin(), walked_m.end());
  const std::size_t half = walked_m.size() / 2;
  out.median_distance_m = walked_m.size() % 2 == 1 ? walked_m[half] : (walked_m[half - 1] + walked_m[half]) / 2;
  out.distance_gini = gini_of(walked_m, out.total_distance_m);
  const double minutes = to_seconds(until - after) / 60;
  if (minutes > 0) {
    out.marks_per_minute = static_cast<double>(out.arrivals) / static_cast<double>(walked_m.size()) / minutes;
  }
}

void add_clearance(const Plan& plan, const Walks& walks, Instant start, Instant end, Measures& out) {
  const judge::Approaches near = judge::find_approaches(plan, walks, start, end, 0);
  out.min_clearance_m = near.nearest.distance_m;
  out.closest_a = PerformerIndex(near.nearest.a);
  out.closest_b = PerformerIndex(near.nearest.b);
  out.closest_at = near.nearest.at;
  out.too_close = near.too_close;
}

/// Frames in batches: parallel inside of a batch, progress between two.
constexpr std::size_t kBatch = 64;
/// How often it is looked at how the crowd moves.
constexpr double kCrowdStep_s = 0.5;

class Measurer {
 public:
  Measurer(const Plan& plan, const std::vector<std::optional<Film>>& films, const Progress& progress)
      : plan_(plan), films_(films), progress_(progress), walks_(plan) {
    FL_CHECK(films.size() == plan.sections.size());
    FL_CHECK(plan.radius_m.size() == plan.tracks.size());
  }

  ShowMeasures run() {
    ShowMeasures out;
    out.sections.resize(plan_.sections.size());
    draw(out);
    const Instant first = walks_.times().empty() ? kStart : walks_.times().front();
    const Instant last = walks_.times().empty() ? kStart : walks_.times().back();
    add_walks(walks_, first, last, out.show);
    add_clearance(plan_, walks_, first, last, out.show);
    Instant after = first;
    for (std::size_t k = 0; k < out.sections.size() && !progress_.stopped(); ++k) {
      const Instant until = std::max(after, plan_.sections[k].end);
      add_walks(walks_, after, until, out.sections[k]);
      if (after == first && until >= last) {
        out.sections[k].min_clearance_m = out.show.min_clearance_m;
        out.sections[k].closest_a = out.show.closest_a;
        out.sections[k].closest_b = out.show.closest_b;
        out.sections[k].closest_at = out.show.closest_at;
        out.sections[k].too_close = out.show.too_close;
      } else {
        add_clearance(plan_, walks_, after, until, out.sections[k]);
      }
      after = until;
    }
    for (const Formation& formation : plan_.formations) {
      ++out.show.formations;
      if (formation.section.at() < out.sections.size()) ++out.sections[formation.section.at()].formations;
    }
    add_crowd(out);
    return out;
  }

 private:
  void add_crowd(ShowMeasures& out) {
    if (progress_.stopped()) return;
    const CrowdSeries series = crowd_series(plan_, kCrowdStep_s);
    out.crowd_classes = series.classes;
    double after_s = -std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < out.sections.size(); ++k) {
      const double until_s = to_seconds(plan_.sections[k].end);
      out.sections[k].crowd = crowd_figures(series, after_s, until_s);
      after_s = std::max(after_s, until_s);
    }
    out.show.crowd = crowd_figures(series, -std::numeric_limits<double>::infinity(), after_s);
  }

  void draw(ShowMeasures& out) {
    std::vector<std::optional<DrawingJudge>> judges(films_.size());
    std::size_t frames = 0;
    for (std::size_t k = 0; k < films_.size(); ++k) {
      if (!films_[k] || !plan_.sections[k].film) continue;
      judges[k].emplace(plan_.stage.grid, plan_.sections[k], walks_, *films_[k]);
      frames += judges[k]->frames().size();
    }
    std::vector<FrameJudgement> all;
    all.reserve(frames);
    for (std::size_t k = 0; k < judges.size(); ++k) {
      if (!judges[k]) continue;
      const std::size_t first = all.size();
      draw_section(*judges[k], frames, all);
      sum_up(std::span(all).subspan(first), out.sections[k]);
    }
    sum_up(all, out.show);
  }

  void draw_section(const DrawingJudge& judge, std::size_t frames, std::vector<FrameJudgement>& all) {
    for (std::size_t first = 0; first < judge.frames().size() && !progress_.stopped(); first += kBatch) {
      const std::size_t count = std::min(kBatch, judge.frames().size() - first);
      const std::size_t at = all.size();
      all.resize(at + count);
      tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count), [&](const auto& range) {
        DrawingJudge::Scratch& scratch = scratch_.local();
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
          all[at + i] = judge.judge(judge.frames()[first + i], scratch);
        }
      });
      progress_.tell("measure", static_cast<double>(all.size()) / static_cast<double>(frames));
    }
  }

  const Plan& plan_;
  const std::vector<std::optional<Film>>& films_;
  const Progress& progress_;
  Walks walks_;
  tbb::enumerable_thread_specific<DrawingJudge::Scratch> scratch_;
};

}  // namespace

ShowMeasures measure_walks(const Plan& plan) {
  ShowMeasures out;
  const Walks walks(plan);
  if (walks.times().empty()) return out;
  const auto nearer = [](double distance_m, PerformerIndex a, PerformerIndex b, Instant at, Measures& measures) {
    if (distance_m >= measures.min_clearance_m) return;
    measures.min_clearance_m = distance_m;
    measures.closest_a = a;
    measures.closest_b = b;
    measures.closest_at = at;
  };
  out.show.min_clearance_m = std::numeric_limits<double>::infinity();
  add_walks(walks, walks.times().front(), walks.times().back(), out.show);
  Instant after = walks.times().front();
  std::size_t next = 0;
  for (const PlanSection& section : plan.sections) {
    Measures& measures = out.sections.emplace_back();
    measures.min_clearance_m = std::numeric_limits<double>::infinity();
    const Instant until = std::max(after, section.end);
    add_walks(walks, after, until, measures);
    bool walked = false;
    for (; next < plan.transitions.size() && plan.transitions[next].end <= until; ++next) {
      const TransitionFacts& facts = plan.transitions[next];
      nearer(facts.clearance_m, facts.closest_a, facts.closest_b, facts.closest_at, measures);
      walked = true;
    }
    if (!walked) {
      const ClosestApproach standing = closest_approach(plan, until, until);
      nearer(standing.distance_m, standing.a, standing.b, after, measures);
    }
    nearer(measures.min_clearance_m, measures.closest_a, measures.closest_b, measures.closest_at, out.show);
    after = until;
  }
  for (const Formation& formation : plan.formations) {
    ++out.show.formations;
    if (formation.section.at() < out.sections.size()) ++out.sections[formation.section.at()].formations;
  }
  return out;
}

ShowMeasures measure(const Plan& plan, const std::vector<std::optional<Film>>& films, const Progress& progress) {
  return Measurer(plan, films, progress).run();
}

std::vector<double> measure_lag(const Plan& plan, const Progress& progress) {
  std::vector<double> lag_s(plan.transitions.size());
  for_each_index(lag_s.size(), "lag", progress, [&](std::size_t k) {
    const TransitionFacts& facts = plan.transitions[k];
    lag_s[k] = tolerated_lag_s(plan, facts.start, std::max(facts.start, facts.end));
  });
  return lag_s;
}

}  // namespace footlight::planner
