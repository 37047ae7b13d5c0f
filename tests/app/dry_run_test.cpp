// SPDX-License-Identifier: Apache-2.0
#include "app/dry_run.hpp"

#include <sstream>
#include <tuple>
#include <utility>

#include <gtest/gtest.h>

#include "config/device_profile.hpp"
#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

using tests::lamps_everywhere;
using tests::random_show;
using tests::SmallShow;

const std::vector<BusKind> kAllKinds{BusKind::serial, BusKind::modbus_rtu, BusKind::can};

SmallShow small_show() {
  SmallShow small = random_show(16, 12, 60, 2, 4, 5);
  small.rig = lamps_everywhere(small.show.stage.grid, kAllKinds, 115'200, 16);
  return small;
}

DryRunReport report_of(const SmallShow& small, const std::string& faults, std::uint64_t seed) {
  DryRunOptions options;
  options.seed = seed;
  if (!faults.empty()) options.faults = sim::Faults::parse(faults).value();
  Result<DryRunReport> report = dry_run(small.show, small.plan, small.rig, options);
  EXPECT_TRUE(report.has_value()) << (report ? "" : report.error().message);
  return report ? std::move(report).value() : DryRunReport{};
}

std::string trouble(const DryRunReport& report) {
  std::ostringstream text;
  for (const CueReport& cue : report.cues) {
    text << "cue " << cue.number << ": " << cue.wrong << " wrong";
    for (const WrongMarker& marker : cue.first) {
      text << "; " << marker.node << ":" << marker.channel << " shows " << marker.shows << " for " << marker.should;
    }
    text << "\n";
  }
  for (const BusReport& bus : report.buses) {
    text << bus.name << " " << bus.kind << " use " << bus.utilisation << " deliveries " << bus.deliveries << " retries "
         << bus.retries << " misses " << bus.misses << " quarantines " << bus.quarantines << " boots " << bus.boots
         << " late latches " << bus.late_latches << " worst " << to_seconds(bus.worst_lateness) * 1e3 << " ms\n";
  }
  text << "right " << report.right_share << " late " << report.late << " wrong_s " << report.wrong_s << "\n";
  return text.str();
}

TEST(DryRun, WithoutFaultsEveryMarkerIsRightAndNothingIsSentAgain) {
  const DryRunReport report = report_of(small_show(), "", 1);
  EXPECT_EQ(report.wrong_final, 0U) << trouble(report);
  EXPECT_EQ(report.late, 0U) << trouble(report);
  EXPECT_EQ(report.retries, 0U) << trouble(report);
  EXPECT_GE(report.right_share, 0.999) << trouble(report);
  EXPECT_EQ(report.wrong, 0U) << trouble(report);
  EXPECT_EQ(report.wrong_s, 0) << trouble(report);
  for (const BusReport& bus : report.buses) {
    EXPECT_GT(bus.deliveries, 0U) << bus.name;
    EXPECT_EQ(bus.late_latches, 0U) << trouble(report);
  }
  EXPECT_EQ(report.cues.size(), 2U);
}

TEST(DryRun, EveryMarkerIsRightAtTheEndOfEveryCueThroughLossAndRestarts) {
  const SmallShow small = small_show();
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const DryRunReport report = report_of(small, "loss=5%,reboot=2", seed);
    EXPECT_EQ(report.wrong_final, 0U) << "seed " << seed << "\n" << trouble(report);
    EXPECT_EQ(report.wrong, 0U) << "seed " << seed << "\n" << trouble(report);
    EXPECT_GT(report.retries, 0U);
  }
}

