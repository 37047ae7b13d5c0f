// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/load.hpp"
#include "app/session.hpp"
#include "core/plan.hpp"
#include "core/result.hpp"
#include "core/time.hpp"
#include "planner/plan_show.hpp"

namespace CLI {
class App;
}

namespace footlight::app {

/// Where a command takes its plan from.
struct PlanChoice {
  std::string show;     ///< the show file
  std::string plan;     ///< a plan file that must be of this show; empty: the one beside the show where it fits
  int threads = 0;      ///< 0: as many as there are processors
  bool afresh = false;  ///< take nothing from `stages`
  std::string stages;   ///< file of what earlier plannings gave, used where they fit; empty: none
  std::vector<std::string> absent;  ///< ids of people who do not come, besides those of the show file
  std::vector<std::string> covers;  ///< "4=zoe": absent, and who takes her whole way
  /// A plan file that the user named may break its limits: it is taken, and marked as not valid.
  bool unchecked = false;

  /// SHOW, --plan and --threads.
  void add_options(CLI::App& command);
};

/// A show and its plan.
struct PlannedShow {
  config::LoadedShow loaded;
  std::optional<Films> films;             ///< absent when the plan came from a file and nobody asked for them
  planner::Planned planned;               ///< `shortest` is empty when the plan came from a file
  std::optional<Duration> planning;       ///< that planning took, decoding apart; absent when the plan came from a file
  std::function<Status<>()> keep_stages;  ///< writes the stages of this planning for the next; empty: not planned now
  [[nodiscard]] const Plan& plan() const { return planned.plan; }
};

/// "shows/vine/show.plan" for "shows/vine/show.yaml".
[[nodiscard]] std::string plan_file_beside(const std::string& show_file);

/// Reads the show and takes its plan from a file of the same show (same bytes of every file that the planner reads),
/// else plans it and says so. A refused plan is returned with its refusal; see `refusal_of`. Errors: whatever the show,
/// its media or the plan file have wrong; interrupted.
[[nodiscard]] Result<PlannedShow> plan_for(Session& session, const PlanChoice& choice, bool want_films);

/// "shows/vine/show.stages" for "shows/vine/show.plan".
[[nodiscard]] std::string stage_file_beside(const std::string& plan_file);

/// Reads and plans, whatever plan files there are. With `choice.stages` only what depends on a change is planned, films
/// whose formations are known are not decoded (unless wanted), and `keep_stages` writes the file for the next time.
[[nodiscard]] Result<PlannedShow> plan_anew(Session& session, const PlanChoice& choice, bool want_films = false);

/// A plan file on its own, judged: a plan that breaks its limits is marked as not valid.
[[nodiscard]] Result<Plan> plan_alone(const std::string& file);

/// Nothing for a valid plan; else why it is refused, in one message of a line each.
[[nodiscard]] std::optional<Error> refusal_of(const planner::Planned& planned);

}  // namespace footlight::app
