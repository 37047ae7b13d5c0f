// SPDX-License-Identifier: Apache-2.0
#include "app/measure_report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/numbers.hpp"
#include "app/plan_summary.hpp"
#include "app/text_table.hpp"
#include "core/check.hpp"
#include "planner/manual_work.hpp"

namespace footlight::app {
namespace {

using Json = nlohmann::ordered_json;

Json number(std::optional<double> value) { return value && std::isfinite(*value) ? Json(*value) : Json(); }

/// How late people may be, over some transitions.
struct Lag {
  int transitions = 0;
  int tolerated_by = 0;  ///< of them, those that tolerate the stage's lag
  double least_s = std::numeric_limits<double>::infinity();
};

/// Of a section, or of the whole show.
Lag lag_of(const MeasuredPlan& measured, std::optional<std::size_t> section) {
  Lag lag;
  const Plan& plan = measured.plan;
  for (std::size_t k = 0; k < std::min(plan.transitions.size(), measured.lag_s.size()); ++k) {
    if (section && section_at(plan, plan.transitions[k].end) != *section) continue;
    ++lag.transitions;
    lag.tolerated_by += measured.lag_s[k] >= to_seconds(plan.stage.lag) - 1e-9 ? 1 : 0;
    lag.least_s = std::min(lag.least_s, measured.lag_s[k]);
  }
  return lag;
}

/// How many times the median distance the longest is; nothing when half of the people stand still.
std::optional<double> longest_to_median(const planner::Measures& m) {
  if (m.median_distance_m <= 0) return std::nullopt;
  return m.longest_distance_m / m.median_distance_m;
}

Json crowd_json(const std::optional<planner::CrowdFigures>& crowd, const planner::InformationClasses& classes) {
  if (!crowd) return {};
  return {{"R_m", classes.bin_m},
          {"K", classes.sectors},
          {"N", crowd->moving},
          {"instants", crowd->instants},
          {"I_d_bits", number(crowd->direction_bits)},
          {"I_d_shuffled_bits", number(crowd->shuffled_direction_bits)},
          {"I_v_bits", number(crowd->speed_bits)},
          {"I_v_shuffled_bits", number(crowd->shuffled_speed_bits)},
          {"sigma_min_dis_m", number(crowd->sigma_nearest_m)},
          {"sigma_curr_eft_m", number(crowd->sigma_effort_m)}};
}

bool has_pair(const Plan& plan, const planner::Measures& m) {
  return std::isfinite(m.min_clearance_m) && m.closest_a != m.closest_b && m.closest_b.at() < plan.performers.size();
}

Json figures(const Plan& plan, const planner::Measures& m, const Lag& lag) {
  Json out{{"frames", m.frames},
           {"theta_dev", number(m.theta_dev)},
           {"theta_dev_var", number(m.theta_dev_var)},
           {"theta_miss", number(m.theta_miss)},
           {"theta_iou", number(m.theta_iou)},
           {"min_clearance_m", number(m.min_clearance_m)},
           {"closest", Json()},
           {"too_close", m.too_close},
           {"max_speed_m_s", number(m.max_speed_m_s)},
           {"total_distance_m", number(m.total_distance_m)},
           {"longest_distance_m", number(m.longest_distance_m)},
           {"median_distance_m", number(m.median_distance_m)},
           {"longest_to_median", number(longest_to_median(m))},
           {"distance_gini", number(m.distance_gini)},
           {"direction_changes", m.direction_changes},
           {"marks_per_minute", number(m.marks_per_minute)},
           {"transitions", lag.transitions},
           {"lag_tolerated_by", lag.tolerated_by},
           {"least_tolerated_lag_s", number(lag.least_s)},
           {"formations", m.formations}};
  if (has_pair(plan, m)) {
    out["closest"] = {{"performers", {plan.performers[m.closest_a.at()], plan.performers[m.closest_b.at()]}},
                      {"at_s", to_seconds(m.closest_at)}};
  }
  return out;
}

std::string percent(std::optional<double> share) { return share ? fmt::format("{:.2f} %", *share * 100) : "-"; }

using Row = std::vector<std::string>;

Row drawing_row(const std::string& name, const planner::Measures& m) {
  return {name,
          fmt::format("{}", m.formations),
          fmt::format("{}", m.frames),
          percent(m.theta_dev),
          m.theta_dev_var ? fmt::format("{:.2g}", *m.theta_dev_var) : "-",
          percent(m.theta_miss),
          percent(m.theta_iou)};
}

Row best_row(const planner::SingleFigures& best) {
  return {"  best", "-", "-", percent(best.theta_dev), "-", percent(best.theta_miss), percent(best.theta_iou)};
}

Row at_formations(const char* name, std::size_t instants, double theta_iou) {
  return {name, fmt::format("{}", instants), fmt::format("{}", instants), "-", "-", "-", percent(theta_iou)};
}

Row clearance_row(const std::string& name, const Plan& plan, const planner::Measures& m, const Lag& lag) {
  const bool pair = has_pair(plan, m);
  return {name,
          std::isfinite(m.min_clearance_m) ? fmt::format("{:.3f} m", m.min_clearance_m) : "-",
          pair ? plan.performers[m.closest_a.at()] + " and " + plan.performers[m.closest_b.at()] : "-",
          pair ? fmt::format("{:.2f} s", to_seconds(m.closest_at)) : "-",
          fmt::format("{}", m.too_close),
          fmt::format("{:.2f} m/s", m.max_speed_m_s),
          fmt::format("{} of {}", lag.tolerated_by, lag.transitions),
          std::isfinite(lag.least_s) ? fmt::format("{:.2f} s", lag.least_s) : "-"};
}

Row way_row(const std::string& name, std::size_t people, const planner::Measures& m) {
  const auto ratio = longest_to_median(m);
  return {name,
          fmt::format("{:.0f} m", m.total_distance_m),
          fmt::format("{:.0f} m", m.longest_distance_m),
          ratio ? fmt::format("{:.1f} x", *ratio) : "-",
          fmt::format("{:.2f}", m.distance_gini),
          people > 0 ? fmt::format("{:.1f}", double(m.direction_changes) / double(people)) : "-",
          fmt::format("{:.1f}", m.marks_per_minute)};
}

Row crowd_row(const std::string& name, const std::optional<planner::CrowdFigures>& crowd) {
  if (!crowd) return {name, "-", "-", "-", "-", "-", "-", "-"};
  const auto bits = [](double value) { return fmt::format("{:.3f}", value); };
  // One person has no nearest neighbour.
  const bool alone = !std::isfinite(crowd->sigma_nearest_m);
  return {name,
          fmt::format("{:.0f}", crowd->moving),
          bits(crowd->direction_bits),
          bits(crowd->shuffled_direction_bits),
          bits(crowd->speed_bits),
          bits(crowd->shuffled_speed_bits),
          alone ? "-" : fmt::format("{:.3f} m", crowd->sigma_nearest_m),
          fmt::format("{:.2f} m", crowd->sigma_effort_m)};
}

/// The four tables, row by row.
class Tables {
 public:
  Tables(const std::string& first, const std::string& asked_lag, bool planning)
      : drawing_({first, "formations", "frames", "theta_dev", "variance", "theta_miss", "theta_iou"}),
        clearance_({first, "clearance", "between", "at", "too close", "fastest", asked_lag, "least"}),
        ways_(way_headings(first, planning)),
        crowd_({first, "walking", "I_d", "by chance", "I_v", "by chance", "sigma_min_dis", "sigma_curr_eft"}),
        planning_(planning) {}

