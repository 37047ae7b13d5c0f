// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <vector>

#include "planner/judge/approach.hpp"
#include "planner/judge/geometry.hpp"
#include "planner/judge/near_pairs.hpp"
#include "planner/judge/walks.hpp"
#include "planner/validate.hpp"

namespace footlight::planner {
namespace {

using judge::Box;
using judge::Walks;

/// Lateness is found on this many equal steps of the cap, so that the answer does not depend on the order of pairs.
constexpr std::int64_t kSteps = std::int64_t{1} << 20;

class LagJudge {
 public:
  LagJudge(const Plan& plan, const Walks& walks, Instant start, Instant end, double cap_s)
      : plan_(plan), walks_(walks), start_(start), end_(end), cap_s_(cap_s) {
    until_ = std::min(end + seconds(cap_s), std::max(end, walks.times().back()));
    const std::uint32_t people = walks.people();
    legs_.resize(people);
    fastest_mps_.resize(people);
    for (std::uint32_t i = 0; i < people; ++i) cut_legs(i);
  }

  /// @return s
  double run() {
    judge::NearPairs near;
    std::vector<judge::MovingDisc> discs(walks_.people());
    // Whoever comes too near with a small lateness is found with small discs.
    for (const std::int64_t most : {kSteps / 16, kSteps / 4, kSteps}) {
      steps_ = most;
      for (std::uint32_t i = 0; i < walks_.people(); ++i) discs[i] = disc(i, lag_of(most));
      for (const auto& [a, b] : near.find(discs)) judge_pair(a, b);
      if (steps_ < most) break;
    }
    return lag_of(steps_);
  }

 private:
  /// A straight walk or wait, times in seconds after start_.
  struct Leg {
    double t0_s = 0;
    double t1_s = 0;
    Point from;
    Point velocity;  // m/s
    [[nodiscard]] Point at(double t_s) const { return from + (t_s - t0_s) * velocity; }
  };

  [[nodiscard]] double lag_of(std::int64_t steps) const {
    return cap_s_ * (static_cast<double>(steps) / static_cast<double>(kSteps));
  }

  void cut_legs(std::uint32_t person) {
    const auto& track = walks_.track(person);
    if (track.empty()) return;
    std::size_t before = walks_.stand_before(person, start_);
    Instant now = start_;
    do {
      Instant next = until_;
      if (track[before].time > now) next = std::min(next, track[before].time);
      if (track[before].time <= now && before + 1 < track.size()) next = std::min(next, track[before + 1].time);
      const Point from = walks_.position(person, before, now);
      if (before + 1 < track.size() && track[before + 1].time <= next) ++before;
      const double time_s = to_seconds(next - now);
      const Point way = walks_.position(person, before, next) - from;
      const Point velocity = time_s > 0 ? (1 / time_s) * way : Point{};
      legs_[person].push_back({to_seconds(now - start_), to_seconds(next - start_), from, velocity});
      fastest_mps_[person] = std::max(fastest_mps_[person], length(velocity));
      now = next;
    } while (now < until_);
  }

  /// Where somebody is in [start_, end_], and whoever may come too near by lateness up to `lag_s`: who is late is at
  /// most that time times the speed away from where he would be.
  [[nodiscard]] judge::MovingDisc disc(std::uint32_t person, double lag_s) const {
    const auto& legs = legs_[person];
    if (legs.empty()) return {{}, {}, -1};
    const double end_s = to_seconds(end_ - start_);
    const double keep_m = std::max(plan_.stage.clearance_m, 2 * plan_.radius_m[person]) / 2;
    const double radius_m = keep_m + lag_s * fastest_mps_[person];
    if (legs.front().t1_s >= end_s) return {legs.front().from, legs.front().at(end_s), radius_m};
    Box box;
    for (const Leg& leg : legs) {
      if (leg.t0_s > end_s) break;
      box.add(leg.from);
      box.add(leg.at(std::min(end_s, leg.t1_s)));
    }
    const Point low{box.x0, box.y0};
    const Point middle = low + 0.5 * (Point{box.x1, box.y1} - low);
    return {middle, middle, radius_m + distance(low, middle)};
  }

  void judge_pair(std::uint32_t a, std::uint32_t b) {
    if (steps_ == 0) return;
    const double limit = judge::least_distance_m(plan_, a, b) - judge::kClearanceTolerance_m;
    if (limit <= 0) return;
    // Whoever is late by L is at most L times the speed from where he would be.
    const double together_m = std::sqrt(together_squared_m2(a, b));
    if (together_m - lag_of(steps_) * std::min(fastest_mps_[a], fastest_mps_[b]) >= limit) return;
    if (far_enough(a, b, steps_, limit)) return;
    std::int64_t good = 0;  // 0 is also the answer for two who are too near without being late
    std::int64_t bad = steps_;
    while (bad - good > 1) {
      const std::int64_t middle = good + (bad - good) / 2;
      (far_enough(a, b, middle, limit) ? good : bad) = middle;
    }
    steps_ = good;
  }

  /// Least squared distance with nobody late.
  [[nodiscard]] double together_squared_m2(std::uint32_t a, std::uint32_t b) const {
    double best = std::numeric_limits<double>::infinity();
    std::size_t k = 0;
    std::size_t l = 0;
    const auto& x = legs_[a];
    const auto& y = legs_[b];
    while (k < x.size() && l < y.size()) {
      const double t0 = std::max(x[k].t0_s, y[l].t0_s);
      const double t1 = std::min(x[k].t1_s, y[l].t1_s);
      best = std::min(best, judge::nearest_to_origin(x[k].at(t0) - y[l].at(t0), x[k].at(t1) - y[l].at(t1)).squared_m2);
      x[k].t1_s < y[l].t1_s ? ++k : ++l;
    }
    return best;
  }

  /// Whether the two keep `limit_m` when each is late by up to `steps` steps.
  [[nodiscard]] bool far_enough(std::uint32_t a, std::uint32_t b, std::int64_t steps, double limit_m) const {
    const double lag_s = lag_of(steps);
    const double end_s = to_seconds(end_ - start_);
    const auto clear = [&](const Leg& x, const Leg& y, double x_end, double y_end) {
      const judge::TimeBox times{x.t0_s, std::min(x.t1_s, x_end), y.t0_s, std::min(y.t1_s, y_end)};
      if (times.s1 < times.s0 || times.u1 < times.u0) return true;
      const judge::IndependentWalks walks{x.at(0) - y.at(0), x.velocity, y.velocity};
      return judge::least_squared_m2(walks, times, lag_s) >= limit_m * limit_m;
    };
    // One of the two is still in this stretch of time; the other may be in the next.
    for (const Leg& x : legs_[a]) {
      for (const Leg& y : legs_[b]) {
        if (!clear(x, y, end_s, end_s + lag_s)) return false;
        if (!clear(x, y, end_s + lag_s, end_s)) return false;
      }
    }
    return true;
  }

  const Plan& plan_;
  const Walks& walks_;
  Instant start_;
  Instant end_;
  Instant until_;
  double cap_s_;
  std::int64_t steps_ = kSteps;
  std::vector<std::vector<Leg>> legs_;
  std::vector<double> fastest_mps_;
};

}  // namespace

double tolerated_lag_s(const Plan& plan, Instant start, Instant end, double cap_s) {
  FL_CHECK(start <= end && cap_s >= 0);
  const Walks walks(plan, start, end + seconds(cap_s));
  if (walks.times().empty() || cap_s == 0) return cap_s;
  return LagJudge(plan, walks, start, end, cap_s).run();
}

}  // namespace footlight::planner
