// SPDX-License-Identifier: Apache-2.0
#include "app/diff_command.hpp"

#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/output_place.hpp"
#include "app/plan_diff.hpp"
#include "app/plan_step.hpp"
#include "config/output_file.hpp"

namespace footlight::app {
namespace {

struct Options {
  std::string before;
  std::string now;
  std::string output;
};

int run(Session& session, const Options& options) {
  if (!options.output.empty()) {
    if (!options.output.ends_with(".pdf")) {
      return session.fail(
          input_error(fmt::format("'{}': changes are drawn into a file that ends with .pdf", options.output)));
    }
    if (auto free = can_write(options.output); !free) return session.fail(free.error());
  }
  const auto before = plan_alone(options.before);
  if (!before) return session.fail(before.error());
  const auto now = plan_alone(options.now);
  if (!now) return session.fail(now.error());
  const PlanDiff diff = diff_of(*before, *now);
  if (!options.output.empty()) {
    if (auto done = config::write_file(options.output, diff_pdf(*before, *now, diff)); !done) {
      return session.fail(done.error());
    }
  }
  session.print(session.json ? diff_json(diff) : diff_text(diff));
  return 0;
}

}  // namespace

void add_diff_command(CLI::App& program, Session& session, Chosen& chosen) {
  CLI::App* command = program.add_subcommand("diff", "Tell and draw what has changed between two plans");
  auto options = std::make_shared<Options>();
  command->add_option("OLD", options->before, "a plan file")->required();
  command->add_option("NEW", options->now, "a later plan file")->required();
  command->add_option("-o,--output", options->output, "draw the changed formations, too: FILE.pdf");
  session.add_options(*command, true);
  command->footer(
      "Examples:\n  footlight diff monday.plan show.plan\n  footlight diff monday.plan show.plan -o changes.pdf\n"
      "  footlight diff monday.plan show.plan --json | jq .changed\n");
  command->callback([&session, &chosen, options] { chosen = [&, options] { return run(session, *options); }; });
}

}  // namespace footlight::app
