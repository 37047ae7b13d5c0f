// SPDX-License-Identifier: Apache-2.0
#include "app/why_report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/numbers.hpp"
#include "app/text_table.hpp"

namespace footlight::app {
namespace {

using Json = nlohmann::ordered_json;
using planner::Move;
using planner::MoveFigures;

double count_at(const Show& show, Instant instant) { return tidy_count(show.tempo.count_at(instant)); }
std::string count_text(const Show& show, Instant instant) {
  return fmt::format("{:g}", std::round(count_at(show, instant) * 100) / 100);
}
double counts_of(const Show& show, const Move& move) {
  return tidy_count(count_at(show, move.end) - count_at(show, move.start));
}
std::string counts_text(double counts) {
  return fmt::format("{:g} count{}", std::round(counts * 100) / 100, counts == 1 ? "" : "s");
}
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

const char* whose(Move::SpeedLimit limit) {
  switch (limit) {
    case Move::SpeedLimit::own:
      return "the performer's own";
    case Move::SpeedLimit::section:
      return "the section's";
    case Move::SpeedLimit::stage:
      break;
  }
  return "the stage's";
}

MoveLimit pace_limit(const Show& show, const Move& move) {
  return {"pace", move.fastest_mps / move.limit_mps,
          fmt::format("{:.1f} m in the {} that {}: {:.2f} m/s of {:g} m/s ({} limit)", move.walk_m,
                      counts_text(counts_of(show, move)),
                      move.film_sets_time ? "the film's pace leaves" : "lie between the two formations",
                      move.fastest_mps, move.limit_mps, whose(move.whose_limit))};
}

MoveLimit neighbour_limit(const Show& show, const Plan& plan, const Move::Neighbour& near) {
  const double used = near.distance_m > 0 ? near.least_m / near.distance_m : std::numeric_limits<double>::infinity();
  return {"neighbour", used,
          fmt::format("performer {} comes as near as {:.3f} m at count {} (at least {:g} m)",
                      plan.performers[near.who.at()], near.distance_m, count_text(show, near.at), near.least_m)};
}

MoveLimit lag_limit(const Plan& plan, const Move& move) {
  const double asked_s = to_seconds(plan.stage.lag);
  double used = asked_s > 0 ? std::numeric_limits<double>::infinity() : 0;
  if (move.tolerated_lag_s > 0) used = asked_s / move.tolerated_lag_s;
  if (!move.lag_limited_by) {
    return {"lag", used, fmt::format("nobody comes too close when people are up to 2 s late ({:g} s asked)", asked_s)};
  }
  return {"lag", used,
          fmt::format("performer {} comes too close when one of the two is more than {:.2f} s late ({:g} s asked)",
                      plan.performers[move.lag_limited_by->at()], move.tolerated_lag_s, asked_s)};
}

MoveLimit drawing_limit(const Show& show, const Plan& plan, const Move& move) {
  const double reach_m = move.limit_mps * move.time_s();
  const double needed_s = move.free_place->away_m / move.limit_mps;
  const double needed = count_at(show, move.start + seconds(needed_s)) - count_at(show, move.start);
  const std::string where = fmt::format("the nearest free place of the drawing, {}, is {:.1f} m away: {} at {:g} m/s",
                                        plan.stage.grid.name(move.free_place->cell), move.free_place->away_m,
                                        counts_text(std::ceil(needed * 10 - 1e-9) / 10), move.limit_mps);
  return {"drawing", reach_m > 0 ? move.free_place->away_m / reach_m : std::numeric_limits<double>::infinity(), where};
}

std::string place(const Plan& plan, CellIndex cell) { return plan.stage.grid.name(cell); }

std::string used_text(const std::optional<double>& used) {
  if (!used) return "-";
  return std::isfinite(*used) ? fmt::format("{:.0f} %", *used * 100) : "all";
}

std::vector<std::string> figures_row(const Plan& plan, const char* name, const MoveFigures& f, int places) {
  return {name,
          place(plan, f.to),
          fmt::format("{:.1f} m", f.walk_m),
          fmt::format("{:.2f} m/s", f.speed_mps),
          fmt::format("{:.0f} m", f.total_walk_m),
          fmt::format("{:.2f} m/s", f.fastest_mps),
          fmt::format("{}", f.too_fast),
          std::isfinite(f.clearance_m) ? fmt::format("{:.3f} m", f.clearance_m) : "-",
          fmt::format("{:.2f} s", f.tolerated_lag_s),
          fmt::format("{} of {}", f.places_reached, places)};
}

Json figures_json(const Plan& plan, const MoveFigures& f) {
  return {{"to", place(plan, f.to)},
          {"walk_m", f.walk_m},
          {"speed_m_s", f.speed_mps},
          {"total_walk_m", f.total_walk_m},
          {"fastest_m_s", f.fastest_mps},
          {"too_fast", f.too_fast},
          {"min_clearance_m", number(f.clearance_m)},
          {"tolerated_lag_s", f.tolerated_lag_s},
          {"places_reached", f.places_reached}};
}

Json move_json(const Show& show, const Plan& plan, const Move& move) {
  Json out{{"formation", plan.formations[move.into.at()].id},
           {"start_count", count_at(show, move.start)},
           {"end_count", count_at(show, move.end)},
           {"start_s", to_seconds(move.start)},
           {"end_s", to_seconds(move.end)},
           {"from", place(plan, move.from)},
           {"to", place(plan, move.to)},
           {"walk_m", move.walk_m},
           {"speed_m_s", move.fastest_mps},
           {"limit_m_s", move.limit_mps}};
  out["nearest"] = !move.nearest ? Json()
                                 : Json{{"performer", plan.performers[move.nearest->who.at()]},
                                        {"distance_m", move.nearest->distance_m},
                                        {"least_m", move.nearest->least_m},
                                        {"at_s", to_seconds(move.nearest->at)}};
  out["tolerated_lag_s"] = move.tolerated_lag_s;
  out["lag_limited_by"] = move.lag_limited_by ? Json(plan.performers[move.lag_limited_by->at()]) : Json();
  out["limits"] = Json::array();
  for (const MoveLimit& limit : limits_of(show, plan, move)) {
    out["limits"].push_back(
        {{"kind", limit.kind}, {"used", limit.used ? number(*limit.used) : Json()}, {"text", limit.text}});
  }
  return out;
}

std::string table_of_moves(const Show& show, const Plan& plan, const WhyAnswer& answer) {
  TextTable table({"formation", "counts", "from", "to", "walks", "speed", "tightest limit", "used"});
  for (const Move& move : answer.moves) {
    const auto limits = limits_of(show, plan, move);
    table.add({plan.formations[move.into.at()].id, count_text(show, move.start) + "-" + count_text(show, move.end),
               place(plan, move.from), place(plan, move.to), fmt::format("{:.1f} m", move.walk_m),
               fmt::format("{:.2f} m/s", move.fastest_mps), limits.front().kind, used_text(limits.front().used)});
  }
  return table.to_text();
}

/// What the show file asks for by name, by group or by hand: kind and sentence.
std::vector<std::pair<std::string, std::string>> given_by_the_show(const Show& show, const Plan& plan,
                                                                   const Move& move) {
  std::vector<std::pair<std::string, std::string>> out;
  const std::string to = place(plan, move.to);
  const std::string group =
      move.group ? "the group '" + show.groups[move.group->at()].name + "'" : "who is in no group";
  switch (move.bound) {
    case Move::Bound::nothing:
      break;
    case Move::Bound::list:
      out.emplace_back("pin", to + " is given by the show's list of cells: nobody else can take it");
      break;
    case Move::Bound::pin:
      out.emplace_back("pin", *move.pinned_to == move.to
                                  ? to + " is given to this performer by name: nobody else can take it"
                                  : place(plan, *move.pinned_to) + " is given to this performer by name, and is not " +
                                        "reached in time");
      break;
    case Move::Bound::group_in_list:
      out.emplace_back("group", to + " is a place of " + group + " in the show's list of cells");
      break;
    case Move::Bound::region:
      out.emplace_back("group", "places in its regions are kept for " + group + ", and its people for them");
      break;
    case Move::Bound::group:
      out.emplace_back("group", "nobody else takes a place of " + group + " (exchange: false)");
      break;
  }
  if (move.exact && move.bound != Move::Bound::list)
    out.emplace_back("key", "the formation is exact: nobody may be elsewhere, however far it is");
  if (move.moved > 0) {
    out.emplace_back("hand", fmt::format("{} {} placed by hand in this formation", move.moved,
                                         move.moved == 1 ? "person is" : "people are"));
  }
  return out;
}

}  // namespace

std::vector<MoveLimit> limits_of(const Show& show, const Plan& plan, const planner::Move& move) {
  std::vector<MoveLimit> limits{pace_limit(show, move), lag_limit(plan, move)};
  if (move.nearest) limits.push_back(neighbour_limit(show, plan, *move.nearest));
  if (move.blocked) {
    const Move::BlockedCell& cell = *move.blocked;
    limits.push_back({"blocked",
                      cell.distance_m > 0 ? cell.least_m / cell.distance_m : std::numeric_limits<double>::infinity(),
                      fmt::format("the blocked cell {} is {:.3f} m from the way (at least {:g} m)",
                                  place(plan, cell.cell), cell.distance_m, cell.least_m)});
  }
  if (move.free_place) limits.push_back(drawing_limit(show, plan, move));
  std::stable_sort(limits.begin(), limits.end(),
                   [](const MoveLimit& a, const MoveLimit& b) { return a.used.value_or(0) > b.used.value_or(0); });
  for (const auto& [kind, text] : given_by_the_show(show, plan, move)) limits.push_back({kind, std::nullopt, text});
  return limits;
}

std::size_t tightest(const Show& show, const Plan& plan, const std::vector<planner::Move>& moves) {
  std::size_t best = 0;
  double most = -1;
  for (std::size_t k = 0; k < moves.size(); ++k) {
    const double used = limits_of(show, plan, moves[k]).front().used.value_or(0);
    if (used > most) {
      most = used;
      best = k;
    }
  }
  return best;
}

std::string why_text(const Show& show, const Plan& plan, const WhyAnswer& answer) {
  const Move& move = answer.moves[answer.told];
  std::string out;
  if (answer.moves.size() > 1) out += table_of_moves(show, plan, answer) + "\n";
  out += fmt::format("performer {} into {}, count {} to {}: {}\n\n", plan.performers[answer.who.at()],
                     plan.formations[move.into.at()].id, count_text(show, move.start), count_text(show, move.end),
                     move.walk_m > 0 ? fmt::format("walks from {} to {}", place(plan, move.from), place(plan, move.to))
                                     : fmt::format("stays on {}", place(plan, move.from)));
  TextTable limits({"limit", "used"});
  for (const MoveLimit& limit : limits_of(show, plan, move)) limits.add({limit.kind, used_text(limit.used)});
  // The sentences stand behind the columns, since they are not aligned with each other.
  const std::string table = limits.to_text();
  std::size_t line = table.find('\n') + 1;
  out += table.substr(0, line);
  for (const MoveLimit& limit : limits_of(show, plan, move)) {
    const std::size_t end = table.find('\n', line);
    out += table.substr(line, end - line) + "  " + limit.text + "\n";
    line = end + 1;
  }
  out += fmt::format("\nthe walks of all {} performers into {}:\n", plan.performers.size(),
                     plan.formations[move.into.at()].id);
  TextTable more({"", "goes to", "walks", "speed", "all walk", "fastest", "too fast", "clearance", "lag", "places"});
  const auto& one = answer.one_more;
  more.add(figures_row(plan, "as planned", one.planned, one.places));
  more.add(figures_row(plan, "solved again", one.again, one.places));
  more.add(figures_row(plan, "one more count", one.one_more, one.places));
  return out + more.to_text() + (plan.valid ? "" : "The plan is not valid: it breaks its limits.\n");
}

std::string why_json(const Show& show, const Plan& plan, const WhyAnswer& answer) {
  Json out{{"performer", plan.performers[answer.who.at()]}, {"valid", plan.valid}};
  out.update(move_json(show, plan, answer.moves[answer.told]));
  const auto& one = answer.one_more;
  out["one_more_count"] = {{"places", one.places},
                           {"planned", figures_json(plan, one.planned)},
                           {"again", figures_json(plan, one.again)},
                           {"one_more", figures_json(plan, one.one_more)}};
  out["moves"] = Json::array();
  for (const Move& move : answer.moves) out["moves"].push_back(move_json(show, plan, move));
  return out.dump(1) + "\n";
}

}  // namespace footlight::app
