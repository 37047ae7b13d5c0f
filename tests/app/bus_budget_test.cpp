// SPDX-License-Identifier: Apache-2.0
//
// The arithmetic by which a show is refused, against the simulated wires on which it is played.
#include "controller/bus_budget.hpp"

#include <gtest/gtest.h>

#include "app/dry_run.hpp"
#include "app/simulated_buses.hpp"
#include "controller/cue_list.hpp"
#include "drivers/registry.hpp"
#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

using controller::BusNeed;
using tests::lamps_everywhere;
using tests::random_show;
using tests::SmallShow;

/// Walks of two seconds, at a bit rate at which most of the time goes into bits and not into turnarounds.
SmallShow slow_show(BusKind kind, int bits_per_second, int walk_stretch = 1) {
  SmallShow small = random_show(8, 6, 20, 2, 3, 5);
  small.rig = lamps_everywhere(small.show.stage.grid, {kind}, bits_per_second, 16);
  for (Bus& bus : small.rig.buses) bus.bits_per_second = bits_per_second;
  for (auto& track : small.plan.tracks) {
    for (Mark& mark : track) mark.time = kStart + walk_stretch * (mark.time - kStart);
  }
  for (PlanSection& section : small.plan.sections) {
    section.start = kStart + walk_stretch * (section.start - kStart);
    section.end = kStart + walk_stretch * (section.end - kStart);
  }
  return small;
}

/// Takes nothing from what the wire tells.
struct Deaf final : drivers::EventSink {
  void on_event(const drivers::DeviceEvent& /*event*/) override {}
};

/// One driver on one simulated bus, given one operation after the other.
class Wire {
 public:
  explicit Wire(const SmallShow& small)
      : simulated_(small.rig, {}, 1, clock_, nullptr),
        drivers_(drivers_on(simulated_, small.rig, small.plan).value()),
        schedule_(controller::build_schedule(small.show, small.plan, small.rig, drivers_).value()),
        nodes_(drivers::node_addresses(small.rig, BusIndex(0))) {
    const std::vector<Duration> gaps(small.show.cues.size(), controller::kShortestHold);
    needs_ = controller::bus_needs(schedule_, small.rig, drivers_, gaps);
    run([&] { return driver().start(clock_.now()); });
  }

  [[nodiscard]] const std::vector<BusNeed>& needs() const { return needs_; }

  /// What the bus loop has to send from one switch to the next. @return time that it takes, back to back
  Duration play(const BusNeed& need) {
    const Instant start = clock_.now();
    const Duration before = spent();
    const bool pushes = driver().capabilities().pushes_status;
    int asked = 0;
    for (const auto& node : nodes_) {
      if (!pushes && asked < need.verified && changes(need.k - 1, node)) {
        ++asked;
        run([&] { return driver().ask(node, clock_.now()); });
      }
    }
    for (int i = 0; i < need.heartbeats; ++i) run([&] { return driver().heartbeat({}, clock_.now()); });
    for (const auto& node : nodes_) {
      if (!changes(need.k, node)) continue;
      const auto looks = schedule_.looks_of(need.k, node.node).first(node.channels);
      run([&] { return driver().preload(node, controller::sequence_of(need.k), looks, clock_.now()); });
    }
    for (int i = 0; i < need.latches; ++i) {
      run([&] { return driver().latch(controller::sequence_of(need.k), clock_.now()); });
    }
    // Answers and the nodes' heartbeats come by themselves.
    while (pushes && clock_.now() < start + need.available) step(start + need.available);
    return spent() - before;
  }

 private:
  drivers::Driver& driver() { return *drivers_[0]; }
  [[nodiscard]] bool changes(std::size_t k, const drivers::NodeAddress& node) const {
    return !std::ranges::equal(schedule_.looks_of(k - 1, node.node), schedule_.looks_of(k, node.node));
  }
  /// Where frames wait in a queue, the wire's own time; else turnarounds and silences, too.
  [[nodiscard]] Duration spent() {
    return driver().capabilities().pushes_status ? simulated_.use(BusIndex(0)).busy : clock_.now() - kStart;
  }
  template <class Operation>
  void run(Operation operation) {
    while (operation() == drivers::SendStatus::busy) step(kNever);
    Instant wish = driver().step(clock_.now(), deaf_);
    while (!driver().ready()) wish = step(wish);
  }
  Instant step(Instant end) {
    simulated_.advance_to(std::max(std::min(simulated_.next_event(), end), clock_.now() + Duration(1)));
    return driver().step(clock_.now(), deaf_);
  }

