// SPDX-License-Identifier: Apache-2.0
#include "app/dryrun_command.hpp"

#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "app/commission/wipe_record.hpp"
#include "app/dry_run.hpp"
#include "app/dry_run_report.hpp"
#include "app/growing_file.hpp"
#include "app/plan_step.hpp"
#include "app/state_folder.hpp"

namespace footlight::app {
namespace {

struct Options {
  PlanChoice choice;
  std::uint64_t seed = 1;
  std::string trace;
  std::string wire_log;
  std::string faults;
  bool realtime = false;
};

Result<DryRunReport> play(Session& session, const Options& options, const PlannedShow& planned,
                          const sim::Faults& faults, std::ostream* trace, std::ostream* wire_log) {
  DryRunOptions dry;
  dry.seed = options.seed;
  dry.faults = faults;
  dry.trace = trace;
  dry.wire_log = wire_log;
  dry.stop = session.stop();
  std::optional<SteadyClock> clock;
  if (options.realtime) {
    dry.pace = &clock.emplace();
    dry.moment = [&](const std::string& line) { session.print_now(line); };
  } else {
    dry.progress = [&](double share) { session.tell("dry run", share); };
  }
  auto report = dry_run(planned.loaded.show, planned.plan(), planned.loaded.rig, dry);
  session.clear_line();
  return report;
}

int run(Session& session, const Options& options) {
  sim::Faults faults;
  if (!options.faults.empty()) {
    auto parsed = sim::Faults::parse(options.faults);
    if (!parsed) return session.fail(parsed.error());
    faults = *parsed;
  }
  auto planned = plan_for(session, options.choice, false);
  if (!planned) return session.fail(planned.error());
  if (const auto refused = refusal_of(planned->planned)) return session.fail(*refused);
  std::optional<GrowingFile> trace;
  std::optional<GrowingFile> wire_log;
  const auto open = [&](std::optional<GrowingFile>& file, const char* what, const std::string& name) -> Status<> {
    if (name.empty()) return Done{};
    if (auto spared = spare_inputs(planned->loaded, name); !spared) return spared;
    return file.emplace(what, name).open();
  };
  if (auto opened = open(trace, "trace", options.trace); !opened) return session.fail(opened.error());
  if (auto opened = open(wire_log, "wire log", options.wire_log); !opened) return session.fail(opened.error());
  if (const auto changed = wipe_note(state_folder(""), options.choice.show, planned->loaded.rig)) {
    session.note(*changed);
  }
  const auto report = play(session, options, *planned, faults, trace ? &trace->stream() : nullptr,
                           wire_log ? &wire_log->stream() : nullptr);
  if (!report) return session.fail(report.error());
  for (std::optional<GrowingFile>* file : {&trace, &wire_log}) {
    if (!*file) continue;
    if (auto kept = (*file)->keep(); !kept) return session.fail(kept.error());
  }
  session.print(session.json ? dry_run_json(*report) : dry_run_text(*report));
  if (report->wrong_final > 0) return session.fail(device_error(dry_run_failure(*report)));
  return 0;
}

}  // namespace

void add_dryrun_command(CLI::App& program, Session& session, Chosen& chosen) {
  CLI::App* command = program.add_subcommand("dryrun", "Play the show on simulated buses, in virtual time");
  auto options = std::make_shared<Options>();
  options->choice.add_options(*command);
  command->add_option("--seed", options->seed, "what happens by chance depends on this number alone")
      ->check(CLI::Validator(
          [](const std::string& text) {
            return text.starts_with('-') ? std::string("a seed is a whole number from 0 on") : std::string();
          },
          "", "whole number"))
      ->capture_default_str();
  command->add_option("--faults", options->faults,
                      "what goes wrong, for example loss=5%,reboot=2 (also corrupt, duplicate, delay, dead)");
  command->add_option("--trace", options->trace, "write every frame on every bus to this file, one a line");
  command->add_option("--wire-log", options->wire_log,
                      "write what the drivers say and hear to this pcapng file, for Wireshark");
  command->add_flag("--realtime", options->realtime, "no faster than the music, with a line for each switch");
  session.add_options(*command, true);
  command->footer(
      "The drivers are those of the show; buses with a real URL are simulated as their kind. GO is pressed whenever "
      "the\n"
      "show waits. At the end of every cue all markers are compared with the schedule: exit status 4 when one is "
      "wrong,\n"
      "3 when the plan is refused or a bus cannot carry it in time.\n\n"
      "Examples:\n  footlight dryrun show.yaml\n  footlight dryrun show.yaml --faults loss=5%,reboot=2 --seed 7\n"
      "  footlight dryrun show.yaml --json --trace out/trace.txt\n");
  command->callback([&session, &chosen, options] { chosen = [&, options] { return run(session, *options); }; });
}

}  // namespace footlight::app