// Its boot-up message and the NMT start that followed were lost: a CAN node waited a second for its next heartbeat.
TEST(DryRun, RegressionARestartedCanNodeIsStartedAgainWhenItsBootUpMessageIsLost) {
  SmallShow small = random_show(16, 12, 60, 3, 4, 9);
  small.rig = lamps_everywhere(small.show.stage.grid, kAllKinds, 115'200, 16);
  const DryRunReport report = report_of(small, "loss=5%,reboot=2", 32);
  EXPECT_EQ(report.wrong_final, 0U) << trouble(report);
}

Bus bus_with(const std::string& profile) {
  Bus bus;
  bus.name = profile;
  bus.bits_per_second = 115'200;
  const auto file = config::find_profile(profile, "/").value();
  Diagnostics diagnostics;
  if (profile.starts_with("dmx")) {
    bus.kind = BusKind::dmx;
    bus.url = "sim://dmx";
    bus.fixture = config::read_fixture(file, diagnostics);
  } else {
    bus.kind = BusKind::modbus_rtu;
    bus.url = "sim://rtu";
    bus.profile = config::read_profile(file, diagnostics);
  }
  return bus;
}

/// A slow show of few people on nodes of so many lamps of one kind.
SmallShow show_with(const std::string& profile, int channels, int slots) {
  SmallShow small = random_show(8, 6, 20, 2, 3, 5);
  small.rig = lamps_everywhere(small.show.stage.grid, {BusKind::modbus_rtu}, 115'200, channels);
  small.rig.buses[0] = bus_with(profile);
  int next = 1;
  for (Node& node : small.rig.nodes) {
    if (slots > 0) node.address = std::exchange(next, next + slots * static_cast<int>(node.channels.size()));
  }
  return small;
}

TEST(DryRun, LampsOfOtherPeoplesLanguagesAreRightAtTheEndOfEveryCue) {
  for (const auto& [profile, channels, slots] :
       std::vector<std::tuple<std::string, int, int>>{{"relay-16", 16, 0}, {"dmx-rgb", 24, 3}, {"dmx-dimmer", 24, 1}}) {
    const SmallShow small = show_with(profile, channels, slots);
    const DryRunReport quiet = report_of(small, "", 1);
    EXPECT_EQ(quiet.wrong_final, 0U) << profile << "\n" << trouble(quiet);
    EXPECT_EQ(quiet.late, 0U) << profile << "\n" << trouble(quiet);
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const DryRunReport report = report_of(small, "loss=5%", seed);
      EXPECT_EQ(report.wrong_final, 0U) << profile << " seed " << seed << "\n" << trouble(report);
    }
  }
}

TEST(DryRun, AShowOfMoreLooksThanADeviceKnowsIsRefused) {
  const SmallShow small = show_with("pick-light", 1, 0);
  const Result<DryRunReport> report = dry_run(small.show, small.plan, small.rig, {});
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().message.substr(0, 65),
            "bus \"pick-light\": its devices know 5 looks besides dark, and the ");
}

SmallShow show_on(BusKind kind) {
  SmallShow small = random_show(16, 12, 60, 2, 4, 5);
  small.rig = lamps_everywhere(small.show.stage.grid, {kind}, 115'200, 16);
  return small;
}

// Answers in quarantine were asked for a second apart while every second one was lost.
TEST(DryRun, RegressionASerialNodeThatIsMisheardOftenIsAskedAgainSoon) {
  const SmallShow small = show_on(BusKind::serial);
  const DryRunReport report = report_of(small, "loss=15%,reboot=3", 96);
  EXPECT_EQ(report.wrong_final, 0U) << trouble(report);
}

// The question about a quarantined node came after everything else on a busy line; time-outs took most of the wire.
TEST(DryRun, RegressionAMisheardModbusNodeIsAskedOnABusyLine) {
  const SmallShow small = show_on(BusKind::modbus_rtu);
  const DryRunReport report = report_of(small, "loss=15%,reboot=3", 191);
  EXPECT_EQ(report.wrong_final, 0U) << trouble(report);
}

// Answers after the time-out met the next request on the wire, and nobody understood either.
TEST(DryRun, RegressionLateSerialAnswersDoNotMeetTheNextRequest) {
  const SmallShow small = show_on(BusKind::serial);
  for (const std::uint64_t seed : {198, 199, 200}) {
    const DryRunReport report = report_of(small, "delay=20ms,duplicate=20%", seed);
    EXPECT_EQ(report.wrong_final, 0U) << trouble(report);
    EXPECT_EQ(report.late, 0U) << trouble(report);
  }
}

TEST(DryRun, EveryMarkerIsRightTwoRefreshPeriodsAfterTheLastFaultOnEveryBus) {
  for (const BusKind kind : {BusKind::serial, BusKind::modbus_rtu, BusKind::modbus_tcp, BusKind::can}) {
    const SmallShow small = show_on(kind);
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      for (const char* faults : {"loss=30%,reboot=4", "loss=30%,reboot=4,until=50%"}) {
        const DryRunReport report = report_of(small, faults, seed);
        EXPECT_EQ(report.wrong_after_recovery, 0U) << faults << " seed " << seed << "\n" << trouble(report);
        EXPECT_LT(report.right_share, 1) << "faults that change nothing prove nothing";
      }
    }
  }
}

TEST(DryRun, EveryMarkerIsRightAfterBusOffJamsAndUnpluggingOfCan) {
  const SmallShow small = show_on(BusKind::can);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const DryRunReport report = report_of(small, "loss=5%,bus-off=6,full=6,unplug=2,until=50%", seed);
    EXPECT_EQ(report.wrong_after_recovery, 0U) << "seed " << seed << "\n" << trouble(report);
    EXPECT_LT(report.right_share, 1) << "faults that change nothing prove nothing";
  }
}

