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

int run(Session& session, const PlanChoice& choice) {
  auto planned = plan_for(session, choice, true);
  if (!planned) return session.fail(planned.error());
  FL_CHECK(planned->films.has_value());  // they were asked for
  const auto measures = planner::measure(planned->plan(), *planned->films, session.progress());
  session.clear_line();
  if (session.stopped()) return session.fail({ErrorKind::interrupted, "interrupted while measuring"});
  session.print(session.json ? measure_json(planned->plan(), measures) : measure_text(planned->plan(), measures));
  return 0;
}

}  // namespace

void add_measure_command(CLI::App& program, Session& session, Chosen& chosen) {
  CLI::App* command = program.add_subcommand("measure", "Measure how well and how calmly the show is drawn");
  auto choice = std::make_shared<PlanChoice>();
  choice->add_options(*command);
  session.add_options(*command, true);
  command->footer(
      "theta_dev   who is outside of the picture (share of the people, 0 is perfect)\n"
      "theta_miss  what of the picture nobody covers (share of its area)\n"
      "theta_iou   both at once: 1 - (covered and picture) / (covered or picture)\n"
      "A refused plan is measured, too, and marked as not valid.\n\n"
      "Examples:\n  footlight measure show.yaml\n  footlight measure show.yaml --json | jq .theta_dev\n");
  command->callback([&session, &chosen, choice] { chosen = [&, choice] { return run(session, *choice); }; });
}

}  // namespace footlight::app
