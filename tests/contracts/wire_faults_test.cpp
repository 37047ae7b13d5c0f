// SPDX-License-Identifier: Apache-2.0
// What a fault of a serial or Modbus wire may bring about: whole buses, with loop, driver and simulated markers, in
// virtual time. Named for the rows of docs/faults.md.
#include <algorithm>
#include <array>
#include <deque>
#include <memory>

#include <gtest/gtest.h>

#include "controller/bus_loop.hpp"
#include "core/rng.hpp"
#include "drivers/registry.hpp"
#include "sim/simulated_rig.hpp"

namespace footlight::contracts {
namespace {

using controller::BusLoop;
using controller::BusTarget;
using controller::CueSchedule;
using controller::Switch;
using drivers::SendStatus;

constexpr std::size_t kChannels = 16;
constexpr Duration kBeat = milliseconds(1000);
constexpr std::uint8_t kPlanByte = 0xA3;

/// A cable that can be pulled and picks up noise.
class Cable final : public drivers::ByteStream {
 public:
  explicit Cable(drivers::ByteStream& port) : port_(port) {}
  SendStatus write(std::span<const std::uint8_t> bytes) override {
    ++calls;
    return pulled ? SendStatus::down : port_.write(bytes);
  }
  std::size_t read(std::span<std::uint8_t> buffer) override {
    ++calls;
    if (pulled) return 0;
    if (noise > 0 && rng_.uniform() < noise) {
      const auto count = std::min<std::size_t>(buffer.size(), 1 + rng_.below(40));
      for (std::size_t i = 0; i < count; ++i) buffer[i] = static_cast<std::uint8_t>(rng_.below(256));
      return count;
    }
    // In pieces, so that it falls into the frames.
    return port_.read(noise > 0 ? buffer.first(std::min<std::size_t>(buffer.size(), 5)) : buffer);
  }
  [[nodiscard]] Duration wire_time(std::size_t bytes) const override { return port_.wire_time(bytes); }

  bool pulled = false;
  double noise = 0;  ///< share of reads that give garbage
  int calls = 0;

 private:
  drivers::ByteStream& port_;
  Rng rng_{3};
};

/// Buses of a rig with a show that changes every lamp every second.
class Floor {
 public:
  Floor(const std::vector<BusKind>& kinds, std::size_t nodes_per_bus, const sim::Faults& faults = {},
        std::uint64_t seed = 1)
      : rig_(rig_of(kinds, nodes_per_bus)),
        schedule_(schedule_of(rig_.nodes.size())),
        simulated_(rig_, faults, seed, clock_, nullptr) {
    for (std::size_t b = 0; b < kinds.size(); ++b) {
      const auto bus = BusIndex::of(b);
      drivers::PortReference port;
      if (kinds[b] == BusKind::serial) {
        cables_.push_back(std::make_unique<Cable>(simulated_.serial(bus)));
        port = cables_.back().get();
      } else if (kinds[b] == BusKind::can) {
        port = &simulated_.can(bus);
      } else {
        port = &simulated_.modbus(bus);
      }
      auto nodes = drivers::node_addresses(rig_, bus);
      drivers_.push_back(drivers::make_driver(rig_.buses[b], nodes, kPlanByte, port).value());
      loops_.push_back(std::make_unique<BusLoop>(schedule_, std::move(nodes), *drivers_.back()));
    }
    wishes_.assign(loops_.size(), kStart);
    simulated_.set_show(kStart, seconds(60));
  }

  void run_until(Instant end) {
    while (clock_.now() < end) {
      const BusTarget target = target_now();
      Instant next = std::min({simulated_.next_event(), target.next_at, end});
      for (std::size_t b = 0; b < loops_.size(); ++b) {
        const Instant wish = loops_[b]->step(clock_.now(), target);
        ++steps_;
        next = std::min(next, std::max(wish, clock_.now() + microseconds(1)));
      }
      simulated_.advance_to(std::max(next, clock_.now()));
      note_right();
    }
  }

