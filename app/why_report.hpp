// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/plan.hpp"
#include "core/show.hpp"
#include "planner/why/move.hpp"
#include "planner/why/one_more_count.hpp"

namespace footlight::app {

/// What limits a move: how much of the limit is used, and a sentence.
struct MoveLimit {
  std::string kind;            ///< pace, neighbour, lag, blocked, drawing, pin, group, key, hand
  std::optional<double> used;  ///< share of the limit, 1: all of it; absent where there is nothing to measure
  std::string text;
};

/// All that limits a move, the tightest first; what cannot be measured stands at the end.
[[nodiscard]] std::vector<MoveLimit> limits_of(const Show& show, const Plan& plan, const planner::Move& move);

/// The move among these that is nearest to one of its limits; the first among equals. @param moves not empty
[[nodiscard]] std::size_t tightest(const Show& show, const Plan& plan, const std::vector<planner::Move>& moves);

/// The answer to `footlight why`.
struct WhyAnswer {
  PerformerIndex who;
  std::vector<planner::Move> moves;  ///< that were asked for
  std::size_t told = 0;              ///< the one that is told in full
  planner::OneMoreCount one_more;    ///< of that one
};

[[nodiscard]] std::string why_text(const Show& show, const Plan& plan, const WhyAnswer& answer);
[[nodiscard]] std::string why_json(const Show& show, const Plan& plan, const WhyAnswer& answer);

}  // namespace footlight::app
