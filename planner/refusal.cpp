// SPDX-License-Identifier: Apache-2.0
#include "planner/refusal.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "planner/schedule/beats.hpp"

namespace footlight::planner {
namespace {

/// A walk from mark to mark that is too fast.
struct FastWalk {
  std::size_t performer = 0;
  Mark from;
  Mark to;
  double walk_m = 0;
  double excess = 0;  ///< times the limit
  double limit_mps = 0;
};

/// Sections that touch are planned a millisecond apart.
constexpr double kNoTime_s = 0.0015;

/// The section whose limits hold at an instant: the first one that ends after it.
std::size_t section_of(const Plan& plan, Instant instant) {
  std::size_t s = 0;
  while (s + 1 < plan.sections.size() && plan.sections[s].end <= instant) ++s;
  return s;
}

std::vector<std::optional<FastWalk>> fastest_walks(const Plan& plan) {
  std::vector<std::optional<FastWalk>> worst(plan.sections.size());
  for (std::size_t p = 0; p < plan.tracks.size(); ++p) {
    const auto& track = plan.tracks[p];
    for (std::size_t m = 0; m + 1 < track.size(); ++m) {
      if (track[m].cell == track[m + 1].cell) continue;
      const std::size_t s = section_of(plan, track[m].time);
      const double limit = plan.max_speed_mps[p] > 0 ? plan.max_speed_mps[p] : plan.sections[s].max_speed_mps;
      const double walk_m = distance(plan.stage.grid.centre(track[m].cell), plan.stage.grid.centre(track[m + 1].cell));
      const double excess = walk_m / to_seconds(track[m + 1].time - track[m].time) / limit;
      if (excess <= 1 + 1e-6 || (worst[s] && worst[s]->excess >= excess)) continue;
      worst[s] = FastWalk{p, track[m], track[m + 1], walk_m, excess, limit};
    }
  }
  return worst;
}

std::string count_text(double count) { return fmt::format("{:g}", std::round(count * 100) / 100); }

/// The key formation after its section's first to which a walk leads.
const Formation* key_inside(const Plan& plan, std::size_t section, const FastWalk& walk) {
  for (const Formation& formation : plan.formations) {
    if (formation.section.at() != section || formation.time < walk.to.time) continue;
    return formation.key && formation.time > plan.sections[section].start ? &formation : nullptr;
  }
  return nullptr;
}

/// Over cells too many steps have been laid evenly into the time there is for them.
std::string too_many_steps_text(const Show& show, const Plan& plan, std::size_t section, const FastWalk& walk) {
  Instant depart = section > 0 ? plan.sections[section - 1].end : kStart;
  const Formation* goal = nullptr;
  for (const Formation& formation : plan.formations) {
    if (formation.time >= walk.to.time) {
      goal = &formation;
      break;
    }
    depart = std::max(depart, formation.time);
  }
  FL_CHECK(goal != nullptr);
  const double step_s = to_seconds(walk.to.time - walk.from.time);
  const double steps = std::round(to_seconds(goal->time - depart) / step_s);
  const Beats beats = beats_between(show.tempo, depart, goal->time, plan.stage.grid.pitch_m() / walk.limit_mps);
  const double start = show.tempo.count_at(depart);
  const double needed = std::ceil(start - 1e-6) + steps * beats.counts - start;
  const double given = show.tempo.count_at(goal->time) - start;
  const double later = std::ceil(needed - given - 1e-6);
  const std::string each = beats.counts == 1 ? "a count" : fmt::format("{} counts", beats.counts);
  return section_message(
      show, SectionIndex::of(section),
      fmt::format("the formation {} at count {} cannot be reached over cells in time: it takes {:g} steps of {} each "
                  "at {:g} m/s, and there are {} counts from count {}",
                  goal->id, count_text(goal->count), steps, each, walk.limit_mps, count_text(given), count_text(start)),
      fmt::format("{:g} count{} more before it, or walk: straight", later, later == 1 ? "" : "s"));
}

std::string too_fast_text(const Show& show, const Plan& plan, std::size_t section, const FastWalk& walk) {
  if (plan.stage.walk == WalkKind::cells) return too_many_steps_text(show, plan, section, walk);
  const double first = show.tempo.count_at(walk.from.time);
  const double last = show.tempo.count_at(walk.to.time);
  const double needed_s = walk.walk_m / walk.limit_mps;
  const double given_s = to_seconds(walk.to.time - walk.from.time);
  const double later = std::ceil((needed_s - given_s) * show.tempo.bpm_at(last) / 60 - 1e-9);
  const double slower = std::floor((last - first) * 60 / needed_s + 1e-9);
  const std::string who =
      fmt::format("performer {} would walk {:.1f} m from {} to {}", plan.performers[walk.performer], walk.walk_m,
                  plan.stage.grid.name(walk.from.cell), plan.stage.grid.name(walk.to.cell));
  if (given_s <= kNoTime_s) {
    const double start = show.sections[section].start_count;
    return section_message(
        show, SectionIndex::of(section),
        fmt::format("there is no time to walk between the section before and this one: {} at count {}", who,
                    count_text(first)),
        fmt::format("start the section at count {} or later, or end the one before {:g} count{} earlier",
                    count_text(start + later), later, later == 1 ? "" : "s"));
  }
  const Formation* key = key_inside(plan, section, walk);
  std::string pace = fmt::format("{:.1f} m/s, {:.1f} times the limit", walk.excess * walk.limit_mps, walk.excess);
  if (walk.excess < 1.05) pace = fmt::format("{:.3g} m/s, above the limit", walk.excess * walk.limit_mps);
  const std::string what = fmt::format("{} between count {} and count {} at {} of {:g} m/s", who, count_text(first),
                                       count_text(last), pace, walk.limit_mps);
  if (key != nullptr) {
    return section_message(
        show, SectionIndex::of(section),
        fmt::format("the key formation {} at count {} cannot be reached in time: {}", key->id, count_text(key->count),
                    what),
        fmt::format("{:g} count{} more before it: another key, a longer section, or less changed by hand", later,
                    later == 1 ? "" : "s"));
  }
  const bool held = section > 0 && show.sections[section - 1].hold_counts > 0;
  std::string hint = fmt::format("start the section {:g} count{} later", later, later == 1 ? "" : "s");
  hint += slower >= 1 ? ", " : " or ";
  hint += held ? "hold the one before shorter" : "end the one before earlier";
  if (slower >= 1) hint += fmt::format(", or slow the music to {:g} counts a minute", slower);
  return section_message(show, SectionIndex::of(section), what, hint);
}

std::string other_text(const Show& show, const Plan& plan, const Violation& violation, std::uint64_t more) {
  std::string hint;
  switch (violation.kind) {
    case Violation::Kind::too_close:
      hint = "a longer section, a larger pitch or a smaller clearance";
      break;
    case Violation::Kind::into_obstacle:
      hint = "more time, more room beside the obstacle's way, or an obstacle that is slower or smaller";
      break;
    case Violation::Kind::into_blocked:
      hint = "more time, so that everybody can go around the blocked cells";
      break;
    default:
      hint = "please report this: the planner should not do it";
  }
  std::string what = violation.text;
  if (more > 0) what += fmt::format("; {} more like it in the show", more);
  return section_message(show, SectionIndex::of(section_of(plan, violation.time)), what, hint);
}

/// Over cells nobody is too close but where no steps were found; how many there would have to be says nothing then.
std::string in_the_way_text(const Show& show, const Plan& plan, const Verdict& verdict) {
  const std::string what = fmt::format(
      "performers {} and {} are in each other's way: no steps over cells were found on which they pass, and at count "
      "{} "
      "they would be {:.3f} m apart",
      plan.performers[verdict.closest_a.at()], plan.performers[verdict.closest_b.at()],
      count_text(show.tempo.count_at(verdict.closest_at)), verdict.min_clearance_m);
  return section_message(show, SectionIndex::of(section_of(plan, verdict.closest_at)), what,
                         "places that they may exchange, other places, a wider way, or walk: straight");
}

}  // namespace

std::vector<std::string> refusal_texts(const Show& show, const Plan& plan, const Verdict& verdict) {
  std::vector<std::string> texts;
  if (verdict.valid()) return texts;
  if (plan.stage.walk == WalkKind::cells && verdict.too_close > 0) {
    texts.push_back(in_the_way_text(show, plan, verdict));
    return texts;
  }
  const auto worst = fastest_walks(plan);
  std::vector<std::size_t> order;
  for (std::size_t s = 0; s < worst.size(); ++s) {
    if (worst[s]) order.push_back(s);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return worst[a]->excess > worst[b]->excess; });
  for (const std::size_t s : order) texts.push_back(too_fast_text(show, plan, s, *worst[s]));
  if (!texts.empty()) return texts;
  if (verdict.first.empty()) return {"the plan breaks a limit that the judge does not name"};
  texts.push_back(other_text(show, plan, verdict.first.front(), verdict.violations - 1));
  return texts;
}

