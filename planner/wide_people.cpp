// SPDX-License-Identifier: Apache-2.0
#include "planner/wide_people.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "planner/plan_section.hpp"

namespace footlight::planner {

WidePeople::WidePeople(const Show& show) : show_(show), clearance_m_(show.stage.clearance_m) {
  const auto radius_m = [&](PerformerIndex who) { return show.performers[who.at()].radius_m; };
  for (std::size_t p = 0; p < show.performers.size(); ++p) {
    const PerformerIndex who = PerformerIndex::of(p);
    if (!widest_ || radius_m(who) > radius_m(*widest_)) {
      second_ = widest_;
      widest_ = who;
    } else if (!second_ || radius_m(who) > radius_m(*second_)) {
      second_ = who;
    }
  }
  pair_by_pair_ = show.stage.walk == WalkKind::straight && widest_two_m() > show.stage.grid.clearance_bound_m() &&
                  widest_two_m() > clearance_m_;
  if (!pair_by_pair_) clearance_m_ = std::max(clearance_m_, std::min(widest_two_m(), show.stage.grid.pitch_m()));
}

double WidePeople::widest_m() const { return widest_ ? show_.performers[widest_->at()].radius_m : 0; }

double WidePeople::widest_two_m() const { return second_ ? widest_m() + show_.performers[second_->at()].radius_m : 0; }

std::string WidePeople::widest_two() const {
  const Performer& one = show_.performers[widest_->at()];
  const Performer& two = show_.performers[second_->at()];
  return fmt::format("performers {} and {} (radius {:g} m and {:g} m)", one.id, two.id, one.radius_m, two.radius_m);
}

std::optional<std::string> WidePeople::too_wide() const {
  const double pitch_m = show_.stage.grid.pitch_m();
  if (widest_two_m() <= pitch_m) return std::nullopt;
  return section_message(show_, SectionIndex(0),
                         fmt::format("{} must keep {:g} m, and neighbouring cells are {:g} m apart", widest_two(),
                                     widest_two_m(), pitch_m),
                         fmt::format("smaller radii or a pitch of at least {:g} m", widest_two_m()));
}

void WidePeople::note(Plan& plan) const {
  const double bound_m = show_.stage.grid.clearance_bound_m();
  if (!pair_by_pair_ && (clearance_m_ <= show_.stage.clearance_m || clearance_m_ <= bound_m)) return;
  plan.sections.front().notes.push_back(
      fmt::format("{} must keep {:g} m, more than the {:.3f} m that walks on this grid keep by themselves: {}",
                  widest_two(), widest_two_m(), bound_m,
                  pair_by_pair_ ? "only people of the same radius take their places, and some may have to wait"
                                : "everybody is planned that far apart, and many may have to wait"));
}

Ways ways_of(const Show& show, const WidePeople& wide) {
  return {show.stage, std::max(show.stage.clearance_m / 2, wide.widest_m())};
}

}  // namespace footlight::planner
