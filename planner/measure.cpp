// SPDX-License-Identifier: Apache-2.0
#include "planner/measure.hpp"

#include <algorithm>
#include <span>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "core/check.hpp"
#include "planner/judge/approach.hpp"
#include "planner/judge/drawing.hpp"
#include "planner/judge/walks.hpp"

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

/// Distances and speeds of the walks that end in (after, until].
void add_walks(const Walks& walks, Instant after, Instant until, Measures& out) {
  for (std::uint32_t i = 0; i < walks.people(); ++i) {
    const auto& track = walks.track(i);
    double way_m = 0;
    for (std::size_t k = 1; k < track.size(); ++k) {
      if (track[k].time <= after || track[k].time > until) continue;
      const double walk_m = distance(track[k - 1].at, track[k].at);
      way_m += walk_m;
      out.max_speed_m_s = std::max(out.max_speed_m_s, walk_m / to_seconds(track[k].time - track[k - 1].time));
    }
    out.total_distance_m += way_m;
    out.longest_distance_m = std::max(out.longest_distance_m, way_m);
  }
}

void add_clearance(const Plan& plan, const Walks& walks, Instant start, Instant end, Measures& out) {
  const judge::Approaches near = judge::find_approaches(plan, walks, start, end, 0);
  out.min_clearance_m = near.nearest.distance_m;
  out.too_close = near.too_close;
}

/// Frames in batches: parallel inside of a batch, progress between two.
constexpr std::size_t kBatch = 64;

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
    return out;
  }

 private:
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

ShowMeasures measure(const Plan& plan, const std::vector<std::optional<Film>>& films, const Progress& progress) {
  return Measurer(plan, films, progress).run();
}

}  // namespace footlight::planner
