// SPDX-License-Identifier: Apache-2.0
#include "planner/freeze.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>
#include <utility>

#include "core/check.hpp"
#include "planner/judge/approach.hpp"
#include "planner/judge/freeze_spans.hpp"
#include "planner/judge/geometry.hpp"
#include "planner/judge/walks.hpp"
#include "planner/parallel.hpp"

namespace footlight::planner {
namespace {

using judge::Walks;

/// Somebody walks straight, or stands, from one instant to another.
struct Leg {
  Instant begins;
  Instant ends;
  Point from;
  Point to;
  std::uint32_t who = 0;
  [[nodiscard]] bool walks() const { return from != to; }
};

struct Touches {
  std::vector<Touch> freeze;
  std::vector<Touch> resume;
};

/// A stretch of the show in which it does not wait: legs in the order of their beginnings, each compared with those
/// near its way that have begun before it. What is near is found on a uniform grid, in whose squares every leg lies
/// that comes within half of the clearance.
class Stretch {
 public:
  Stretch(const Plan& plan, Instant from, Instant to, Duration late)
      : plan_(plan), from_(from), to_(to), late_(late), square_m_(2 * plan.stage.grid.pitch_m()) {
    double reach_m = plan.stage.clearance_m / 2;
    for (const double radius_m : plan.radius_m) reach_m = std::max(reach_m, radius_m);
    reach_m_ = reach_m;
  }

  Touches run(const Walks& walks) {
    for (std::uint32_t i = 0; i < walks.people(); ++i) cut_legs(walks, i);
    if (legs_.empty()) return {};
    std::ranges::sort(legs_, {}, [](const Leg& leg) { return std::tie(leg.begins, leg.who); });
    lay_squares();
    compared_.assign(legs_.size(), kNobody);
    for (std::uint32_t i = 0; i < legs_.size(); ++i) {
      for_squares(legs_[i], [&](std::vector<std::uint32_t>& square) {
        compare(i, square);
        square.push_back(i);
      });
    }
    unite(out_.freeze);
    unite(out_.resume);
    return std::move(out_);
  }

 private:
  static constexpr std::uint32_t kNobody = ~0U;

  void cut_legs(const Walks& walks, std::uint32_t who) {
    const auto& track = walks.track(who);
    if (track.empty()) return;
    const std::size_t first = legs_.size();
    std::size_t before = walks.stand_before(who, from_);
    Instant now = from_;
    while (now < to_) {
      Instant next = to_;
      if (track[before].time > now) next = std::min(next, track[before].time);
      if (track[before].time <= now && before + 1 < track.size()) next = std::min(next, track[before + 1].time);
      Leg leg{now, next, walks.position(who, before, now), walks.position(who, before, next), who};
      const bool stood = legs_.size() > first && !legs_.back().walks();
      if (stood && !leg.walks() && legs_.back().to == leg.from) {
        legs_.back().ends = next;  // she stands on
      } else {
        legs_.push_back(leg);
      }
      if (before + 1 < track.size() && track[before + 1].time <= next) ++before;
      now = next;
    }
  }

  void lay_squares() {
    judge::Box box;
    for (const Leg& leg : legs_) {
      box.add(leg.from);
      box.add(leg.to);
    }
    box.grow(reach_m_);
    corner_ = {box.x0, box.y0};
    columns_ = 1 + static_cast<int>((box.x1 - box.x0) / square_m_);
    rows_ = 1 + static_cast<int>((box.y1 - box.y0) / square_m_);
    squares_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  }

  /// The squares that somebody may touch on the way: row by row, the part of the way that is near the row.
  template <class Visit>
  void for_squares(const Leg& leg, const Visit& visit) {
    const Point a = leg.from - corner_;
    const Point b = leg.to - corner_;
    const double low_m = std::min(a.y, b.y) - reach_m_;
    const double high_m = std::max(a.y, b.y) + reach_m_;
    for (int row = square_of(low_m, rows_); row <= square_of(high_m, rows_); ++row) {
      double from = 0;
      double to = 1;
      if (a.y != b.y) {
        const double enters = (row * square_m_ - reach_m_ - a.y) / (b.y - a.y);
        const double leaves = ((row + 1) * square_m_ + reach_m_ - a.y) / (b.y - a.y);
        from = std::clamp(std::min(enters, leaves), 0.0, 1.0);
        to = std::clamp(std::max(enters, leaves), 0.0, 1.0);
      }
      const double x0 = a.x + from * (b.x - a.x);
      const double x1 = a.x + to * (b.x - a.x);
      const int last = square_of(std::max(x0, x1) + reach_m_, columns_);
      for (int column = square_of(std::min(x0, x1) - reach_m_, columns_); column <= last; ++column) {
        visit(squares_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                       static_cast<std::size_t>(column)]);
      }
    }
  }
  [[nodiscard]] int square_of(double m, int count) const {
    return std::clamp(static_cast<int>(std::floor(m / square_m_)), 0, count - 1);
  }

