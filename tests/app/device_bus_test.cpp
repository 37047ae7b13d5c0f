// SPDX-License-Identifier: Apache-2.0
// What a technician does, with the real drivers on simulated buses.
#include <algorithm>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "app/simulated_buses.hpp"
#include "config/device_profile.hpp"
#include "controller/bus_service.hpp"
#include "core/clock.hpp"
#include "drivers/registry.hpp"
#include "sim/simulated_rig.hpp"

namespace footlight::app {
namespace {

using controller::BusService;
using controller::FoundNode;
using Kind = FoundNode::Kind;

struct Place {
  int address;
  bool in_rig = true;
};

/// A bus with devices at these addresses, of which the rig knows some.
class Bench {
 public:
  Bench(BusKind kind, const std::vector<Place>& places, const std::string& faults = "", std::uint64_t seed = 1,
        const std::string& profile = "footlight-marker") {
    Bus bus;
    bus.name = "front";
    bus.kind = kind;
    bus.url = "sim://" + std::string(to_text(kind));
    if (kind == BusKind::modbus_rtu || kind == BusKind::modbus_tcp) {
      Diagnostics diagnostics;
      bus.profile = config::read_profile(config::find_profile(profile, "/").value(), diagnostics);
    }
    rig_.buses.push_back(bus);
    for (std::size_t i = 0; i < places.size(); ++i) {
      Node node;
      node.name = "n" + std::to_string(i + 1);
      node.bus = BusIndex(0);
      node.address = places[i].address;
      node.channels.resize(4);
      rig_.nodes.push_back(node);
      if (places[i].in_rig) {
        nodes_.push_back({NodeIndex::of(i), static_cast<std::uint16_t>(places[i].address), 4});
      }
    }
    const sim::Faults wrong = faults.empty() ? sim::Faults{} : sim::Faults::parse(faults).value();
    simulated_ = std::make_unique<sim::SimulatedRig>(rig_, wrong, seed, clock_, nullptr);
    auto made = drivers::make_driver(rig_.buses[0], nodes_, 0, port_of(*simulated_, rig_, BusIndex(0)));
    EXPECT_TRUE(made) << (made ? "" : made.error().message);
    driver_ = std::move(made).value();
    service.emplace(*driver_, nodes_);
  }

  /// Until the task is over. @return what failed, or nothing
  std::string run() {
    const Instant end = clock_.now() + seconds(600);
    while (!service->finished() && clock_.now() < end) {
      const Instant wish = service->step(clock_.now());
      if (service->finished()) break;
      simulated_->advance_to(
          std::max(clock_.now(), std::min({wish, simulated_->next_event(), clock_.now() + seconds(1)})));
    }
    EXPECT_TRUE(service->finished()) << "a task has an end";
    return service->failure() ? service->failure()->message : "";
  }
  [[nodiscard]] const FoundNode* at(int address) const {
    for (const FoundNode& found : service->found()) {
      if (found.address == address) return &found;
    }
    return nullptr;
  }
  [[nodiscard]] Kind kind_at(int address) const {
    const FoundNode* found = at(address);
    EXPECT_NE(found, nullptr) << address;
    return found == nullptr ? Kind::ghost : found->kind;
  }
  [[nodiscard]] std::string list() const {
    std::string text;
    for (const FoundNode& found : service->found()) {
      text += std::to_string(found.address) + " is " + std::string(to_text(found.kind)) + ": heard " +
              std::to_string(found.heard) + ", garbled " + std::to_string(found.garbled) + " of " +
              std::to_string(found.rounds) + "\n";
    }
    return text;
  }
  [[nodiscard]] Instant now() const { return clock_.now(); }

  std::optional<BusService> service;

