// SPDX-License-Identifier: Apache-2.0
#include "app/export_command.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/export_files.hpp"
#include "app/plan_step.hpp"
#include "config/output_file.hpp"

namespace footlight::app {
namespace {

struct Options {
  PlanChoice choice;
  std::string csv;
  bool unchecked = false;
};

int run(Session& session, const Options& options) {
  auto planned = plan_for(session, options.choice, false);
  if (!planned) return session.fail(planned.error());
  const auto refused = refusal_of(planned->planned);
  if (refused && !options.unchecked) return session.fail(*refused);
  std::error_code error;
  std::filesystem::create_directories(options.csv, error);
  if (error)
    return session.fail(input_error(fmt::format("cannot make the folder '{}': {}", options.csv, error.message())));
  const Plan& plan = planned->plan();
  const Show& show = planned->loaded.show;
  // All texts are made before the first is written; stage.json, which says whether the plan is valid, comes last.
  const std::pair<const char*, std::string> files[] = {{"marks.csv", marks_csv(plan, show)},
                                                       {"formations.csv", formations_csv(plan)},
                                                       {"stage.json", stage_json(plan, show)}};
  for (const auto& [name, content] : files) {
    const std::string file = (std::filesystem::path(options.csv) / name).string();
    if (auto spared = spare_inputs(planned->loaded, file); !spared) return session.fail(spared.error());
  }
  for (const auto& [name, content] : files) {
    if (session.stopped()) return session.fail({ErrorKind::interrupted, "interrupted while exporting"});
    auto done = config::write_file(std::filesystem::path(options.csv) / name, content);
    if (!done) return session.fail(done.error());
  }
  for (const auto& [name, content] : files) session.print((std::filesystem::path(options.csv) / name).string());
  if (refused) session.note("the plan is refused; stage.json says \"valid\": false");
  return 0;
}

}  // namespace

void add_export_command(CLI::App& program, Session& session, Chosen& chosen) {
  CLI::App* command = program.add_subcommand("export", "Write everybody's marks for other programs");
  auto options = std::make_shared<Options>();
  options->choice.add_options(*command);
  command->add_option("--csv", options->csv, "the folder for marks.csv, stage.json and formations.csv")->required();
  command->add_flag("--unchecked", options->unchecked, "export a refused plan, too, marked as not valid");
  session.add_options(*command, false);
  command->footer(
      "Examples:\n  footlight export show.yaml --csv out/csv\n"
      "  footlight export show.yaml --plan monday.plan --csv out/monday\n");
  command->callback([&session, &chosen, options] { chosen = [&, options] { return run(session, *options); }; });
}

}  // namespace footlight::app