  void compare(std::uint32_t i, std::vector<std::uint32_t>& square) {
    const Leg& leg = legs_[i];
    std::erase_if(square, [&](std::uint32_t other) { return legs_[other].ends + late_ < leg.begins; });
    for (const std::uint32_t other : square) {
      if (compared_[other] == i || legs_[other].who == leg.who) continue;
      compared_[other] = i;
      if (leg.walks() || legs_[other].walks()) judge_pair(legs_[other], leg);
    }
  }

  void judge_pair(const Leg& a, const Leg& b) {
    const double limit_m = judge::least_distance_m(plan_, a.who, b.who) - judge::kClearanceTolerance_m;
    if (limit_m <= 0) return;
    // Seconds from the beginning of the first: small figures are exact ones.
    const double late_s = to_seconds(late_);
    const judge::TimeBox box{0, to_seconds(a.ends - a.begins), to_seconds(b.begins - a.begins),
                             to_seconds(b.ends - a.begins)};
    const Point v = 1 / (box.s1 - box.s0) * (a.to - a.from);
    const Point w = 1 / (box.u1 - box.u0) * (b.to - b.from);
    const judge::IndependentWalks walks{a.from - (b.from - box.u0 * w), v, w};
    const judge::FreezeSpans spans = judge::freeze_spans(walks, box, late_s, limit_m);
    keep(a, b, spans.freeze, out_.freeze);
    keep(a, b, spans.resume_first, out_.resume);
    keep(a, b, spans.resume_second, out_.resume);
  }

  void keep(const Leg& a, const Leg& b, const judge::TimeRange& range, std::vector<Touch>& touches) const {
    if (range.empty()) return;
    const Instant from = std::max(from_, a.begins + seconds(range.first));
    const Instant until = std::min(to_, a.begins + seconds(range.last));
    if (from < until) touches.push_back({from, until, std::min(a.who, b.who), std::max(a.who, b.who)});
  }

  /// A pair counts once at an instant.
  static void unite(std::vector<Touch>& touches) {
    std::ranges::sort(touches, {}, [](const Touch& t) { return std::tie(t.a, t.b, t.from); });
    std::size_t kept = 0;
    for (const Touch& touch : touches) {
      if (kept > 0) {
        Touch& last = touches[kept - 1];
        if (last.a == touch.a && last.b == touch.b && touch.from <= last.until) {
          last.until = std::max(last.until, touch.until);
          continue;
        }
      }
      touches[kept++] = touch;
    }
    touches.resize(kept);
  }

  const Plan& plan_;
  Instant from_;
  Instant to_;
  Duration late_;
  double square_m_;
  double reach_m_ = 0;
  std::vector<Leg> legs_;
  Point corner_;
  int columns_ = 1;
  int rows_ = 1;
  std::vector<std::vector<std::uint32_t>> squares_;
  std::vector<std::uint32_t> compared_;  ///< of each leg: whom it was compared with last
  Touches out_;
};

/// From wait to wait.
std::vector<Instant> cuts_of(const Walks& walks, std::span<const Instant> waits) {
  std::vector<Instant> cuts;
  if (walks.times().empty()) return cuts;
  cuts.push_back(walks.times().front());
  for (const Instant wait : waits) {
    if (wait > cuts.back() && wait < walks.times().back()) cuts.push_back(wait);
  }
  cuts.push_back(walks.times().back());
  return cuts;
}

std::uint64_t pairs_of(const std::vector<Touch>& touches) {  // sorted by pair within each stretch
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  pairs.reserve(touches.size());
  for (const Touch& touch : touches) pairs.emplace_back(touch.a, touch.b);
  std::ranges::sort(pairs);
  return static_cast<std::uint64_t>(std::unique(pairs.begin(), pairs.end()) - pairs.begin());
}

}  // namespace

