// SPDX-License-Identifier: Apache-2.0
// What every language owes its callers, checked over the table of languages.
#include <array>
#include <functional>
#include <memory>
#include <numeric>
#include <string>

#include <gtest/gtest.h>

#include "core/rng.hpp"
#include "drivers/devices/canopen/canopen_frames.hpp"
#include "drivers/devices/footlight_serial/serial_frame.hpp"
#include "drivers/registry.hpp"
#include "tests/drivers/recording_ports.hpp"

namespace footlight::drivers {
namespace {

using Kind = DeviceEvent::Kind;

constexpr std::uint8_t kPlanByte = 0xA3;
const NodeAddress kSeven{NodeIndex(3), 7, 32};
const NodeAddress kNine{NodeIndex(4), 9, 5};

std::vector<LookIndex> looks_for(const NodeAddress& node) {
  std::vector<LookIndex> looks(node.channels);
  std::iota(looks.begin(), looks.end(), LookIndex{1});
  return looks;
}

struct Shown {
  Sequence sequence = 17;
  std::uint16_t crc = 0xBEEF;
  std::uint8_t state = 1;
  std::uint16_t boots = 5;
};

/// A driver on a recording port, and the answers of its nodes.
class Bench {
 public:
  virtual ~Bench() = default;
  /// The wire gets idle: queues drain, broadcasts end, time goes on.
  virtual void settle() = 0;
  virtual void answer_preload(const NodeAddress& node, Sequence sequence) = 0;
  virtual void answer_status(const NodeAddress& node, const Shown& shown) = 0;
  /// The language's own way to notice that nobody answers, and time for it.
  virtual void stay_silent() = 0;
  virtual void garbage(Rng& rng) = 0;
  virtual void set_wire(SendStatus status) = 0;
  [[nodiscard]] virtual std::size_t sent() const = 0;

  void make(BusKind kind, PortReference port) {
    Bus bus;
    bus.name = "front";
    bus.kind = kind;
    // Their lamps must not share slots.
    nodes = kind == BusKind::dmx ? std::vector<NodeAddress>{{NodeIndex(3), 7, 32}, {NodeIndex(4), 109, 5}}
                                 : std::vector<NodeAddress>{kSeven, kNine};
    auto made = make_driver(bus, nodes, kPlanByte, port);
    ASSERT_TRUE(made) << made.error().message;
    driver = std::move(made).value();
  }
  Instant step() { return driver->step(now, log); }
  /// Everything an operation brings about without an answer of a node.
  void finish() {
    settle();
    step();
  }

  std::unique_ptr<Driver> driver;
  std::vector<NodeAddress> nodes;
  EventLog log;
  Instant now = instant_at(10);
};

class SerialBench final : public Bench {
 public:
  SerialBench() { make(BusKind::serial, &port_); }
  void settle() override { now += milliseconds(1); }
  void answer_preload(const NodeAddress& node, Sequence sequence) override {
    const std::uint16_t crc = looks_crc(looks_for(node));
    hear(footlight_serial::Command::preload, node, sequence,
         {static_cast<std::uint8_t>(crc & 0xFF), static_cast<std::uint8_t>(crc >> 8)});
  }
  void answer_status(const NodeAddress& node, const Shown& shown) override {
    hear(footlight_serial::Command::status, node, shown.sequence,
         {0, static_cast<std::uint8_t>(shown.crc & 0xFF), static_cast<std::uint8_t>(shown.crc >> 8), shown.state,
          static_cast<std::uint8_t>(shown.boots & 0xFF), static_cast<std::uint8_t>(shown.boots >> 8), 0, 0});
  }
  void stay_silent() override { now += milliseconds(100); }
  void garbage(Rng& rng) override {
    for (int i = 0; i < 300; ++i) port_.incoming.push_back(static_cast<std::uint8_t>(rng.below(256)));
    port_.incoming.push_back(0);
  }
  void set_wire(SendStatus status) override { port_.status = status; }
  [[nodiscard]] std::size_t sent() const override { return port_.sent.size(); }

