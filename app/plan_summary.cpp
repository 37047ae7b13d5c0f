// SPDX-License-Identifier: Apache-2.0
#include "app/plan_summary.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/numbers.hpp"
#include "app/text_table.hpp"
#include "planner/manual_work.hpp"
#include "planner/measure.hpp"

namespace footlight::app {
namespace {

using Json = nlohmann::ordered_json;

/// The transitions that end in a section.
struct Transitions {
  int count = 0;
  int tolerant = 0;  ///< of them, those in which everybody may be as late as the stage's lag
  double longest_walk_m = 0;
  PerformerIndex longest_walker;
};

std::vector<Transitions> transitions_of(const Plan& plan) {
  std::vector<Transitions> out(plan.sections.size());
  for (const TransitionFacts& facts : plan.transitions) {
    Transitions& section = out[section_at(plan, facts.end)];
    ++section.count;
    if (facts.tolerated_lag_s >= to_seconds(plan.stage.lag) - 1e-9) ++section.tolerant;
    if (facts.longest_walk_m <= section.longest_walk_m) continue;
    section.longest_walk_m = facts.longest_walk_m;
    section.longest_walker = facts.longest_walker;
  }
  return out;
}

Transitions sum_of(const std::vector<Transitions>& sections) {
  Transitions out;
  for (const Transitions& section : sections) {
    out.count += section.count;
    out.tolerant += section.tolerant;
    if (section.longest_walk_m <= out.longest_walk_m) continue;
    out.longest_walk_m = section.longest_walk_m;
    out.longest_walker = section.longest_walker;
  }
  return out;
}

std::string metres(double value, int decimals) {
  return std::isfinite(value) ? fmt::format("{:.{}f} m", value, decimals) : "-";
}

std::string longest(const Plan& plan, const Transitions& transitions) {
  if (transitions.longest_walk_m == 0) return "-";
  return fmt::format("{:.1f} m ({})", transitions.longest_walk_m, plan.performers[transitions.longest_walker.at()]);
}

std::string tolerant(const Transitions& transitions) {
  return fmt::format("{} of {}", transitions.tolerant, transitions.count);
}

std::vector<std::string> row(const Plan& plan, const std::string& name, const std::string& counts,
                             const planner::Measures& m, const Transitions& transitions) {
  return {name,
          counts,
          fmt::format("{}", m.formations),
          longest(plan, transitions),
          metres(m.total_distance_m, 0),
          metres(m.min_clearance_m, 3),
          fmt::format("{:.2f} m/s", m.max_speed_m_s),
          tolerant(transitions)};
}

planner::ShowMeasures walks_of(const Plan& plan) {
  if (plan.valid) return planner::measure_walks(plan);
  return planner::measure(plan, std::vector<std::optional<Film>>(plan.sections.size()));
}

double count_at(const Show& show, Instant instant) { return tidy_count(show.tempo.count_at(instant)); }

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

void add_figures(Json& out, const Plan& plan, const planner::Measures& m, const Transitions& transitions) {
  out["formations"] = m.formations;
  out["transitions"] = transitions.count;
  out["lag_tolerated_by"] = transitions.tolerant;
  out["longest_walk_m"] = number(transitions.longest_walk_m);
  out["longest_walker"] =
      transitions.longest_walk_m > 0 ? Json(plan.performers[transitions.longest_walker.at()]) : Json();
  out["total_distance_m"] = number(m.total_distance_m);
  out["longest_distance_m"] = number(m.longest_distance_m);
  out["min_clearance_m"] = number(m.min_clearance_m);
  out["too_close"] = m.too_close;
  out["max_speed_m_s"] = number(m.max_speed_m_s);
}

const planner::Planned::Shortest* shortest_of(const planner::Planned& planned, std::size_t section) {
  if (section >= planned.shortest.size() || !planned.shortest[section]) return nullptr;
  return &*planned.shortest[section];
}

}  // namespace

std::string shortest_text(const Show& show, const planner::Planned& planned) {
  std::string out;
  for (std::size_t i = 0; i < show.sections.size(); ++i) {
    const auto* shortest = shortest_of(planned, i);
    if (shortest == nullptr) continue;
    const Section& section = show.sections[i];
    out += fmt::format("section {}: ", section.name);
    const double has = section.duration_counts;
    const double least = std::ceil(shortest->counts);
    if (has > 0 && least > has) {
      // Most films are faster than people; that is no error and needs no thousand counts.
      out += fmt::format(
          "the film is faster than people walk in {:g} counts, so they stand as near to it as they come; a longer "
          "duration or a higher max_speed brings them nearer (every place would be reached with {:.0f} counts)",
          tidy_count(has), least);
    } else if (has > 0) {
      out += fmt::format("could be as short as {:.0f} counts (it has {:g})", least, tidy_count(has));
    } else {
      out += fmt::format("the walk into it could be as short as {:.0f} counts", least);
    }
    out += shortest->limited_by.empty() ? "\n" : fmt::format("; the hardest walk: {}\n", shortest->limited_by);
  }
  return out;
}

std::string by_hand_text(const Plan& plan) {
  const planner::ManualWork work = planner::manual_work(plan);
  if (work.moved == 0 && work.pinned == 0) return "";
  return fmt::format(
      "by hand: {} of {} places in key formations (MWSKF {:.3g} %), {} of {} assignments (MWPFT {:.3g} %)\n",
      work.moved, work.places, 100 * work.formations_share(), work.pinned, work.assignments,
      100 * work.transitions_share());
}

std::string plan_text(const Show& show, const planner::Planned& planned) {
  const Plan& plan = planned.plan;
  const auto measures = walks_of(plan);
  const auto transitions = transitions_of(plan);
  std::string out =
      fmt::format("{}: {} performers on {} x {} cells, {:.1f} s\n\n", plan.title.empty() ? "untitled" : plan.title,
                  plan.performers.size(), plan.stage.grid.columns(), plan.stage.grid.rows(),
                  plan.sections.empty() ? 0.0 : to_seconds(plan.sections.back().end - plan.sections.front().start));
  TextTable table({"section", "counts", "formations", "longest walk (who)", "walked", "clearance", "speed",
                   fmt::format("tolerate {:g} s", to_seconds(plan.stage.lag))});
  for (std::size_t i = 0; i < plan.sections.size(); ++i) {
    const PlanSection& section = plan.sections[i];
    table.add(row(plan, section.name,
                  fmt::format("{:g}-{:g}", count_at(show, section.start), count_at(show, section.end)),
                  measures.sections[i], transitions[i]));
  }
  table.add(row(plan, "show", "", measures.show, sum_of(transitions)));
  out += table.to_text();
  std::string notes;
  for (const PlanSection& section : plan.sections) {
    for (const std::string& text : section.notes) notes += fmt::format("section {}: {}\n", section.name, text);
  }
  notes += by_hand_text(plan);
  notes += shortest_text(show, planned);
  return out + (notes.empty() ? "" : "\n" + notes);
}

std::string plan_json(const Show& show, const planner::Planned& planned) {
  const Plan& plan = planned.plan;
  const auto measures = walks_of(plan);
  const auto transitions = transitions_of(plan);
  Json out{{"title", plan.title},
           {"version", plan.version},
           {"show_hash", plan.show_hash},
           {"valid", plan.valid},
           {"performers", plan.performers.size()},
           {"clearance_m", plan.stage.clearance_m},
           {"lag_s", to_seconds(plan.stage.lag)}};
  const planner::ManualWork work = planner::manual_work(plan);
  out["mwskf"] = work.formations_share();
  out["mwpft"] = work.transitions_share();
  add_figures(out, plan, measures.show, sum_of(transitions));
  out["sections"] = Json::array();
  for (std::size_t i = 0; i < plan.sections.size(); ++i) {
    const PlanSection& section = plan.sections[i];
    Json one{{"name", section.name},
             {"start_count", count_at(show, section.start)},
             {"end_count", count_at(show, section.end)},
             {"start_s", to_seconds(section.start)},
             {"end_s", to_seconds(section.end)}};
    add_figures(one, plan, measures.sections[i], transitions[i]);
    const auto* shortest = shortest_of(planned, i);
    one["shortest_counts"] = shortest == nullptr ? Json() : Json(shortest->counts);
    one["limited_by"] = shortest == nullptr ? Json() : Json(shortest->limited_by);
    one["notes"] = section.notes;
    out["sections"].push_back(std::move(one));
  }
  out["refusal"] = planned.refusal;
  return out.dump(1) + "\n";
}

}  // namespace footlight::app
