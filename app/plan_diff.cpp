// SPDX-License-Identifier: Apache-2.0
#include "app/plan_diff.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/natural_order.hpp"
#include "app/numbers.hpp"
#include "app/paper/drawn_floor.hpp"
#include "app/paper/flow.hpp"
#include "app/text_table.hpp"

namespace footlight::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kSamePlace_m = 1e-9;

/// The same marks: at the same times on the same places.
bool same_part(const Grid& before, const std::vector<Mark>& a, const Grid& now, const std::vector<Mark>& b) {
  return std::ranges::equal(a, b, [&](const Mark& one, const Mark& other) {
    return one.time == other.time && distance(before.centre(one.cell), now.centre(other.cell)) < kSamePlace_m;
  });
}

std::map<std::string, std::size_t> numbers_of(const std::vector<std::string>& ids) {
  std::map<std::string, std::size_t> out;
  for (std::size_t i = 0; i < ids.size(); ++i) out[ids[i]] = i;
  return out;
}

void compare_formations(const Plan& before, const Plan& now, const std::map<std::string, std::size_t>& old_people,
                        PlanDiff& out) {
  std::map<std::string, const Formation*> old;
  for (const Formation& formation : before.formations) old[formation.id] = &formation;
  for (const Formation& formation : now.formations) {
    const auto known = old.find(formation.id);
    FormationDiff one{formation.id, FormationDiff::Kind::added, 0, tidy_count(formation.count), {}};
    if (known != old.end()) {
      const Formation& was = *known->second;
      one.kind = FormationDiff::Kind::changed;
      one.count_before = tidy_count(was.count);
      for (std::size_t p = 0; p < formation.cells.size(); ++p) {
        const auto person = old_people.find(now.performers[p]);
        if (person == old_people.end()) continue;
        const Point from = before.stage.grid.centre(was.cells[person->second]);
        const Point to = now.stage.grid.centre(formation.cells[p]);
        if (distance(from, to) >= kSamePlace_m) one.displaced.push_back({PerformerIndex::of(p), from, to});
      }
      old.erase(known);
      if (one.displaced.empty() && one.count_before == one.count_now) continue;
    }
    out.formations.push_back(std::move(one));
  }
  for (const Formation& formation : before.formations) {
    if (!old.contains(formation.id)) continue;
    out.formations.push_back({formation.id, FormationDiff::Kind::removed, tidy_count(formation.count), 0, {}});
  }
  std::ranges::stable_sort(out.formations, {}, [](const FormationDiff& one) {
    return one.kind == FormationDiff::Kind::removed ? one.count_before : one.count_now;
  });
}

std::string figure(double value) { return std::isfinite(value) ? fmt::format("{:.3f}", value) : "-"; }

/// Name, before, now.
std::vector<std::vector<std::string>> figures_of(const PlanDiff& diff) {
  const auto row = [&](const char* name, double planner::Measures::*value) {
    return std::vector<std::string>{name, figure(diff.before.*value), figure(diff.now.*value)};
  };
  return {row("smallest clearance, m", &planner::Measures::min_clearance_m),
          row("fastest walk, m/s", &planner::Measures::max_speed_m_s),
          row("walked by all, m", &planner::Measures::total_distance_m),
          row("longest way, m", &planner::Measures::longest_distance_m),
          row("median way, m", &planner::Measures::median_distance_m),
          row("inequality of ways (Gini)", &planner::Measures::distance_gini),
          row("marks a minute", &planner::Measures::marks_per_minute)};
}

std::string words_of(const FormationDiff& one) {
  switch (one.kind) {
    case FormationDiff::Kind::added:
      return fmt::format("new, at count {:g}", one.count_now);
    case FormationDiff::Kind::removed:
      return fmt::format("gone, was at count {:g}", one.count_before);
    case FormationDiff::Kind::changed:
      break;
  }
  double longest = 0;
  for (const Displaced& person : one.displaced) longest = std::max(longest, distance(person.before, person.now));
  std::string out = fmt::format("{} stand elsewhere, by {:.1f} m at most", one.displaced.size(), longest);
  if (one.count_before != one.count_now) out += fmt::format("; count {:g} was {:g}", one.count_now, one.count_before);
  return out;
}

const char* kind_text(FormationDiff::Kind kind) {
  return kind == FormationDiff::Kind::changed ? "changed" : kind == FormationDiff::Kind::added ? "added" : "removed";
}

std::string list_of(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 40;
  std::string out;
  for (std::size_t i = 0; i < names.size() && i < kMost; ++i) out += (i == 0 ? "" : ", ") + names[i];
  return names.size() > kMost ? out + fmt::format(" and {} more", names.size() - kMost) : out;
}

std::string people_text(const PlanDiff& diff) {
  std::string out = fmt::format("{} people have other marks, {} the same", diff.changed.size(), diff.same);
  if (!diff.changed.empty()) out += ": " + list_of(diff.changed);
  if (!diff.joined.empty()) out += "\nonly in the new plan: " + list_of(diff.joined);
  if (!diff.left.empty()) out += "\nonly in the old plan: " + list_of(diff.left);
  return out;
}