std::string cannot_pass_text(const Show& show, const CannotPass& fact) {
  const auto id = [&](std::uint32_t performer) { return show.performers[performer].id; };
  std::string who = "people";
  if (!fact.pairs.empty()) {
    who = fmt::format("performers {} and {}", id(fact.pairs.front().first), id(fact.pairs.front().second));
    if (fact.pairs.size() > 1) {
      who += fmt::format(", and {} more pair{},", fact.pairs.size() - 1, fact.pairs.size() == 2 ? "" : "s");
    }
  }
  const double first = show.tempo.count_at(fact.start);
  const double last = show.tempo.count_at(fact.start + seconds(fact.given_s));
  std::string text = fmt::format("{} cannot pass each other on the way between count {} and count {}", who,
                                 count_text(first), count_text(last));
  if (!fact.needed_s) {
    text += ": no way was found with marks on it, either";
    return section_message(show, fact.section, text,
                           "other places for them, places that they may exchange, or a smaller clearance");
  }
  const double more = std::ceil((*fact.needed_s - fact.given_s) * show.tempo.bpm_at(last) / 60 - 1e-9);
  text += fmt::format(": with marks on it it takes {:.1f} s of {:.1f} s", *fact.needed_s, fact.given_s);
  if (fact.last) text += fmt::format(", performer {} being the last", id(*fact.last));
  return section_message(show, fact.section, text,
                         fmt::format("start the section {:g} count{} later, or give them places that they may exchange",
                                     more, more == 1 ? "" : "s"));
}

}  // namespace footlight::planner
