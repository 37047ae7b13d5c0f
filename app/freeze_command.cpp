// SPDX-License-Identifier: Apache-2.0
#include "app/freeze_command.hpp"

#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/freeze_report.hpp"
#include "app/plan_step.hpp"
#include "planner/freeze.hpp"

namespace footlight::app {
namespace {

struct Options {
  PlanChoice choice;
  double late_s = to_seconds(planner::kLatestStop);
  int tempo_percent = 100;
  std::optional<double> count;
  std::optional<double> time_s;
};

int run(Session& session, const Options& options) {
  auto planned = plan_for(session, options.choice, false);
  if (!planned) return session.fail(planned.error());
  if (const auto refused = refusal_of(planned->planned)) return session.fail(*refused);
  const Show& show = planned->loaded.show;
  const Plan& plan = planned->plan();
  const auto plays = controller::cue_plays(show, plan);
  const std::vector<Instant> waits = waits_of(plays);
  const Duration late = seconds(options.late_s * options.tempo_percent / 100);
  if (options.count || options.time_s) {
    const Instant freeze = options.count ? show.tempo.at(*options.count) : instant_at(*options.time_s);
    if (freeze < plays.front().from || freeze > plays.back().to) {
      return session.fail(input_error(fmt::format(
          "the show has counts {:g} to {:g}, {:.3f} to {:.3f} s", show.tempo.count_at(plays.front().from),
          show.tempo.count_at(plays.back().to), to_seconds(plays.front().from), to_seconds(plays.back().to))));
    }
    const planner::FreezeAt at = planner::judge_freeze_at(plan, waits, freeze, late);
    session.print(session.json ? freeze_at_json(show, plan, freeze, at) : freeze_at_text(show, plan, freeze, at));
    return 0;
  }
  const planner::FreezeJudgement judged = planner::judge_freezes(plan, waits, late, session.progress());
  session.clear_line();
  if (session.stopped()) return session.fail(Error{ErrorKind::interrupted, "interrupted while freezes were judged"});
  session.print(session.json ? freeze_json(show, plan, judged) : freeze_text(show, plan, judged));
  return 0;
}

}  // namespace

void add_freeze_command(CLI::App& program, Session& session, Chosen& chosen) {
  CLI::App* command =
      program.add_subcommand("freeze", "Tell at which counts the show may be stopped at once, and who is in danger");
  auto options = std::make_shared<Options>();
  options->choice.add_options(*command);
  CLI::Option* count = command->add_option("--count", options->count, "the pairs that may touch at this count")
                           ->check(CLI::Range(-1e9, 1e9));
  command->add_option("--time", options->time_s, "the same at this time, s")
      ->check(CLI::Range(-1e9, 1e9))
      ->excludes(count);
  command->add_option("--late", options->late_s, "how late anybody may stop, s")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  command->add_option("--tempo", options->tempo_percent, "at so many percent of the written tempo")
      ->check(CLI::Range(25, 200))
      ->capture_default_str();
  session.add_options(*command, true);
  command->footer(
      "Frozen in the middle of a walk, each goes on along her way for 0 to --late seconds and stops there. A freeze\n"
      "is safe when no two can come below their clearance by that; closed form, every pair, every instant. Going on,\n"
      "each is ahead of the show by as much, until the end of her straight stretch. HOLD at the end of the set is\n"
      "always safe: there everybody stands.\n\n"
      "Examples:\n  footlight freeze show.yaml\n  footlight freeze show.yaml --count 17\n"
      "  footlight freeze show.yaml --late 0.5 --json | jq '.cues[].freeze.safe_share'\n");
  command->callback([&session, &chosen, options] { chosen = [&, options] { return run(session, *options); }; });
}

}  // namespace footlight::app
