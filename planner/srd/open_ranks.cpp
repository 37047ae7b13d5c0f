// SPDX-License-Identifier: Apache-2.0
#include "planner/srd/open_ranks.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <tbb/parallel_for.h>

#include "planner/motion/neighbours.hpp"

namespace footlight::planner::srd {
namespace {

/// No formation is spread more than this.
constexpr double kWidest = 2;
/// Of the slowest person's speed, what ranks are opened and closed with: the rest carries her along.
constexpr double kOpening = 0.15;
/// How often it is looked who meets whom, s.
constexpr double kLook_s = 0.4;
/// Two who move no faster than this against each other walk together.
constexpr double kPassed_mps = 0.2;
/// Shares of the opening that are tried where there is no room for all of it.
constexpr std::array kShares{1.0, 0.75, 0.5, 0.25};

class Ranks {
 public:
  Ranks(std::vector<March::Task>& marches, const SrdOptions& options, const FreeFloor& floor, const MotionTask& task,
        Groups& out)
      : marches_(marches), options_(options), floor_(floor), task_(task), out_(out) {}

  void open() {
    widest_m_ = 2 * *std::max_element(task_.radius_m.begin(), task_.radius_m.end());
    find_factors();
    const bool dense = std::any_of(factor_.begin(), factor_.end(), [](double one) { return one > 1; });
    if (!dense || marches_.size() < 2) return;
    const std::vector<double> closed(marches_.size(), 1);
    std::vector<double> wanted = closed;
    const Meetings meetings = meet(closed);
    for (std::size_t g = 0; g < wanted.size(); ++g) {
      if (std::find(meetings[g].begin(), meetings[g].end(), 1) != meetings[g].end()) wanted[g] = factor_[g];
    }
    if (wanted == closed) return;
    // Open ranks reach farther: they meet earlier and longer.
    const Meetings open = meet(wanted);
    for (std::size_t g = 0; g < wanted.size(); ++g) {
      if (wanted[g] > 1) spread(g, wanted[g], open[g]);
    }
  }

 private:
  using Meetings = std::vector<std::vector<char>>;  ///< of each group, at every kLook_s: whether it meets another

  /// How much each group has to be spread to let others through: half of its people have so much room then, as few
  /// who stand nearer hold nobody up.
  void find_factors() {
    factor_.assign(marches_.size(), 1);
    const double look_m = kPassable * widest_m_;
    for (const auto* places : {&task_.from, &task_.to}) {
      if (places->empty()) continue;
      const std::vector<double> nearest = nearest_others(*places, look_m);
      std::vector<std::vector<double>> wanted(factor_.size());
      for (std::size_t i = 0; i < out_.of.size(); ++i) {
        const double here_m = nearest[places == &task_.from ? i : out_.place_of[i]];
        const double room_m = 2 * task_.radius_m[i] * kPassable;
        wanted[group(i)].push_back(here_m * kWidest > room_m ? room_m / here_m : kWidest);
      }
      for (std::size_t g = 0; g < wanted.size(); ++g) {
        const auto middle = wanted[g].begin() + static_cast<std::ptrdiff_t>(wanted[g].size() / 2);
        std::nth_element(wanted[g].begin(), middle, wanted[g].end());
        factor_[g] = std::max(factor_[g], *middle);
      }
    }
  }

  /// Everybody's place in her formation. @param spread of each group
  [[nodiscard]] std::vector<Point> places(double at_s, const std::vector<double>& spread) const {
    std::vector<Placing> placing;
    for (std::size_t g = 0; g < marches_.size(); ++g) {
      Frame frame = out_.march[g].at(at_s);
      frame.spread = spread[g];
      placing.emplace_back(frame);
    }
    std::vector<Point> at(out_.of.size());
    for (std::size_t i = 0; i < at.size(); ++i) at[i] = placing[group(i)](out_.offsets[i]);
    return at;
  }

  /// Who passes somebody of another group so near that open ranks would not do more than let her through.
  /// @param spread of each group
  [[nodiscard]] Meetings meet(const std::vector<double>& spread) const {
    const auto looks = static_cast<std::size_t>(task_.duration_s() / kLook_s) + 1;
    Meetings out(marches_.size(), std::vector<char>(looks, 0));
    tbb::parallel_for(std::size_t{0}, looks, [&](std::size_t k) {
      const double now_s = kLook_s * static_cast<double>(k);
      const std::vector<Point> at = places(now_s, spread);
      const std::vector<Point> then = places(now_s + kLook_s, spread);
      Neighbours crowd;
      crowd.sort(at, kPassable / 2 * widest_m_);
      for (std::size_t i = 0; i < at.size(); ++i) {
        char& meets = out[group(i)][k];
        if (meets != 0) continue;
        crowd.visit(at[i], kPassable / 2 * widest_m_, [&](std::uint32_t j, double squared) {
          const double apart_m = kPassable / 2 * (task_.radius_m[i] + task_.radius_m[j]);
          if (out_.of[j] == out_.of[i] || squared >= apart_m * apart_m) return;
          const Point passed = (then[j] - then[i]) - (at[j] - at[i]);
          if (squared_length(passed) > kPassed_mps * kLook_s * kPassed_mps * kLook_s) meets = 1;
        });
      }
    });
    return out;
  }

