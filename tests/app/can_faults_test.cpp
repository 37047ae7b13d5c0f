// SPDX-License-Identifier: Apache-2.0
// What is promised of CAN when its wire fails: seen within 100 ms, the whole state again within a second, no look of
// another moment meanwhile. The bus loop and the real driver on the simulated bus, in virtual time.
#include <algorithm>

#include <gtest/gtest.h>

#include "controller/bus_loop.hpp"
#include "drivers/registry.hpp"
#include "sim/simulated_rig.hpp"

namespace footlight::app {
namespace {

using controller::BusLoop;
using controller::BusTarget;
using controller::CueSchedule;
using controller::Switch;
using sim::LineFault;

constexpr std::size_t kNodes = 40;
constexpr Duration kBeat = milliseconds(2000);
constexpr std::size_t kSwitches = 8;

Rig rig_of_forty_nodes() {
  Rig rig;
  rig.buses.push_back({"floor", BusKind::can, "sim://can", 500'000, std::nullopt, {}});
  for (std::size_t i = 1; i <= kNodes; ++i) {
    const auto address = static_cast<int>(i);
    rig.nodes.push_back({"n" + std::to_string(i), BusIndex(0), address, std::vector<Channel>(kChannelsPerNode), {}});
  }
  return rig;
}

/// Every lamp changes at each switch.
LookIndex planned(std::size_t k, std::size_t node) { return static_cast<LookIndex>(1 + (k + node) % 20); }

CueSchedule schedule() {
  std::vector<Look> looks{{{0, 0, 0}, Effect::steady, 0}};
  for (int i = 1; i <= 20; ++i) looks.push_back({{static_cast<std::uint8_t>(i), 0, 0}, Effect::steady, 255});
  std::vector<Switch> switches;
  std::vector<LookIndex> table;
  for (std::size_t k = 0; k < kSwitches; ++k) {
    switches.push_back({kStart + static_cast<Duration::rep>(k + 1) * kBeat, "switch", false, std::nullopt});
    for (std::size_t n = 0; n < kNodes; ++n) table.insert(table.end(), kChannelsPerNode, planned(k, n));
  }
  return CueSchedule(std::move(looks), std::move(switches), kNodes, std::move(table), 0, {});
}

/// Forty nodes, the real driver and the real loop in virtual time.
class Floor {
 public:
  Floor() : rig_(rig_of_forty_nodes()), simulated_(rig_, {}, 1, clock_, nullptr) {
    nodes_ = drivers::node_addresses(rig_, BusIndex(0));
    driver_ = drivers::make_driver(rig_.buses[0], nodes_, 0, &simulated_.can(BusIndex(0))).value();
    loop_ = std::make_unique<BusLoop>(schedule_, nodes_, *driver_);
  }

  void run_until(Instant end) {
    while (clock_.now() < end) {
      const Instant wish = std::max(loop_->step(clock_.now(), target()), clock_.now() + Duration(1));
      simulated_.advance_to(std::min({wish, simulated_.next_event(), end}));
      watch();
    }
  }
  void strike(LineFault fault) { ASSERT_TRUE(simulated_.strike(BusIndex(0), fault)); }
  [[nodiscard]] Instant now() const { return clock_.now(); }
  [[nodiscard]] bool all_right() const { return right_; }
  /// Lamps seen with a look that is neither planned nor the one before nor NO-GUIDANCE.
  [[nodiscard]] int wrong() const { return wrong_; }

 private:
  [[nodiscard]] std::size_t current() const {
    const auto beats = static_cast<std::size_t>(std::max<Duration::rep>(0, (clock_.now() - kStart) / kBeat));
    return std::min(beats == 0 ? 0 : beats - 1, kSwitches - 1);
  }
  [[nodiscard]] BusTarget target() const {
    BusTarget target;
    target.current = current();
    target.next = std::min(target.current + 1, kSwitches - 1);
    if (target.next != target.current) target.next_at = schedule_.switches()[target.next].time;
    return target;
  }
  void watch() {
    const std::size_t k = current();
    // The latch is sent so that at worst stuffing its last bit comes at the moment: mostly it comes a little sooner.
    const std::size_t soon =
        k + 1 < kSwitches && clock_.now() + milliseconds(1) >= schedule_.switches()[k + 1].time ? k + 1 : k;
    bool right = true;
    for (std::size_t n = 0; n < kNodes; ++n) {
      const LookIndex shown = simulated_.shown(NodeIndex::of(n), 31);
      const bool is_planned = shown == planned(k, n) || shown == planned(soon, n);
      const bool is_before = k > 0 && shown == planned(k - 1, n);
      right = right && is_planned;
      if (!is_planned && !is_before && shown != kNoGuidance) ++wrong_;
    }
    right_ = right;
  }

  ManualClock clock_;
  Rig rig_;
  CueSchedule schedule_ = schedule();
  sim::SimulatedRig simulated_;
  std::vector<drivers::NodeAddress> nodes_;
  std::unique_ptr<drivers::Driver> driver_;
  std::unique_ptr<BusLoop> loop_;
  bool right_ = false;
  int wrong_ = 0;
};

std::string name_of(LineFault fault) {
  switch (fault) {
    case LineFault::bus_off:
      return "bus_off";
    case LineFault::full:
      return "full";
    case LineFault::unplug:
      return "unplug";
  }
  return {};
}

struct Promise {
  LineFault fault;
  Duration lasts;  ///< at most
};

class CanFault : public ::testing::TestWithParam<Promise> {};

/// Struck at many instants around a switch: during its preloads, at its latch, in its verification, in idle time.
TEST_P(CanFault, TheWholeStateIsThereAgainASecondAfterItsEndAndNoLampIsWrongMeanwhile) {
  for (Duration offset = milliseconds(-600); offset <= milliseconds(200); offset += milliseconds(25)) {
    Floor floor;
    const Instant struck = kStart + 3 * kBeat + offset;
    floor.run_until(struck);
    ASSERT_GT(floor.now(), kStart);
    floor.strike(GetParam().fault);
    floor.run_until(struck + GetParam().lasts + seconds(1));
    EXPECT_TRUE(floor.all_right()) << "struck at " << offset.count() / 1'000'000 << " ms";
    floor.run_until(kStart + kSwitches * kBeat);
    EXPECT_TRUE(floor.all_right()) << "struck at " << offset.count() / 1'000'000 << " ms";
    EXPECT_EQ(floor.wrong(), 0) << "struck at " << offset.count() / 1'000'000 << " ms";
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, CanFault,
                         ::testing::Values(Promise{LineFault::bus_off, milliseconds(0)},
                                           Promise{LineFault::full, milliseconds(500)},
                                           Promise{LineFault::unplug, milliseconds(1000)}),
                         [](const auto& promise) { return name_of(promise.param.fault); });

/// Notes when the bus is told down.
class Listener final : public drivers::EventSink {
 public:
  void on_event(const drivers::DeviceEvent& event) override {
    if (event.kind == drivers::DeviceEvent::Kind::bus_down && !down) down = now;
  }
  Instant now = kStart;
  std::optional<Instant> down;
};

TEST(CanFaults, AreSeenWithin100Milliseconds) {
  for (const LineFault fault : {LineFault::bus_off, LineFault::full, LineFault::unplug}) {
    const Rig rig = rig_of_forty_nodes();
    int seen = 0;
    for (int millisecond = 0; millisecond < 250; millisecond += 7) {
      ManualClock clock;
      sim::SimulatedRig simulated(rig, {}, static_cast<std::uint64_t>(millisecond + 1), clock, nullptr);
      const auto driver =
          drivers::make_driver(rig.buses[0], drivers::node_addresses(rig, BusIndex(0)), 0, &simulated.can(BusIndex(0)))
              .value();
      Listener listener;
      const auto run_until = [&](Instant end) {
        while (clock.now() < end) {
          listener.now = clock.now();
          const Instant wish = std::max(driver->step(clock.now(), listener), clock.now() + Duration(1));
          simulated.advance_to(std::min({wish, simulated.next_event(), end}));
        }
      };
      const Instant struck = kStart + seconds(1) + milliseconds(millisecond);
      run_until(struck);
      simulated.strike(BusIndex(0), fault);
      driver->heartbeat({}, clock.now());  // a wire on which nothing is sent cannot be known to be dead
      run_until(struck + milliseconds(400));
      // A queue that is full for less than 70 ms is no more than a busy bus.
      if (fault != LineFault::full) {
        ASSERT_TRUE(listener.down) << millisecond;
      }
      if (!listener.down) continue;
      ++seen;
      EXPECT_LE(*listener.down - struck, milliseconds(100));
    }
    EXPECT_GT(seen, 30);
  }
}

}  // namespace
}  // namespace footlight::app