 private:
  void hear(footlight_serial::Command command, const NodeAddress& node, Sequence sequence,
            std::vector<std::uint8_t> body) {
    port_.hear(footlight_serial::encode(
        {footlight_serial::Direction::from_node, command, node.unit(), kPlanByte, sequence, std::move(body)}));
  }
  RecordingStream port_;
};

class CanBench final : public Bench {
 public:
  CanBench() { make(BusKind::can, &port_); }
  void settle() override {
    port_.in_queue = 0;
    now += milliseconds(1);
  }
  void answer_preload(const NodeAddress& /*node*/, Sequence /*sequence*/) override { settle(); }
  void answer_status(const NodeAddress& node, const Shown& shown) override {
    const auto low = [](std::uint16_t value) { return static_cast<std::uint8_t>(value & 0xFF); };
    const auto high = [](std::uint16_t value) { return static_cast<std::uint8_t>(value >> 8); };
    port_.incoming.push_back(
        {static_cast<std::uint16_t>(0x180 + node.address),
         8,
         {shown.sequence, shown.state, low(shown.crc), high(shown.crc), low(shown.boots), high(shown.boots), 0, 0}});
  }
  void stay_silent() override { now += milliseconds(100); }
  void garbage(Rng& rng) override {
    for (int i = 0; i < 50; ++i) {
      CanFrame frame;
      frame.id = static_cast<std::uint16_t>(rng.below(0x800) & ~0x7FU);  // of no node of ours
      frame.length = static_cast<std::uint8_t>(rng.below(9));
      for (auto& byte : frame.data) byte = static_cast<std::uint8_t>(rng.below(256));
      port_.incoming.push_back(frame);
    }
  }
  void set_wire(SendStatus status) override { port_.status = status; }
  [[nodiscard]] std::size_t sent() const override { return port_.sent.size(); }

 private:
  RecordingCan port_;
};

class ModbusBench final : public Bench {
 public:
  explicit ModbusBench(BusKind kind) { make(kind, &port_); }
  void settle() override {
    if (!port_.sent.empty() && port_.sent.back().unit == 0) port_.taken = false;
    now += milliseconds(1);
  }
  void answer_preload(const NodeAddress& /*node*/, Sequence /*sequence*/) override {
    port_.answer(ModbusReply::Outcome::ok);
  }
  void answer_status(const NodeAddress& /*node*/, const Shown& shown) override {
    std::vector<std::uint16_t> registers{
        static_cast<std::uint16_t>(shown.sequence << 8), shown.crc, shown.state, shown.boots, 9, 0};
    registers.resize(port_.sent.back().count);
    port_.answer(ModbusReply::Outcome::ok, std::move(registers));
  }
  void stay_silent() override {
    now += milliseconds(100);
    port_.answer(ModbusReply::Outcome::timeout);
    step();
    now += milliseconds(100);  // and the line is quiet
  }
  void garbage(Rng& /*rng*/) override {
    if (port_.taken && port_.sent.back().unit != 0) port_.answer(ModbusReply::Outcome::garbled);
  }
  void set_wire(SendStatus status) override { port_.status = status; }
  [[nodiscard]] std::size_t sent() const override { return port_.sent.size(); }

 private:
  RecordingModbus port_;
};

/// Nobody answers on DMX: what is asked is told nobody, and what is sent counts as taken.
class DmxBench final : public Bench {
 public:
  DmxBench() { make(BusKind::dmx, &port_); }
  void settle() override { now += milliseconds(12); }
  void answer_preload(const NodeAddress& /*node*/, Sequence /*sequence*/) override {}
  void answer_status(const NodeAddress& /*node*/, const Shown& /*shown*/) override {}
  void stay_silent() override { now += milliseconds(100); }
  void garbage(Rng& rng) override {
    for (int i = 0; i < 300; ++i) port_.incoming.push_back(static_cast<std::uint8_t>(rng.below(256)));
  }
  void set_wire(SendStatus status) override { port_.status = status; }
  [[nodiscard]] std::size_t sent() const override { return port_.sent.size(); }