  ManualClock clock_;
  sim::SimulatedRig simulated_;
  std::vector<std::unique_ptr<drivers::Driver>> drivers_;
  controller::CueSchedule schedule_;
  std::vector<drivers::NodeAddress> nodes_;
  std::vector<BusNeed> needs_;
  Deaf deaf_;
};

/// @param most the budget may be so much larger than what the wire took
void expect_agreement(BusKind kind, int bits_per_second, double most) {
  const SmallShow small = slow_show(kind, bits_per_second, 2);
  Wire wire(small);
  Duration needed{};
  Duration took{};
  for (const BusNeed& need : wire.needs()) {
    if (need.changed == 0) continue;
    needed += need.needed();
    took += wire.play(need);
  }
  ASSERT_GT(took, Duration{});
  const double ratio = to_seconds(needed) / to_seconds(took);
  ::testing::Test::RecordProperty("ratio", std::to_string(ratio));
  EXPECT_GE(ratio, 1.0) << to_text(kind) << ": the budget is too small";
  EXPECT_LE(ratio, most) << to_text(kind) << ": the budget is too large";
}

TEST(BusBudget, AgreesWithWhatTheSimulatedSerialLineMeasures) { expect_agreement(BusKind::serial, 9600, 1.03); }
TEST(BusBudget, AgreesWithWhatTheSimulatedModbusLineMeasures) { expect_agreement(BusKind::modbus_rtu, 9600, 1.05); }
// A CAN frame has as many stuff bits as its content wants, and the budget takes the most.
TEST(BusBudget, AgreesWithWhatTheSimulatedCanBusMeasures) { expect_agreement(BusKind::can, 50'000, 1.12); }

struct Rates {
  BusKind kind;
  std::vector<int> bits_per_second;
};

// Heartbeats took more than half of a line of 1,200 Bd, the look table was not there at the opening, and nothing of it
// was in the budget.
TEST(BusBudget, RegressionASlowBusThatIsAcceptedIsNeverLate) {
  for (const Rates& rates : {Rates{BusKind::serial, {1200, 1800, 2400, 3600, 4800, 9600}},
                             Rates{BusKind::modbus_rtu, {1200, 1800, 2400, 3600, 4800, 9600}},
                             Rates{BusKind::can, {10'000, 12'000, 16'000, 20'000, 50'000}}}) {
    for (const int stretch : {1, 3, 6}) {
      int accepted = 0;
      for (const int rate : rates.bits_per_second) {
        const SmallShow small = slow_show(rates.kind, rate, stretch);
        const auto report = dry_run(small.show, small.plan, small.rig, {});
        if (!report) {
          EXPECT_EQ(report.error().kind, ErrorKind::refused) << report.error().message;
          continue;
        }
        ++accepted;
        const std::string where = std::string(to_text(rates.kind)) + " " + std::to_string(rate) + " bit/s";
        EXPECT_EQ(report->wrong_final, 0U) << where;
        EXPECT_EQ(report->late, 0U) << where;
        EXPECT_EQ(report->retries, 0U) << where;
        EXPECT_EQ(report->buses[0].late_latches, 0U) << where;
        EXPECT_GT(report->right_share, 0.999) << where;
      }
      EXPECT_GT(accepted, 0) << to_text(rates.kind) << " x" << stretch;
    }
  }
}

TEST(BusBudget, OfAShowThatIsCheckedHasTheFramesByWhichARunLeads) {
  for (const BusKind kind : {BusKind::serial, BusKind::modbus_rtu}) {
    const SmallShow small = slow_show(kind, 19'200, 4);
    Wire wire(small);
    std::vector<BusNeed> checked;
    const auto look = [&](const SimulatedSchedule& built) {
      const std::vector<Duration> gaps(small.show.cues.size(), controller::kShortestHold);
      checked = controller::bus_needs(built.schedule, built.wires, built.drivers, gaps);
    };
    const auto built = with_schedule(small.show, small.plan, small.rig, look);
    ASSERT_TRUE(built) << built.error().message;
    ASSERT_EQ(checked.size(), wire.needs().size());
    for (std::size_t i = 0; i < checked.size(); ++i) {
      const BusNeed& plain = wire.needs()[i];
      EXPECT_EQ(checked[i].heartbeats, plain.heartbeats);
      EXPECT_EQ(checked[i].preloads, plain.preloads);
      if (plain.heartbeats > 0) {
        EXPECT_GT(checked[i].beating, plain.beating) << "LEAD goes with heartbeats";
      }
    }
  }
}

}  // namespace
}  // namespace footlight::app
