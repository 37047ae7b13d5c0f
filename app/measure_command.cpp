// SPDX-License-Identifier: Apache-2.0
#include "app/measure_command.hpp"

#include <fstream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/measure_report.hpp"
#include "app/plan_step.hpp"
#include "config/media.hpp"
#include "core/check.hpp"
#include "planner/measure.hpp"

namespace footlight::app {
namespace {

struct Options {
  std::vector<std::string> files;
  PlanChoice choice;  ///< plan and threads; the show is one of the files
  bool best = false;
  bool bound = false;
};

/// Of improving a bound; more win less than a hundredth.
constexpr int kRounds = 16;

/// Plan files begin as every SQLite file does.
bool is_plan_file(const std::string& file) {
  const std::string magic = "SQLite format 3";
  std::string start(magic.size(), ' ');
  std::ifstream stream(file, std::ios::binary);
  return stream.read(start.data(), static_cast<std::streamsize>(start.size())) && start == magic;
}

/// The film that a plan was made from, as the plan remembers it; nothing, with a word, where it is not there any more.
std::optional<Film> film_again(Session& session, const PlanSection& section) {
  if (!section.film) return std::nullopt;
  const FilmPlacement& placed = *section.film;
  const PictureOptions picture{Fit::area, placed.threshold, placed.inverted};
  auto film = placed.show_fps > 0 ? config::decode_video({placed.path, placed.first_frame, placed.last_frame, picture},
                                                         {}, session.stop())
                                  : config::decode_image({placed.path, picture}, {}, session.stop());
  if (film) return std::move(film).value();
  session.note(fmt::format("the drawing of section {} is not measured: {}", section.name, film.error().message));
  return std::nullopt;
}

/// A plan and its films, wherever they come from.
struct Subject {
  MeasuredPlan measured;
  Films films;
};

Result<Subject> subject_of_plan(Session& session, const std::string& file) {
  auto plan = plan_alone(file);
  if (!plan) return std::move(plan).error();
  Subject out;
  for (const PlanSection& section : plan->sections) out.films.push_back(film_again(session, section));
  out.measured.plan = std::move(plan).value();
  return out;
}

Result<Subject> subject_of_show(Session& session, const Options& options, const std::string& file) {
  PlanChoice choice = options.choice;
  choice.show = file;
  choice.unchecked = true;
  auto planned = plan_for(session, choice, true);
  if (!planned) return std::move(planned).error();
  FL_CHECK(planned->films.has_value());  // they were asked for
  Subject out;
  out.films = *std::move(planned->films);
  out.measured.plan = std::move(planned->planned.plan);
  if (planned->planning) out.measured.planning_s = to_seconds(*planned->planning);
  return out;
}

Result<MeasuredPlan> measure_one(Session& session, const Options& options, const std::string& file) {
  auto subject = is_plan_file(file) ? subject_of_plan(session, file) : subject_of_show(session, options, file);
  if (!subject) return std::move(subject).error();
  MeasuredPlan& out = subject->measured;
  out.file = file;
  out.measures = planner::measure(out.plan, subject->films, session.progress());
  out.lag_s = planner::measure_lag(out.plan, session.progress());
  if (options.best) {
    out.bests.resize(subject->films.size());
    for (std::size_t i = 0; i < subject->films.size(); ++i) {
      const auto& film = subject->films[i];
      if (film) out.bests[i] = planner::best_of_frames(out.plan, SectionIndex::of(i), *film);
    }
  }
  if (options.bound) {
    out.bounds.resize(subject->films.size());
    for (std::size_t i = 0; i < subject->films.size(); ++i) {
      const auto& film = subject->films[i];
      if (film)
        out.bounds[i] = planner::bound_drawing(out.plan, SectionIndex::of(i), *film, kRounds, session.progress());
    }
  }
  session.clear_line();
  if (session.stopped()) return Error{ErrorKind::interrupted, "interrupted while measuring"};
  return std::move(out);
}

int run(Session& session, const Options& options) {
  if (options.files.size() > 1 && !options.choice.plan.empty()) {
    return session.fail(input_error("--plan goes with one show (name plan files beside the shows instead)"));
  }
  std::vector<MeasuredPlan> measured;
  for (const std::string& file : options.files) {
    auto one = measure_one(session, options, file);
    if (!one) return session.fail(one.error());
    measured.push_back(std::move(one).value());
  }
  session.print(session.json ? measure_json(measured) : measure_text(measured));
  return 0;
}

}  // namespace

void add_measure_command(CLI::App& program, Session& session, Chosen& chosen) {
  CLI::App* command = program.add_subcommand("measure", "Measure how well and how calmly shows are drawn");
  auto options = std::make_shared<Options>();
  command->add_option("SHOW", options->files, "show files (YAML), plan files, or some of each to compare")->required();
  command->add_option("--plan", options->choice.plan,
                      "use this plan file (default: the one beside the show, where it fits)");
  command
      ->add_option("--threads", options->choice.threads,
                   "plan with so many threads (the plan is the same for any number)")
      ->check(CLI::Range(1, 1024));
  command->add_flag("--best", options->best, "Also the best formation of each single frame, if nobody had to walk");
  command->add_flag("--bound", options->bound,
                    "Also how good theta_iou could be at the formations if everybody walked in the best way there is; "
                    "takes much longer than planning");
  session.add_options(*command, true);
  command->footer(
      "theta_dev   who is outside of the picture (share of the people, 0 is perfect), and its variance over frames\n"
      "theta_miss  what of the picture nobody covers (share of its area)\n"
      "theta_iou   both at once: 1 - (covered and picture) / (covered or picture)\n"
      "Every figure: docs/figures.md. A plan that breaks its limits is measured, too, and marked as not valid.\n\n"
      "Examples:\n  footlight measure show.yaml\n  footlight measure show.yaml --json | jq .theta_dev\n"
      "  footlight measure flat.yaml joint.yaml monday.plan\n");
  command->callback([&session, &chosen, options] { chosen = [&, options] { return run(session, *options); }; });
}

}  // namespace footlight::app
