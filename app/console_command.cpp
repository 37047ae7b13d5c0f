// SPDX-License-Identifier: Apache-2.0
#include "app/console_command.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>

#include "app/console/console_options.hpp"
#include "app/plan_step.hpp"
#include "app/simulated_buses.hpp"
#include "app/state_folder.hpp"
#include "app/surfaces/run_desk.hpp"
#include "core/clock.hpp"

namespace footlight::app {
namespace {

constexpr Duration kLook = milliseconds(100);

struct Options {
  PlanChoice choice;
  ConsoleOptions console;
  std::string state;
};

/// The show as it stands before the first GO, and stays.
DeskView standing(const Plan& plan, const controller::CueSchedule& schedule) {
  DeskView view;
  view.schedule = &schedule;
  view.show.standby = 0;
  for (const auto& track : plan.tracks) view.show.position = std::min(view.show.position, track.front().time);
  return view;
}

/// Until the user stops it, or the console cannot be opened.
Status<> serve(Session& session, const Options& options, const PlannedShow& planned,
               const controller::CueSchedule& schedule) {
  const Show& show = planned.loaded.show;
  RunDesk desk(show, planned.plan());
  auto console =
      options.console.open(session, state_folder(options.state), show, planned.plan(), planned.loaded.rig, desk, false);
  if (!console) return std::move(console).error();
  session.print_now((*console)->address());
  const SteadyClock clock;
  DeskView view = standing(planned.plan(), schedule);
  while (!session.stopped()) {
    view.show.at = clock.now();
    (void)desk.look(view);
    desk.wait(kLook);
  }
  return Done{};
}

int run(Session& session, const Options& options) {
  auto planned = plan_for(session, options.choice, false);
  if (!planned) return session.fail(planned.error());
  if (const auto refused = refusal_of(planned->planned)) return session.fail(*refused);
  Status<> served = Done{};
  const auto built = with_schedule(
      planned->loaded.show, planned->plan(), planned->loaded.rig,
      [&](const SimulatedSchedule& wires) { served = serve(session, options, *planned, wires.schedule); });
  if (!built) return session.fail(built.error());
  return served ? 0 : session.fail(served.error());
}

}  // namespace

void add_console_command(CLI::App& program, Session& session, Chosen& chosen) {
  CLI::App* command = program.add_subcommand("console", "Look at a plan in the console, without any bus");
  auto options = std::make_shared<Options>();
  options->choice.add_options(*command);
  options->console.place = "0";
  options->console.most = Role::view;
  options->console.add_options(*command);
  command->add_option("--state", options->state, "folder for the token and the log of who has looked")
      ->default_str("~/.local/state/footlight");
  session.add_options(*command, false);
  command->footer(
      "Serves the page of `footlight run --console` to look at: who stands where at any time, and what every marker\n"
      "would show. Nobody can give an order. Prints the page's address on stdout; SIGINT ends it.\n\n"
      "Example:\n  footlight console show.yaml\n");
  command->callback([&session, &chosen, options] { chosen = [&, options] { return run(session, *options); }; });
}

}  // namespace footlight::app
