// SPDX-License-Identifier: Apache-2.0
#include "tests/contracts/go_run.hpp"

#include <algorithm>
#include <ctime>
#include <map>
#include <memory>
#include <string>

#include "controller/bus_loop.hpp"
#include "core/check.hpp"
#include "core/clock.hpp"
#include "drivers/registry.hpp"
#include "sim/simulated_rig.hpp"

namespace footlight::contracts {
namespace {

using controller::BusLoop;
using controller::BusTarget;
using controller::CueSchedule;

Rig rig_of(const std::vector<FloorBus>& buses) {
  Rig rig;
  for (std::size_t b = 0; b < buses.size(); ++b) {
    const std::string name = "b" + std::to_string(b);
    rig.buses.push_back({name, buses[b].kind, "sim://b", buses[b].bits_per_second, std::nullopt, {}});
    for (int i = 1; i <= buses[b].nodes; ++i) {
      rig.nodes.push_back(
          {name + "-" + std::to_string(i), BusIndex::of(b), i, std::vector<Channel>(kChannelsPerNode), {}});
    }
  }
  return rig;
}

/// An opening of one look, and another look everywhere at a GO.
CueSchedule schedule_of(std::size_t nodes) {
  std::vector<Look> looks(3, Look{{9, 9, 9}, Effect::steady, 255});
  std::vector<controller::Switch> switches{{kStart, "opening", false, std::nullopt},
                                           {kStart + seconds(1'000), "GO", false, std::nullopt}};
  std::vector<LookIndex> table;
  for (const LookIndex look : {LookIndex{1}, LookIndex{2}}) table.insert(table.end(), nodes * kChannelsPerNode, look);
  return CueSchedule(std::move(looks), std::move(switches), nodes, std::move(table), 0, {});
}

drivers::PortReference port_of(sim::SimulatedRig& simulated, const Rig& rig, BusIndex bus) {
  if (rig.buses[bus.at()].kind == BusKind::serial) return &simulated.serial(bus);
  if (rig.buses[bus.at()].kind == BusKind::can) return &simulated.can(bus);
  return &simulated.modbus(bus);
}

Duration cpu_now() {
  timespec now{};
  FL_CHECK(clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now) == 0);
  return std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec);
}

class Floor {
 public:
  explicit Floor(const std::vector<FloorBus>& buses)
      : rig_(rig_of(buses)), schedule_(schedule_of(rig_.nodes.size())), simulated_(rig_, {}, 1, clock_, nullptr) {
    simulated_.set_show(kStart, seconds(1'000));
    for (std::size_t b = 0; b < buses.size(); ++b) {
      const auto bus = BusIndex::of(b);
      auto nodes = drivers::node_addresses(rig_, bus);
      drivers_.push_back(drivers::make_driver(rig_.buses[b], nodes, 0xA3, port_of(simulated_, rig_, bus)).value());
      loops_.push_back(std::make_unique<BusLoop>(schedule_, std::move(nodes), *drivers_.back()));
    }
  }

  GoRun run() {
    GoRun out;
    while (!std::ranges::all_of(loops_, [](const auto& loop) { return loop->settled(); })) step(kNever);
    out.preload = clock_.now() - kStart;
    out.cpu = cpu_;
    target_.next = 1;
    for (const Instant end = clock_.now() + seconds(60); clock_.now() < end;) step(end);
    for (const auto& loop : loops_) out.notice = std::max(out.notice, loop->notice(loop->schedule(), 1));
    const Instant go = clock_.now();
    target_.next_at = go + out.notice;
    while (changed_.size() < rig_.nodes.size() && clock_.now() < go + seconds(60)) {
      step(target_.next_at);
      if (clock_.now() >= target_.next_at) target_ = {1, 1, kNever, clock_.now() - kStart};
      note();
    }
    out.lit = static_cast<int>(changed_.size());
    summarise(out, go);
    return out;
  }

 private:
  void step(Instant limit) {
    Instant next = std::min(limit, simulated_.next_event());
    target_.show_time = clock_.now() - kStart;
    const Duration before = cpu_now();
    for (const auto& loop : loops_) {
      next = std::min(next, std::max(loop->step(clock_.now(), target_), clock_.now() + Duration(1)));
    }
    cpu_ += cpu_now() - before;
    next = std::min(next, simulated_.next_event());
    FL_CHECK(next < kStart + seconds(1'000));
    simulated_.advance_to(std::max(next, clock_.now()));
  }

  void note() {
    for (std::size_t n = 0; n < rig_.nodes.size(); ++n) {
      if (simulated_.shown(NodeIndex::of(n), 0) == 2) changed_.emplace(n, clock_.now());
    }
  }

  void summarise(GoRun& out, Instant go) const {
    std::map<std::size_t, std::pair<Instant, Instant>> buses;
    Instant first = kNever;
    Instant last = kStart;
    for (const auto& [node, at] : changed_) {
      auto& [begin, end] = buses.try_emplace(rig_.nodes[node].bus.at(), at, at).first->second;
      begin = std::min(begin, at);
      end = std::max(end, at);
      first = std::min(first, at);
      last = std::max(last, at);
    }
    for (const auto& [bus, span] : buses) out.within_bus = std::max(out.within_bus, span.second - span.first);
    out.across_buses = last - first;
    out.go_to_last_lamp = last - go;
  }

  Rig rig_;
  CueSchedule schedule_;
  ManualClock clock_;
  sim::SimulatedRig simulated_;
  std::vector<std::unique_ptr<drivers::Driver>> drivers_;
  std::vector<std::unique_ptr<BusLoop>> loops_;
  BusTarget target_;
  Duration cpu_{};
  std::map<std::size_t, Instant> changed_;
};

}  // namespace

GoRun go_on(const std::vector<FloorBus>& buses) { return Floor(buses).run(); }

}  // namespace footlight::contracts
