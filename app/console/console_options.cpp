// SPDX-License-Identifier: Apache-2.0
#include "app/console/console_options.hpp"

#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace footlight::app {

void ConsoleOptions::add_options(CLI::App& command) {
  auto* console =
      command.add_option("--console", place,
                         "serve the console, a page for browsers, at this port of this machine alone, or at "
                         "ADDRESS:PORT, for whoever has the token (0: any free port)");
  command
      .add_option("--console-host", hosts,
                  "a name by which browsers reach the console besides, as they write it: desk.example:8440")
      ->needs(console);
}

Result<std::unique_ptr<Console>> ConsoleOptions::open(Session& session, const std::filesystem::path& folder,
                                                      const Show& show, const Plan& plan, const Rig& rig, RunDesk& desk,
                                                      bool leads) const {
  if (place.empty()) return std::unique_ptr<Console>();
  auto where = Console::place_from(place);
  if (!where) return std::move(where).error();
  where->hosts = hosts;
  where->most = most;
  auto console = Console::open(*where, folder, show, plan, rig, desk, leads);
  if (!console) return console;
  desk.add(**console);
  session.note("console: " + (*console)->address());
  if ((*console)->needs_token()) {
    session.note(
        fmt::format("console: browsers are asked for the token in {}; there is no TLS: the network can read "
                    "what is said",
                    (folder / "console.token").string()));
  }
  return console;
}

}  // namespace footlight::app
