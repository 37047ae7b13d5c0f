// SPDX-License-Identifier: Apache-2.0
#include "planner/collective/collective.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "core/check.hpp"
#include "planner/collective/affinity.hpp"
#include "planner/collective/pairing.hpp"
#include "planner/collective/social_crowd.hpp"
#include "planner/motion/model.hpp"
#include "planner/motion/models.hpp"
#include "planner/motion/ordered_task.hpp"

namespace footlight::planner {
namespace collective {
namespace {

/// Share of the time in which people mean to arrive where something is in the way.
constexpr double kShareAround = 0.85;

Error stopped() { return {ErrorKind::interrupted, "stopped while a crowd was moved"}; }

/// People and places that may be paired with each other.
struct Side {
  std::vector<std::uint32_t> people;
  std::vector<std::uint32_t> places;
};

/// One for each group, or one of all.
std::map<std::uint32_t, Side> sides_of(const MotionTask& task) {
  std::map<std::uint32_t, Side> out;
  const bool bound = !task.to_group.empty();
  for (std::uint32_t p = 0; p < task.people(); ++p) out[bound ? task.group[p] : kNoGroup].people.push_back(p);
  for (std::uint32_t j = 0; j < task.to.size(); ++j) out[bound ? task.to_group[j] : kNoGroup].places.push_back(j);
  return out;
}

template <class T>
std::vector<T> chosen(const std::vector<T>& all, const std::vector<std::uint32_t>& which) {
  std::vector<T> out;
  out.reserve(which.size());
  for (const std::uint32_t i : which) out.push_back(all[i]);
  return out;
}

/// Says who it is that has no place she can get to, if it is that simple.
Error unpaired(const PairCosts& costs, const Side& side, const MotionTask& task) {
  for (std::uint32_t i = 0; i < costs.size(); ++i) {
    bool any = false;
    for (std::uint32_t j = 0; j < costs.size() && !any; ++j) any = std::isfinite(costs.cost(i, j));
    if (any) continue;
    const Point at = task.from[side.people[i]];
    return input_error(
        fmt::format("unreachable target: whoever stands at [{:g} m, {:g} m] can get to no place of the "
                    "formation, blocked cells are all around (open a way)",
                    at.x, at.y));
  }
  for (std::uint32_t j = 0; j < costs.size(); ++j) {
    bool any = false;
    for (std::uint32_t i = 0; i < costs.size() && !any; ++i) any = std::isfinite(costs.cost(i, j));
    if (any) continue;
    const Point at = task.to[side.places[j]];
    return input_error(
        fmt::format("unreachable target: nobody can get to the place at [{:g} m, {:g} m], blocked cells "
                    "are all around (open a way, or move the place)",
                    at.x, at.y));
  }
  return input_error(
      "unreachable target: blocked cells divide the floor, and there are not as many people as places on each side "
      "(open a way, or move places)");
}

std::optional<Error> pair_side(const MotionTask& task, const CollectiveOptions& options, const Side& side,
                               const WalkField* around, const std::atomic<bool>* stop, Preparation& out) {
  if (side.people.size() != side.places.size()) {
    return input_error(fmt::format("a group of {} people has {} places in the formation (as many as people)",
                                   side.people.size(), side.places.size()));
  }
  const auto from = chosen(task.from, side.people);
  const auto to = chosen(task.to, side.places);
  const auto radius_m = chosen(task.radius_m, side.people);
  const auto speed_mps = chosen(task.speed_mps, side.people);
  const PairCosts costs({from, to, radius_m, speed_mps, around, stop}, options);
  if (around != nullptr && from.size() > kMostAround) {
    out.notes.push_back(
        fmt::format("{} people are more than {}: paired by straight distances, not by ways around blocked cells",
                    from.size(), kMostAround));
  }
  const auto pairing = find_pairing(costs, stop);
  if (stop != nullptr && stop->load()) return stopped();
  if (!pairing) return unpaired(costs, side, task);
  for (std::size_t i = 0; i < side.people.size(); ++i) {
    out.place_of[side.people[i]] = side.places[pairing->place_of[i]];
  }
  out.cost += pairing->cost;
  return std::nullopt;
}

/// Sub-groups never mix people of two groups.
void find_all_subgroups(const MotionTask& task, const CollectiveOptions& options, const std::vector<Point>& to,
                        const std::atomic<bool>* stop, Preparation& out) {
  std::map<std::uint32_t, std::vector<std::uint32_t>> groups;
  for (std::uint32_t p = 0; p < task.people(); ++p) groups[task.group[p]].push_back(p);
  out.subgroup.assign(task.people(), 0);
  std::uint32_t next = 0;
  for (const auto& [group, people] : groups) {
    const Clusters found =
        find_subgroups(chosen(task.from, people), chosen(to, people), {options.damping, options.rounds}, stop);
    std::map<std::uint32_t, std::uint32_t> number;
    for (std::size_t i = 0; i < people.size(); ++i) {
      const auto [at, fresh] = number.try_emplace(found.exemplar_of[i], next);
      next += fresh ? 1 : 0;
      out.subgroup[people[i]] = at->second;
    }
    if (!found.converged) {
      out.notes.push_back(fmt::format(
          "affinity propagation had not settled after {} rounds (more `rounds`, or more `damping`)", found.rounds));
    }
  }
  out.subgroups = next;
}

void tell_of(const std::vector<Crossing>& crossings, std::vector<std::string>& notes) {
  for (const Crossing& one : crossings) {
    const double aside_m = length(one.aside);
    if (aside_m == 0) continue;
    notes.push_back(fmt::format(
        "two groups pass through each other from {:.1f} s to {:.1f} s of the section: each goes {:.2g} m aside, "
        "their ideal ways come no nearer than {:.2f} m instead of {:.2f} m",
        one.from_s, one.until_s, aside_m, one.after_m, one.before_m));
  }
}

}  // namespace

Result<Preparation> prepare(const MotionTask& task, const CollectiveOptions& options, const Progress& progress) {
  if (task.to.size() != task.people()) {
    return input_error("`model: collective` leads people into a formation, and the section has none for all of them");
  }
  const auto* stop = progress.stop;
  Preparation out;
  out.place_of.assign(task.people(), 0);
  progress.tell("pairing", 0);
  std::optional<WalkField> around;
  if (!task.floor->ways().open()) around.emplace(task.floor->ways());
  const WalkField* field = around ? &*around : nullptr;
  for (const auto& [group, side] : sides_of(task)) {
    if (auto error = pair_side(task, options, side, field, stop, out)) return *error;
  }
  progress.tell("pairing", 1);
  const std::vector<Point> to = chosen(task.to, out.place_of);
  // Who is there two reaction times before the end has come to rest at the end. Around obstacles people also wait for
  // each other.
  const double arrive_s =
      std::max(0.5 * task.duration_s(), (around ? kShareAround : 1) * task.duration_s() - 2 * options.reaction_s);
  auto ways = TimedWays::make(task, to, field, arrive_s);
  if (!ways) return ways.error();
  out.ways = std::move(*ways);
  if (options.subgroups) {
    progress.tell("sub-groups", 0);
    find_all_subgroups(task, options, to, stop, out);
    progress.tell("sub-groups", 1);
  }
  if (options.rigidity > 0) {
    out.crossings = pass_between(task, out.ways);
    tell_of(out.crossings, out.notes);
  }
  if (progress.stopped()) return stopped();
  return out;
}

}  // namespace collective

Result<Trajectory> move_crowd(const MotionTask& task, const CollectiveOptions& options, const Progress& progress) {
  const OrderedTask ordered(task);
  auto prepared = collective::prepare(ordered.task(), options, progress);
  if (!prepared) return prepared.error();
  const collective::SocialCrowd crowd(ordered.task(), options, prepared->ways, std::move(prepared->subgroup));
  auto at = simulate(crowd, task.at_s, progress);
  if (!at) return collective::stopped();
  return ordered.as_given({std::move(*at), std::move(prepared->place_of), std::move(prepared->notes)});
}

}  // namespace footlight::planner
