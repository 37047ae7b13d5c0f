// SPDX-License-Identifier: Apache-2.0
#include "app/commission/flash_sequence.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "controller/bus_budget.hpp"
#include "core/check.hpp"

namespace footlight::app {
namespace {

constexpr int kLead = 2;
constexpr int kLong = 3;
constexpr Duration kLeastStep = milliseconds(400);
constexpr Duration kStepUnit = milliseconds(50);
constexpr double kLeastShare = 0.05;  // of the wire, where heartbeats take almost all
constexpr LookIndex kLit = 1;
constexpr std::uint8_t kPlanByte = 0;  // no show is on the bus

}  // namespace

FlashSequence::FlashSequence(LampCode code) : code_(code) {
  using Kind = FlashPart::Kind;
  const auto add = [&](Kind kind, int steps, int bit = 0, bool complement = false) {
    parts_.push_back({kind, bit, complement, steps, steps_});
    steps_ += steps;
  };
  add(Kind::dark, kLead);
  add(Kind::all, kLong);
  for (int i = 0; i < 2; ++i) {
    add(Kind::dark, 1);
    add(Kind::all, 1);
  }
  for (int bit = 0; bit < code_.bits(); ++bit) {
    add(Kind::bit, 1, bit, false);
    add(Kind::bit, 1, bit, true);
  }
  add(Kind::all, kLong);
  add(Kind::dark, kLead);
  for (std::size_t part = 0; part < parts_.size(); ++part) {
    std::size_t lit = 0;
    for (std::size_t lamp = 0; lamp < code_.lamps(); ++lamp) lit += this->lit(part, lamp) ? 1 : 0;
    shares_.push_back(static_cast<double>(lit) / static_cast<double>(code_.lamps()));
  }
}

bool FlashSequence::lit(std::size_t part, std::size_t lamp) const {
  const FlashPart& what = parts_[part];
  if (what.kind != FlashPart::Kind::bit) return what.kind == FlashPart::Kind::all;
  return code_.bit(lamp, what.bit) != what.complement;
}

Look lamp_white(const Rig& rig) {
  double share = 1;
  const double lamp_a = rig.currents.red_a + rig.currents.green_a + rig.currents.blue_a;
  for (const Supply& supply : rig.supplies) {
    double lamps = 0;
    double nodes = 0;
    for (const Node& node : rig.nodes) {
      if (node.supply != supply.name) continue;
      nodes += 1;
      lamps += static_cast<double>(node.channels.size());
    }
    const double all_a = lamps * lamp_a;
    if (all_a > 0) share = std::min(share, (supply.limit_a - nodes * rig.currents.node_a) / all_a);
  }
  Look look;
  look.colour = {255, 255, 255};
  look.brightness = static_cast<std::uint8_t>(std::clamp(std::floor(share * 255), 1.0, 255.0));
  return look;
}

controller::CueSchedule lit_schedule(const Rig& rig, const std::vector<FloorLamp>& lamps, const Look& look,
                                     const std::vector<LitLamps>& switches) {
  FL_CHECK(!switches.empty());
  const std::size_t row = rig.nodes.size() * static_cast<std::size_t>(kChannelsPerNode);
  std::vector<LookIndex> table(row * switches.size(), kDark);
  std::vector<controller::Switch> times;
  for (std::size_t k = 0; k < switches.size(); ++k) {
    times.push_back({kStart + switches[k].at, "commissioning", false, std::nullopt});
    for (const std::size_t lamp : switches[k].lamps) {
      const MarkerPlace place = lamps[lamp].place;
      table[k * row + place.node.at() * kChannelsPerNode + static_cast<std::size_t>(place.channel)] = kLit;
    }
  }
  Look dark;
  dark.brightness = 0;
  return {{dark, look}, std::move(times), rig.nodes.size(), std::move(table), kPlanByte, {}};
}

controller::CueSchedule flash_schedule(const Rig& rig, const std::vector<FloorLamp>& lamps,
                                       const FlashSequence& sequence, Duration step, const Look& look) {
  std::vector<LitLamps> switches;
  for (std::size_t part = 0; part < sequence.parts().size(); ++part) {
    LitLamps lit{sequence.parts()[part].begins * step, {}};
    for (std::size_t lamp = 0; lamp < lamps.size(); ++lamp) {
      if (sequence.lit(part, lamp)) lit.lamps.push_back(lamp);
    }
    switches.push_back(std::move(lit));
  }
  return lit_schedule(rig, lamps, look, switches);
}

Duration shortest_step(const Rig& rig, const std::vector<std::unique_ptr<drivers::Driver>>& drivers) {
  double longest_s = to_seconds(kLeastStep);
  for (std::size_t b = 0; b < rig.buses.size(); ++b) {
    const drivers::Driver& driver = *drivers[b];
    Duration needed = 2 * driver.latch_time();
    for (const Node& node : rig.nodes) {
      if (node.bus != BusIndex::of(b)) continue;
      needed += driver.preload_time(static_cast<int>(node.channels.size())) + driver.status_time();
    }
    const double beat = to_seconds(driver.heartbeat_time() + driver.node_heartbeats_time());
    const double left = 1 - controller::kBusReserve - beat / to_seconds(drivers::kHeartbeatPeriod);
    longest_s = std::max(longest_s, to_seconds(needed) / std::max(left, kLeastShare));
  }
  const auto units = static_cast<Duration::rep>(std::ceil(longest_s / to_seconds(kStepUnit) - 1e-9));
  return units * kStepUnit;
}

}  // namespace footlight::app
