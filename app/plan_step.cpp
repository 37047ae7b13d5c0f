// SPDX-License-Identifier: Apache-2.0
#include "app/plan_step.hpp"

#include <chrono>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <tbb/global_control.h>

#include "app/stage_file.hpp"
#include "config/plan_file.hpp"
#include "core/clock.hpp"
#include "planner/validate.hpp"

namespace footlight::app {
namespace {

/// How often it is looked whether planning shall stop, and how long its next step is waited for then.
constexpr std::chrono::milliseconds kLook{20};
constexpr std::chrono::milliseconds kPatience{60};

Error interrupted() { return {ErrorKind::interrupted, "interrupted; nothing was written"}; }

/// What earlier plannings left, and what the show's films are called there.
class Kept {
 public:
  Kept(Session& session, const PlanChoice& choice, const config::LoadedShow& loaded)
      : file_(choice.stages), loaded_(loaded) {
    std::error_code error;
    if (file_.empty() || build_id().empty()) return;
    reuse_.stages = &stages_;
    if (!choice.afresh && std::filesystem::exists(file_, error)) {
      const auto done = load_stages(file_, stages_);
      if (!done) session.note(fmt::format("planning everything anew: '{}': {}", file_, done.error().message));
      had_any_ = done.has_value();
    }
    for (const Section& section : loaded.show.sections) reuse_.film_ids.push_back(film_id(section));
  }

  [[nodiscard]] const planner::Reuse& reuse() const { return reuse_; }
  [[nodiscard]] bool had_any() const { return had_any_; }

  /// Lengths of the films that need not be decoded.
  [[nodiscard]] std::vector<std::optional<config::FilmLength>> lengths() {
    std::vector<std::optional<config::FilmLength>> out(loaded_.show.sections.size());
    for (std::size_t i = 0; i < reuse_.film_ids.size(); ++i) {
      if (reuse_.film_ids[i].empty()) continue;
      const auto bytes = stages_.find(length_key(i));
      if (!bytes) continue;
      planner::StageReader reader(*bytes);
      const config::FilmLength length{reader.get<int>(), reader.get<double>()};
      if (reader.whole()) out[i] = length;
    }
    Show show = loaded_.show;
    if (!config::settle_film_lengths(show, out)) return {};
    const std::vector<bool> known = planner::formations_known(show, reuse_);
    for (std::size_t i = 0; i < out.size(); ++i) {
      if (!known[i]) out[i].reset();
    }
    return out;
  }

  void keep_lengths(const Films& films) {
    if (reuse_.stages == nullptr) return;
    for (std::size_t i = 0; i < films.size(); ++i) {
      if (!films[i] || reuse_.film_ids[i].empty()) continue;
      planner::StageWriter out;
      out.add(static_cast<int>(films[i]->frames.size())).add(films[i]->fps);
      stages_.keep(length_key(i), out.take());
    }
  }

  Status<> save() const { return reuse_.stages == nullptr ? Status<>(Done{}) : save_stages(stages_, file_); }

 private:
  [[nodiscard]] planner::StageKey length_key(std::size_t section) const {
    return planner::StageHash("film length").add(std::string_view(reuse_.film_ids[section])).key();
  }

  /// The film's bytes and how they are read; empty for what is no film or cannot be read.
  static std::string film_id(const Section& section) {
    const auto* video = std::get_if<VideoSource>(&section.from);
    const auto* image = std::get_if<ImageSource>(&section.from);
    if (video == nullptr && image == nullptr) return {};
    const std::string& path = video != nullptr ? video->path : image->path;
    const PictureOptions& picture = video != nullptr ? video->picture : image->picture;
    const auto content = config::hash_files(std::span(&path, 1));
    if (!content) return {};
    const std::string colours =
        picture.colour ? to_text(picture.colour->from) + to_text(picture.colour->to) : std::string();
    return fmt::format("{} {} {} {} {} {} {}", *content, video != nullptr, video != nullptr ? video->first_frame : 0,
                       video != nullptr ? video->last_frame.value_or(-1) : -1, picture.threshold.value_or(-1),
                       picture.invert, colours);
  }