  void add(const std::string& name, const MeasuredPlan& measured, std::optional<std::size_t> section) {
    const planner::Measures& m = section ? measured.measures.sections[*section] : measured.measures.show;
    drawing_.add(drawing_row(name, m));
    if (section && *section < measured.bests.size() && measured.bests[*section]) {
      drawing_.add(best_row(*measured.bests[*section]));
    }
    if (section && *section < measured.bounds.size() && measured.bounds[*section]) {
      const planner::DrawingBound& bound = *measured.bounds[*section];
      drawing_.add(at_formations("  at formations", bound.instants, bound.of_plan));
      drawing_.add(at_formations("  at least", bound.instants, bound.least));
    }
    clearance_.add(clearance_row(name, measured.plan, m, lag_of(measured, section)));
    Row way = way_row(name, measured.plan.tracks.size(), m);
    if (planning_) way.push_back(measured.planning_s ? fmt::format("{:.2f} s", *measured.planning_s) : "-");
    ways_.add(std::move(way));
    crowd_.add(crowd_row(name, m.crowd));
  }
  [[nodiscard]] std::string to_text() const {
    return drawing_.to_text() + "\n" + clearance_.to_text() + "\n" + ways_.to_text() + "\n" + crowd_.to_text();
  }

 private:
  static Row way_headings(const std::string& first, bool planning) {
    Row headings{first, "walked", "longest", "to median", "Gini", "turns each", "marks a minute"};
    if (planning) headings.emplace_back("planned in");
    return headings;
  }