/// One changed formation on the page's floor.
void draw_change(Canvas& canvas, const Plan& now, const Formation& formation, const FormationDiff& change, double top) {
  const double left = kA4.margin_pt;
  const double width = kA4.width_pt - 2 * left;
  const Frame frame(now.stage.grid, {left + 14, top}, width - 14, kA4.height_pt - top - kA4.margin_pt - 40);
  const DrawnFloor floor(canvas, frame, now.stage, kOnPaper);
  floor.ground(now.sections.at(formation.section.at()).reserve);
  floor.lines();
  floor.blocked();
  floor.labels(6);
  const double dot = std::max(1.2, 0.3 * now.stage.grid.pitch_m() * frame.scale);
  canvas.ink({0.7, 0.7, 0.7});
  for (const CellIndex cell : formation.cells) canvas.disc(frame.at(now.stage.grid.centre(cell)), dot);
  for (const Displaced& person : change.displaced) {
    canvas.ink({0.0, 0.45, 0.70});
    canvas.ring(frame.at(person.before), dot, std::max(0.5, 0.3 * dot));
    canvas.stroke_line(frame.at(person.before), frame.at(person.now), 0.6);
    canvas.ink({0.84, 0.37, 0.0});
    canvas.disc(frame.at(person.now), dot);
  }
}

}  // namespace

PlanDiff diff_of(const Plan& before, const Plan& now) {
  PlanDiff out;
  out.plan_before = Stamp(before).plan;
  out.plan_now = Stamp(now).plan;
  const auto old_people = numbers_of(before.performers);
  const auto people = numbers_of(now.performers);
  for (const std::string& id : before.performers) {
    if (!people.contains(id)) out.left.push_back(id);
  }
  for (std::size_t p = 0; p < now.performers.size(); ++p) {
    const auto known = old_people.find(now.performers[p]);
    if (known == old_people.end()) {
      out.joined.push_back(now.performers[p]);
    } else if (same_part(before.stage.grid, before.tracks[known->second], now.stage.grid, now.tracks[p])) {
      ++out.same;
    } else {
      out.changed.push_back(now.performers[p]);
    }
  }
  std::ranges::sort(out.changed, natural_less);
  compare_formations(before, now, old_people, out);
  out.before = planner::measure(before, std::vector<std::optional<Film>>(before.sections.size())).show;
  out.now = planner::measure(now, std::vector<std::optional<Film>>(now.sections.size())).show;
  return out;
}

std::string diff_text(const PlanDiff& diff) {
  TextTable figures({"", "old", "new"});
  for (const auto& row : figures_of(diff)) figures.add(row);
  std::string out = figures.to_text() + "\n" + people_text(diff) + "\n\n";
  if (diff.formations.empty()) out += "no formation has changed\n";
  for (const FormationDiff& one : diff.formations) out += fmt::format("{}: {}\n", one.id, words_of(one));
  return out;
}

std::string diff_json(const PlanDiff& diff) {
  const auto measures = [](const planner::Measures& m) {
    Json out{{"max_speed_m_s", m.max_speed_m_s},           {"total_distance_m", m.total_distance_m},
             {"longest_distance_m", m.longest_distance_m}, {"median_distance_m", m.median_distance_m},
             {"distance_gini", m.distance_gini},           {"marks_per_minute", m.marks_per_minute}};
    out["min_clearance_m"] = std::isfinite(m.min_clearance_m) ? Json(m.min_clearance_m) : Json();
    return out;
  };
  Json out{
      {"old", measures(diff.before)}, {"new", measures(diff.now)}, {"joined", diff.joined},      {"left", diff.left},
      {"changed", diff.changed},      {"same", diff.same},         {"formations", Json::array()}};
  out["old"]["plan"] = diff.plan_before;
  out["new"]["plan"] = diff.plan_now;
  for (const FormationDiff& one : diff.formations) {
    Json formation{{"id", one.id}, {"kind", kind_text(one.kind)}, {"displaced", one.displaced.size()}};
    if (one.kind != FormationDiff::Kind::added) formation["old_count"] = one.count_before;
    if (one.kind != FormationDiff::Kind::removed) formation["new_count"] = one.count_now;
    out["formations"].push_back(formation);
  }
  return out.dump(1) + "\n";
}

std::string diff_pdf(const Plan& before, const Plan& now, const PlanDiff& diff) {
  const Stamp stamp(now);
  Canvas canvas = Canvas::pdf(kA4.width_pt, kA4.height_pt, {"Changes", stamp.line()});
  Flow flow(canvas, kA4, stamp);
  flow.begin("Changes since plan " + Stamp(before).plan);
  const std::vector<double> shares{0.5, 0.25, 0.25};
  flow.row(shares, {"", "old", "new"}, true);
  for (const auto& row : figures_of(diff)) flow.row(shares, row);
  flow.space(1);
  flow.words(people_text(diff));
  flow.space(1);
  for (const FormationDiff& one : diff.formations) flow.words(one.id + ": " + words_of(one));
  for (const FormationDiff& one : diff.formations) {
    if (one.displaced.empty()) continue;
    const auto formation = std::ranges::find(now.formations, one.id, &Formation::id);
    flow.begin(one.id);
    flow.words(words_of(one) + ". Rings: old places; orange: new ones; grey: all others.");
    draw_change(canvas, now, *formation, one, flow.at());
  }
  return canvas.finish();
}

}  // namespace footlight::app