TouchCount::TouchCount(const std::vector<Touch>& touches) {
  std::vector<std::pair<Instant, int>> changes;
  changes.reserve(2 * touches.size());
  for (const Touch& touch : touches) {
    changes.emplace_back(touch.from, 1);
    changes.emplace_back(touch.until, -1);
  }
  std::ranges::sort(changes);
  std::int64_t pairs = 0;
  for (std::size_t k = 0; k < changes.size();) {
    const Instant now = changes[k].first;
    for (; k < changes.size() && changes[k].first == now; ++k) pairs += changes[k].second;
    FL_CHECK(pairs >= 0);
    if (steps_.back().pairs != pairs) steps_.push_back({now, static_cast<std::uint32_t>(pairs)});
  }
}

std::size_t TouchCount::step_at(Instant freeze) const {
  const auto after = std::ranges::upper_bound(steps_, freeze, {}, &Step::from);
  return after == steps_.begin() ? 0 : static_cast<std::size_t>(after - steps_.begin()) - 1;
}

std::uint32_t TouchCount::at(Instant freeze) const { return steps_[step_at(freeze)].pairs; }

Instant TouchCount::none_from(Instant freeze) const {
  std::size_t k = step_at(freeze);
  if (steps_[k].pairs == 0) return freeze;
  while (k < steps_.size() && steps_[k].pairs > 0) ++k;
  return k < steps_.size() ? steps_[k].from : kNever;
}

TouchCount::Worst TouchCount::worst_in(Instant from, Instant to) const {
  Worst worst{0, from};
  for (std::size_t k = step_at(from); k < steps_.size() && steps_[k].from < to; ++k) {
    if (steps_[k].pairs > worst.pairs) worst = {steps_[k].pairs, std::max(from, steps_[k].from)};
  }
  return worst;
}

Duration TouchCount::safe_in(Instant from, Instant to) const {
  Duration safe{};
  for (std::size_t k = step_at(from); k < steps_.size() && steps_[k].from < to; ++k) {
    if (steps_[k].pairs > 0) continue;
    const Instant until = k + 1 < steps_.size() ? std::min(to, steps_[k + 1].from) : to;
    safe += until - std::max(from, steps_[k].from);
  }
  return safe;
}

FreezeJudgement judge_freezes(const Plan& plan, std::span<const Instant> waits, Duration late,
                              const Progress& progress) {
  FL_CHECK(late >= Duration{});
  const Walks walks(plan);
  const std::vector<Instant> cuts = cuts_of(walks, waits);
  std::vector<Touches> parts(cuts.empty() ? 0 : cuts.size() - 1);
  FreezeJudgement out;
  out.late = late;
  const bool whole = for_each_index(parts.size(), "freeze", progress, [&](std::size_t k) {
    parts[k] = Stretch(plan, cuts[k], cuts[k + 1], late).run(walks);
  });
  if (!whole) return out;
  Touches all;
  for (Touches& part : parts) {
    all.freeze.insert(all.freeze.end(), part.freeze.begin(), part.freeze.end());
    all.resume.insert(all.resume.end(), part.resume.begin(), part.resume.end());
    part = {};
  }
  out.freeze = TouchCount(all.freeze);
  out.resume = TouchCount(all.resume);
  out.freeze_pairs = pairs_of(all.freeze);
  out.resume_pairs = pairs_of(all.resume);
  return out;
}

FreezeAt judge_freeze_at(const Plan& plan, std::span<const Instant> waits, Instant freeze, Duration late) {
  const Walks walks(plan);
  const std::vector<Instant> cuts = cuts_of(walks, waits);
  FreezeAt out;
  for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
    if (freeze < cuts[k] || freeze >= cuts[k + 1]) continue;
    const Touches touches = Stretch(plan, cuts[k], cuts[k + 1], late).run(walks);
    const auto now = [&](const Touch& touch) { return touch.from <= freeze && freeze < touch.until; };
    std::ranges::copy_if(touches.freeze, std::back_inserter(out.freeze), now);
    std::ranges::copy_if(touches.resume, std::back_inserter(out.resume), now);
  }
  return out;
}

}  // namespace footlight::planner