 private:
  RecordingStream port_;
};

struct Language {
  std::string name;
  std::function<std::unique_ptr<Bench>()> make;
};

class DriverContract : public ::testing::TestWithParam<Language> {
 protected:
  std::unique_ptr<Bench> bench_ = GetParam().make();
  Driver& driver() { return *bench_->driver; }
  EventLog& log() { return bench_->log; }
  SendStatus preload(const NodeAddress& node, Sequence sequence) {
    return driver().preload(node, sequence, looks_for(node), bench_->now);
  }
};

TEST_P(DriverContract, TakesEveryOperationOnAnIdleWire) {
  Bench& bench = *bench_;
  const Look look{{255, 0, 0}, Effect::pulse, 100};
  EXPECT_EQ(driver().start(bench.now), SendStatus::accepted);
  bench.finish();
  EXPECT_EQ(driver().heartbeat(seconds(3), bench.now), SendStatus::accepted);
  bench.finish();
  bench.settle();
  bench.now += milliseconds(10);
  bench.step();
  EXPECT_TRUE(driver().ready());
  EXPECT_EQ(driver().upload_look(5, look, bench.now), SendStatus::accepted);
  bench.now += milliseconds(10);
  bench.finish();
  EXPECT_EQ(preload(kSeven, 1), SendStatus::accepted);
  bench.answer_preload(kSeven, 1);
  bench.now += milliseconds(10);
  bench.finish();
  EXPECT_EQ(driver().latch(1, bench.now), SendStatus::accepted);
  bench.now += milliseconds(10);
  bench.finish();
  EXPECT_EQ(driver().ask(kSeven, bench.now), SendStatus::accepted);
}

TEST_P(DriverContract, RefusesRatherThanWaitsWhenTheWireIsTaken) {
  int accepted = 0;
  while (accepted < 100 && preload(kSeven, 1) == SendStatus::accepted) ++accepted;
  EXPECT_GE(accepted, 1);
  EXPECT_LT(accepted, 100);
  EXPECT_FALSE(driver().ready());
  const std::size_t sent = bench_->sent();
  EXPECT_EQ(preload(kNine, 1), SendStatus::busy);
  EXPECT_EQ(bench_->sent(), sent) << "a refused operation leaves nothing on the wire";
}

TEST_P(DriverContract, IsReadyAgainAfterTheAnswer) {
  ASSERT_EQ(preload(kSeven, 1), SendStatus::accepted);
  bench_->answer_preload(kSeven, 1);
  bench_->step();
  EXPECT_TRUE(driver().ready());
  EXPECT_EQ(preload(kNine, 1), SendStatus::accepted);
}

TEST_P(DriverContract, TellsOnceThatAPreloadIsTaken) {
  ASSERT_EQ(preload(kSeven, 240), SendStatus::accepted);
  EXPECT_EQ(log().count(Kind::preloaded), 0U);
  bench_->answer_preload(kSeven, 240);
  bench_->step();
  bench_->step();
  ASSERT_EQ(log().count(Kind::preloaded), 1U);
  EXPECT_EQ(log().last(Kind::preloaded)->node, kSeven.node);
  EXPECT_EQ(log().last(Kind::preloaded)->sequence, 240);
  EXPECT_EQ(log().count(Kind::showing), 0U) << "a receipt is no proof";
}

/// Who cannot be read back takes a question and tells nothing: neither a look nor a miss.
void expect_no_answer(Bench& bench) {
  ASSERT_EQ(bench.driver->ask(kNine, bench.now), SendStatus::accepted);
  for (int i = 0; i < 3; ++i) {
    bench.stay_silent();
    bench.step();
  }
  EXPECT_TRUE(bench.log.events.empty());
  EXPECT_FALSE(bench.driver->assumption().empty()) << "what is taken for granted is said";
}

TEST_P(DriverContract, WhatIsNotProvedIsSaid) {
  EXPECT_EQ(driver().capabilities().proves_looks, driver().assumption().empty());
}

TEST_P(DriverContract, EveryTaskIsDoneOrRefusedWithAReason) {
  for (const Task task : {Task::probe, Task::identify, Task::set_address, Task::health, Task::clock, Task::patch}) {
    const std::string_view refusal = driver().refusal(task);
    if (!refusal.empty()) {
      EXPECT_GT(refusal.size(), 20U) << refusal;
      continue;
    }
    log().answers.clear();
    const auto begin = [&] {
      switch (task) {
        case Task::probe:
          return driver().probe(7, 0, bench_->now);
        case Task::identify:
          return driver().identify(7, true, bench_->now);
        case Task::set_address:
          return driver().set_address(7, 0x12345678, 11, bench_->now);
        case Task::health:
          return driver().ask_health(7, bench_->now);
        case Task::clock:
          return driver().ask_clock(7, bench_->now);
        case Task::patch:
          return driver().ask_patch(7, 0x12345678, bench_->now);
      }
      return SendStatus::down;
    };
    ASSERT_EQ(begin(), SendStatus::accepted) << to_text(task);
    for (int i = 0; i < 20 && (log().answers.empty() || !driver().ready()); ++i) {
      bench_->step();
      bench_->stay_silent();
      bench_->step();
      bench_->settle();
      bench_->step();
    }
    ASSERT_FALSE(log().answers.empty()) << to_text(task) << " ends also when nobody answers";
    EXPECT_EQ(log().answers.back().task, task);
    EXPECT_EQ(log().answers.back().address, 7);
    EXPECT_NE(log().answers.back().kind, ServiceAnswer::Kind::found) << "nobody has said anything";
    EXPECT_TRUE(driver().ready()) << to_text(task);
  }
}

TEST_P(DriverContract, ANodeThatDoesNotTellWhatItKeepsIsNotMissed) {
  EXPECT_EQ(driver().capabilities().keeps_checks, driver().refusal(Task::patch).empty());
  if (!driver().capabilities().keeps_checks) return;
  EXPECT_GT(driver().kept_time(), Duration{});
  ASSERT_EQ(driver().tell_plan(0x89ABCDEF, bench_->now), SendStatus::accepted);
  bench_->settle();
  bench_->now += milliseconds(10);
  bench_->finish();
  ASSERT_EQ(driver().ask_kept(kSeven, bench_->now), SendStatus::accepted);
  for (int i = 0; i < 5; ++i) {
    bench_->step();
    bench_->stay_silent();
    bench_->settle();
    bench_->step();
  }
  EXPECT_TRUE(driver().ready());
  EXPECT_EQ(log().count(Kind::keeps), 0U);
  EXPECT_EQ(log().count(Kind::missed), 0U);
}

TEST_P(DriverContract, TellsWhatANodeShows) {
  if (!driver().capabilities().readback) return expect_no_answer(*bench_);
  ASSERT_EQ(driver().ask(kNine, bench_->now), SendStatus::accepted);
  bench_->answer_status(kNine, {200, 0x1234, 2, 0x0102});
  bench_->step();
  ASSERT_EQ(log().count(Kind::showing), 1U);
  const DeviceEvent& event = *log().last(Kind::showing);
  EXPECT_EQ(event.node, kNine.node);
  EXPECT_EQ(event.sequence, 200);
  EXPECT_EQ(event.crc, 0x1234);
  EXPECT_EQ(event.state, 2);
  EXPECT_EQ(event.boots, 0x0102);
}

TEST_P(DriverContract, ANodeThatDoesNotAnswerIsMissed) {
  if (!driver().capabilities().readback) return expect_no_answer(*bench_);
  ASSERT_EQ(driver().ask(kNine, bench_->now), SendStatus::accepted);
  bench_->step();
  EXPECT_EQ(log().count(Kind::missed), 0U) << "not before its time";
  bench_->stay_silent();
  bench_->step();
  const DeviceEvent* missed = log().last(Kind::missed);
  ASSERT_NE(missed, nullptr);
  EXPECT_EQ(missed->node, kNine.node);
  EXPECT_EQ(log().count(Kind::showing), 0U);
  bench_->settle();
  bench_->step();
  EXPECT_TRUE(driver().ready()) << "one silent node must not keep the bus";
}

TEST_P(DriverContract, WantsToBeCalledWhenAnAnswerIsOverdue) {
  if (!driver().capabilities().readback) return expect_no_answer(*bench_);
  ASSERT_EQ(driver().ask(kNine, bench_->now), SendStatus::accepted);
  const Instant next = bench_->step();
  EXPECT_GT(next, bench_->now);
  EXPECT_LE(next, bench_->now + milliseconds(100));
}

TEST_P(DriverContract, WantsNothingWhenNothingIsAwaited) {
  EXPECT_EQ(bench_->step(), kNever);
  EXPECT_TRUE(log().events.empty());
}

TEST_P(DriverContract, GarbageIsHarmlessAndAnswersAfterItAreUnderstood) {
  Rng rng(7);
  for (int round = 0; round < 50; ++round) {
    bench_->garbage(rng);
    bench_->step();
  }
  EXPECT_TRUE(log().events.empty()) << "nothing was asked";
  if (!driver().capabilities().readback) return expect_no_answer(*bench_);
  ASSERT_EQ(driver().ask(kSeven, bench_->now), SendStatus::accepted);
  bench_->garbage(rng);
  bench_->step();
  EXPECT_EQ(log().count(Kind::showing), 0U);
  bench_->stay_silent();
  bench_->step();
  bench_->settle();
  bench_->step();
  ASSERT_EQ(driver().ask(kSeven, bench_->now), SendStatus::accepted);
  bench_->answer_status(kSeven, {});
  bench_->step();
  EXPECT_EQ(log().count(Kind::showing), 1U);
}

TEST_P(DriverContract, ARestartIsToldBeforeWhatTheNodeShows) {
  if (!driver().capabilities().readback) return expect_no_answer(*bench_);
  for (const std::uint16_t boots : std::array<std::uint16_t, 3>{5, 5, 6}) {
    bench_->settle();
    bench_->step();
    ASSERT_EQ(driver().ask(kSeven, bench_->now), SendStatus::accepted);
    bench_->answer_status(kSeven, {17, 0xBEEF, 1, boots});
    bench_->step();
    bench_->step();
    bench_->now += milliseconds(100);
  }
  ASSERT_EQ(log().count(Kind::booted), 1U);
  EXPECT_EQ(log().last(Kind::booted)->node, kSeven.node);
  const auto seen = [&](const DeviceEvent& event) { return event.kind == Kind::booted; };
  const auto booted = std::find_if(log().events.begin(), log().events.end(), seen);
  ASSERT_NE(booted + 1, log().events.end());
  EXPECT_EQ((booted + 1)->kind, Kind::showing);
}

TEST_P(DriverContract, TheWireIsToldDownOnceAndUpOnce) {
  bench_->set_wire(SendStatus::down);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(driver().heartbeat({}, bench_->now), SendStatus::down);
    bench_->now += milliseconds(250);
    bench_->step();
  }
  EXPECT_EQ(log().count(Kind::bus_down), 1U);
  EXPECT_EQ(preload(kSeven, 1), SendStatus::down);
  bench_->set_wire(SendStatus::accepted);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(driver().heartbeat({}, bench_->now), SendStatus::accepted);
    bench_->now += milliseconds(250);
    bench_->finish();
  }
  EXPECT_EQ(log().count(Kind::bus_down), 1U);
  EXPECT_EQ(log().count(Kind::bus_up), 1U);
}

