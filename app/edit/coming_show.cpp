// SPDX-License-Identifier: Apache-2.0
#include "app/edit/coming_show.hpp"

#include <optional>
#include <utility>

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include "app/load.hpp"
#include "app/plan_step.hpp"
#include "config/plan_file.hpp"

namespace footlight::app {
namespace {

Status<> same_wires(const Rig& now, const Rig& running) {
  const auto other = [](std::string_view what) {
    return refusal(fmt::format("the rig has other {} than the one that runs: end the run and start it again", what));
  };
  if (now.buses.size() != running.buses.size()) return other("buses");
  for (std::size_t b = 0; b < now.buses.size(); ++b) {
    if (now.buses[b].name != running.buses[b].name || now.buses[b].kind != running.buses[b].kind) return other("buses");
  }
  if (now.nodes.size() != running.nodes.size()) return other("nodes");
  for (std::size_t n = 0; n < now.nodes.size(); ++n) {
    const Node& one = now.nodes[n];
    const Node& old = running.nodes[n];
    if (one.bus != old.bus || one.address != old.address || one.channels.size() != old.channels.size()) {
      return other("nodes");
    }
  }
  return Done{};
}

/// The plan that was just written, judged once more by the marks alone.
Result<Plan> judged(const std::string& file) {
  std::optional<Result<Plan>> plan;
  tbb::task_arena(1).execute([&] { plan = plan_alone(file); });
  if (*plan && !(*plan)->valid) return refusal(fmt::format("the plan in '{}' breaks its limits", file));
  return *std::move(plan);
}

}  // namespace

Result<std::unique_ptr<ComingShow>> prepare_show(const PlanOrder& order, const PlayingNow& playing,
                                                 const std::atomic<bool>& stop) {
  take_the_lowest_priority();
  if (auto planned = plan_in_a_process(order, stop); !planned) return std::move(planned).error();
  auto loaded = config::load_show(order.show);
  if (!loaded) return input_error(loaded.error().to_text());
  Show everybody;
  everybody.performers = loaded->show.performers;
  everybody.understudies = loaded->show.understudies;
  if (auto done = mark_absent(loaded->show, order.absent); !done) return std::move(done).error();
  if (auto done = mark_covers(loaded->show, order.covers); !done) return std::move(done).error();
  auto plan = judged(order.output);
  if (!plan) return std::move(plan).error();
  const auto hash = config::hash_files(loaded->planned_files);
  if (!hash || *hash != plan->show_hash) return Error{ErrorKind::interrupted, "the show has changed meanwhile"};
  take_durations(loaded->show, *plan);
  take_people(*loaded, *plan);
  if (auto same = same_wires(loaded->rig, *playing.rig); !same) return std::move(same).error();
  loaded->rig.buses = playing.rig->buses;  // where they are today
  WalkChanges changes = walk_changes(*playing.plan, *plan);
  auto wires = put_beside(loaded->show, *plan, loaded->rig, *playing.wires, *playing.schedule);
  if (!wires) return std::move(wires).error();
  auto limits = limit_tempo(loaded->show, *plan, loaded->rig, **wires, *playing.wires);
  controller::Stands stands(*plan);
  return std::make_unique<ComingShow>(ComingShow{std::move(loaded).value(), std::move(everybody),
                                                 std::move(plan).value(), std::move(changes), std::move(wires).value(),
                                                 std::move(limits), std::move(stands)});
}

}  // namespace footlight::app
