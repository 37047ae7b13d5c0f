// SPDX-License-Identifier: Apache-2.0
#include "planner/manual_work.hpp"

namespace footlight::planner {
namespace {

double share(std::int64_t part, std::int64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0;
}

}  // namespace

double ManualWork::formations_share() const { return share(moved, places); }
double ManualWork::transitions_share() const { return share(pinned, assignments); }

ManualWork manual_work(const Plan& plan) {
  ManualWork work;
  const auto people = static_cast<std::int64_t>(plan.performers.size());
  for (const Formation& formation : plan.formations) {
    work.places += formation.key ? people : 0;
    work.moved += formation.moved;
    work.pinned += formation.pinned;
  }
  const auto formations = static_cast<std::int64_t>(plan.formations.size());
  work.assignments = formations > 1 ? people * (formations - 1) : people * formations;
  return work;
}

}  // namespace footlight::planner
