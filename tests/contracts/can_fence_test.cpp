// SPDX-License-Identifier: Apache-2.0
// Two controllers on one CAN bus: the older epoch is refused by the markers, says so, and sends nothing more.
#include <array>
#include <memory>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"
#include "drivers/devices/canopen/canopen_driver.hpp"
#include "sim/markers/canopen_marker.hpp"
#include "tests/drivers/recording_ports.hpp"

namespace footlight {
namespace {

using drivers::CanFrame;
using drivers::CanopenDriver;
using drivers::SendStatus;

constexpr std::uint8_t kNodes = 3;
constexpr int kChannels = 8;

struct Controller {
  Controller(std::uint32_t epoch, const std::vector<drivers::NodeAddress>& nodes) {
    leadership.epoch = epoch;
    driver = std::make_unique<CanopenDriver>(port, nodes, std::nullopt, &leadership);
  }
  drivers::RecordingCan port;
  drivers::Leadership leadership;
  std::unique_ptr<CanopenDriver> driver;
  drivers::EventLog log;
  std::size_t carried = 0;
  bool frozen = false;
  bool leads = false;  ///< its heart beats
};

/// Everybody hears everybody else, frame by frame, whoever's turn it is.
class Wire {
 public:
  Wire() {
    std::vector<drivers::NodeAddress> nodes;
    for (std::uint8_t n = 1; n <= kNodes; ++n) {
      nodes.push_back({NodeIndex::of(n - 1), n, kChannels});
      models_.push_back(std::make_unique<sim::NodeModel>(kChannels, true));
      models_.back()->power_on(now);
      markers_.push_back(std::make_unique<sim::CanopenMarker>(n, *models_.back()));
      markers_.back()->power_on();
    }
    older = std::make_unique<Controller>(7, nodes);
    newer = std::make_unique<Controller>(8, nodes);
    nodes_ = nodes;
  }

  /// A frame of each controller's queue, in turns, until both are empty.
  void carry() {
    for (bool more = true; more;) {
      more = false;
      for (Controller* one : {older.get(), newer.get()}) {
        if (one->carried == one->port.sent.size()) continue;
        const CanFrame frame = one->port.sent[one->carried++];
        if (one->port.in_queue > 0) --one->port.in_queue;
        deliver(frame, one);
        more = true;
      }
    }
  }
  void step() {
    for (Controller* one : {older.get(), newer.get()}) {
      if (!one->frozen) one->driver->step(now, one->log);
    }
    carry();
  }
  void beat(Controller& one) {
    (void)one.driver->heartbeat({}, now);
    step();
  }
  /// Preload and latch for all nodes. @return whether all of it was taken by the driver
  bool light(Controller& one, LookIndex look, drivers::Sequence sequence) {
    const std::vector<LookIndex> looks(kChannels, look);
    bool taken = true;
    for (const auto& node : nodes_) {
      taken = one.driver->preload(node, sequence, looks, now) == SendStatus::accepted && taken;
      step();
    }
    taken = one.driver->latch(sequence, now) == SendStatus::accepted && taken;
    step();
    return taken;
  }
  [[nodiscard]] std::vector<LookIndex> shown() const {
    std::vector<LookIndex> out;
    for (const auto& model : models_) out.push_back(model->shown(0));
    return out;
  }
  void pass(Duration time) {
    for (const Instant end = now + time; now < end; now += milliseconds(50)) {
      step();
      if ((now - kStart) % milliseconds(250) == Duration{}) {
        for (Controller* one : {older.get(), newer.get()}) {
          if (!one->frozen && one->leads) beat(*one);
        }
      }
    }
  }

  Instant now = kStart;
  std::unique_ptr<Controller> older;
  std::unique_ptr<Controller> newer;

 private:
  void deliver(const CanFrame& frame, const Controller* from) {
    for (Controller* one : {older.get(), newer.get()}) {
      if (one != from) one->port.incoming.push_back(frame);
    }
    for (const auto& marker : markers_) {
      using Reaction = sim::CanNode::Reaction;
      switch (marker->receive(frame, now)) {
        case Reaction::none:
          break;
        case Reaction::status:
          answer(marker->status());
          break;
        case Reaction::boot_up:
          answer(marker->boot_up());
          break;
        case Reaction::emergency:
          answer(marker->emergency());
          break;
        case Reaction::sdo:
          answer(marker->sdo_answer());
          break;
      }
    }
  }
  void answer(const CanFrame& frame) {
    for (Controller* one : {older.get(), newer.get()}) one->port.incoming.push_back(frame);
  }