  TextTable drawing_;
  TextTable clearance_;
  TextTable ways_;
  TextTable crowd_;
  bool planning_;
};

Json plan_json(const MeasuredPlan& measured) {
  const Plan& plan = measured.plan;
  Json out{{"file", measured.file},
           {"title", plan.title},
           {"version", plan.version},
           {"valid", plan.valid},
           {"performers", plan.performers.size()},
           {"lag_s", to_seconds(plan.stage.lag)},
           {"planning_s", number(measured.planning_s)}};
  out.update(figures(plan, measured.measures.show, lag_of(measured, std::nullopt)));
  out["crowd"] = crowd_json(measured.measures.show.crowd, measured.measures.crowd_classes);
  const planner::ManualWork work = planner::manual_work(plan);
  out["mwskf"] = work.formations_share();
  out["mwpft"] = work.transitions_share();
  out["sections"] = Json::array();
  for (std::size_t i = 0; i < measured.measures.sections.size() && i < plan.sections.size(); ++i) {
    Json section{{"name", plan.sections[i].name}};
    section.update(figures(plan, measured.measures.sections[i], lag_of(measured, i)));
    section["crowd"] = crowd_json(measured.measures.sections[i].crowd, measured.measures.crowd_classes);
    if (i < measured.bests.size() && measured.bests[i]) {
      const planner::SingleFigures& best = *measured.bests[i];
      section["best"] = {{"theta_dev", best.theta_dev}, {"theta_miss", best.theta_miss}, {"theta_iou", best.theta_iou}};
    }
    if (i < measured.bounds.size() && measured.bounds[i]) {
      const planner::DrawingBound& bound = *measured.bounds[i];
      section["bound"] = {{"formations", bound.instants},
                          {"theta_iou", bound.of_plan},
                          {"theta_iou_least", bound.least},
                          {"theta_iou_nobody_walks", bound.nobody_walks}};
    }
    out["sections"].push_back(std::move(section));
  }
  out["tolerated_lag"] = Json::array();
  for (std::size_t k = 0; k < std::min(plan.transitions.size(), measured.lag_s.size()); ++k) {
    out["tolerated_lag"].push_back({{"start_s", to_seconds(plan.transitions[k].start)},
                                    {"end_s", to_seconds(plan.transitions[k].end)},
                                    {"lag_s", measured.lag_s[k]}});
  }
  return out;
}

}  // namespace

std::string measure_text(const std::vector<MeasuredPlan>& plans) {
  FL_CHECK(!plans.empty());
  if (plans.size() > 1) {
    Tables tables("plan", "tolerate lag", true);
    std::string invalid;
    for (const MeasuredPlan& measured : plans) {
      tables.add(measured.file + (measured.plan.valid ? "" : " (not valid)"), measured, std::nullopt);
      if (!measured.plan.valid) invalid += "The plan of " + measured.file + " is not valid: it breaks its limits.\n";
    }
    return tables.to_text() + invalid;
  }
  const MeasuredPlan& measured = plans.front();
  const Plan& plan = measured.plan;
  Tables tables("section", fmt::format("tolerate {:g} s", to_seconds(plan.stage.lag)), false);
  for (std::size_t i = 0; i < measured.measures.sections.size() && i < plan.sections.size(); ++i) {
    tables.add(plan.sections[i].name, measured, i);
  }
  tables.add("show", measured, std::nullopt);
  return tables.to_text() + by_hand_text(plan) +
         (measured.planning_s ? fmt::format("planned in {:.2f} s\n", *measured.planning_s) : "") +
         (plan.valid ? "" : "The plan is not valid: it breaks its limits.\n");
}

std::string measure_json(const std::vector<MeasuredPlan>& plans) {
  FL_CHECK(!plans.empty());
  if (plans.size() == 1) return plan_json(plans.front()).dump(1) + "\n";
  Json out{{"plans", Json::array()}};
  for (const MeasuredPlan& measured : plans) out["plans"].push_back(plan_json(measured));
  return out.dump(1) + "\n";
}

}  // namespace footlight::app
