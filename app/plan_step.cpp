// SPDX-License-Identifier: Apache-2.0
#include "app/plan_step.hpp"

#include <filesystem>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <tbb/global_control.h>

#include "config/plan_file.hpp"
#include "core/clock.hpp"
#include "planner/validate.hpp"

namespace footlight::app {
namespace {

Error interrupted() { return {ErrorKind::interrupted, "interrupted; nothing was written"}; }

/// Decodes what is not decoded yet, and plans.
Status<> plan_now(Session& session, PlannedShow& out, const std::string& hash, int threads) {
  if (!out.films) {
    auto films = decode_films(session, out.loaded);
    if (!films) return std::move(films).error();
    out.films = std::move(films).value();
  }
  std::optional<tbb::global_control> limit;
  if (threads > 0) {
    limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  }
  const SteadyClock clock;
  auto planned = planner::plan_show(out.loaded.show, *out.films, session.progress());
  out.planning = clock.now().time_since_epoch();
  session.clear_line();
  if (!planned) return std::move(planned).error();
  if (session.stopped()) return interrupted();
  out.planned = std::move(planned).value();
  out.planned.plan.show_hash = hash;
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
  return out;
}

}  // namespace

void PlanChoice::add_options(CLI::App& command) {
  command.add_option("SHOW", show, "the show file (YAML)")->required();
  command.add_option("--plan", plan, "use this plan file (default: the one beside the show, where it fits)");
  command.add_option("--threads", threads, "plan with so many threads (the plan is the same for any number)")
      ->check(CLI::Range(1, 1024));
}

std::string plan_file_beside(const std::string& show_file) {
  return std::filesystem::path(show_file).replace_extension(".plan").string();
}

Result<PlannedShow> plan_anew(Session& session, const PlanChoice& choice) {
  auto out = read(session, choice);
  if (!out) return out;
  const auto hash = config::hash_files(out->loaded.planned_files);
  if (!hash) return hash.error();
  if (auto done = plan_now(session, *out, *hash, choice.threads); !done) return std::move(done).error();
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
    session.clear_line();
    return out;
  }
  if (auto done = plan_now(session, *out, *hash, choice.threads); !done) return std::move(done).error();
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