TEST(DryRun, TheSameSeedGivesTheSameTraceByteForByte) {
  const SmallShow small = small_show();
  std::vector<std::string> traces;
  for (const std::uint64_t seed : {3, 3, 4}) {
    std::ostringstream trace;
    DryRunOptions options;
    options.seed = seed;
    options.faults = sim::Faults::parse("loss=5%,corrupt=2%,reboot=2").value();
    options.trace = &trace;
    ASSERT_TRUE(dry_run(small.show, small.plan, small.rig, options).has_value());
    traces.push_back(trace.str());
  }
  EXPECT_FALSE(traces[0].empty());
  EXPECT_EQ(traces[0], traces[1]);
  EXPECT_NE(traces[0], traces[2]);
}

// ---- output modules on a CANopen bus (CiA 401)

SmallShow show_on_modules() {
  SmallShow small = random_show(16, 12, 60, 2, 4, 5);
  small.rig = lamps_everywhere(small.show.stage.grid, {BusKind::can}, 500'000, 16);
  OutputModule module;
  module.name = "sixteen";
  module.outputs = 16;
  small.rig.buses[0].outputs = module;
  return small;
}

TEST(DryRun, OutputModulesAreConfiguredAndShowEverySwitch) {
  const DryRunReport report = report_of(show_on_modules(), "", 1);
  EXPECT_EQ(report.wrong_final, 0U) << trouble(report);
  EXPECT_EQ(report.late, 0U) << trouble(report);
  EXPECT_EQ(report.buses[0].late_latches, 0U) << trouble(report);
  EXPECT_TRUE(report.buses[0].complaints.empty());
  EXPECT_GE(report.right_share, 0.99) << trouble(report);
}

TEST(DryRun, AnOutputModuleThatRebootsIsConfiguredAgain) {
  const DryRunReport report = report_of(show_on_modules(), "reboot=2", 3);
  EXPECT_EQ(report.wrong_final, 0U) << trouble(report);
  EXPECT_EQ(report.wrong_after_recovery, 0U) << trouble(report);
}

TEST(DryRun, FaultsOnABusOfOutputModulesAreOverSoon) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const DryRunReport report = report_of(show_on_modules(), "loss=5%,corrupt=2%,bus-off=1,until=60%", seed);
    EXPECT_EQ(report.wrong_after_recovery, 0U) << trouble(report);
  }
}

// ---- supplies

TEST(DryRun, ASupplyThatDimsAndStaggersIsToldWithItsLoad) {
  SmallShow small = small_show();
  small.rig.currents = {0.02, 0.02, 0.02, 0.01};
  small.rig.supplies = {{"P1", 100, Supply::Overload::dim, milliseconds(20), {"rig.yaml", 3, 5}}};
  for (Node& node : small.rig.nodes) node.supply = "P1";
  const DryRunReport as_it_is = report_of(small, "", 1);
  ASSERT_EQ(as_it_is.supplies.size(), 1U);
  EXPECT_EQ(as_it_is.wrong_final, 0U) << trouble(as_it_is);
  EXPECT_EQ(as_it_is.supplies[0].nodes, 12);
  EXPECT_TRUE(as_it_is.supplies[0].dimmed.empty());
  const double peak_a = as_it_is.supplies[0].peak_a;
  ASSERT_GT(peak_a, 0.12) << "the nodes alone";
  const double room_a = std::max(as_it_is.supplies[0].unguided_a, 0.12 + (peak_a - 0.12) / 2);
  small.rig.supplies[0].limit_a = room_a;
  const DryRunReport dimmed = report_of(small, "", 1);
  EXPECT_EQ(dimmed.wrong_final, 0U) << trouble(dimmed);
  EXPECT_LE(dimmed.supplies.at(0).peak_a, room_a + 1e-9);
  EXPECT_EQ(dimmed.supplies[0].dimmed.empty(), room_a >= peak_a);
}

TEST(DryRun, AnOverloadedSupplyIsRefusedBeforeAnythingIsLit) {
  SmallShow small = small_show();
  small.rig.file = "rig.yaml";
  small.rig.currents = {0.5, 0.5, 0.5, 0.01};
  small.rig.supplies = {{"P1", 40, Supply::Overload::refuse, {}, {"rig.yaml", 3, 5}}};
  for (Node& node : small.rig.nodes) node.supply = "P1";
  const auto report = dry_run(small.show, small.plan, small.rig, {});
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().kind, ErrorKind::refused);
  EXPECT_EQ(report.error().message.rfind("rig.yaml:3:5: error: supplies[0]: the supply \"P1\" ", 0), 0U)
      << report.error().message;
}

}  // namespace
}  // namespace footlight::app
