// SPDX-License-Identifier: Apache-2.0
// What nodes keep of plan and patch, asked over every wire: the real drivers on the simulated markers.
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "controller/bus_loop.hpp"
#include "core/clock.hpp"
#include "core/patch.hpp"
#include "drivers/registry.hpp"
#include "sim/simulated_rig.hpp"

namespace footlight {
namespace {

using controller::BusLoop;
using Keeps = BusLoop::Keeps;

constexpr int kNodes = 4;
constexpr std::size_t kChannels = 6;

Rig rig_of(BusKind kind) {
  Rig rig;
  rig.buses.push_back({"b", kind, "sim://b", kind == BusKind::can ? 500'000 : 115'200, std::nullopt, {}});
  if (kind == BusKind::dmx) rig.buses[0].fixture = DmxFixture{"rgb", {DmxSlot::red, DmxSlot::green, DmxSlot::blue}};
  for (int i = 1; i <= kNodes; ++i) {
    std::vector<Channel> channels;
    for (std::size_t c = 0; c < kChannels; ++c) {
      channels.push_back({Channel::Kind::cell, CellIndex::of(static_cast<std::size_t>(i) * 100 + c), {}});
    }
    const int address = kind == BusKind::dmx ? 1 + (i - 1) * 18 : i;
    rig.nodes.push_back({"n" + std::to_string(i), BusIndex(0), address, std::move(channels), {}});
  }
  return rig;
}

controller::CueSchedule schedule_of(const Rig& rig) {
  std::vector<Look> looks(2, Look{{9, 9, 9}, Effect::steady, 255});
  std::vector<LookIndex> table(rig.nodes.size() * kChannelsPerNode, LookIndex{1});
  controller::CueSchedule schedule(std::move(looks), {{kStart, "first", false, std::nullopt}}, rig.nodes.size(),
                                   std::move(table), 0xA3, {});
  controller::WantedChecks checks{0x89ABCDEF};
  for (const Node& node : rig.nodes) checks.patches.push_back(patch_check(node));
  schedule.set_checks(std::move(checks));
  return schedule;
}

drivers::PortReference port_of(sim::SimulatedRig& simulated, BusKind kind) {
  const BusIndex bus(0);
  if (kind == BusKind::can) return &simulated.can(bus);
  if (kind == BusKind::modbus_rtu || kind == BusKind::modbus_tcp) return &simulated.modbus(bus);
  return &simulated.serial(bus);
}

/// A show of one picture that stands, on markers that were commissioned for `wired`.
std::vector<Keeps> told(const Rig& wired, const Rig& rig, const std::string& faults) {
  const BusKind kind = rig.buses[0].kind;
  ManualClock clock;
  sim::Faults wrong;
  if (!faults.empty()) wrong = sim::Faults::parse(faults).value();
  sim::SimulatedRig simulated(wired, wrong, 3, clock, nullptr);
  auto driver =
      drivers::make_driver(rig.buses[0], drivers::node_addresses(rig, BusIndex(0)), 0xA3, port_of(simulated, kind));
  EXPECT_TRUE(driver) << driver.error().message;
  const controller::CueSchedule schedule = schedule_of(rig);
  BusLoop loop(schedule, drivers::node_addresses(rig, BusIndex(0)), **driver);
  const Instant end = clock.now() + seconds(8);
  while (clock.now() < end) {
    const Instant now = clock.now();
    const Instant wish = std::min(loop.step(now, {}), now + milliseconds(20));
    simulated.advance_to(std::max(now + microseconds(100), std::min(wish, simulated.next_event())));
  }
  EXPECT_EQ(loop.keeps_checks(), kind != BusKind::dmx);
  if (faults.empty()) {
    EXPECT_EQ(loop.counters().quarantines, 0U);
  }
  EXPECT_TRUE(loop.settled());
  std::vector<Keeps> out;
  for (std::size_t n = 0; n < loop.nodes(); ++n) out.push_back(loop.standing(n).keeps);
  return out;
}

class KeptChecks : public ::testing::TestWithParam<BusKind> {};

INSTANTIATE_TEST_SUITE_P(Wires, KeptChecks,
                         ::testing::Values(BusKind::serial, BusKind::modbus_rtu, BusKind::modbus_tcp, BusKind::can),
                         [](const auto& kind) {
                           std::string name(to_text(kind.param));
                           std::erase(name, '-');
                           return name;
                         });

TEST_P(KeptChecks, OfNodesThatWereCommissionedForThisRigAreTheSame) {
  const Rig rig = rig_of(GetParam());
  EXPECT_EQ(told(rig, rig, ""), std::vector<Keeps>(kNodes, Keeps::same));
  EXPECT_EQ(told(rig, rig, "loss=5%,duplicate=2%"), std::vector<Keeps>(kNodes, Keeps::same)) << "on a bad line, too";
}

TEST_P(KeptChecks, OfNodesWhosePatchIsAnotherAreOthers) {
  const Rig rig = rig_of(GetParam());
  Rig wired = rig;
  std::swap(wired.nodes[0].channels, wired.nodes[2].channels);  // exchanged
  std::swap(wired.nodes[3].channels[0], wired.nodes[3].channels[1]);
  EXPECT_EQ(told(wired, rig, ""),
            (std::vector{Keeps::other_patch, Keeps::same, Keeps::other_patch, Keeps::other_patch}));
}

TEST(KeptChecksOnDmx, LampsKeepNothing) {
  const Rig rig = rig_of(BusKind::dmx);
  EXPECT_EQ(told(rig, rig, ""), std::vector<Keeps>(kNodes, Keeps::unknown));
}

}  // namespace
}  // namespace footlight
