// SPDX-License-Identifier: Apache-2.0
#include "app/export_command.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "app/export_files.hpp"
#include "app/import/drone_zip.hpp"
#include "app/output_place.hpp"
#include "app/plan_step.hpp"
#include "app/sound/click_file.hpp"
#include "app/written.hpp"
#include "config/output_file.hpp"
#include "controller/cue_list.hpp"

namespace footlight::app {
namespace {

struct Options {
  PlanChoice choice;
  std::string csv;
  std::string drone;
  std::string click;
  bool unchecked = false;
};

using NamedFiles = std::vector<std::pair<std::filesystem::path, std::string>>;

/// All texts are made before the first is written; stage.json, which says whether the plan is valid, comes last.
Result<NamedFiles> files_of(const Plan& plan, const Show& show, const Options& options) {
  NamedFiles out;
  if (!options.drone.empty()) {
    auto zip = drone_zip(drone_tracks(plan, show));
    if (!zip) return std::move(zip).error();
    out.emplace_back(options.drone, std::move(zip).value());
  }
  if (!options.csv.empty()) {
    const std::filesystem::path folder = options.csv;
    out.emplace_back(folder / "marks.csv", marks_csv(plan, show));
    out.emplace_back(folder / "formations.csv", formations_csv(plan));
    out.emplace_back(folder / "stage.json", stage_json(plan, show));
  }
  return out;
}

int run(Session& session, const Options& options) {
  if (options.csv.empty() && options.drone.empty() && options.click.empty()) {
    return session.fail(input_error("say what to write: --csv FOLDER, --drone FILE.zip, --click FILE.wav"));
  }
  auto planned = plan_for(session, options.choice, false);
  if (!planned) return session.fail(planned.error());
  const auto refused = refusal_of(planned->planned);
  if (refused && !options.unchecked) return session.fail(*refused);
  if (refused && !options.drone.empty()) {
    return session.fail(input_error("--drone: the format cannot say that a plan is refused (--csv can)"));
  }
  const auto files = files_of(planned->plan(), planned->loaded.show, options);
  if (!files) return session.fail(files.error());
  if (!options.csv.empty()) {
    if (auto made = make_folder(options.csv); !made) return session.fail(made.error());
  }
  for (const auto& [file, content] : *files) {
    if (auto spared = spare_inputs(planned->loaded, file.string()); !spared) return session.fail(spared.error());
  }
  for (const auto& [file, content] : *files) {
    if (session.stopped()) return session.fail({ErrorKind::interrupted, "interrupted while exporting"});
    if (auto done = config::write_file(file, content); !done) return session.fail(done.error());
  }
  std::vector<std::string> names;
  for (const auto& [file, content] : *files) names.push_back(file.string());
  if (!options.click.empty()) {
    if (auto spared = spare_inputs(planned->loaded, options.click); !spared) return session.fail(spared.error());
    const auto plays = controller::cue_plays(planned->loaded.show, planned->plan());
    const auto beats = click_track(planned->loaded.show.tempo, plays.front().from, plays.back().to);
    if (auto done = write_clicks(options.click, beats, plays.front().from); !done) return session.fail(done.error());
    names.push_back(options.click);
  }
  if (session.json) {
    session.print(written_json(Stamp(planned->plan()), names).dump(2));
  } else {
    for (const std::string& name : names) session.print(name);
  }
  if (refused) session.note("the plan is refused; stage.json says \"valid\": false");
  return 0;
}

}  // namespace

void add_export_command(CLI::App& program, Session& session, Chosen& chosen) {
  CLI::App* command = program.add_subcommand("export", "Write everybody's marks for other programs");
  auto options = std::make_shared<Options>();
  options->choice.add_options(*command);
  command->add_option("--csv", options->csv, "the folder for marks.csv, stage.json and formations.csv");
  command->add_option("--drone", options->drone, "a zip of NAME.csv for each performer, as drone tools read it");
  command->add_option("--click", options->click,
                      "a WAV file with a click for each count, accented where a measure begins; count 1 is its first");
  command->add_flag("--unchecked", options->unchecked, "export a refused plan, too, marked as not valid");
  session.add_options(*command, true);
  command->footer(
      "Examples:\n  footlight export show.yaml --csv out/csv\n"
      "  footlight export show.yaml --plan monday.plan --csv out/monday\n"
      "  footlight export show.yaml --drone show.zip\n  footlight export show.yaml --click click.wav\n");
  command->callback([&session, &chosen, options] { chosen = [&, options] { return run(session, *options); }; });
}

}  // namespace footlight::app
