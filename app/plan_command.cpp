// SPDX-License-Identifier: Apache-2.0
#include "app/plan_command.hpp"

#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/paper/picture.hpp"
#include "app/plan_step.hpp"
#include "app/plan_summary.hpp"
#include "config/output_file.hpp"
#include "config/plan_file.hpp"

namespace footlight::app {
namespace {

struct Options {
  PlanChoice choice;
  std::string output;
  std::string pictures;
  bool timing = false;
};

constexpr const char* kPictureList = "pictures.txt";  // what has been drawn into the folder, a name a line
constexpr std::size_t kMostListBytes = 10'000'000;

std::vector<std::string> lines_of(const std::filesystem::path& file) {
  std::vector<std::string> out;
  const auto text = config::read_file(file, kMostListBytes);
  if (!text) return out;
  std::istringstream in(*text);
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}

Status<> write_pictures(Session& session, const PlannedShow& planned, const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return input_error(fmt::format("cannot make the folder '{}': {}", folder, error.message()));
  const Plan& plan = planned.plan();
  const auto listed = std::filesystem::path(folder) / kPictureList;
  const std::vector<std::string> older = lines_of(listed);
  std::string names;
  for (std::size_t i = 0; i < plan.formations.size(); ++i) {
    if (session.stopped()) return Error{ErrorKind::interrupted, "interrupted while drawing pictures"};
    session.tell("drawing pictures", static_cast<double>(i) / static_cast<double>(plan.formations.size()));
    const auto index = FormationIndex::of(i);
    const auto& film = planned.films->at(plan.formations[i].section.at());
    const auto png = formation_png(plan, planned.loaded.show, index, film ? &*film : nullptr);
    const std::string name = picture_name(plan, index);
    auto done = config::write_file(std::filesystem::path(folder) / name, png);
    if (!done) return done;
    names += name + "\n";
  }
  session.clear_line();
  // What an earlier plan has drawn and this one has not would be taken for a formation of this one.
  for (const std::string& name : older) {
    const bool ours = name.ends_with(".png") && name.find('/') == std::string::npos;
    if (ours && ("\n" + names).find("\n" + name + "\n") == std::string::npos) {
      std::filesystem::remove(std::filesystem::path(folder) / name, error);
    }
  }
  return config::write_file(listed, names);
}

/// How long what took, beside the result.
std::string with_timing(Session& session, std::string json_text) {
  const auto& stages = session.times()->finish();
  const double peak_mb = peak_memory_mb();
  if (!session.json) {
    session.note(to_text(stages, peak_mb));
    return json_text;
  }
  auto out = nlohmann::ordered_json::parse(json_text);
  for (const auto& [stage, time_s] : stages) out["timing_s"][stage] = time_s;
  out["peak_mb"] = peak_mb;
  return out.dump(1) + "\n";
}

int run(Session& session, const Options& options) {
  const SteadyClock clock;
  if (options.timing) session.time_stages(clock);
  session.enter("reading");
  const std::string file = options.output.empty() ? plan_file_beside(options.choice.show) : options.output;
  PlanChoice choice = options.choice;
  choice.stages = stage_file_beside(file);
  auto planned = plan_anew(session, choice, !options.pictures.empty());
  if (!planned) return session.fail(planned.error());
  const auto refused = refusal_of(planned->planned);
  for (const std::string& output : {file, choice.stages}) {
    if (auto spared = spare_inputs(planned->loaded, output); !spared) return session.fail(spared.error());
  }
  session.enter("writing");
  if (!refused) {
    if (auto done = config::save_plan(planned->plan(), file); !done) return session.fail(done.error());
    if (auto kept = planned->keep_stages(); !kept) {
      session.note(fmt::format("the next planning will begin from nothing: {}", kept.error().message));
    }
  }
  // Pictures of a refused plan help to see why; they say so themselves.
  if (!options.pictures.empty()) {
    if (auto done = write_pictures(session, *planned, options.pictures); !done) return session.fail(done.error());
  }
  session.enter("summary");
  std::string result = session.json ? plan_json(planned->loaded.show, planned->planned)
                                    : plan_text(planned->loaded.show, planned->planned);
  if (options.timing) result = with_timing(session, std::move(result));
  session.print(result);
  if (refused) return session.fail(*refused);
  session.note(fmt::format("wrote {}", file));
  return 0;
}

}  // namespace

void add_plan_command(CLI::App& program, Session& session, Chosen& chosen) {
  CLI::App* command = program.add_subcommand("plan", "Plan where everybody stands and walks, and prove it");
  auto options = std::make_shared<Options>();
  command->add_option("SHOW", options->choice.show, "the show file (YAML)")->required();
  command->add_option("-o,--output", options->output, "the plan file to write (default: SHOW.plan beside the show)");
  command->add_option("--pictures", options->pictures, "draw a picture of every key formation into this folder");
  command
      ->add_option("--absent", options->choice.absent,
                   "who does not come today, besides those of the show file: ids, commas between them")
      ->delimiter(',');
  command
      ->add_option("--cover", options->choice.covers,
                   "who takes the whole way of somebody absent: 4=zoe, commas between them; nobody else changes")
      ->delimiter(',');
  command->add_flag("--afresh", options->choice.afresh,
                    "plan everything anew, whatever is kept of earlier plannings (the plan is the same)");
  command
      ->add_option("--threads", options->choice.threads,
                   "plan with so many threads (the plan is the same for any number)")
      ->check(CLI::Range(1, 1024));
  command->add_flag("--timing", options->timing, "tell how long reading, decoding and each stage of planning took");
  session.add_options(*command, true);
  command->footer(
      "A plan that somebody could not walk, or in which people would come too close, is refused with who, where and\n"
      "when (exit status 3), and no plan file is written.\n"
      "What each stage of planning gave is kept beside the plan file (.stages): after a change only what depends on "
      "it\n"
      "is planned again.\n\n"
      "Examples:\n  footlight plan show.yaml\n  footlight plan show.yaml --pictures out/show\n"
      "  footlight plan show.yaml -o monday.plan --json\n");
  command->callback([&session, &chosen, options] { chosen = [&, options] { return run(session, *options); }; });
}

}  // namespace footlight::app
