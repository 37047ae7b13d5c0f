// SPDX-License-Identifier: Apache-2.0
// The local search of the proposed swarm: which of some steps is the best.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "planner/repair/closest_approach.hpp"
#include "planner/swarm/proposed.hpp"

namespace footlight::planner::swarm {
namespace {

constexpr double kRounding_m = 1e-9;
constexpr double kFar = std::numeric_limits<double>::infinity();

}  // namespace

double ProposedSwarm::disc_room(const Surroundings::Disc& disc, const Walker& walker, Point to) const {
  const double both_m = disc.radius_m + landscape_->scope_m(walker.person);
  const double keep_m = std::max(disc.radius_m + landscape_->task().radius_m[walker.person],
                                 std::sqrt(landscape_->options().hardness) * both_m);
  return closest_approach({walker.at, to}, {disc.from, disc.to}).distance_m - keep_m;
}

void ProposedSwarm::judge(const Turn& turn, const Walker& walker, Tries& tries) const {
  const SwarmOptions& options = landscape_->options();
  const Surroundings& around = turn.scratch.around;
  tries.squared.fill(kFar);
  tries.room.fill(kFar);
  for (std::size_t i = 0; i < tries.size && !walker.open; ++i) {
    tries.squared[i] = landscape_->still_squared(walker.at + tries.step(i), kFar);
  }
  sweep(walker.near, tries);
  for (std::size_t i = 0; i < tries.size; ++i) {
    const Point to = walker.at + tries.step(i);
    // The hard boundary of Eq. 10; who is beyond it already may go where it is better.
    const bool beyond = tries.squared[i] < options.hardness - kRounding_m && tries.squared[i] <= walker.still_squared;
    tries.allowed[i] = tries.room[i] >= 0 && !beyond;
    tries.ground[i] = landscape_->ground_cost(to);
    tries.disc_m[i] = kFar;
    if (around.discs().empty()) continue;
    tries.squared[i] = around.disc_squared(walker.person, to, tries.squared[i]);
    for (const Surroundings::Disc& disc : around.discs()) {
      tries.disc_m[i] = std::min(tries.disc_m[i], disc_room(disc, walker, to));
    }
  }
  weigh({walker.heading_for - walker.at, walker.rest_m, walker.avoid, options.avoid, landscape_->per_floor_square()},
        tries);
}

ProposedSwarm::Option ProposedSwarm::best_of(const Turn& turn, const Walker& walker, Tries& tries) const {
  judge(turn, walker, tries);
  const auto option = [&](std::size_t i) {
    return Option{tries.step(i), tries.worst[i], tries.weighed[i], tries.value[i], tries.allowed[i], tries.disc_m[i]};
  };
  for (;;) {
    std::size_t leads = 0;
    for (std::size_t i = 1; i < tries.size; ++i) leads = option(i).better_than(option(leads)) ? i : leads;
    if (!tries.allowed[leads] || landscape_->step_is_free(walker.at, walker.at + tries.step(leads), walker.open)) {
      return option(leads);
    }
    tries.allowed[leads] = false;
  }
}

ProposedSwarm::Option ProposedSwarm::search(const Turn& turn, const Walker& walker, Point move, bool flees,
                                            Rng& rng) const {
  const SwarmOptions& options = landscape_->options();
  const double range = flees ? 2 * std::numbers::pi : std::numbers::pi;
  std::optional<Option> best;
  const auto take_better = [&](Tries& tries) {
    const Option option = best_of(turn, walker, tries);
    if (!best || option.better_than(*best)) best = option;
  };
  for (int n = 0; n < options.directions;) {
    std::array<double, lanes::kLanes> angle_rad{};
    std::size_t tried = 0;
    for (; n < options.directions && tried < angle_rad.size(); ++n) angle_rad[tried++] = (rng.uniform() - 0.5) * range;
    Tries tries;
    add_turned(move, std::span(angle_rad).first(tried), tries);
    take_better(tries);
  }
  const Point viewed = best->step;
  for (std::size_t n = 0; n < grid_turns_.size();) {
    Tries tries;
    for (; n < grid_turns_.size() && tries.size < lanes::kLanes; ++n) {
      const auto [cosine, sine] = grid_turns_[n];
      tries.add({cosine * viewed.x - sine * viewed.y, sine * viewed.x + cosine * viewed.y});
    }
    take_better(tries);
  }
  return *best;
}

}  // namespace footlight::planner::swarm