 private:
  Rig rig_;
  std::vector<drivers::NodeAddress> nodes_;
  ManualClock clock_;
  std::unique_ptr<sim::SimulatedRig> simulated_;
  std::unique_ptr<drivers::Driver> driver_;
};

TEST(Discovery, OfASerialLineFindsNodesStrangersDoublesAndGaps) {
  Bench bench(BusKind::serial, {{1}, {2}, {7}, {7, false}, {9, false}});
  bench.service->scan(1, 254);
  EXPECT_EQ(bench.run(), "");
  EXPECT_EQ(bench.service->found().size(), 4U) << "nobody is found where nobody is";
  EXPECT_EQ(bench.kind_at(1), Kind::present);
  ASSERT_EQ(bench.at(1)->identities.size(), 1U);
  EXPECT_EQ(bench.at(1)->identities[0].channels, 4);
  EXPECT_TRUE(bench.at(1)->expected);
  EXPECT_EQ(bench.kind_at(7), Kind::twofold);
  EXPECT_EQ(bench.at(7)->identities.size(), 2U) << "both tell who they are";
  EXPECT_EQ(bench.kind_at(9), Kind::present);
  EXPECT_FALSE(bench.at(9)->expected);
  EXPECT_LT(bench.now() - kStart, seconds(20));
}

TEST(Discovery, OfAModbusLineFindsNodesStrangersDoublesAndGaps) {
  Bench bench(BusKind::modbus_rtu, {{1}, {7}, {7, false}, {9, false}});
  bench.service->scan(1, 20);
  EXPECT_EQ(bench.run(), "");
  EXPECT_EQ(bench.service->found().size(), 3U) << bench.list();
  EXPECT_EQ(bench.kind_at(1), Kind::present);
  ASSERT_EQ(bench.at(1)->identities.size(), 1U);
  EXPECT_EQ(bench.at(1)->identities[0].model, "footlight-marker");
  EXPECT_EQ(bench.kind_at(7), Kind::twofold);
  EXPECT_EQ(bench.kind_at(9), Kind::present);
  EXPECT_FALSE(bench.at(9)->expected);
}

TEST(Discovery, NodesOfTheRigThatAreNotThereAreAbsent) {
  Bench bench(BusKind::serial, {{1}, {2}, {3}}, "dead=1", 4);
  bench.service->scan(1, 8);
  EXPECT_EQ(bench.run(), "");
  int absent = 0;
  for (const FoundNode& found : bench.service->found()) absent += found.kind == Kind::absent ? 1 : 0;
  EXPECT_EQ(absent, 1);
  EXPECT_EQ(bench.service->found().size(), 3U);
}

TEST(Discovery, OnALossyLineFindsTheSameNodesAgainAndAgain) {
  for (const BusKind kind : {BusKind::serial, BusKind::modbus_rtu}) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      Bench bench(kind, {{1}, {2}, {5}}, "loss=10%", seed);
      bench.service->scan(1, 12);
      EXPECT_EQ(bench.run(), "");
      ASSERT_EQ(bench.service->found().size(), 3U) << to_text(kind) << " seed " << seed;
      for (const FoundNode& found : bench.service->found()) {
        EXPECT_EQ(found.kind, Kind::present)
            << to_text(kind) << " seed " << seed << " address " << found.address << " heard " << found.heard
            << " garbled " << found.garbled << " of " << found.rounds;
      }
    }
  }
}

TEST(Discovery, OfForeignDevicesTakesAnExceptionForALife) {
  Bench bench(BusKind::modbus_rtu, {{3}, {4, false}}, "", 1, "relay-16");
  bench.service->scan(1, 8);
  EXPECT_EQ(bench.run(), "");
  ASSERT_EQ(bench.service->found().size(), 2U);
  EXPECT_EQ(bench.kind_at(3), Kind::present);
  EXPECT_EQ(bench.kind_at(4), Kind::present);
}

TEST(Service, ASpareGetsTheAddressOfWhatItReplaces) {
  for (const BusKind kind : {BusKind::serial, BusKind::modbus_rtu}) {
    Bench bench(kind, {{1}, {40, false}});
    bench.service->set_address(40, std::nullopt, 2, false);
    EXPECT_EQ(bench.run(), "") << to_text(kind);
    bench.service->scan(1, 45);
    EXPECT_EQ(bench.run(), "");
    EXPECT_EQ(bench.kind_at(2), Kind::present) << to_text(kind);
    EXPECT_EQ(bench.at(40), nullptr);
  }
}