  [[nodiscard]] bool right(std::size_t node) const {
    const auto looks = schedule_.looks_of(target_now().current, NodeIndex::of(node));
    for (std::size_t c = 0; c < kChannels; ++c) {
      if (simulated_.shown(NodeIndex::of(node), static_cast<int>(c)) != looks[c]) return false;
    }
    return true;
  }
  /// Nodes of bus `b` that do not show what they should now.
  [[nodiscard]] int wrong(std::size_t b) const {
    int count = 0;
    for (std::size_t n = 0; n < rig_.nodes.size(); ++n) count += rig_.nodes[n].bus.at() == b && !right(n) ? 1 : 0;
    return count;
  }
  /// Until bus `b` is settled, or is not any more; kNever when that does not come within five seconds.
  Instant run_until_settled(std::size_t b, bool settled) {
    const Instant limit = clock_.now() + seconds(5);
    while (loops_[b]->settled() != settled && clock_.now() < limit) run_until(clock_.now() + milliseconds(1));
    return loops_[b]->settled() == settled ? clock_.now() : kNever;
  }
  /// How late lamps of living nodes were right, in order, switches from 3 on; those that never were are a second late.
  [[nodiscard]] std::vector<Duration> lateness() const {
    std::vector<Duration> list = late_;
    std::ranges::sort(list);
    return list;
  }

  [[nodiscard]] Instant now() const { return clock_.now(); }
  [[nodiscard]] Cable& cable() { return *cables_.front(); }
  [[nodiscard]] const BusLoop& loop(std::size_t b) const { return *loops_[b]; }
  [[nodiscard]] std::uint64_t steps() const { return steps_; }
  [[nodiscard]] const sim::SimulatedRig& simulated() const { return simulated_; }

 private:
  static Rig rig_of(const std::vector<BusKind>& kinds, std::size_t nodes_per_bus) {
    Rig rig;
    for (std::size_t b = 0; b < kinds.size(); ++b) {
      const int speed = kinds[b] == BusKind::can ? 500'000 : 115'200;
      rig.buses.push_back({"b" + std::to_string(b), kinds[b], "sim://b", speed, std::nullopt, {}});
      for (std::size_t i = 1; i <= nodes_per_bus; ++i) {
        rig.nodes.push_back({"n" + std::to_string(b) + "-" + std::to_string(i),
                             BusIndex::of(b),
                             static_cast<int>(i),
                             std::vector<Channel>(kChannels),
                             {}});
      }
    }
    return rig;
  }
  static CueSchedule schedule_of(std::size_t nodes) {
    std::vector<Look> looks(30, Look{{9, 9, 9}, Effect::steady, 255});
    std::vector<Switch> switches;
    std::vector<LookIndex> table;
    for (std::size_t k = 0; k < 40; ++k) {
      switches.push_back({kStart + static_cast<Duration::rep>(k + 2) * kBeat, "switch", false, std::nullopt});
      for (std::size_t n = 0; n < nodes; ++n) {
        for (std::size_t c = 0; c < kChannelsPerNode; ++c) {
          table.push_back(c < kChannels ? static_cast<LookIndex>(1 + (3 * k + 5 * n + c) % 29) : kDark);
        }
      }
    }
    return CueSchedule(std::move(looks), std::move(switches), nodes, std::move(table), 0, {});
  }

  [[nodiscard]] BusTarget target_now() const {
    const auto& switches = schedule_.switches();
    BusTarget target;
    while (target.current + 1 < switches.size() && switches[target.current + 1].time <= clock_.now()) ++target.current;
    target.next = std::min(target.current + 1, switches.size() - 1);
    if (target.next != target.current) target.next_at = switches[target.next].time;
    target.show_time = clock_.now() - kStart;
    return target;
  }

