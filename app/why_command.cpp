// SPDX-License-Identifier: Apache-2.0
#include "app/why_command.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/find_in_show.hpp"
#include "app/plan_step.hpp"
#include "app/why_report.hpp"
#include "config/nearest.hpp"
#include "core/check.hpp"

namespace footlight::app {
namespace {

struct Options {
  PlanChoice choice;
  std::string performer;
  std::string cue;
  std::string formation;
  std::optional<double> count;
  std::optional<double> time_s;
};

/// Formations [first, last] of one section.
using Asked = std::pair<FormationIndex, FormationIndex>;

Error opening_form(const std::string& what) {
  return input_error(what + " is the opening form: nobody walks into it (ask for a later one)");
}

Result<Asked> move_into(const Plan& plan, const std::string& word) {
  const auto found = find_formation(plan, word);
  if (!found) return found.error();
  if (*found == FormationIndex(0)) return opening_form(fmt::format("formation {}", config::in_quotes(word)));
  return Asked{*found, *found};
}

Result<Asked> find_cue(const Show& show, const Plan& plan, const std::string& word) {
  const auto number = CueNumber::parse(word);
  std::vector<std::string> known;
  for (const Cue& cue : show.cues) {
    known.push_back(cue.number.to_text());
    if (!number || cue.number != *number) continue;
    std::optional<Asked> asked;
    for (std::size_t k = 0; k < plan.formations.size(); ++k) {
      if (plan.formations[k].section != cue.section || k == 0) continue;
      if (!asked) asked = Asked{FormationIndex::of(k), {}};
      asked->second = FormationIndex::of(k);
    }
    if (!asked) return opening_form("cue " + cue.number.to_text());
    return *asked;
  }
  return input_error(
      fmt::format("there is no cue {} ({})", config::in_quotes(word), config::suggestion(word, known, "cues")));
}

/// The move that goes on at an instant, or the next one.
Result<Asked> find_instant(const Show& show, const Plan& plan, Instant instant) {
  for (std::size_t k = 1; k < plan.formations.size(); ++k) {
    if (plan.formations[k].time >= instant) return Asked{FormationIndex::of(k), FormationIndex::of(k)};
  }
  const Formation& last = plan.formations.back();
  return input_error(fmt::format("nobody walks after count {:g}, at {:.3f} s ({} is the last formation)",
                                 show.tempo.count_at(last.time), to_seconds(last.time), last.id));
}

Result<Asked> find_moves(const Show& show, const Plan& plan, const Options& options) {
  const int ways = (options.cue.empty() ? 0 : 1) + (options.formation.empty() ? 0 : 1) + (options.count ? 1 : 0) +
                   (options.time_s ? 1 : 0);
  if (ways != 1) return input_error("say which move: one of CUE, --formation, --count and --time");
  if (!options.cue.empty()) return find_cue(show, plan, options.cue);
  if (!options.formation.empty()) return move_into(plan, options.formation);
  return find_instant(show, plan, options.count ? show.tempo.at(*options.count) : instant_at(*options.time_s));
}

int run(Session& session, const Options& options) {
  auto planned = plan_for(session, options.choice, true);
  if (!planned) return session.fail(planned.error());
  const Show& show = planned->loaded.show;
  const Plan& plan = planned->plan();
  const auto who = find_performer(show, options.performer);
  if (!who) return session.fail(who.error());
  const auto asked = find_moves(show, plan, options);
  if (!asked) return session.fail(asked.error());
  FL_CHECK(planned->films.has_value());  // they were asked for
  const auto& film = planned->films->at(plan.formations[asked->first.at()].section.at());
  WhyAnswer answer;
  answer.who = *who;
  answer.moves = planner::explain_moves(show, plan, film, *who, asked->first, asked->second);
  answer.told = tightest(show, plan, answer.moves);
  auto one_more = planner::one_more_count(show, plan, film, *who, answer.moves[answer.told].into, session.progress());
  session.clear_line();
  if (!one_more) return session.fail(one_more.error());
  answer.one_more = *one_more;
  session.print(session.json ? why_json(show, plan, answer) : why_text(show, plan, answer));
  return 0;
}

}  // namespace

void add_why_command(CLI::App& program, Session& session, Chosen& chosen) {
  CLI::App* command = program.add_subcommand("why", "Explain what limits somebody's move, and what a count more gives");
  auto options = std::make_shared<Options>();
  options->choice.add_options(*command);
  command->add_option("PERFORMER", options->performer, "id or name")->required();
  command->add_option("CUE", options->cue, "the cue whose moves are asked about; the tightest one is told in full");
  command->add_option("--formation", options->formation, "the move into this formation, as growth/12");
  command->add_option("--count", options->count, "the move at this count")->check(CLI::Range(-1e9, 1e9));
  command->add_option("--time", options->time_s, "the move at this time, s")->check(CLI::Range(-1e9, 1e9));
  session.add_options(*command, true);
  command->footer(
      "pace       the walk and the time there is for it, against the speed limit\n"
      "neighbour  who comes nearest, and when\n"
      "lag        how late people may be before somebody comes too close\n"
      "blocked    the blocked cell nearest to the way\n"
      "drawing    a free place of the drawing that is too far away\n"
      "pin        the place is given by the show\n"
      "Then the walks of everybody into that formation are solved again, as they are and with one more count.\n\n"
      "Examples:\n  footlight why show.yaml 7 2\n  footlight why show.yaml \"Ana Ruiz\" --formation growth/12\n"
      "  footlight why show.yaml 7 --count 25 --json | jq .limits\n");
  command->callback([&session, &chosen, options] { chosen = [&, options] { return run(session, *options); }; });
}

}  // namespace footlight::app
