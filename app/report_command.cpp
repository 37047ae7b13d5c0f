// SPDX-License-Identifier: Apache-2.0
#include "app/report_command.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/dark_report.hpp"
#include "app/output_place.hpp"
#include "app/paper/stamp.hpp"
#include "app/plan_step.hpp"
#include "app/report_json.hpp"
#include "app/report_page.hpp"
#include "app/simulated_buses.hpp"
#include "config/output_file.hpp"
#include "controller/bus_budget.hpp"
#include "controller/cue_list.hpp"
#include "core/check.hpp"

namespace footlight::app {
namespace {

struct Options {
  PlanChoice choice;
  std::string output;
};

constexpr double kStep_s = 1;

/// What every bus has to carry at its hardest switch, and every supply.
Status<> add_loads(const Show& show, const Plan& plan, const Rig& rig, ReportFacts& facts) {
  const auto plays = controller::cue_plays(show, plan);
  std::vector<Duration> gaps;
  for (const auto& play : plays) gaps.push_back(play.gap_after.value_or(controller::kShortestHold));
  std::vector<BusLoad>& out = facts.buses;
  for (const Bus& bus : rig.buses) out.push_back({bus.name, 0, 0, 0, 0, ""});
  const auto find_hardest = [&](const SimulatedSchedule& built) {
    facts.supplies = supply_figures(built.schedule, built.wires, plays);
    for (const controller::BusNeed& need : bus_needs(built.schedule, built.wires, built.drivers, gaps)) {
      BusLoad& bus = out[need.bus.at()];
      const double allowed_s = to_seconds(need.allowed());
      const double load = allowed_s > 0 ? to_seconds(need.needed()) / allowed_s : 0;
      if (need.changed == 0 || load <= bus.busiest) continue;
      bus.busiest = load;
      bus.needed_s = to_seconds(need.needed());
      bus.allowed_s = allowed_s;
      bus.changed = need.changed;
      bus.cause = built.schedule.switches()[need.k].cause;
    }
  };
  return with_schedule(show, plan, rig, find_hardest);
}

ReportFacts facts_of(Session& session, const PlannedShow& planned) {
  const Plan& plan = planned.plan();
  ReportFacts out;
  out.measures = planner::measure(plan, *planned.films, session.progress());
  out.lag_s = planner::measure_lag(plan, session.progress());
  session.tell("drawing", 0);
  out.drawing = drawing_series(plan, *planned.films);
  out.clearance = clearance_series(plan, kStep_s);
  session.tell("crowd", 0);
  out.crowd = planner::crowd_series(plan, kStep_s);
  out.ways = way_figures(plan);
  session.tell("buses", 0);
  if (plan.valid) {
    if (auto added = add_loads(planned.loaded.show, plan, planned.loaded.rig, out); !added) {
      out.buses_missing = added.error().message;
    }
    session.tell("dark markers", 0);
    out.dark = controller::find_dark_units(plan, planned.loaded.rig, kDarkKept);
  } else {
    out.buses_missing = "A refused plan is not lit.";
  }
  out.warnings = planned.loaded.warnings;
  return out;
}

int run(Session& session, const Options& options) {
  const bool page = !options.output.empty();
  if (!page && !session.json) return session.fail(input_error("say what to write: -o FILE.html, or --json"));
  if (page) {
    if (auto free = can_write(options.output); !free) return session.fail(free.error());
  }
  auto planned = plan_for(session, options.choice, true);
  if (!planned) return session.fail(planned.error());
  if (page) {
    if (auto spared = spare_inputs(planned->loaded, options.output); !spared) return session.fail(spared.error());
  }
  FL_CHECK(planned->films.has_value());  // they were asked for
  const ReportFacts facts = facts_of(session, *planned);
  if (session.stopped()) return session.fail({ErrorKind::interrupted, "interrupted; nothing was written"});
  const Plan& plan = planned->plan();
  const Show& show = planned->loaded.show;
  if (page) {
    const std::string html = report_html(plan, show, *planned->films, facts);
    if (auto done = config::write_file(options.output, html); !done) return session.fail(done.error());
  }
  session.clear_line();
  if (session.json) {
    session.print(report_json(plan, show, facts, page ? std::vector{options.output} : std::vector<std::string>()));
  } else {
    session.print(fmt::format("{}: plan {}", options.output, Stamp(plan).plan));
  }
  // The report of a refused plan helps to see why; it says so itself.
  const auto refused = refusal_of(planned->planned);
  return refused ? session.fail(*refused) : 0;
}

}  // namespace

void add_report_command(CLI::App& program, Session& session, Chosen& chosen) {
  CLI::App* command = program.add_subcommand("report", "Tell everything about a show in one HTML page");
  auto options = std::make_shared<Options>();
  options->choice.add_options(*command);
  command->add_option("-o,--output", options->output, "the HTML file; it needs no other file and no network");
  session.add_options(*command, true);
  command->footer(
      "Examples:\n  footlight report show.yaml -o report.html\n"
      "  footlight report show.yaml --json | jq '.sections[].theta_dev'\n");
  command->callback([&session, &chosen, options] { chosen = [&, options] { return run(session, *options); }; });
}

}  // namespace footlight::app
