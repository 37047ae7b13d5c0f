// SPDX-License-Identifier: Apache-2.0
#include "app/measure_command.hpp"

#include <memory>

#include <CLI/CLI.hpp>

#include "app/measure_report.hpp"
#include "app/plan_step.hpp"
#include "core/check.hpp"
#include "planner/measure.hpp"

namespace footlight::app {
namespace {

SectionBests bests_of(const Plan& plan, const Films& films) {
  SectionBests bests(films.size());
  for (std::size_t i = 0; i < films.size(); ++i) {
    if (films[i]) bests[i] = planner::best_of_frames(plan, SectionIndex::of(i), *films[i]);
  }
  return bests;
}

int run(Session& session, const PlanChoice& choice, bool best) {
  auto planned = plan_for(session, choice, true);
  if (!planned) return session.fail(planned.error());
  FL_CHECK(planned->films.has_value());  // they were asked for
  const auto measures = planner::measure(planned->plan(), *planned->films, session.progress());
  session.clear_line();
  if (session.stopped()) return session.fail({ErrorKind::interrupted, "interrupted while measuring"});
  const SectionBests bests = best ? bests_of(planned->plan(), *planned->films) : SectionBests();
  session.print(session.json ? measure_json(planned->plan(), measures, bests)
                             : measure_text(planned->plan(), measures, bests));
  return 0;
}

}  // namespace

void add_measure_command(CLI::App& program, Session& session, Chosen& chosen) {
  CLI::App* command = program.add_subcommand("measure", "Measure how well and how calmly the show is drawn");
  auto choice = std::make_shared<PlanChoice>();
  choice->add_options(*command);
  auto best = std::make_shared<bool>(false);
  command->add_flag("--best", *best, "Also the best formation of each single frame, if nobody had to walk");
  session.add_options(*command, true);
  command->footer(
      "theta_dev   who is outside of the picture (share of the people, 0 is perfect)\n"
      "theta_miss  what of the picture nobody covers (share of its area)\n"
      "theta_iou   both at once: 1 - (covered and picture) / (covered or picture)\n"
      "A refused plan is measured, too, and marked as not valid.\n\n"
      "Examples:\n  footlight measure show.yaml\n  footlight measure show.yaml --json | jq .theta_dev\n");
  command->callback(
      [&session, &chosen, choice, best] { chosen = [&, choice, best] { return run(session, *choice, *best); }; });
}

}  // namespace footlight::app
