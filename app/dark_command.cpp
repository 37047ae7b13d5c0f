// SPDX-License-Identifier: Apache-2.0
#include "app/dark_command.hpp"

#include <memory>

#include <CLI/CLI.hpp>

#include "app/dark_report.hpp"
#include "app/plan_step.hpp"

namespace footlight::app {
namespace {

int run(Session& session, const PlanChoice& choice) {
  auto planned = plan_for(session, choice, false);
  if (!planned) return session.fail(planned.error());
  if (const auto refused = refusal_of(planned->planned)) return session.fail(*refused);
  const auto units = controller::find_dark_units(planned->plan(), planned->loaded.rig, kDarkKept);
  const Show& show = planned->loaded.show;
  session.print(session.json ? dark_json(show, planned->plan(), units) : dark_text(show, planned->plan(), units));
  return 0;
}

}  // namespace

void add_dark_command(CLI::App& program, Session& session, Chosen& chosen) {
  CLI::App* command =
      program.add_subcommand("dark", "Tell whose cues become unsafe when a node or a power supply is dark");
  auto choice = std::make_shared<PlanChoice>();
  choice->add_options(*command);
  session.add_options(*command, true);
  command->footer(
      "Each node of the rig, and each supply that the rig names, is dark for the whole show, one at a time. Who is "
      "not\n"
      "shown a place stays until a place is shown again; the others walk as planned. A cue is unsafe when somebody "
      "then\n"
      "comes nearer than the clearance. The ten worst are listed.\n\n"
      "Examples:\n  footlight dark show.yaml\n  footlight dark show.yaml --json | jq '.units[0].worst'\n");
  command->callback([&session, &chosen, choice] { chosen = [&, choice] { return run(session, *choice); }; });
}

}  // namespace footlight::app
