// SPDX-License-Identifier: Apache-2.0
// The CANopen language through the kernel: our driver on one interface, simulated markers on another of the same bus,
// and can-utils beside them.
#include <algorithm>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "core/clock.hpp"
#include "drivers/registry.hpp"
#include "sim/endpoints/served_rig.hpp"
#include "tests/hardware/guest.hpp"

namespace footlight::hardware {
namespace {

using drivers::DeviceEvent;
using drivers::SendStatus;
using drivers::ServiceAnswer;

constexpr int kNodes = 3;

class EventLog final : public drivers::EventSink {
 public:
  void on_event(const DeviceEvent& event) override { events.push_back(event); }
  void on_answer(const ServiceAnswer& answer) override { answers.push_back(answer); }
  [[nodiscard]] int count(DeviceEvent::Kind kind) const {
    const auto same = [&](const DeviceEvent& event) { return event.kind == kind; };
    return static_cast<int>(std::count_if(events.begin(), events.end(), same));
  }

  std::vector<DeviceEvent> events;
  std::vector<ServiceAnswer> answers;
};

Rig rig_on(const std::string& interface) {
  Rig rig;
  rig.buses.push_back({"floor", BusKind::can, "can://" + interface, 500'000, std::nullopt, {}});
  for (int i = 1; i <= kNodes; ++i) {
    rig.nodes.push_back({"n" + std::to_string(i), BusIndex(0), i, std::vector<Channel>(32), {}});
  }
  return rig;
}

/// A driver on one interface and the markers on another, or on the same virtual one.
struct Floor {
  Floor(const std::string& here, const std::string& there) : rig(rig_on(here)) {
    sim::Serving serving;
    serving.folder = "/tmp/endpoints";
    serving.can["floor"] = there;
    auto opened = sim::ServedRig::open(rig, serving, clock, nullptr);
    EXPECT_TRUE(opened) << opened.error().message;
    served = std::move(opened).value();
    nodes = drivers::node_addresses(rig, BusIndex(0));
    auto opened_port = drivers::open_port(rig.buses[0], nodes);
    EXPECT_TRUE(opened_port) << opened_port.error().message;
    port = std::move(opened_port).value();
    driver = drivers::make_driver(rig.buses[0], nodes, 0, drivers::reference(port)).value();
  }
  bool until(const std::function<bool()>& condition) {
    return eventually([&] {
      driver->step(clock.now(), log);
      served->step(milliseconds(1), [](Instant) {});
      return condition();
    });
  }
  /// Preloads the look on every channel of every node and latches it.
  void show(LookIndex look, drivers::Sequence sequence) {
    const std::vector<LookIndex> looks(32, look);
    for (const auto& node : nodes) {
      EXPECT_TRUE(until([&] { return driver->preload(node, sequence, looks, clock.now()) == SendStatus::accepted; }));
    }
    EXPECT_TRUE(until([&] { return driver->latch(sequence, clock.now()) == SendStatus::accepted; }));
    EXPECT_TRUE(until([&] { return shows_everywhere(look); }));
  }
  [[nodiscard]] bool shows_everywhere(LookIndex look) const {
    for (std::uint32_t node = 0; node < kNodes; ++node) {
      for (int channel = 0; channel < 32; ++channel) {
        if (served->rig().shown(NodeIndex(node), channel) != look) return false;
      }
    }
    return true;
  }
  void start() {
    EXPECT_TRUE(until([&] { return driver->start(clock.now()) == SendStatus::accepted; }));
    EXPECT_TRUE(until([&] { return driver->ready(); }));
  }

  SteadyClock clock;
  Rig rig;
  std::unique_ptr<sim::ServedRig> served;
  std::vector<drivers::NodeAddress> nodes;
  drivers::Port port;
  std::unique_ptr<drivers::Driver> driver;
  EventLog log;
};

class CanopenOnControllers : public ::testing::Test {
 protected:
  CanopenOnControllers() {
    for (const char* name : {"can0", "can1"}) {
      run(std::string("ip link set ") + name + " down; ip link set " + name + " txqueuelen 10; ip link set " + name +
          " up type can bitrate 500000 restart-ms 100");
    }
  }
};

TEST_F(CanopenOnControllers, MarkersShowWhatIsPreloadedAndLatchedAndProveIt) {
  Floor floor("can0", "can1");
  floor.start();
  floor.show(7, 1);
  floor.show(9, 2);
  const std::vector<LookIndex> nines(32, 9);
  ASSERT_TRUE(floor.until([&] { return floor.log.count(DeviceEvent::Kind::showing) >= 2 * kNodes; }));
  const DeviceEvent& last = floor.log.events.back();
  EXPECT_EQ(last.kind, DeviceEvent::Kind::showing);
  EXPECT_EQ(last.sequence, 2);
  EXPECT_EQ(last.crc, drivers::looks_crc(nines));
  EXPECT_EQ(floor.log.count(DeviceEvent::Kind::bus_down), 0);
}

TEST_F(CanopenOnControllers, SdoTellsWhoTheyAre) {
  Floor floor("can0", "can1");
  ASSERT_EQ(floor.driver->probe(2, 0, floor.clock.now()), SendStatus::accepted);
  ASSERT_TRUE(floor.until([&] { return !floor.log.answers.empty(); }));
  const ServiceAnswer& answer = floor.log.answers.front();
  EXPECT_EQ(answer.kind, ServiceAnswer::Kind::found);
  EXPECT_EQ(answer.identity.model, "Footlight marker");
  EXPECT_EQ(answer.identity.channels, 32);
  EXPECT_TRUE(answer.identity.unique_id.has_value());
}

TEST_F(CanopenOnControllers, CandumpSeesTheFramesOfTheDocument) {
  run("stdbuf -oL candump -L can0 >candump.log & echo $! >candump.pid");
  ASSERT_TRUE(eventually([] { return run("cat /proc/net/can/rcvlist_all").find("  can0 ") != std::string::npos; }));
  Floor floor("can0", "can1");
  floor.start();
  floor.show(7, 1);
  const auto dump = [] {
    std::stringstream log;
    log << std::ifstream("candump.log").rdbuf();
    return log.str();
  };
  for (const std::string frame : {"can0 000#0100", "can0 201#0707070707070707", "can0 503#0707070707070707",
                                  "can0 080#01", "can0 181#01", "can0 182#01", "can0 183#01"}) {
    EXPECT_TRUE(floor.until([&] { return dump().find(frame) != std::string::npos; })) << frame << "\n" << dump();
  }
  run("kill $(cat candump.pid)");
}

TEST_F(CanopenOnControllers, CansendSpeaksToAMarkerByHand) {
  Floor floor("can0", "can1");
  run("cansend can0 000#0101");              // NMT start of node 1
  run("cansend can0 201#0A0A0A0A0A0A0A0A");  // RPDO1
  run("cansend can0 080#05");                // SYNC
  EXPECT_TRUE(floor.until([&] { return floor.served->rig().shown(NodeIndex(0), 7) == 10; }));
  EXPECT_EQ(floor.served->rig().shown(NodeIndex(1), 7), kNoGuidance) << "node 2 has not been started";
}

class CanopenOnVcan : public ::testing::Test {
 protected:
  CanopenOnVcan() { run("ip link add vcan0 type vcan && ip link set vcan0 up"); }
  ~CanopenOnVcan() override { run("ip link del vcan0"); }
};

TEST_F(CanopenOnVcan, BusOffIsToldAndAfterTheRestartTheFloorIsLitAgain) {
  Floor floor("vcan0", "vcan0");
  floor.start();
  floor.show(7, 1);
  run("cansend vcan0 20000040#0000000000000000");
  ASSERT_TRUE(floor.until([&] { return floor.log.count(DeviceEvent::Kind::bus_down) == 1; }));
  EXPECT_EQ(floor.driver->latch(2, floor.clock.now()), SendStatus::down);
  run("cansend vcan0 20000100#0000000000000000");
  ASSERT_TRUE(floor.until([&] { return floor.log.count(DeviceEvent::Kind::bus_up) == 1; }));
  floor.show(9, 2);
}

TEST_F(CanopenOnVcan, AnInterfaceThatGoesDownAndComesBackIsToldAndUsedAgain) {
  Floor floor("vcan0", "vcan0");
  floor.start();
  floor.show(7, 1);
  run("ip link set vcan0 down");
  ASSERT_TRUE(floor.until([&] { return floor.log.count(DeviceEvent::Kind::bus_down) == 1; }));
  run("ip link set vcan0 up");
  ASSERT_TRUE(floor.until([&] { return floor.log.count(DeviceEvent::Kind::bus_up) == 1; }));
  floor.show(9, 2);
}

}  // namespace
}  // namespace footlight::hardware
