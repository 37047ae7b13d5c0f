// SPDX-License-Identifier: Apache-2.0
#include "app/dryrun_command.hpp"

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <system_error>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include "app/dry_run.hpp"
#include "app/dry_run_report.hpp"
#include "app/plan_step.hpp"

namespace footlight::app {
namespace {

struct Options {
  PlanChoice choice;
  std::uint64_t seed = 1;
  std::string trace;
  std::string faults;
  bool realtime = false;
};

/// A trace may have gigabytes: it is written as it comes, to a temporary name beside the file, and takes the file's
/// name when it is whole.
class TraceFile {
 public:
  explicit TraceFile(std::string file)
      : file_(std::move(file)), temporary_(fmt::format("{}.{}.part", file_, getpid())) {}
  ~TraceFile() {
    if (stream_.is_open()) stream_.close();
    std::error_code ignored;
    if (!kept_) std::filesystem::remove(temporary_, ignored);
  }
  TraceFile(const TraceFile&) = delete;
  TraceFile& operator=(const TraceFile&) = delete;

  Status<> open() {
    stream_.open(temporary_, std::ios::binary | std::ios::trunc);
    if (!stream_) return failure();
    return Done{};
  }
  std::ostream& stream() { return stream_; }
  Status<> keep() {
    stream_.close();
    if (!stream_ || std::rename(temporary_.c_str(), file_.c_str()) != 0) return failure();
    kept_ = true;
    return Done{};
  }

 private:
  [[nodiscard]] Error failure() const {
    return input_error(fmt::format("cannot write the trace '{}': {}", file_, std::generic_category().message(errno)));
  }

  std::string file_;
  std::string temporary_;
  std::ofstream stream_;
  bool kept_ = false;
};

Result<DryRunReport> play(Session& session, const Options& options, const PlannedShow& planned,
                          const sim::Faults& faults, TraceFile* trace) {
  DryRunOptions dry;
  dry.seed = options.seed;
  dry.faults = faults;
  dry.trace = trace != nullptr ? &trace->stream() : nullptr;
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
  std::optional<TraceFile> trace;
  if (!options.trace.empty()) {
    if (auto spared = spare_inputs(planned->loaded, options.trace); !spared) return session.fail(spared.error());
    trace.emplace(options.trace);
    if (auto opened = trace->open(); !opened) return session.fail(opened.error());
  }
  const auto report = play(session, options, *planned, faults, trace ? &*trace : nullptr);
  if (!report) return session.fail(report.error());
  if (trace) {
    if (auto kept = trace->keep(); !kept) return session.fail(kept.error());
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
