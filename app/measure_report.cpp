// SPDX-License-Identifier: Apache-2.0
#include "app/measure_report.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/text_table.hpp"

namespace footlight::app {
namespace {

using Json = nlohmann::ordered_json;

Json number(std::optional<double> value) { return value && std::isfinite(*value) ? Json(*value) : Json(); }

Json figures(const planner::Measures& m) {
  return {{"frames", m.frames},
          {"theta_dev", number(m.theta_dev)},
          {"theta_dev_var", number(m.theta_dev_var)},
          {"theta_miss", number(m.theta_miss)},
          {"theta_iou", number(m.theta_iou)},
          {"min_clearance_m", number(m.min_clearance_m)},
          {"too_close", m.too_close},
          {"max_speed_m_s", number(m.max_speed_m_s)},
          {"total_distance_m", number(m.total_distance_m)},
          {"longest_distance_m", number(m.longest_distance_m)},
          {"formations", m.formations}};
}

std::string percent(std::optional<double> share) { return share ? fmt::format("{:.2f} %", *share * 100) : "-"; }

std::vector<std::string> row(const std::string& name, const planner::Measures& m) {
  return {name,
          fmt::format("{}", m.formations),
          fmt::format("{}", m.frames),
          percent(m.theta_dev),
          percent(m.theta_miss),
          percent(m.theta_iou),
          std::isfinite(m.min_clearance_m) ? fmt::format("{:.3f} m", m.min_clearance_m) : "-",
          fmt::format("{}", m.too_close),
          fmt::format("{:.2f} m/s", m.max_speed_m_s),
          fmt::format("{:.0f} m", m.total_distance_m),
          fmt::format("{:.0f} m", m.longest_distance_m)};
}

std::vector<std::string> best_row(const planner::SingleFigures& best) {
  return {"  best", "-", "-", percent(best.theta_dev), percent(best.theta_miss), percent(best.theta_iou), "-", "-",
          "-",      "-", "-"};
}

}  // namespace

std::string measure_text(const Plan& plan, const planner::ShowMeasures& measures, const SectionBests& bests) {
  TextTable table({"section", "formations", "frames", "theta_dev", "theta_miss", "theta_iou", "clearance", "too close",
                   "speed", "walked", "longest"});
  for (std::size_t i = 0; i < measures.sections.size() && i < plan.sections.size(); ++i) {
    table.add(row(plan.sections[i].name, measures.sections[i]));
    if (i < bests.size() && bests[i]) table.add(best_row(*bests[i]));
  }
  table.add(row("show", measures.show));
  return table.to_text() + (plan.valid ? "" : "The plan is not valid: it breaks its limits.\n");
}

std::string measure_json(const Plan& plan, const planner::ShowMeasures& measures, const SectionBests& bests) {
  Json out{{"title", plan.title}, {"valid", plan.valid}, {"performers", plan.performers.size()}};
  out.update(figures(measures.show));
  out["sections"] = Json::array();
  for (std::size_t i = 0; i < measures.sections.size() && i < plan.sections.size(); ++i) {
    Json section{{"name", plan.sections[i].name}};
    section.update(figures(measures.sections[i]));
    if (i < bests.size() && bests[i]) {
      section["best"] = {
          {"theta_dev", bests[i]->theta_dev}, {"theta_miss", bests[i]->theta_miss}, {"theta_iou", bests[i]->theta_iou}};
    }
    out["sections"].push_back(std::move(section));
  }
  return out.dump(1) + "\n";
}

}  // namespace footlight::app
