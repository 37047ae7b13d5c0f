// SPDX-License-Identifier: Apache-2.0
#include "controller/bus_budget.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "controller/bus_loop.hpp"
#include "core/check.hpp"
#include "core/diagnostic.hpp"

namespace footlight::controller {
namespace {

constexpr std::size_t kShownBuses = 10;
constexpr double kLeastShare = 0.05;  // of the wire, for the opening: such a bus carries no switch

double ms(Duration duration) { return static_cast<double>(duration.count()) * 1e-6; }

double excess(const BusNeed& need) { return ms(need.needed()) / std::max(ms(need.allowed()), 1e-3); }

/// Nodes that answer after a switch: those that had to change; where nodes answer by themselves, all of the bus.
bool answers(const CueSchedule& schedule, std::size_t k, NodeIndex node) {
  if (k == 0) return true;
  const auto before = schedule.looks_of(k - 1, node);
  return !std::ranges::equal(before, schedule.looks_of(k, node));
}

/// Heartbeats in one period, the nodes' own included.
Duration beat_of(const drivers::Driver& driver) { return driver.heartbeat_time() + driver.node_heartbeats_time(); }

BusNeed need_of(const CueSchedule& schedule, const Rig& rig, BusIndex bus, std::size_t k, const drivers::Driver& driver,
                Duration available) {
  BusNeed need;
  need.bus = bus;
  need.k = k;
  need.available = available;
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
    if (k > 0 && answers(schedule, k - 1, node)) ++verified;
  }
  if (need.changed == 0) return need;
  need.verified = verified > 0 && driver.capabilities().pushes_status ? all : verified;
  need.receipts = need.verified * driver.status_time();
  need.latches = driver.capabilities().sequenced_latch ? 2 : 1;
  need.latching = need.latches * driver.latch_time();
  if (driver.heartbeat_time().count() > 0) {
    need.heartbeats =
        static_cast<int>((available + drivers::kHeartbeatPeriod - Duration(1)) / drivers::kHeartbeatPeriod);
  }
  need.beating = need.heartbeats * beat_of(driver);
  return need;
}

/// Share of the wire that heartbeats leave to everything else, the reserve taken off; not above 0 when there is none.
double share_left(Duration beat) { return 1 - kBusReserve - ms(beat) / ms(drivers::kHeartbeatPeriod); }

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

std::string counted(int number, std::string_view what) {
  return fmt::format("{} {}{}", number, what, number == 1 ? "" : what.ends_with('h') ? "es" : "s");
}

/// What would help, as far as it would.
std::string remedy(const BusNeed& need, const Bus& bus, Instant due, const TempoMap& tempo) {
  std::vector<std::string> ways;
  const auto counts_before = [&](double duration_ms) {
    return tempo.count_at(due) - tempo.count_at(due - seconds(duration_ms * 1e-3));
  };
  const double room_ms = ms(need.allowed() - need.latching - need.beating);
  const double buses = std::ceil(ms(need.preloads + need.receipts) / std::max(room_ms, 1e-6));
  if (buses <= std::max(need.changed, need.verified))
    ways.push_back(fmt::format("share its nodes among {} buses", buses));
  if (bus.kind != BusKind::modbus_tcp) {
    ways.emplace_back("raise the bit rate, which does not shorten silences and turnarounds");
  }
  const double share = share_left(need.heartbeats == 0 ? Duration{} : need.beating / need.heartbeats);
  if (share > 0) {
    ways.push_back(fmt::format("leave {:.2f} counts between these switches instead of {:.2f}",
                               counts_before(ms(need.preloads + need.receipts + need.latching) / share),
                               counts_before(ms(need.available))));
  }
  return fmt::format("{}", fmt::join(ways, ", or "));
}

Diagnostic complaint(const Worst& worst, const CueSchedule& schedule, const Rig& rig, const Show& show) {
  const BusNeed& need = *worst.need;
  const Bus& bus = rig.buses[need.bus.at()];
  const Switch& due = schedule.switches()[need.k];
  const bool has_rate = bus.kind != BusKind::modbus_tcp;
  Diagnostic out;
  out.position = rig.file.empty() ? Position{show.file} : bus.position;
  out.key_path = rig.file.empty() ? "" : fmt::format("buses[{}]", need.bus.at());
  out.text = fmt::format(
      "the {} bus \"{}\"{} cannot carry switch {} \"{}\" (count {:.6g}, {:.3f} s) in time: preloads of {} that change "
      "{:.1f} ms + {} of the switch before {:.1f} ms + {} {:.1f} ms + {} {:.1f} ms = {:.1f} ms; the switch before is "
      "{:.1f} ms earlier, of which {:.1f} ms may be used and {:.0f} % stay in reserve; {} of {} switches do not fit",
      to_text(bus.kind), bus.name, has_rate ? fmt::format(" at {} bit/s", bus.bits_per_second) : "", need.k, due.cause,
      show.tempo.count_at(due.time), to_seconds(due.time), counted(need.changed, "node"), ms(need.preloads),
      counted(need.verified, "receipt"), ms(need.receipts), counted(need.latches, "latch"), ms(need.latching),
      counted(need.heartbeats, "heartbeat"), ms(need.beating), ms(need.needed()), ms(need.available),
      ms(need.allowed()), kBusReserve * 100, worst.misfits, worst.switches);
  out.hint = remedy(need, bus, due.time, show.tempo);
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
    // Where a set ends, the show stands; the opening, which is nobody's cue, is not among them.
    const std::optional<std::size_t>& cue = switches[k - 1].cue;
    if (switches[k - 1].settled && cue) available += gaps[*cue];
    for (std::size_t b = 0; b < rig.buses.size(); ++b) {
      needs.push_back(need_of(schedule, rig, BusIndex::of(b), k, *drivers[b], available));
    }
  }
  return needs;
}

Duration opening_time(const CueSchedule& schedule, const Rig& rig,
                      const std::vector<std::unique_ptr<drivers::Driver>>& drivers) {
  FL_CHECK(drivers.size() == rig.buses.size());
  double longest_ms = 0;
  for (std::size_t b = 0; b < rig.buses.size(); ++b) {
    const drivers::Driver& driver = *drivers[b];
    const BusNeed need = need_of(schedule, rig, BusIndex::of(b), 0, driver, {});
    const auto uploads = static_cast<Duration::rep>(kUploads * (schedule.looks().size() - 1));
    const Duration work =
        uploads * driver.upload_time() + need.preloads + need.changed * driver.status_time() + need.latching;
    longest_ms = std::max(longest_ms, ms(work) / std::max(share_left(beat_of(driver)), kLeastShare));
  }
  return seconds(longest_ms * 1e-3);
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
