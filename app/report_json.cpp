// SPDX-License-Identifier: Apache-2.0
#include "app/report_json.hpp"

#include <nlohmann/json.hpp>

#include "app/dark_report.hpp"
#include "app/written.hpp"

namespace footlight::app {
namespace {

// What is not a number, and what is not finite, is null.
using Json = nlohmann::ordered_json;

template <class T>
Json value_of(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}

Json figures_of(const planner::Measures& m) {
  return {{"formations", m.formations},           {"theta_dev", value_of(m.theta_dev)},
          {"theta_miss", value_of(m.theta_miss)}, {"min_clearance_m", m.min_clearance_m},
          {"max_speed_m_s", m.max_speed_m_s},     {"total_distance_m", m.total_distance_m}};
}

Json sections_of(const Plan& plan, const planner::ShowMeasures& measures) {
  Json out = Json::array();
  for (std::size_t s = 0; s < plan.sections.size(); ++s) {
    const PlanSection& section = plan.sections[s];
    Json one{{"name", section.name}, {"start_s", to_seconds(section.start)}, {"end_s", to_seconds(section.end)}};
    one.update(figures_of(measures.sections.at(s)));
    out.push_back(one);
  }
  return out;
}

Json clearance_of(const Plan& plan, const ClearanceSeries& series) {
  Json pairs = Json::array();
  for (std::size_t i = 0; i < series.a.size(); ++i) {
    pairs.push_back({plan.performers.at(series.a[i].at()), plan.performers.at(series.b[i].at())});
  }
  return {{"time_s", series.time_s}, {"least_m", series.least_m}, {"performers", pairs}, {"at_s", series.at_s}};
}

Json crowd_of(const planner::CrowdSeries& crowd) {
  Json out{{"R_m", crowd.classes.bin_m}, {"K", crowd.classes.sectors}, {"time_s", crowd.time_s}};
  for (const char* key :
       {"N", "I_d_bits", "I_v_bits", "I_d_shuffled_bits", "I_v_shuffled_bits", "sigma_min_dis_m", "sigma_curr_eft_m"}) {
    out[key] = Json::array();
  }
  for (const planner::CrowdInstant& at : crowd.at) {
    out["N"].push_back(at.information.moving);
    out["I_d_bits"].push_back(at.information.direction_bits);
    out["I_v_bits"].push_back(at.information.speed_bits);
    out["I_d_shuffled_bits"].push_back(at.shuffled_direction_bits);
    out["I_v_shuffled_bits"].push_back(at.shuffled_speed_bits);
    out["sigma_min_dis_m"].push_back(at.sigma_nearest_m);
    out["sigma_curr_eft_m"].push_back(at.sigma_effort_m);
  }
  return out;
}

Json lag_of(const Plan& plan, const std::vector<double>& lag_s) {
  Json start = Json::array();
  for (const TransitionFacts& one : plan.transitions) start.push_back(to_seconds(one.start));
  return {{"wanted_s", to_seconds(plan.stage.lag)}, {"start_s", start}, {"tolerated_s", lag_s}};
}

Json buses_of(const std::vector<BusLoad>& buses) {
  Json out = Json::array();
  for (const BusLoad& bus : buses) {
    out.push_back({{"name", bus.bus},
                   {"load", bus.busiest},
                   {"needed_s", bus.needed_s},
                   {"allowed_s", bus.allowed_s},
                   {"nodes_changed", bus.changed},
                   {"cause", bus.cause}});
  }
  return out;
}

Json warnings_of(const Plan& plan, const std::vector<Diagnostic>& warnings) {
  Json out = Json::array();
  for (const Diagnostic& warning : warnings) out.push_back(to_text(warning));
  for (const PlanSection& section : plan.sections) {
    for (const std::string& note : section.notes) out.push_back(section.name + ": " + note);
  }
  return out;
}

}  // namespace

std::string report_json(const Plan& plan, const Show& show, const ReportFacts& facts,
                        const std::vector<std::string>& files) {
  Json out = written_json(Stamp(plan), files);
  out["performers"] = plan.performers;
  out["clearance_limit_m"] = plan.stage.clearance_m;
  out["all"] = figures_of(facts.measures.show);
  out["sections"] = sections_of(plan, facts.measures);
  out["drawing"] = {
      {"time_s", facts.drawing.time_s}, {"theta_dev", facts.drawing.dev}, {"theta_miss", facts.drawing.miss}};
  out["clearance"] = clearance_of(plan, facts.clearance);
  out["lag"] = lag_of(plan, facts.lag_s);
  out["ways"] = {{"walked_m", facts.ways.walked_m},
                 {"fastest_m_s", facts.ways.fastest_mps},
                 {"median_m", facts.measures.show.median_distance_m},
                 {"gini", facts.measures.show.distance_gini}};
  out["crowd"] = crowd_of(facts.crowd);
  out["buses"] = buses_of(facts.buses);
  out["buses_missing"] = facts.buses_missing.empty() ? Json() : Json(facts.buses_missing);
  out["supplies"] = supplies_json(facts.supplies);
  out["dark"] = plan.valid ? Json::parse(dark_json(show, plan, facts.dark)) : Json();
  out["warnings"] = warnings_of(plan, facts.warnings);
  return out.dump(1);
}

}  // namespace footlight::app
