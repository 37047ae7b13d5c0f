// SPDX-License-Identifier: Apache-2.0
#include "app/journal_command.hpp"

#include <chrono>
#include <cstdint>
#include <ctime>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/journal/journal_file.hpp"
#include "app/state_folder.hpp"

namespace footlight::app {
namespace {

using Json = nlohmann::ordered_json;

struct Options {
  std::string file;
  std::int64_t run = 0;
  bool runs = false;
};

/// "2026-11-23 19:30:05.250", of the machine's time zone.
std::string wall_text(Duration since_1970) {
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(since_1970);
  const auto seconds = static_cast<std::time_t>(whole.count());
  std::tm parts{};
  (void)::localtime_r(&seconds, &parts);
  return fmt::format("{:04}-{:02}-{:02} {:02}:{:02}:{:02}.{:03}", parts.tm_year + 1900, parts.tm_mon + 1, parts.tm_mday,
                     parts.tm_hour, parts.tm_min, parts.tm_sec, (since_1970 - whole) / milliseconds(1));
}

std::string run_text(const JournalRun& run) {
  return fmt::format(
      "run {}  {}  {}  plan {}  {}\n", run.id, wall_text(run.began), run.show, run.plan.substr(0, 12),
      run.ended ? fmt::format("{} at {}", run.how, wall_text(*run.ended)) : "not ended: it runs or died");
}

/// What somebody typed cannot steer a terminal.
std::string on_one_line(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) {
      out += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    } else {
      out += c;
    }
  }
  return out;
}

std::string entry_text(const JournalEntry& entry) {
  std::string text = entry.text;
  if (entry.kind == "answer") {
    text = fmt::format("{}, by {}{}: {}", entry.order, entry.who, entry.refused ? ", refused" : "", entry.text);
  }
  return fmt::format("{}  {:10.3f} s  {:<7} {}\n", wall_text(entry.wall), to_seconds(entry.position), entry.kind,
                     on_one_line(text));
}

Json run_json(const JournalRun& run) {
  return {{"run", run.id},
          {"began_since_1970_s", to_seconds(run.began)},
          {"version", run.version},
          {"show", run.show},
          {"plan", run.plan},
          {"epoch", run.epoch},
          {"ended_since_1970_s", run.ended ? Json(to_seconds(*run.ended)) : Json(nullptr)},
          {"how", run.how}};
}

Json entry_json(const JournalEntry& entry) {
  Json out{{"since_1970_s", to_seconds(entry.wall)},
           {"position_s", to_seconds(entry.position)},
           {"kind", entry.kind},
           {"text", entry.text}};
  if (entry.kind == "answer") {
    out["order"] = entry.order;
    out["who"] = entry.who;
    out["refused"] = entry.refused;
  }
  return out;
}

Json place_json(const Place& place) {
  return {{"position_s", to_seconds(place.where.position)},
          {"cue", place.where.cue ? Json(*place.where.cue) : Json(nullptr)},
          {"runs", place.where.runs_since.has_value()},
          {"tempo_percent", place.where.percent},
          {"over", place.over},
          {"in_reset", place.in_reset}};
}

int run(Session& session, const Options& options) {
  const std::string file = options.file.empty() ? journal_in(state_folder("")).string() : options.file;
  auto reading = read_journal(file, options.run);
  if (!reading) return session.fail(reading.error());
  if (reading->runs.empty()) return session.fail(input_error("the journal '" + file + "' has no run yet"));
  const auto wanted = options.run == 0 ? reading->runs.back().id : options.run;
  const JournalRun* run = nullptr;
  for (const JournalRun& one : reading->runs) run = one.id == wanted ? &one : run;
  if (run == nullptr) {
    return session.fail(input_error(fmt::format("the journal '{}' has no run {} (it has {} to {})", file, wanted,
                                                reading->runs.front().id, reading->runs.back().id)));
  }
  if (session.json) {
    Json runs = Json::array();
    for (const JournalRun& one : reading->runs) runs.push_back(run_json(one));
    Json document{{"runs", std::move(runs)}};
    if (!options.runs) {
      document["run"] = wanted;
      document["entries"] = Json::array();
      for (const JournalEntry& entry : reading->entries) document["entries"].push_back(entry_json(entry));
      document["last_place"] = reading->last_place ? place_json(*reading->last_place) : Json(nullptr);
    }
    session.print(document.dump(2, ' ', false, Json::error_handler_t::replace));
    return 0;
  }
  std::string text;
  if (options.runs) {
    for (const JournalRun& one : reading->runs) text += run_text(one);
  } else {
    text = run_text(*run);
    for (const JournalEntry& entry : reading->entries) text += entry_text(entry);
  }
  session.print(text);
  return 0;
}

}  // namespace

void add_journal_command(CLI::App& program, Session& session, Chosen& chosen) {
  CLI::App* command =
      program.add_subcommand("journal", "What happened in a run: who said what, alarms, silent markers");
  auto options = std::make_shared<Options>();
  command->add_option("FILE", options->file, "journal of runs")->default_str("~/.local/state/footlight/journal.sqlite");
  command->add_option("--run", options->run, "number of a run")->default_str("the last one");
  command->add_flag("--runs", options->runs, "list the runs alone");
  session.add_options(*command, true);
  command->footer(
      "`footlight run` writes it, and finds its place in it again after it has died (run --resume). It may be read\n"
      "while a show runs, and by any tool for SQLite: docs/surviving.md.\n\n"
      "Examples:\n  footlight journal\n  footlight journal --runs\n  footlight journal --run 3 --json\n");
  command->callback([&session, &chosen, options] { chosen = [&, options] { return run(session, *options); }; });
}

}  // namespace footlight::app
