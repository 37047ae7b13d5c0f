// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <cstdio>
#include <exception>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/bundle_command.hpp"
#include "app/cast_command.hpp"
#include "app/check_command.hpp"
#include "app/command.hpp"
#include "app/commission_command.hpp"
#include "app/console_command.hpp"
#include "app/dark_command.hpp"
#include "app/devices_command.hpp"
#include "app/diff_command.hpp"
#include "app/dryrun_command.hpp"
#include "app/export_command.hpp"
#include "app/freeze_command.hpp"
#include "app/import_command.hpp"
#include "app/journal_command.hpp"
#include "app/measure_command.hpp"
#include "app/new_command.hpp"
#include "app/painting_command.hpp"
#include "app/plan_command.hpp"
#include "app/preview_command.hpp"
#include "app/report_command.hpp"
#include "app/run_command.hpp"
#include "app/session.hpp"
#include "app/sheets_command.hpp"
#include "app/sim_command.hpp"
#include "app/why_command.hpp"
#include "config/nearest.hpp"

namespace footlight::app {
namespace {

constexpr AddCommand kCommands[] = {
    add_new_command,     add_check_command,    add_plan_command,       add_measure_command, add_why_command,
    add_export_command,  add_sheets_command,   add_preview_command,    add_report_command,  add_diff_command,
    add_dryrun_command,  add_dark_command,     add_devices_command,    add_sim_command,     add_run_command,
    add_bundle_command,  add_import_command,   add_commission_command, add_journal_command, add_freeze_command,
    add_console_command, add_painting_command, add_cast_command,
};

constexpr const char* kFooter =
    "Exit status: 0 ok, 1 internal error, 2 wrong input, 3 plan refused, 4 device, 130 interrupted.\n\n"
    "Start here:\n  footlight new my-show\n  footlight plan my-show/show.yaml --pictures out\n"
    "  footlight COMMAND --help";

/// Results that did not reach their reader are no success.
int finish(int status, Session& session) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return status;
  return session.fail(
      input_error(std::string("cannot write the result to stdout: ") + std::generic_category().message(errno)));
}

Error unknown_command(const CLI::App& program, const std::string& word) {
  std::vector<std::string> known;
  for (const CLI::App* command : program.get_subcommands(nullptr)) known.push_back(command->get_name());
  return input_error("there is no command " + config::in_quotes(word) + " (" +
                     config::suggestion(word, known, "commands") + ")");
}

int run(int argc, char** argv) {
  Session session(stop_on_signals());
  Chosen chosen;
  CLI::App program("Footlight: plans, proves and lights where everybody stands and walks.", "footlight");
  program.set_version_flag("--version", "footlight " FOOTLIGHT_VERSION);
  program.require_subcommand(1);
  program.get_formatter()->column_width(34);
  program.footer(kFooter);
  for (const AddCommand add : kCommands) add(program, session, chosen);
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& asked) {  // --help, --version
    return finish(program.exit(asked), session);
  } catch (const CLI::ParseError& error) {
    if (program.get_subcommands().empty() && !program.remaining().empty()) {
      return session.fail(unknown_command(program, program.remaining().front()));
    }
    return session.fail(input_error(std::string(error.what()) + " (footlight --help tells what there is)"));
  }
  return finish(chosen(), session);
}

}  // namespace
}  // namespace footlight::app

int main(int argc, char** argv) {
  try {
    return footlight::app::run(argc, argv);
  } catch (const std::exception& error) {
    (void)std::fprintf(stderr, "error: internal: %s (please report this)\n", error.what());
    return 1;
  }
}
