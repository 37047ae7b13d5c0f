// SPDX-License-Identifier: Apache-2.0
#include "app/new_command.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "config/output_file.hpp"
#include "config/starter_show.hpp"

namespace footlight::app {
namespace {

int run(Session& session, const std::string& folder, std::string title) {
  if (folder.empty()) return session.fail(input_error("the new show's folder needs a name (footlight new my-show)"));
  const std::filesystem::path place(folder);
  std::error_code error;
  if (std::filesystem::exists(place, error)) {
    return session.fail(input_error(fmt::format("'{}' is there already (a new show wants a new folder)", folder)));
  }
  if (title.empty()) title = std::filesystem::absolute(place).filename().string();
  if (!std::filesystem::create_directories(place, error)) {
    return session.fail(input_error(fmt::format("cannot make the folder '{}': {}", folder, error.message())));
  }
  for (const auto& [name, content] : config::starter_show(title)) {
    const std::filesystem::path file = place / name;
    std::filesystem::create_directories(file.parent_path(), error);
    if (auto done = config::write_file(file, content); !done) return session.fail(done.error());
  }
  const std::string show = (place / "show.yaml").string();
  session.print(
      fmt::format("{0}\n\nnext:\n  footlight check {0}\n  footlight plan {0}\n  footlight dryrun {0}\n", show));
  return 0;
}

}  // namespace

void add_new_command(CLI::App& program, Session& session, Chosen& chosen) {
  CLI::App* command = program.add_subcommand("new", "Write a commented starter show into a new folder");
  auto folder = std::make_shared<std::string>();
  auto title = std::make_shared<std::string>();
  command->add_option("FOLDER", *folder, "the folder to make")->required();
  command->add_option("--title", *title, "title of the show (default: the folder's name)");
  session.add_options(*command, false);
  command->footer("Examples:\n  footlight new my-show\n  footlight new shows/spring --title 'Spring concert'\n");
  command->callback(
      [&session, &chosen, folder, title] { chosen = [&, folder, title] { return run(session, *folder, *title); }; });
}

}  // namespace footlight::app