  std::vector<drivers::NodeAddress> nodes_;
  std::vector<std::unique_ptr<sim::NodeModel>> models_;
  std::vector<std::unique_ptr<sim::CanopenMarker>> markers_;
};

std::vector<LookIndex> all(LookIndex look) { return std::vector<LookIndex>(kNodes, look); }

class CanFence : public ::testing::Test {
 protected:
  CanFence() {
    (void)wire_.older->driver->start(wire_.now);
    wire_.older->leads = true;
    wire_.beat(*wire_.older);
    EXPECT_TRUE(wire_.light(*wire_.older, 1, 1));
    EXPECT_EQ(wire_.shown(), all(1));
  }
  void take_over() {
    wire_.newer->leads = true;
    (void)wire_.newer->driver->start(wire_.now);
    wire_.beat(*wire_.newer);
    EXPECT_TRUE(wire_.light(*wire_.newer, 2, 2));
    EXPECT_EQ(wire_.shown(), all(2));
  }
  Wire wire_;
};

TEST_F(CanFence, TheFirstHearsOfTheSecondAndSendsNothingMore) {
  take_over();
  EXPECT_GT(wire_.older->leadership.refusals.load(), 0U);
  const std::size_t sent = wire_.older->port.sent.size();
  EXPECT_FALSE(wire_.light(*wire_.older, 3, 3));
  EXPECT_EQ(wire_.shown(), all(2));
  EXPECT_EQ(wire_.older->port.sent.size(), sent);
  EXPECT_EQ(wire_.newer->leadership.refusals.load(), 0U) << "the newer one is refused by nobody";
}

TEST_F(CanFence, AFirstThatWasFrozenAndComesBackIsRefusedByTheMarkers) {
  wire_.older->frozen = true;
  wire_.pass(milliseconds(3000));
  take_over();
  wire_.pass(milliseconds(2000));
  wire_.older->port.incoming.clear();  // its queue was too short for what it has missed
  wire_.older->frozen = false;
  wire_.older->driver->step(wire_.now, wire_.older->log);
  const std::vector<LookIndex> three(kChannels, 3);
  (void)wire_.older->driver->preload({NodeIndex(0), 1, kChannels}, 3, three, wire_.now);
  (void)wire_.older->driver->latch(3, wire_.now);
  wire_.carry();
  EXPECT_EQ(wire_.shown(), all(2)) << "its LEAD came first, and was refused with all that followed";
  wire_.step();
  EXPECT_GT(wire_.older->leadership.refusals.load(), 0U) << "and it was told so";
  EXPECT_TRUE(wire_.light(*wire_.newer, 4, 4));
  EXPECT_EQ(wire_.shown(), all(4)) << "the newer one has said again that it leads";
}

TEST_F(CanFence, WhenTheSecondHasGoneAnybodyMayLead) {
  take_over();
  wire_.newer->frozen = true;
  wire_.pass(milliseconds(6000));
  EXPECT_TRUE(wire_.light(*wire_.older, 5, 5));
  EXPECT_EQ(wire_.shown(), all(5));
}

TEST_F(CanFence, WhateverTheOldOneSaysAndWhenNoLampIsLitByIt) {
  EXPECT_TRUE(rc::check("no look of the older one after the newer one leads", [] {
    Wire wire;
    (void)wire.older->driver->start(wire.now);
    wire.older->leads = true;
    wire.beat(*wire.older);
    RC_ASSERT(wire.light(*wire.older, 1, 1));
    wire.older->frozen = *rc::gen::arbitrary<bool>();
    wire.pass(milliseconds(*rc::gen::inRange(1, 60) * 50));
    wire.newer->leads = true;
    (void)wire.newer->driver->start(wire.now);
    wire.beat(*wire.newer);
    RC_ASSERT(wire.light(*wire.newer, 2, 2));
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    for (int i = 0; i < 20; ++i) {
      wire.pass(milliseconds(50 * (1 + static_cast<int>(rng.below(20)))));
      if (rng.below(3) == 0) wire.older->frozen = false;
      if (!wire.older->frozen) (void)wire.light(*wire.older, 3, static_cast<drivers::Sequence>(3 + rng.below(200)));
      for (const LookIndex look : wire.shown()) RC_ASSERT(look != 3);
    }
    RC_ASSERT(wire.older->leadership.refusals.load() > 0);
  }));
}

}  // namespace
}  // namespace footlight