  [[nodiscard]] std::size_t group(std::size_t i) const { return static_cast<std::size_t>(out_.of[i]); }

  void spread(std::size_t g, double wanted, const std::vector<char>& meets) {
    March::Task opened = marches_[g];
    const March& march = out_.march[g];
    const std::vector<double>& at_s = march.times_s();
    std::vector<double>& spread = opened.spread;
    spread.assign(march.frames().size(), 1);
    for (std::size_t k = 0; k < spread.size(); ++k) {
      const auto first = static_cast<std::size_t>(std::max(0.0, at_s[k] / kLook_s - 1));
      const auto last = std::min(meets.size(), static_cast<std::size_t>(at_s[k] / kLook_s) + 2);
      if (std::find(meets.begin() + static_cast<std::ptrdiff_t>(first),
                    meets.begin() + static_cast<std::ptrdiff_t>(last),
                    1) != meets.begin() + static_cast<std::ptrdiff_t>(last)) {
        spread[k] = wanted;
      }
    }
    double outermost_m = 0;
    for (const Offsets& one : opened.offsets) outermost_m = std::max({outermost_m, length(one.from), length(one.to)});
    const double slowest_mps = *std::min_element(opened.speed_mps.begin(), opened.speed_mps.end());
    const double most_per_s = kOpening * slowest_mps / outermost_m;
    ramp(spread, at_s, -most_per_s);
    keep_on_floor(opened, march, spread);
    spread.front() = spread.back() = 1;
    ramp(spread, at_s, most_per_s);
    auto planned = March::plan(opened, options_);
    if (planned) out_.march[g] = std::move(*planned);
  }

  /// Changes no faster than `per_s`: down to that where it is positive, up where it is negative.
  static void ramp(std::vector<double>& spread, const std::vector<double>& at_s, double per_s) {
    const auto limit = [&](std::size_t k, std::size_t beside) {
      const double most = spread[beside] + per_s * std::abs(at_s[k] - at_s[beside]);
      spread[k] = per_s > 0 ? std::min(spread[k], most) : std::max(spread[k], most);
    };
    for (std::size_t k = 1; k < spread.size(); ++k) limit(k, k - 1);
    for (std::size_t k = spread.size() - 1; k-- > 0;) limit(k, k + 1);
  }

  /// Less where somebody who has a place on the floor would lose it.
  void keep_on_floor(const March::Task& opened, const March& march, std::vector<double>& spread) const {
    const Point low = task_.floor->low();
    const Point high = task_.floor->high();
    const auto free = [&](Point at) {
      return at.x >= low.x && at.x <= high.x && at.y >= low.y && at.y <= high.y && floor_.free_place(at) == at;
    };
    tbb::parallel_for(std::size_t{0}, spread.size(), [&](std::size_t k) {
      if (spread[k] <= 1) return;
      Frame frame = march.frames()[k];
      const Placing closed(frame);
      const auto fits = [&](double share) {
        frame.spread = 1 + share * (spread[k] - 1);
        const Placing open(frame);
        return std::all_of(opened.offsets.begin(), opened.offsets.end(),
                           [&](const Offsets& one) { return free(open(one)) || !free(closed(one)); });
      };
      const auto share = std::find_if(kShares.begin(), kShares.end(), fits);
      spread[k] = share != kShares.end() ? 1 + *share * (spread[k] - 1) : 1;
    });
  }

  std::vector<March::Task>& marches_;
  const SrdOptions& options_;
  const FreeFloor& floor_;
  const MotionTask& task_;
  Groups& out_;
  double widest_m_ = 0;  ///< the most that two people need
  std::vector<double> factor_;
};

}  // namespace

std::vector<double> nearest_others(const std::vector<Point>& at, double most_m) {
  Neighbours crowd;
  crowd.sort(at, most_m);
  std::vector<double> out(at.size());
  for (std::size_t n = 0; n < at.size(); ++n) {
    double nearest = most_m * most_m;
    crowd.visit(at[n], most_m, [&](std::uint32_t other, double squared) {
      if (other != n) nearest = std::min(nearest, squared);
    });
    out[n] = std::sqrt(nearest);
  }
  return out;
}

void open_ranks(std::vector<March::Task>& marches, const SrdOptions& options, const FreeFloor& floor,
                const MotionTask& task, Groups& out) {
  Ranks(marches, options, floor, task, out).open();
}

}  // namespace footlight::planner::srd
