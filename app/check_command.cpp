// SPDX-License-Identifier: Apache-2.0
#include "app/check_command.hpp"

#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/load.hpp"
#include "app/plan_step.hpp"
#include "app/plan_summary.hpp"
#include "app/readiness/readiness.hpp"
#include "app/simulated_buses.hpp"
#include "app/supply_figures.hpp"
#include "app/wire_check.hpp"

namespace footlight::app {
namespace {

struct Options {
  PlanChoice choice;
  bool no_media = false;
  bool devices = false;
};

std::string counts_of(const Show& show) {
  return fmt::format("{} performers, {} sections, {} cues", show.performers.size(), show.sections.size(),
                     show.cues.size());
}

int check_files(Session& session, const std::string& file) {
  auto loaded = read_show(session, file);
  if (!loaded) return session.fail(loaded.error());
  if (session.json) {
    session.print(nlohmann::ordered_json{{"ok", true}}.dump());
  } else {
    session.print(fmt::format("{}: no errors ({}); films were not looked at", file, counts_of(loaded->show)));
  }
  return 0;
}

int run(Session& session, const Options& options) {
  if (options.no_media) return check_files(session, options.choice.show);
  auto planned = plan_anew(session, options.choice);
  if (!planned) return session.fail(planned.error());
  const Show& show = planned->loaded.show;
  auto refused = refusal_of(planned->planned);
  std::vector<SupplyFigures> supplies;
  if (!refused) {
    auto lit = check_delivery(show, planned->plan(), planned->loaded.rig);
    if (lit) {
      supplies = std::move(lit).value();
    } else {
      refused = std::move(lit).error();
    }
  }
  if (session.json) {
    auto result = nlohmann::ordered_json::parse(plan_json(show, planned->planned));
    result["ok"] = !refused;
    if (!supplies.empty()) result["supplies"] = supplies_json(supplies);
    session.print(result.dump(1));
  } else {
    session.print(shortest_text(show, planned->planned) + supplies_text(supplies));
  }
  if (refused) return session.fail(*refused);
  if (const std::string unfenced = unfenced_text(planned->loaded.rig.buses); !unfenced.empty()) session.note(unfenced);
  if (options.devices) {
    if (auto wires = check_wires(session, planned->loaded.rig.buses); !wires) return session.fail(wires.error());
  }
  if (!session.json) session.print(fmt::format("{}: no errors ({})", options.choice.show, counts_of(show)));
  return 0;
}

}  // namespace

void add_check_command(CLI::App& program, Session& session, Chosen& chosen) {
  CLI::App* command = program.add_subcommand("check", "Report everything that is wrong with a show");
  auto options = std::make_shared<Options>();
  command->add_option("SHOW", options->choice.show, "the show file (YAML)")->required();
  command->add_flag("--no-media", options->no_media, "read the files only: decode no film, plan nothing");
  command->add_flag("--devices", options->devices,
                    "also look whether this machine has the real buses set up as the rig says (CAN)");
  command->add_option("--threads", options->choice.threads, "plan with so many threads")->check(CLI::Range(1, 1024));
  session.add_options(*command, true);
  command->footer(
      "Errors of all files are reported in one run, as file:line:column: error: key: what (what would be right).\n"
      "Then the show is planned, to say how short each section could be at its speed limit, and what limits it, and\n"
      "its lamps are set, to say whether every bus carries them in time, and every power supply at all.\n\n"
      "Exit status: 0 nothing wrong, 2 errors in the files, 3 the show cannot be walked or lit as it is, 4 (--devices) "
      "a\n"
      "bus of this machine is not there, down, or at another bit rate.\n\n"
      "Examples:\n  footlight check shows/vine/show.yaml\n  footlight check --no-media show.yaml   # while typing\n");
  command->callback([&session, &chosen, options] { chosen = [&, options] { return run(session, *options); }; });
}

}  // namespace footlight::app
