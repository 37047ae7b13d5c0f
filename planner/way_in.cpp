// SPDX-License-Identifier: Apache-2.0
#include "planner/way_in.hpp"

#include <algorithm>
#include <utility>

#include "core/check.hpp"
#include "planner/motion/cell_steps.hpp"
#include "planner/validate.hpp"
#include "planner/way_in/search.hpp"
#include "planner/way_in/stretch.hpp"

namespace footlight::planner {
namespace {

/// Steps reach so many pitches: two cells ahead and the knight's.
constexpr double kReach = 2.3;

double keep_of(const Plan& plan) {
  double keep_m = plan.stage.clearance_m / 2;
  for (const double radius : plan.radius_m) keep_m = std::max(keep_m, radius);
  return keep_m;
}

struct Box {
  Point low;
  Point high;
};

/// Around all marks that matter between two instants.
Box box_of(const Grid& grid, const std::vector<Mark>& track, Instant start, Instant end) {
  const auto later = [](Instant at, const Mark& mark) { return at < mark.time; };
  auto mark = std::upper_bound(track.begin(), track.end(), start, later);
  if (mark != track.begin()) --mark;
  Box box{grid.centre(mark->cell), grid.centre(mark->cell)};
  for (; mark != track.end(); ++mark) {
    const Point at = grid.centre(mark->cell);
    box.low = {std::min(box.low.x, at.x), std::min(box.low.y, at.y)};
    box.high = {std::max(box.high.x, at.x), std::max(box.high.y, at.y)};
    if (mark->time >= end) break;
  }
  return box;
}

/// Her marks, then what the plan says from there on.
std::vector<Mark> with_own_walk(std::vector<Mark> marks, const std::vector<Mark>& own) {
  for (const Mark& mark : own) {
    if (mark.time > marks.back().time) marks.push_back(mark);
  }
  return marks;
}

/// What `validate` has to say: the plan with her track in the place of her own, of those whose walks come near it.
class Judged {
 public:
  Judged(const Plan& plan, const WayInTask& task, std::vector<Mark> track, Instant end)
      : plan_(plan), task_(task), start_(track.front().time), end_(end) {
    part_.stage = plan.stage;
    part_.sections = plan.sections;
    near_ = box_of(plan.stage.grid, track, start_, end);
    double widest_m = plan.stage.clearance_m;
    for (const double radius : plan.radius_m) widest_m = std::max(widest_m, 2 * radius);
    near_.low = near_.low - Point{widest_m, widest_m};
    near_.high = near_.high + Point{widest_m, widest_m};
    add(task.who, std::move(track));  // the first of all
    for (std::uint32_t i = 0; i < plan.tracks.size(); ++i) add_other(PerformerIndex(i));
  }
  /// Whether she breaks no limit; what is wrong between others was so without her.
  [[nodiscard]] bool valid() const {
    const Verdict verdict = validate(part_, start_, end_);
    const auto hers = [](const Violation& one) { return one.a.value() == 0 || one.b.value() == 0; };
    return verdict.violations == verdict.first.size() && std::none_of(verdict.first.begin(), verdict.first.end(), hers);
  }

 private:
  void add_other(PerformerIndex who) {
    if (who == task_.who) return;
    std::vector<Mark> track = plan_.tracks[who.at()];
    for (const GivenWay& given : task_.given) {
      if (given.who != who || given.marks.empty() || given.marks.back().time <= start_) continue;
      track = with_own_walk(given.marks, plan_.tracks[who.at()]);
      if (track.front().time > start_) track.insert(track.begin(), {start_, track.front().cell});
    }
    if (track.back().time < end_) track.push_back({end_, track.back().cell});
    if (track.front().time > start_) track.insert(track.begin(), {start_, track.front().cell});
    const Box box = box_of(plan_.stage.grid, track, start_, end_);
    const bool apart =
        box.low.x > near_.high.x || box.high.x < near_.low.x || box.low.y > near_.high.y || box.high.y < near_.low.y;
    if (!apart) add(who, std::move(track));
  }
  void add(PerformerIndex who, std::vector<Mark> track) {
    part_.performers.push_back(plan_.performers[who.at()]);
    part_.radius_m.push_back(plan_.radius_m[who.at()]);
    part_.max_speed_mps.push_back(plan_.max_speed_mps[who.at()]);
    part_.tracks.push_back(std::move(track));
  }

  const Plan& plan_;
  const WayInTask& task_;
  Instant start_;
  Instant end_;
  Box near_;
  Plan part_;
};

}  // namespace

struct WaysIn::Floor {
  explicit Floor(const Plan& plan)
      : ways(plan.stage, keep_of(plan)), reach_m(kReach * plan.stage.grid.pitch_m()), steps(ways, reach_m) {}
  Ways ways;
  double reach_m;
  CellSteps steps;
};

WaysIn::WaysIn(const Plan& plan) : plan_(plan), floor_(std::make_unique<const Floor>(plan)) {}
WaysIn::~WaysIn() = default;

bool WaysIn::can_stand(CellIndex cell) const {
  return static_cast<int>(cell.value()) < plan_.stage.grid.size() && floor_->ways.can_stand(cell);
}

std::shared_ptr<const WaysIn::Stretch> WaysIn::stretch(std::vector<Instant> beats, double lag_s) const {
  return std::make_shared<const Stretch>(plan_, std::move(beats), lag_s);
}

WayIn WaysIn::find(const Stretch& stretch, const WayInTask& task) const {
  FL_CHECK(task.who.at() < plan_.tracks.size() && can_stand(task.from) && task.speed_mps > 0);
  WayInSearch search(plan_, floor_->ways, floor_->steps, floor_->reach_m, stretch, task);
  if (auto marks = search.to_own_walk()) {
    const Instant joins = marks->back().time;
    if (Judged(plan_, task, with_own_walk(*marks, plan_.tracks[task.who.at()]), joins).valid()) {
      return {WayIn::Kind::join, std::move(*marks), joins};
    }
  }
  const auto refuge = search.to_refuge();
  if (!refuge) return {WayIn::Kind::nowhere, {}, search.begins()};
  std::vector<Mark> track = *refuge;
  if (track.size() == 1 && search.ends() > track.front().time) track.push_back({search.ends(), track.front().cell});
  if (!Judged(plan_, task, track, search.ends()).valid()) return {WayIn::Kind::nowhere, {}, search.begins()};
  const bool stays = std::all_of(track.begin(), track.end(), [&](const Mark& one) { return one.cell == task.from; });
  return {stays ? WayIn::Kind::wait : WayIn::Kind::aside, std::move(track), search.ends()};
}

}  // namespace footlight::planner
