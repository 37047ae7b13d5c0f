// SPDX-License-Identifier: Apache-2.0
#include "planner/plan_notes.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "planner/refusal.hpp"
#include "planner/schedule/beats.hpp"

namespace footlight::planner {
namespace {

/// "40 %", and "< 1 %" for what rounding would hide.
std::string percent(double share) { return share > 0 && share < 0.01 ? "< 1 %" : fmt::format("{:.0f} %", 100 * share); }

/// Those who go around others between two stops.
void note_detours(const NoteTask& task, std::size_t k, Plan& plan) {
  const Chain& chain = *task.chain;
  const Grid& grid = task.show->stage.grid;
  const Leg& leg = chain.legs[k];
  std::size_t people = 0;
  double walked_m = 0;
  double straight_m = 0;
  for (std::size_t n = 0; n < leg.vias.size();) {
    const std::uint32_t person = leg.vias[n].person;
    const CellIndex target = chain.stops[k + 1].cells[leg.target_of[person]];
    CellIndex at = chain.stops[k].cells[person];
    straight_m += distance(grid.centre(at), grid.centre(target));
    for (; n < leg.vias.size() && leg.vias[n].person == person; ++n) {
      walked_m += distance(grid.centre(at), grid.centre(leg.vias[n].cell));
      at = leg.vias[n].cell;
    }
    walked_m += distance(grid.centre(at), grid.centre(target));
    ++people;
  }
  plan.sections[chain.stops[k + 1].section.at()].notes.push_back(fmt::format(
      "between count {:g} and count {:g} {} {} around others with {} mark{} of {} own on the way: {:.1f} m instead of "
      "{:.1f} m",
      task.show->tempo.count_at(chain.stops[k].depart), chain.stops[k + 1].count, people,
      people == 1 ? "person goes" : "people go", leg.vias.size(), leg.vias.size() == 1 ? "" : "s",
      people == 1 ? "her" : "their", walked_m, straight_m));
}

}  // namespace

void note_what_gave_way(const NoteTask& task, Plan& plan) {
  const Show& show = *task.show;
  const Chain& chain = *task.chain;
  for (std::size_t s = 0; s < show.sections.size(); ++s) {
    long given = 0;
    long drawn = 0;
    int formations = 0;
    int number = 0;
    int worst = 0;
    double worst_share = 0;
    for (const Stop& stop : chain.stops) {
      if (!stop.station || (*task.stations)[*stop.station].section.at() != s) continue;
      const int in_picture = (*task.stations)[*stop.station].in_picture;
      ++number;
      given += stop.given_way;
      drawn += in_picture;
      if (stop.given_way == 0) continue;
      ++formations;
      const double share = double(stop.given_way) / std::max(1, in_picture);
      if (share > worst_share) {
        worst_share = share;
        worst = number;
      }
    }
    if (given == 0) continue;
    plan.sections[s].notes.push_back(
        fmt::format("the drawing gives way: {} of {} places ({}) in {} formations are not reached in time, most in "
                    "{}/{} ({}), since "
                    "nobody walks faster than {:g} m/s",
                    given, drawn, percent(double(given) / double(drawn)), formations, show.sections[s].name, worst,
                    percent(worst_share), section_speed(*task.limits, show.sections[s])));
  }
}

void note_late_pins(const NoteTask& task, Plan& plan) {
  const Show& show = *task.show;
  const Grid& grid = show.stage.grid;
  std::vector<int> late(show.sections.size(), 0);
  std::vector<std::string> first(show.sections.size());
  for (std::size_t k = 0; k < task.chain->stops.size(); ++k) {
    const Stop& stop = task.chain->stops[k];
    if (!stop.station) continue;
    const Station& station = (*task.stations)[*stop.station];
    const std::size_t s = station.section.at();
    for (const auto& [who, wanted] : station.pins) {
      const CellIndex there = stop.cells[(*task.slot)[k][who.at()]];
      if (show.performers[who.at()].absent || there == wanted || late[s]++ > 0) continue;
      first[s] = fmt::format(
          "performer {} is pinned to {} at count {:g} and has come as far as {} by then, since nobody walks faster "
          "than "
          "{:g} m/s",
          show.performers[who.at()].id, grid.name(wanted), station.count, grid.name(there),
          section_speed(*task.limits, show.sections[s]));
    }
  }
  for (std::size_t s = 0; s < late.size(); ++s) {
    if (late[s] == 0) continue;
    if (late[s] > 1) first[s] += fmt::format("; {} more pinned places are not reached in time", late[s] - 1);
    plan.sections[s].notes.push_back(first[s]);
  }
}

void note_steps(const NoteTask& task, Plan& plan) {
  const Show& show = *task.show;
  if (show.stage.walk != WalkKind::cells) return;
  for (std::size_t s = 0; s < show.sections.size(); ++s) {
    const PlanSection& section = plan.sections[s];
    const Instant before = s > 0 ? plan.sections[s - 1].end : kStart;
    const double speed_mps = section_speed(*task.limits, show.sections[s]);
    const Beats beats = beats_between(show.tempo, before, section.end, show.stage.grid.pitch_m() / speed_mps);
    if (beats.counts == 1) continue;
    plan.sections[s].notes.push_back(fmt::format(
        "a step from cell to cell takes {} counts, since one of {:.3g} s is too short for {:g} m at {:g} m/s",
        beats.counts, beats.step_s / beats.counts, show.stage.grid.pitch_m(), speed_mps));
  }
}

void note_lag(const NoteTask& task, Plan& plan) {
  const Show& show = *task.show;
  const double lag_s = to_seconds(show.stage.lag);
  const double spare_m = show.stage.grid.clearance_bound_m() - task.clearance_m;
  for (std::size_t s = 0; s < plan.sections.size(); ++s) {
    const Instant first = s > 0 ? plan.sections[s - 1].end : Instant::min();
    const Instant last = s + 1 < plan.sections.size() ? plan.sections[s].end : Instant::max();
    int count = 0;
    int short_of = 0;
    const TransitionFacts* worst = nullptr;
    for (const TransitionFacts& facts : plan.transitions) {
      if (facts.end <= first || facts.end > last) continue;
      ++count;
      if (facts.tolerated_lag_s >= lag_s - 1e-9) continue;
      ++short_of;
      if (worst == nullptr || facts.tolerated_lag_s < worst->tolerated_lag_s) worst = &facts;
    }
    if (worst == nullptr) continue;
    std::string helps = "a longer section or a smaller clearance would help";
    if (spare_m > 0) helps = fmt::format("walks of at most {:.2f} m/s tolerate it: a longer section", spare_m / lag_s);
    plan.sections[s].notes.push_back(fmt::format(
        "in {} of {} transitions people come too near when they are {:g} s late; least is tolerated, {:.3f} "
        "s, in the one from count {:g}; {}",
        short_of, count, lag_s, worst->tolerated_lag_s, show.tempo.count_at(worst->start), helps));
  }
}

void note_waits(const NoteTask& task, Plan& plan) {
  const Show& show = *task.show;
  const Chain& chain = *task.chain;
  std::vector<int> waits(show.sections.size(), 0);
  std::vector<std::string> example(show.sections.size());
  for (std::size_t k = 0; k < chain.legs.size(); ++k) {
    if (chain.legs[k].timing.empty()) continue;
    const std::size_t s = chain.stops[k + 1].section.at();
    const Instant start = chain.stops[k].depart;
    const Instant end = chain.stops[k + 1].arrive;
    for (std::size_t p = 0; p < show.performers.size(); ++p) {
      const Chain::WalkTimes own = chain.walk_times(k, (*task.slot)[k][p]);
      if (show.performers[p].absent || (own.start == start && own.end == end)) continue;
      if (waits[s]++ > 0) continue;
      const auto counts = [&](Instant from, Instant to) {
        return std::round(100 * (show.tempo.count_at(to) - show.tempo.count_at(from))) / 100;
      };
      example[s] = fmt::format(
          "performer {} leaves {:g} counts later and is there {:g} counts earlier than the others "
          "who walk from count {:g}",
          show.performers[p].id, counts(start, own.start), counts(own.end, end), show.tempo.count_at(start));
    }
  }
  for (std::size_t s = 0; s < waits.size(); ++s) {
    if (waits[s] == 0) continue;
    plan.sections[s].notes.push_back(fmt::format(
        "{} walk{} made one after the other, since people would come too near on them or when they are late: {}",
        waits[s], waits[s] == 1 ? " is" : "s are", example[s]));
  }
}

void note_marks_on_the_way(const NoteTask& task, Plan& plan) {
  const Show& show = *task.show;
  const Chain& chain = *task.chain;
  for (const Chain::Passed& one : chain.passed) {
    const Stop& goal = chain.stops[one.last_stop];
    const std::size_t marks = one.last_stop - one.first_stop - 1;
    plan.sections[goal.section.at()].notes.push_back(fmt::format(
        "between count {:g} and count {:g} people pass each other with {} mark{} on the way: they walk {:.1f} m "
        "instead of {:.1f} m",
        show.tempo.count_at(chain.stops[one.first_stop].depart), goal.count, marks, marks == 1 ? "" : "s", one.walked_m,
        one.straight_m));
  }
  for (std::size_t k = 0; k < chain.legs.size(); ++k) {
    if (!chain.legs[k].vias.empty()) note_detours(task, k, plan);
  }
}

std::vector<std::string> who_cannot_pass(const NoteTask& task) {
  const Show& show = *task.show;
  const Chain& chain = *task.chain;
  std::vector<std::string> texts;
  for (const Chain::Unpassed& one : chain.unpassed) {
    const Stop& start = chain.stops[one.leg];
    std::vector<std::uint32_t> who((*task.slot)[one.leg].size());
    for (std::uint32_t p = 0; p < who.size(); ++p) who[(*task.slot)[one.leg][p]] = p;
    CannotPass fact{start.depart, chain.stops[one.leg + 1].section, one.given_s, one.needed_s, {}, {}};
    for (const auto& [a, b] : chain.legs[one.leg].conflicts) fact.pairs.emplace_back(who[a], who[b]);
    if (one.last) fact.last = who[*one.last];
    texts.push_back(cannot_pass_text(show, fact));
  }
  return texts;
}

}  // namespace footlight::planner
