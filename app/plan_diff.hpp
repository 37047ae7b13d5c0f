// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/plan.hpp"
#include "planner/measure.hpp"

namespace footlight::app {

/// Somebody who stands elsewhere. Numbers are those of the new plan.
struct Displaced {
  PerformerIndex who;
  Point before;
  Point now;
};

struct FormationDiff {
  std::string id;
  enum class Kind { changed, added, removed };
  Kind kind = Kind::changed;
  double count_before = 0;           ///< of the music; 0 when added
  double count_now = 0;              ///< 0 when removed
  std::vector<Displaced> displaced;  ///< in the order of the new plan
};

/// What two plans of one show do not have in common. People and formations are the same when their ids are.
struct PlanDiff {
  std::string plan_before;  ///< first digits of the plans' digests, as on paper
  std::string plan_now;
  std::vector<std::string> joined;  ///< ids of people who are only in the new plan
  std::vector<std::string> left;
  std::vector<std::string> changed;       ///< who has other marks, in natural order
  std::size_t same = 0;                   ///< who has the same marks
  std::vector<FormationDiff> formations;  ///< only those that differ, in the order of time
  planner::Measures before;               ///< without films
  planner::Measures now;
};

[[nodiscard]] PlanDiff diff_of(const Plan& before, const Plan& now);

[[nodiscard]] std::string diff_text(const PlanDiff& diff);
[[nodiscard]] std::string diff_json(const PlanDiff& diff);

/// A page for each changed formation, A4: where people stood (rings), where they stand (dots), and how they moved; who
/// stays is grey. A first page with the figures.
[[nodiscard]] std::string diff_pdf(const Plan& before, const Plan& now, const PlanDiff& diff);

}  // namespace footlight::app
