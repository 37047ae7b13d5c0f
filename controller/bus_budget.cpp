// SPDX-License-Identifier: Apache-2.0
#include "controller/bus_budget.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/check.hpp"
#include "core/diagnostic.hpp"

namespace footlight::controller {
namespace {

constexpr std::size_t kShownBuses = 10;

double ms(Duration duration) { return static_cast<double>(duration.count()) * 1e-6; }

double excess(const BusNeed& need) { return ms(need.needed()) / std::max(ms(need.allowed()), 1e-3); }

/// Nodes that answer after a switch: those that had to change; where nodes answer by themselves, all of the bus.
bool answers(const CueSchedule& schedule, std::size_t k, NodeIndex node) {
  if (k == 0) return true;
  const auto before = schedule.looks_of(k - 1, node);
  return !std::ranges::equal(before, schedule.looks_of(k, node));
}

BusNeed need_of(const CueSchedule& schedule, const Rig& rig, BusIndex bus, std::size_t k, const drivers::Driver& driver,
                Duration available) {
  BusNeed need{bus, k, 0, 0, {}, {}, {}, available};
  int all = 0;
  int verified = 0;
  for (std::size_t n = 0; n < rig.nodes.size(); ++n) {
    if (rig.nodes[n].bus != bus) continue;
    const auto node = NodeIndex::of(n);
    ++all;
    if (answers(schedule, k, node)) {
      ++need.changed;
      need.preloads += driver.preload_time(static_cast<int>(rig.nodes[n].channels.size()));
    }
    if (answers(schedule, k - 1, node)) ++verified;
  }
  if (need.changed == 0) return need;
  need.verified = verified > 0 && driver.capabilities().pushes_status ? all : verified;
  need.receipts = need.verified * driver.status_time();
  need.latch = driver.latch_time();
  return need;
}

/// The need of a bus that exceeds what is allowed most.
struct Worst {
  const BusNeed* need = nullptr;  ///< null when all of them fit
  std::size_t misfits = 0;
  std::size_t switches = 0;
};

Worst worst_of(const std::vector<BusNeed>& needs, BusIndex bus) {
  Worst worst;
  for (const BusNeed& need : needs) {
    if (need.bus != bus) continue;
    ++worst.switches;
    if (need.fits()) continue;
    ++worst.misfits;
    if (worst.need == nullptr || excess(need) > excess(*worst.need)) worst.need = &need;
  }
  return worst;
}

Diagnostic complaint(const Worst& worst, const CueSchedule& schedule, const Rig& rig, const Show& show) {
  const BusNeed& need = *worst.need;
  const Bus& bus = rig.buses[need.bus.at()];
  const Switch& due = schedule.switches()[need.k];
  const auto counts_before = [&](Duration duration) {
    return show.tempo.count_at(due.time) - show.tempo.count_at(due.time - duration);
  };
  Diagnostic out;
  out.position = rig.file.empty() ? Position{show.file} : bus.position;
  out.key_path = rig.file.empty() ? "" : fmt::format("buses[{}]", need.bus.at());
  out.text = fmt::format(
      "the {} bus \"{}\" at {} bit/s cannot carry switch {} \"{}\" (count {:.6g}, {:.3f} s) in time: {} nodes change: "
      "preloads {:.1f} ms + {} receipts of the switch before {:.1f} ms + latch {:.1f} ms = {:.1f} ms; the switch "
      "before "
      "is {:.1f} ms earlier, of which {:.1f} ms may be used and {:.0f} % stay in reserve; {} of {} switches do not fit",
      to_text(bus.kind), bus.name, bus.bits_per_second, need.k, due.cause, show.tempo.count_at(due.time),
      to_seconds(due.time), need.changed, ms(need.preloads), need.verified, ms(need.receipts), ms(need.latch),
      ms(need.needed()), ms(need.available), ms(need.allowed()), kBusReserve * 100, worst.misfits, worst.switches);
  out.hint = fmt::format(
      "share its nodes among {} buses, or raise the bit rate, which does not shorten silences and turnarounds, or "
      "leave {:.2f} counts between these switches instead of {:.2f}",
      static_cast<int>(std::ceil(excess(need))), counts_before(seconds(ms(need.needed()) / 1e3 / (1 - kBusReserve))),
      counts_before(need.available));
  return out;
}

}  // namespace

std::vector<BusNeed> bus_needs(const CueSchedule& schedule, const Rig& rig,
                               const std::vector<std::unique_ptr<drivers::Driver>>& drivers,
                               std::span<const Duration> gaps) {
  FL_CHECK(drivers.size() == rig.buses.size());
  std::vector<BusNeed> needs;
  const auto& switches = schedule.switches();
  // The opening is lit before the show starts and may take as long as it likes.
  for (std::size_t k = 2; k < switches.size(); ++k) {
    Duration available = switches[k].time - switches[k - 1].time;
    if (switches[k - 1].settled) available += gaps[switches[k - 1].cue.value()];
    for (std::size_t b = 0; b < rig.buses.size(); ++b) {
      needs.push_back(need_of(schedule, rig, BusIndex::of(b), k, *drivers[b], available));
    }
  }
  return needs;
}

Error over_budget(const std::vector<BusNeed>& needs, const CueSchedule& schedule, const Rig& rig, const Show& show) {
  std::string lines;
  std::size_t overloaded = 0;
  for (std::size_t b = 0; b < rig.buses.size(); ++b) {
    const auto worst = worst_of(needs, BusIndex::of(b));
    if (!worst.need || overloaded++ >= kShownBuses) continue;
    lines += (lines.empty() ? "" : "\n") + to_text(complaint(worst, schedule, rig, show));
  }
  FL_CHECK(overloaded > 0);
  if (overloaded > kShownBuses) lines += fmt::format("\nand {} more buses", overloaded - kShownBuses);
  return refusal(lines);
}

}  // namespace footlight::controller
