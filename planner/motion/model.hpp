// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "planner/motion/crowd.hpp"
#include "planner/progress.hpp"

namespace footlight::planner {

/// One generation of a crowd. A model's own state derives from it, and may hold whatever else it needs from one step to
/// the next; which is all that a model remembers.
struct Crowd {
  std::uint64_t tick = 0;       ///< steps from the beginning
  std::vector<Point> position;  ///< m, of each person
  std::vector<Point> velocity;  ///< m/s
};

/// The contract of all models of motion. A model is made of a task and does not change; a step is a pure function from
/// one frozen generation to the next: `next` comes as an exact copy of `now`, its tick one more, and others are read
/// from `now` alone. The order of people has no influence but through their own numbers in random streams
/// (`Rng::split`; planner/motion/ordered_task.hpp takes away that, too), sums over neighbours run in an order that does
/// not depend on threads, and the same task gives the same bytes.
template <class M>
concept MotionModel = std::derived_from<typename M::State, Crowd> &&
    requires(const M& model, const typename M::State& now, typename M::State& next) {
  { model.begin() } -> std::same_as<typename M::State>;
  { model.step_s() } -> std::convertible_to<double>;  ///< s of one step, > 0
  { model.step(now, next) } -> std::same_as<void>;
};

/// Steps a model until the last of the wanted instants. Positions between two generations are in between on a straight
/// line. @param at_s ascending, the first 0  @param after called after each step with the generation before and the new
/// one  @return nothing when stopped. O(steps)
template <MotionModel M, class After>
[[nodiscard]] std::optional<std::vector<std::vector<Point>>> simulate(const M& model, const std::vector<double>& at_s,
                                                                      const Progress& progress, After after) {
  typename M::State now = model.begin();
  typename M::State next = now;
  std::vector<std::vector<Point>> out{now.position};
  while (out.size() < at_s.size()) {
    const double end_s = model.step_s() * static_cast<double>(now.tick + 1);
    next = now;
    ++next.tick;
    model.step(now, next);
    while (out.size() < at_s.size() && at_s[out.size()] <= end_s) {
      const double share = 1 - (end_s - at_s[out.size()]) / model.step_s();
      auto& sample = out.emplace_back(now.position);
      for (std::size_t p = 0; p < sample.size(); ++p) sample[p] = sample[p] + share * (next.position[p] - sample[p]);
    }
    after(std::as_const(now), std::as_const(next));
    std::swap(now, next);
    if (progress.stopped()) return std::nullopt;
    progress.tell("motion", std::min(1.0, end_s / at_s.back()));
  }
  return out;
}
template <MotionModel M>
[[nodiscard]] std::optional<std::vector<std::vector<Point>>> simulate(const M& model, const std::vector<double>& at_s,
                                                                      const Progress& progress) {
  return simulate(model, at_s, progress, [](const auto&, const auto&) {});
}

}  // namespace footlight::planner