  void note_right() {
    const std::size_t k = target_now().current;
    if (k != noted_) {
      if (noted_ >= 3) late_.insert(late_.end(), waiting_.size(), kBeat);
      waiting_.clear();
      noted_ = k;
      for (std::size_t n = 0; n < rig_.nodes.size(); ++n) {
        const auto& dead = simulated_.dead();
        if (!std::ranges::binary_search(dead, NodeIndex::of(n))) waiting_.push_back(n);
      }
    }
    const auto seen = std::ranges::remove_if(waiting_, [&](std::size_t n) { return right(n); });
    if (k >= 3) late_.insert(late_.end(), seen.size(), clock_.now() - schedule_.switches()[k].time);
    waiting_.erase(seen.begin(), seen.end());
  }

  Rig rig_;
  CueSchedule schedule_;
  ManualClock clock_;
  sim::SimulatedRig simulated_;
  std::vector<std::unique_ptr<Cable>> cables_;
  std::vector<std::unique_ptr<drivers::Driver>> drivers_;
  std::vector<std::unique_ptr<BusLoop>> loops_;
  std::vector<Instant> wishes_;
  std::uint64_t steps_ = 0;
  std::size_t noted_ = 0;
  std::vector<std::size_t> waiting_;  ///< nodes that have not been right since the switch
  std::vector<Duration> late_;
};

TEST(SerialUnplugged, IsSeenWithin500MillisecondsAndOtherPortsAreUnmoved) {
  for (int offset_ms = 0; offset_ms < 1'000; offset_ms += 130) {
    Floor floor({BusKind::serial, BusKind::serial}, 6);
    floor.run_until(kStart + milliseconds(6'300 + offset_ms));
    ASSERT_NE(floor.run_until_settled(0, true), kNever);
    floor.cable().pulled = true;
    const Instant pulled = floor.now();
    const Instant seen = floor.run_until_settled(0, false);
    EXPECT_LE(seen - pulled, milliseconds(500));
    floor.run_until(pulled + seconds(4));
    EXPECT_EQ(floor.wrong(1), 0);
    EXPECT_EQ(floor.loop(1).counters().late_latches, 0U);
    EXPECT_EQ(floor.loop(1).counters().misses, 0U);
  }
}

TEST(SerialUnplugged, IsNoBusyLoop) {
  Floor floor({BusKind::serial}, 6);
  floor.run_until(kStart + milliseconds(6'300));
  floor.cable().pulled = true;
  floor.run_until(floor.now() + seconds(1));
  floor.cable().calls = 0;
  floor.run_until(floor.now() + seconds(10));
  EXPECT_LE(floor.cable().calls, 10 * 60) << "calls of the port in ten seconds";
  EXPECT_GE(floor.cable().calls, 10 * 5) << "nor is it forgotten";
}

TEST(SerialUnplugged, TheFullStateIsBackWithinTwoSecondsOfThePlug) {
  for (const int away_ms : {50, 700, 1'800, 6'000}) {
    Floor floor({BusKind::serial}, 12);
    floor.run_until(kStart + milliseconds(6'300));
    floor.cable().pulled = true;
    floor.run_until(floor.now() + milliseconds(away_ms));
    floor.cable().pulled = false;
    const Instant back = floor.now();
    Instant right = kNever;
    while (floor.now() < back + seconds(4) && right == kNever) {
      floor.run_until(floor.now() + milliseconds(1));
      if (floor.wrong(0) == 0 && floor.loop(0).settled()) right = floor.now();
    }
    EXPECT_LE(right - back, seconds(2)) << "after " << away_ms << " ms";
  }
}

TEST(GarbageOnTheLine, NoiseBetweenTheFramesCostsAnswersAndNoLamp) {
  Floor floor({BusKind::serial}, 6);
  floor.cable().noise = 0.05;
  floor.run_until(kStart + seconds(30));
  floor.run_until(floor.now() + milliseconds(900));
  EXPECT_EQ(floor.wrong(0), 0);
  EXPECT_GT(floor.loop(0).counters().misses, 0U) << "there was some";
  EXPECT_LT(floor.lateness().back(), kBeat) << "every lamp was right in its second";
}

TEST(GarbageOnTheLine, FlippedBitsOnBothLanguagesLightNoWrongLamp) {
  Floor floor({BusKind::serial, BusKind::modbus_rtu}, 6, {.corrupt = 0.05});
  floor.run_until(kStart + seconds(30) + milliseconds(900));
  EXPECT_EQ(floor.wrong(0), 0);
  EXPECT_EQ(floor.wrong(1), 0);
  EXPECT_LT(floor.lateness().back(), kBeat);
}

Duration worst_of_a_thousand(const std::vector<Duration>& sorted) { return sorted[sorted.size() * 999 / 1'000]; }

TEST(SlowOrDeadDevice, WithFivePercentDeadTheOthersAreAsPunctualAsBefore) {
  for (const BusKind kind : {BusKind::serial, BusKind::modbus_rtu}) {
    Floor whole({kind}, 20);
    Floor hurt({kind}, 20, {.dead = 1});
    for (Floor* floor : {&whole, &hurt}) floor->run_until(kStart + seconds(40));
    ASSERT_EQ(hurt.simulated().dead().size(), 1U);
    EXPECT_EQ(whole.lateness().size(), 36U * 20);
    EXPECT_EQ(hurt.lateness().size(), 36U * 19);
    const double before = static_cast<double>(worst_of_a_thousand(whole.lateness()).count());
    const double after = static_cast<double>(worst_of_a_thousand(hurt.lateness()).count());
    EXPECT_LE(after, 1.1 * before + 1e5) << to_text(kind);
    EXPECT_EQ(hurt.loop(0).quarantined().size(), 1U);
    EXPECT_EQ(hurt.loop(0).counters().quarantines, 1U);
  }
}

TEST(SlowOrDeadDevice, AnswersThatAreLateCostTheirOwnTimeAlone) {
  Floor floor({BusKind::modbus_rtu}, 10, {.delay = milliseconds(100), .late = 0.02});
  floor.run_until(kStart + seconds(40));
  EXPECT_GT(floor.loop(0).counters().misses, 0U);
  EXPECT_LT(worst_of_a_thousand(floor.lateness()), kBeat);
  EXPECT_LE(floor.loop(0).counters().late_latches, floor.loop(0).counters().latches / 20);
}

TEST(RebootingDevice, IsSeenWithinT1AndT0AndRightAgainAtTheNextSwitch) {
  constexpr Duration kOff = milliseconds(300);
  constexpr Duration kSeen = milliseconds(1'250);  // T1 and T0 of a bus that is asked within a second
  for (const BusKind kind : {BusKind::serial, BusKind::modbus_rtu, BusKind::modbus_tcp, BusKind::can}) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      Floor floor({kind}, 6, {.reboot = 1, .until = 0.5}, seed);
      ASSERT_EQ(floor.simulated().reboots().size(), 1U);
      const Instant at = floor.simulated().reboots().front().at;
      const NodeIndex node = floor.simulated().reboots().front().node;
      const std::string what = std::string(to_text(kind)) + ", seed " + std::to_string(seed);
      floor.run_until(at + kOff / 2);
      EXPECT_EQ(floor.simulated().shown(node, 0), kDark) << what << ": it has no power";
      floor.run_until(at + kOff + microseconds(1));
      EXPECT_EQ(floor.simulated().shown(node, 0), kNoGuidance) << what;
      floor.run_until(at + kOff + kSeen);
      EXPECT_EQ(floor.loop(0).counters().boots, 1U) << what;
      const Instant next_switch = kStart + ((floor.now() - kStart) / kBeat + 1) * kBeat;
      floor.run_until(next_switch + kBeat / 2);
      EXPECT_EQ(floor.wrong(0), 0) << what;
    }
  }
}

}  // namespace
}  // namespace footlight::contracts