TEST_P(DriverContract, BudgetsComeFromTheWireTime) {
  EXPECT_GT(driver().latch_time(), Duration{});
  if (!driver().capabilities().readback) return;  // nothing goes out but the latch
  EXPECT_GT(driver().status_time(), Duration{});
  EXPECT_GT(driver().preload_time(1), Duration{});
  for (int channels = 1; channels < 32; ++channels) {
    EXPECT_LE(driver().preload_time(channels), driver().preload_time(channels + 1)) << channels;
  }
  EXPECT_LT(driver().preload_time(1), driver().preload_time(32));
}

TEST_P(DriverContract, ALatchIsOneOperationWithoutReceipt) {
  ASSERT_EQ(driver().latch(Sequence{1}, bench_->now), SendStatus::accepted);
  EXPECT_EQ(bench_->sent(), 1U);
  bench_->now += driver().latch_time();
  bench_->finish();
  EXPECT_TRUE(driver().ready());
  EXPECT_TRUE(log().events.empty());
}

INSTANTIATE_TEST_SUITE_P(
    EveryLanguage, DriverContract,
    ::testing::Values(Language{"serial", [] { return std::make_unique<SerialBench>(); }},
                      Language{"canopen", [] { return std::make_unique<CanBench>(); }},
                      Language{"dmx", [] { return std::make_unique<DmxBench>(); }},
                      Language{"modbus_rtu", [] { return std::make_unique<ModbusBench>(BusKind::modbus_rtu); }},
                      Language{"modbus_tcp", [] { return std::make_unique<ModbusBench>(BusKind::modbus_tcp); }}),
    [](const auto& language) { return language.param.name; });

}  // namespace
}  // namespace footlight::drivers