  std::string file_;
  const config::LoadedShow& loaded_;
  planner::Stages stages_;
  planner::Reuse reuse_;
  bool had_any_ = false;
};

/// What was planned anew, where something was kept.
std::string anew_text(const planner::Planned& planned) {
  const auto of = [](const planner::StageCount& stage, const char* what) {
    return fmt::format("{} of {} {}", stage.anew, stage.all, what);
  };
  return fmt::format("re-planned {} ({}, {}, {})", of(planned.facts, "transitions"),
                     of(planned.formations, "sections' formations"), of(planned.pairings, "pairings"),
                     of(planned.walks, "walks"));
}

/// Plans in a thread of its own, which looks at the flag between steps only: a long one is not waited for. Planning
/// reads and writes nothing but memory, so that the program can end in the midst of it.
Result<planner::Planned> plan_until_stopped(Session& session, const std::function<Result<planner::Planned>()>& plan) {
  auto planned = std::async(std::launch::async, plan);
  while (planned.wait_for(kLook) != std::future_status::ready) {
    if (!session.stopped()) continue;
    if (planned.wait_for(kPatience) == std::future_status::ready) break;
    session.end_now(interrupted());
  }
  return planned.get();
}

/// Decodes what is needed, and plans.
Status<> plan_now(Session& session, PlannedShow& out, const std::string& hash, const PlanChoice& choice,
                  bool want_films) {
  const auto kept_before = std::make_shared<Kept>(session, choice, out.loaded);
  Kept& kept = *kept_before;
  if (!out.films) {
    auto films = decode_films(session, out.loaded, want_films ? decltype(kept.lengths()){} : kept.lengths());
    if (!films) return std::move(films).error();
    out.films = std::move(films).value();
  }
  std::optional<tbb::global_control> limit;
  if (choice.threads > 0) {
    limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(choice.threads));
  }
  const SteadyClock clock;
  auto planned = plan_until_stopped(
      session, [&] { return planner::plan_show(out.loaded.show, *out.films, session.progress(), kept.reuse()); });
  out.planning = clock.now().time_since_epoch();
  session.clear_line();
  // Whatever the step says that noticed the stop, the user is told the same.
  if (session.stopped()) return interrupted();
  if (!planned) return std::move(planned).error();
  out.planned = std::move(planned).value();
  out.planned.plan.show_hash = hash;
  if (kept.had_any()) {
    session.note(fmt::format("{} in {:.0f} ms", anew_text(out.planned), 1000 * to_seconds(*out.planning)));
  }
  kept.keep_lengths(*out.films);
  take_people(out.loaded, out.planned.plan);
  out.keep_stages = [kept_before] { return kept_before->save(); };
  return Done{};
}

/// Judges a plan that comes from a file as if nobody had done so before: the file has a digest and no signature, and a
/// planner of another version may have made it.
std::optional<Error> broken_limit(const Plan& plan, const std::string& file) {
  const planner::Verdict verdict = planner::validate(plan);
  if (verdict.valid()) return std::nullopt;
  return refusal(fmt::format("the plan in '{}' breaks its limits: {} (plan it again)", file,
                             verdict.first.empty() ? "see footlight measure" : verdict.first.front().text));
}

/// The plan of the file if it is of the show with this hash and keeps its limits; one that the user named must fit.
Result<std::optional<Plan>> plan_from_file(Session& session, const PlanChoice& choice, const std::string& hash) {
  const bool wanted = !choice.plan.empty();
  const std::string file = wanted ? choice.plan : plan_file_beside(choice.show);
  const auto anew = [&](const std::string& why) {
    session.note(why);
    return std::optional<Plan>();
  };
  std::error_code error;
  if (!wanted && !std::filesystem::exists(file, error)) {
    return anew(fmt::format("planning, since '{}' is not there (footlight plan writes it)", file));
  }
  auto plan = config::load_plan(file);
  if (!plan) {
    if (wanted) return std::move(plan).error();
    return anew(fmt::format("planning again: {}", plan.error().message));
  }
  if (plan->show_hash != hash) {
    if (!wanted) return anew(fmt::format("planning again, since the show has changed since '{}'", file));
    return input_error(
        fmt::format("'{}' was planned from another show, or before the show was changed (plan it again)", file));
  }
  const auto broken = broken_limit(*plan, file);
  if (broken && !wanted) return anew(fmt::format("planning again: {}", broken->message));
  if (broken && !choice.unchecked) return *broken;
  plan->valid = !broken;
  return std::optional<Plan>(std::move(plan).value());
}

Result<PlannedShow> read(Session& session, const PlanChoice& choice) {
  auto loaded = read_show(session, choice.show);
  if (!loaded) return std::move(loaded).error();
  PlannedShow out;
  out.loaded = std::move(loaded).value();
  if (auto done = mark_absent(out.loaded.show, choice.absent); !done) return std::move(done).error();
  if (auto done = mark_covers(out.loaded.show, choice.covers); !done) return std::move(done).error();
  return out;
}

}  // namespace

void PlanChoice::add_options(CLI::App& command) {
  command.add_option("SHOW", show, "the show file (YAML)")->required();
  command.add_option("--plan", plan, "use this plan file (default: the one beside the show, where it fits)");
  command.add_option("--threads", threads, "plan with so many threads (the plan is the same for any number)")
      ->check(CLI::Range(1, 1024));
}

std::string stage_file_beside(const std::string& plan_file) {
  return std::filesystem::path(plan_file).replace_extension(".stages").string();
}

std::string plan_file_beside(const std::string& show_file) {
  return std::filesystem::path(show_file).replace_extension(".plan").string();
}

Result<PlannedShow> plan_anew(Session& session, const PlanChoice& choice, bool want_films) {
  auto out = read(session, choice);
  if (!out) return out;
  const auto hash = config::hash_files(out->loaded.planned_files);
  if (!hash) return hash.error();
  if (auto done = plan_now(session, *out, *hash, choice, want_films); !done) return std::move(done).error();
  return out;
}

Result<PlannedShow> plan_for(Session& session, const PlanChoice& choice, bool want_films) {
  auto out = read(session, choice);
  if (!out) return out;
  const auto hash = config::hash_files(out->loaded.planned_files);
  if (!hash) return hash.error();
  auto plan = plan_from_file(session, choice, *hash);
  if (!plan) return std::move(plan).error();
  if (*plan) {
    out->planned.plan = *std::move(*plan);
    if (want_films) {
      auto films = decode_films(session, out->loaded);
      if (!films) return std::move(films).error();
      out->films = std::move(films).value();
    } else {
      take_durations(out->loaded.show, out->planned.plan);
    }
    take_people(out->loaded, out->planned.plan);
    session.clear_line();
    return out;
  }
  if (auto done = plan_now(session, *out, *hash, choice, want_films); !done) return std::move(done).error();
  return out;
}

Result<Plan> plan_alone(const std::string& file) {
  auto plan = config::load_plan(file);
  if (plan) plan->valid = !broken_limit(*plan, file);
  return plan;
}

std::optional<Error> refusal_of(const planner::Planned& planned) {
  if (planned.plan.valid) return std::nullopt;
  std::string lines;
  for (const std::string& line : planned.refusal) lines += (lines.empty() ? "" : "\n") + line;
  return refusal(lines.empty() ? "the plan breaks its limits" : lines);
}

}  // namespace footlight::app
