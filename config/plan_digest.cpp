// SPDX-License-Identifier: Apache-2.0
#include "config/plan_digest.hpp"

#include "core/sha256.hpp"

namespace footlight::config {
namespace {

// Each list goes in with its length first and each optional with whether it is there, so that the row of values can be
// read back in one way only.

template <class List, class One>
void add_list(Sha256& sum, const List& list, One one) {
  sum.integer(static_cast<std::int64_t>(list.size()));
  for (const auto& element : list) one(element);
}

void add(Sha256& sum, Instant instant) { sum.integer(instant.time_since_epoch().count()); }

void add(Sha256& sum, const std::vector<CellIndex>& cells) {
  add_list(sum, cells, [&](CellIndex cell) { sum.integer(cell.value()); });
}

void add(Sha256& sum, const Stage& stage) {
  sum.integer(static_cast<int>(stage.grid.kind())).integer(stage.grid.columns()).integer(stage.grid.rows());
  sum.real(stage.grid.pitch_m());
  add(sum, stage.blocked);
  add(sum, stage.reserve);
  sum.real(stage.clearance_m)
      .real(stage.max_speed_mps)
      .integer(stage.lag.count())
      .integer(static_cast<int>(stage.walk));
}

void add(Sha256& sum, const FilmPlacement& film) {
  sum.text(film.path).integer(film.first_frame).integer(film.last_frame).real(film.show_fps);
  sum.integer(film.width).integer(film.height).integer(film.threshold).integer(film.inverted ? 1 : 0);
  for (const double number : film.stage_to_frame) sum.real(number);
}

void add(Sha256& sum, const PlanSection& section) {
  sum.text(section.name);
  add(sum, section.start);
  add(sum, section.end);
  sum.real(section.max_speed_mps).integer(section.film ? 1 : 0);
  if (section.film) add(sum, *section.film);
  add(sum, section.reserve);
  add_list(sum, section.notes, [&](const std::string& note) { sum.text(note); });
  add_list(sum, section.obstacles, [&](const PlanObstacle& obstacle) {
    sum.real(obstacle.radius_m);
    add_list(sum, obstacle.at, [&](const PlanObstacle::At& at) {
      add(sum, at.time);
      sum.real(at.centre.x).real(at.centre.y);
    });
  });
}

void add(Sha256& sum, const Formation& formation) {
  sum.text(formation.id).integer(formation.section.value()).real(formation.count);
  add(sum, formation.time);
  sum.integer(formation.frame ? 1 : 0).integer(formation.frame.value_or(0));
  add(sum, formation.cells);
  sum.integer(formation.in_picture).integer(formation.key ? 1 : 0);
  sum.integer(formation.moved).integer(formation.pinned);
}

void add(Sha256& sum, const TransitionFacts& facts) {
  add(sum, facts.start);
  add(sum, facts.end);
  sum.real(facts.clearance_m).integer(facts.closest_a.value()).integer(facts.closest_b.value());
  add(sum, facts.closest_at);
  sum.real(facts.longest_walk_m).integer(facts.longest_walker.value()).real(facts.tolerated_lag_s);
}

}  // namespace

std::string digest_of(const Plan& plan) {
  Sha256 sum;
  sum.text("footlight plan 3").text(plan.title).text(plan.show_hash);
  // Plans from before there were versions keep their digest.
  if (!plan.version.empty()) sum.text("version").text(plan.version);
  add(sum, plan.stage);
  add_list(sum, plan.performers, [&](const std::string& id) { sum.text(id); });
  add_list(sum, plan.radius_m, [&](double value) { sum.real(value); });
  add_list(sum, plan.max_speed_mps, [&](double value) { sum.real(value); });
  add_list(sum, plan.sections, [&](const PlanSection& section) { add(sum, section); });
  add_list(sum, plan.formations, [&](const Formation& formation) { add(sum, formation); });
  add_list(sum, plan.tracks, [&](const std::vector<Mark>& track) {
    add_list(sum, track, [&](const Mark& mark) {
      add(sum, mark.time);
      sum.integer(mark.cell.value());
    });
  });
  add_list(sum, plan.transitions, [&](const TransitionFacts& facts) { add(sum, facts); });
  sum.integer(plan.valid ? 1 : 0);
  return sum.hex();
}

}  // namespace footlight::config