TEST(Service, OneOfTwoAtAnAddressIsMovedByItsUniqueId) {
  Bench bench(BusKind::serial, {{7}, {7, false}});
  bench.service->set_address(7, std::nullopt, 8, false);
  const std::string refusal = bench.run();
  EXPECT_EQ(refusal.substr(0, 59), "2 devices share address 7: say which one by its unique id (");
  bench.service->scan(7, 7);
  EXPECT_EQ(bench.run(), "");
  ASSERT_EQ(bench.at(7)->identities.size(), 2U);
  const auto id = bench.at(7)->identities[1].unique_id;
  bench.service->set_address(7, id, 8, false);
  EXPECT_EQ(bench.run(), "");
  bench.service->scan(7, 8);
  EXPECT_EQ(bench.run(), "");
  EXPECT_EQ(bench.kind_at(7), Kind::present);
  EXPECT_EQ(bench.kind_at(8), Kind::present);
  EXPECT_EQ(bench.at(8)->identities[0].unique_id, id);
}

TEST(Service, AnAddressThatIsTakenOrEmptyIsRefused) {
  Bench bench(BusKind::serial, {{1}, {2}});
  bench.service->set_address(1, std::nullopt, 2, false);
  EXPECT_EQ(bench.run(), "address 2 is taken already (choose a free one)");
  bench.service->set_address(9, std::nullopt, 3, false);
  EXPECT_EQ(bench.run(), "nobody answers at address 9 (footlight devices scan shows who is there)");
  bench.service->set_address(1, 0x12345678, 3, false);
  EXPECT_EQ(bench.run(), "no device of the unique id 0x12345678 answers at address 1");
}

TEST(Service, WhatADeviceCannotDoIsSaid) {
  Bench bench(BusKind::modbus_rtu, {{1}}, "", 1, "relay-16");
  bench.service->ask_health({1});
  EXPECT_EQ(bench.run(), "modbus cannot health: the device's profile has no health registers");
}

TEST(Service, HealthTellsBatteryLatencyAndWhoIsSilent) {
  for (const BusKind kind : {BusKind::serial, BusKind::modbus_rtu, BusKind::modbus_tcp}) {
    Bench bench(kind, {{1}, {2}, {3}}, "dead=1", 2);
    bench.service->ask_health({1, 2, 3});
    EXPECT_EQ(bench.run(), "");
    int silent = 0;
    for (const auto& node : bench.service->health()) {
      if (node.answered == 0) {
        ++silent;
        EXPECT_FALSE(node.last_seen);
        continue;
      }
      ASSERT_FALSE(node.values.empty());
      EXPECT_EQ(node.values[0].name, "battery");
      EXPECT_EQ(node.values[0].value, 100);
      EXPECT_EQ(node.latency.total(), 1U);
      EXPECT_GT(node.latency.longest(), Duration{});
      EXPECT_TRUE(node.last_seen);
    }
    EXPECT_EQ(silent, 1) << to_text(kind);
  }
}

TEST(Service, HealthTellsHowFarTheClocksOfSerialNodesAreOff) {
  Bench bench(BusKind::serial, {{1}, {2}});
  bench.service->ask_health({1, 2});
  EXPECT_EQ(bench.run(), "");
  ASSERT_EQ(bench.service->health().size(), 2U);
  for (const auto& node : bench.service->health()) {
    EXPECT_EQ(node.asked, 1U) << "the question for the clock is not counted";
    const auto value = [&](const std::string& name) {
      const auto found = std::ranges::find(node.values, name, &drivers::HealthValue::name);
      EXPECT_NE(found, node.values.end()) << name;
      return found == node.values.end() ? -1e9 : found->value;
    };
    EXPECT_EQ(value("battery"), 100);
    EXPECT_EQ(value("TIME frames"), 1);
    EXPECT_NEAR(value("clock error"), 0, 0.01) << "in ms; simulated clocks are right";
  }
}

TEST(Service, IdentifyIsDoneOrRefused) {
  for (const char* profile : {"footlight-marker", "relay-16"}) {
    Bench bench(BusKind::modbus_rtu, {{1}}, "", 1, profile);
    bench.service->identify(1, true);
    EXPECT_EQ(bench.run(), "") << profile;
    bench.service->identify(5, true);
    EXPECT_EQ(bench.run(),
              "the node of address 5 does not answer to identify (footlight devices scan shows who is there)");
  }
}

TEST(Service, WhatIsLostIsAskedAgainAndAMoveWhoseReceiptIsLostIsFoundOut) {
  for (const BusKind kind : {BusKind::serial, BusKind::modbus_rtu}) {
    int done = 0;
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
      Bench bench(kind, {{1}, {40, false}}, "loss=20%", seed);
      bench.service->identify(1, true);
      const std::string identified = bench.run();
      bench.service->set_address(40, std::nullopt, 2, false);
      const std::string moved = bench.run();
      done += identified.empty() && moved.empty() ? 1 : 0;
    }
    // One question alone is answered 64 times of a hundred, both of these together 41.
    EXPECT_GE(done, 25) << to_text(kind);
  }
}

TEST(Service, ATestCountsWhoAnswers) {
  Bench bench(BusKind::serial, {{1}, {2}, {3}, {4}}, "loss=20%");
  bench.service->test({1, 2, 3, 4}, seconds(5));
  EXPECT_EQ(bench.run(), "");
  ASSERT_EQ(bench.service->health().size(), 4U);
  for (const auto& node : bench.service->health()) {
    EXPECT_GT(node.asked, 30U);
    EXPECT_GT(node.answered_share(), 0.4);
    EXPECT_LT(node.answered_share(), 0.9);
    EXPECT_EQ(node.asked, node.answered + node.garbled + node.silent + node.refused);
  }
}

/// A port of a library that blocks: time goes by inside `submit`, and the answer is there when it returns.
class BlockingModbus final : public drivers::ModbusPort {
 public:
  static constexpr Duration kAnswer = milliseconds(7);
  explicit BlockingModbus(ManualClock& clock) : clock_(clock) {}
  drivers::SendStatus submit(const drivers::ModbusRequest& request) override {
    clock_.advance(kAnswer);
    reply_ = {drivers::ModbusReply::Outcome::ok, request.unit, request.function, 0,
              std::vector<std::uint16_t>(request.count, 0)};
    return drivers::SendStatus::accepted;
  }
  std::optional<drivers::ModbusReply> poll() override { return std::exchange(reply_, std::nullopt); }
  [[nodiscard]] bool busy() const override { return false; }
  [[nodiscard]] Duration wire_time(const drivers::ModbusRequest& /*request*/) const override { return kAnswer; }
  bool discard() override { return false; }

 private:
  ManualClock& clock_;
  std::optional<drivers::ModbusReply> reply_;
};

TEST(Service, OverAPortThatBlocksATestEndsAndLatencyIsMeasured) {
  ManualClock clock;
  BlockingModbus port(clock);
  Bus bus;
  bus.name = "front";
  bus.kind = BusKind::modbus_rtu;
  const std::vector<drivers::NodeAddress> nodes{{NodeIndex(0), 1, 4}, {NodeIndex(1), 2, 4}};
  const auto driver = drivers::make_driver(bus, nodes, 0, &port).value();
  BusService service(*driver, nodes);
  service.test({1, 2}, milliseconds(500));
  for (int steps = 0; !service.finished() && steps < 1000; ++steps) {
    const Instant wish = service.step(clock.now());
    if (wish != kNever && wish > clock.now()) clock.advance(wish - clock.now());
  }
  ASSERT_TRUE(service.finished());
  ASSERT_EQ(service.health().size(), 2U);
  EXPECT_GE(service.health()[0].answered, 20U);
  EXPECT_LE(service.health()[0].answered, 80U);
  EXPECT_GE(service.health()[0].latency.longest(), BlockingModbus::kAnswer);
}

}  // namespace
}  // namespace footlight::app
