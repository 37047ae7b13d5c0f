// SPDX-License-Identifier: Apache-2.0
// What every byte stream and every Modbus port owes its driver, over the table of transports: the simulated ones and,
// with the real libraries, pseudo-terminals and TCP. Simulated markers answer at the far end of each.
#include <functional>
#include <optional>

#include <gtest/gtest.h>
#include <poll.h>

#include "drivers/devices/footlight_serial/serial_driver.hpp"
#include "drivers/devices/footlight_serial/serial_frame.hpp"
#include "drivers/devices/modbus/modbus_driver.hpp"
#include "tests/contracts/port_bench.hpp"
#include "tests/drivers/recording_ports.hpp"

namespace footlight::contracts {
namespace {

using drivers::DeviceEvent;
using drivers::ModbusReply;
using drivers::ModbusRequest;
using drivers::NodeAddress;
using drivers::SendStatus;
using Bytes = std::vector<std::uint8_t>;

constexpr int kPatience = 3'000;  // passes, a millisecond at most each; the end of a test that fails

// ---- byte streams

struct SerialKind {
  std::string name;
  std::unique_ptr<SerialBench> (*make)();
};

class ByteStreamContract : public ::testing::TestWithParam<SerialKind> {
 protected:
  drivers::ByteStream& port() { return bench_->port(); }
  /// Sends a question for the status and waits for the whole answer.
  Bytes ask(std::uint8_t address) {
    namespace serial = drivers::footlight_serial;
    EXPECT_EQ(port().write(serial::encode(serial::status_request(address, 0xA3))), SendStatus::accepted);
    return hear(serial::frame_length(serial::kStatusBody));
  }
  Bytes hear(std::size_t count) {
    Bytes heard;
    for (int i = 0; i < kPatience && heard.size() < count; ++i) {
      Bytes buffer(7);  // smaller than an answer
      buffer.resize(port().read(buffer));
      heard.insert(heard.end(), buffer.begin(), buffer.end());
      if (buffer.empty()) bench_->pass();
    }
    return heard;
  }

  std::unique_ptr<SerialBench> bench_ = GetParam().make();
};

TEST_P(ByteStreamContract, CarriesAQuestionThereAndItsAnswerBack) {
  namespace serial = drivers::footlight_serial;
  for (const std::uint8_t address : {kFirstMarker, kSecondMarker}) {
    serial::FrameReceiver receiver;
    std::optional<serial::Frame> answer;
    for (const std::uint8_t byte : ask(address)) {
      if (auto frame = receiver.take(byte)) answer = frame;
    }
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->address, address);
    EXPECT_EQ(answer->plan_byte, 0xA3);
    EXPECT_EQ(answer->direction, serial::Direction::from_node);
  }
}

TEST_P(ByteStreamContract, ReadingNothingIsNothing) {
  Bytes buffer(64, 0xEE);
  EXPECT_EQ(port().read(buffer), 0U);
  EXPECT_EQ(buffer, Bytes(64, 0xEE));
  EXPECT_EQ(port().write({}), SendStatus::accepted);
}

TEST_P(ByteStreamContract, TimeOnTheWireIsThatOfTheCharacters) {
  EXPECT_EQ(port().wire_time(0), Duration{});
  EXPECT_NEAR(static_cast<double>(port().wire_time(1'152).count()), 1e8, 1.0) << "115,200 Bd, ten bits each";
}

TEST_P(ByteStreamContract, TheHandleIsReadableWhenSomethingHasArrived) {
  if (!bench_->real()) {
    EXPECT_EQ(port().poll_handle(), -1) << "virtual time has nothing to sleep on";
    return;
  }
  const auto readable = [&](int patience_ms) {
    pollfd file{port().poll_handle(), POLLIN, 0};
    return ::poll(&file, 1, patience_ms) > 0;
  };
  EXPECT_FALSE(readable(0));
  namespace serial = drivers::footlight_serial;
  ASSERT_EQ(port().write(serial::encode(serial::status_request(kFirstMarker, 1))), SendStatus::accepted);
  EXPECT_TRUE(readable(kPatience));
}

TEST_P(ByteStreamContract, AnUnpluggedPortIsDownSaysWhyAndComesBack) {
  if (!bench_->unplug()) {
    EXPECT_EQ(port().trouble(), "");
    return;
  }
  Bytes buffer(16);
  EXPECT_EQ(port().read(buffer), 0U);
  EXPECT_EQ(port().poll_handle(), -1) << "nothing to spin on";
  EXPECT_EQ(port().write(Bytes{1}), SendStatus::down);
  EXPECT_NE(port().trouble(), "");
  bench_->replug();
  EXPECT_FALSE(ask(kFirstMarker).empty());
  EXPECT_EQ(port().trouble(), "");
}

TEST_P(ByteStreamContract, TheDriverLightsBothMarkers) {
  const NodeAddress one{NodeIndex(0), kFirstMarker, kChannels};
  const NodeAddress two{NodeIndex(1), kSecondMarker, kChannels};
  drivers::SerialDriver driver(port(), {one, two}, 0xA3);
  drivers::EventLog log;
  Instant now = kStart;
  const auto until = [&](const std::function<bool()>& done) {
    for (int i = 0; i < kPatience && !done(); ++i) {
      bench_->pass();
      now += milliseconds(1);
      driver.step(now, log);
    }
    return done();
  };
  for (const NodeAddress& node : {one, two}) {
    ASSERT_EQ(driver.preload(node, 17, Bytes{9, 8, 7, 6}, now), SendStatus::accepted);
    ASSERT_TRUE(until([&] { return driver.ready(); }));
  }
  EXPECT_EQ(log.count(DeviceEvent::Kind::preloaded), 2U);
  ASSERT_EQ(driver.latch(17, now), SendStatus::accepted);
  EXPECT_TRUE(until([&] { return bench_->shown(kFirstMarker) == 9 && bench_->shown(kSecondMarker) == 9; }));
}

INSTANTIATE_TEST_SUITE_P(EveryTransport, ByteStreamContract,
                         ::testing::Values(SerialKind{"simulated", simulated_serial},
                                           SerialKind{"pseudo_terminal", pseudo_terminal_serial}),
                         [](const auto& kind) { return kind.param.name; });

// ---- Modbus

struct ModbusKind {
  std::string name;
  std::unique_ptr<ModbusBench> (*make)();
};

class ModbusPortContract : public ::testing::TestWithParam<ModbusKind> {
 protected:
  drivers::ModbusPort& port() { return bench_->port(); }
  std::optional<ModbusReply> exchange(const ModbusRequest& request) {
    EXPECT_EQ(port().submit(request), SendStatus::accepted);
    for (int i = 0; i < kPatience; ++i) {
      if (auto reply = port().poll()) return reply;
      if (!port().busy()) return std::nullopt;
      bench_->pass();
    }
    return std::nullopt;
  }
  static ModbusRequest read(std::uint8_t unit, std::uint16_t first, std::uint16_t count) {
    return {unit, 0x03, first, count, {}};
  }
  static ModbusRequest write(std::uint8_t unit, std::uint16_t first, std::vector<std::uint16_t> values) {
    const auto count = static_cast<std::uint16_t>(values.size());
    return {unit, 0x10, first, count, std::move(values)};
  }

  std::unique_ptr<ModbusBench> bench_ = GetParam().make();
};

TEST_P(ModbusPortContract, ReadsAndWritesRegistersOfTheUnitThatIsAsked) {
  const auto receipt = exchange(write(kSecondMarker, 0, {0xA305, 0x0908, 0x0706}));
  ASSERT_TRUE(receipt);
  EXPECT_EQ(receipt->outcome, ModbusReply::Outcome::ok);
  EXPECT_EQ(receipt->unit, kSecondMarker);
  EXPECT_EQ(receipt->function, 0x10);
  const auto second = exchange(read(kSecondMarker, 0x40, 1));
  ASSERT_TRUE(second);
  EXPECT_EQ(second->values, (std::vector<std::uint16_t>{0x0005})) << "pending";
  const auto first = exchange(read(kFirstMarker, 0x40, 1));
  ASSERT_TRUE(first);
  EXPECT_EQ(first->values, (std::vector<std::uint16_t>{0x0000}));
}

TEST_P(ModbusPortContract, ABroadcastReachesEverybodyAndHasNoReply) {
  for (const std::uint8_t unit : {kFirstMarker, kSecondMarker}) exchange(write(unit, 0, {0xA307, 0x0303, 0x0303}));
  const std::uint16_t word = 0xA307;
  const auto reply = exchange(
      write(0, 0x20, {word, static_cast<std::uint16_t>(word ^ 0x5A5A), static_cast<std::uint16_t>(word ^ 0xA5A5)}));
  EXPECT_FALSE(reply);
  EXPECT_FALSE(port().busy());
  for (const std::uint8_t unit : {kFirstMarker, kSecondMarker}) {
    const auto status = exchange(read(unit, 0x40, 1));
    ASSERT_TRUE(status);
    EXPECT_EQ(status->values, (std::vector<std::uint16_t>{0x0700})) << "unit " << int{unit} << " shows 7";
    EXPECT_EQ(bench_->shown(unit), 3);
  }
}

TEST_P(ModbusPortContract, ARefusalKeepsItsCode) {
  const auto reply = exchange(read(kFirstMarker, 0x7777, 1));
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->outcome, ModbusReply::Outcome::exception);
  EXPECT_EQ(reply->exception_code, 2);
  EXPECT_TRUE(reply->values.empty());
}

TEST_P(ModbusPortContract, AUnitThatIsNotThereIsATimeOutAndTheNextIsHeard) {
  const auto nobody = exchange(read(kNobody, 0x40, 1));
  ASSERT_TRUE(nobody);
  EXPECT_EQ(nobody->outcome, ModbusReply::Outcome::timeout);
  EXPECT_EQ(nobody->unit, kNobody);
  const auto reply = exchange(read(kFirstMarker, 0x40, 2));
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->outcome, ModbusReply::Outcome::ok);
}

TEST_P(ModbusPortContract, OneRequestAtATimeAndItsReplyOnce) {
  EXPECT_FALSE(port().busy());
  EXPECT_EQ(port().poll(), std::nullopt);
  ASSERT_EQ(port().submit(read(kFirstMarker, 0x40, 1)), SendStatus::accepted);
  EXPECT_TRUE(port().busy());
  EXPECT_EQ(port().submit(read(kFirstMarker, 0x40, 1)), SendStatus::busy);
  std::optional<ModbusReply> reply;
  for (int i = 0; i < kPatience && !reply; ++i) {
    reply = port().poll();
    if (!reply) bench_->pass();
  }
  ASSERT_TRUE(reply);
  EXPECT_FALSE(port().busy());
  EXPECT_EQ(port().poll(), std::nullopt);
  EXPECT_FALSE(port().discard()) << "nothing is left over";
}

TEST_P(ModbusPortContract, TimeOnTheWireGrowsWithTheRegisters) {
  EXPECT_LT(port().wire_time(write(0, 0x20, {1, 2, 3})), port().wire_time(read(kFirstMarker, 0x40, 6)));
  EXPECT_LE(port().wire_time(read(kFirstMarker, 0x40, 1)), port().wire_time(read(kFirstMarker, 0x40, 6)));
  EXPECT_GT(port().wire_time(write(0, 0x20, {1})), Duration{});
}

TEST_P(ModbusPortContract, AnUnpluggedPortIsDownSaysWhyAndComesBack) {
  exchange(read(kFirstMarker, 0x40, 1));
  if (!bench_->unplug()) {
    EXPECT_EQ(port().trouble(), "");
    return;
  }
  EXPECT_EQ(port().submit(read(kFirstMarker, 0x40, 1)), SendStatus::down);
  EXPECT_NE(port().trouble(), "");
  bench_->replug();
  const auto reply = exchange(read(kFirstMarker, 0x40, 1));
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->outcome, ModbusReply::Outcome::ok);
  EXPECT_EQ(port().trouble(), "");
}

TEST_P(ModbusPortContract, TheDriverLightsBothMarkersAndReadsThemBack) {
  const NodeAddress one{NodeIndex(0), kFirstMarker, kChannels};
  const NodeAddress two{NodeIndex(1), kSecondMarker, kChannels};
  drivers::ModbusDriver driver(port(), footlight_marker_profile(), {one, two}, 0xA3);
  drivers::EventLog log;
  Instant now = kStart;
  const auto finish = [&] {
    for (int i = 0; i < kPatience; ++i) {
      driver.step(now, log);
      if (driver.ready()) return true;
      bench_->pass();
      now += milliseconds(1);
    }
    return false;
  };
  const Bytes looks{9, 8, 7, 6};
  for (const NodeAddress& node : {one, two}) {
    ASSERT_EQ(driver.preload(node, 17, looks, now), SendStatus::accepted);
    ASSERT_TRUE(finish());
  }
  ASSERT_EQ(driver.latch(17, now), SendStatus::accepted);
  ASSERT_TRUE(finish());
  for (const NodeAddress& node : {one, two}) {
    ASSERT_EQ(driver.ask(node, now), SendStatus::accepted);
    ASSERT_TRUE(finish());
    ASSERT_EQ(bench_->shown(node.unit()), 9);
    const DeviceEvent* showing = log.last(DeviceEvent::Kind::showing);
    ASSERT_NE(showing, nullptr);
    EXPECT_EQ(showing->node, node.node);
    EXPECT_EQ(showing->sequence, 17);
    EXPECT_EQ(showing->crc, drivers::looks_crc(looks));
  }
  EXPECT_EQ(log.count(DeviceEvent::Kind::missed), 0U);
}

std::vector<ModbusKind> modbus_kinds() {
  std::vector<ModbusKind> kinds{{"simulated_rtu", simulated_rtu}, {"simulated_tcp", simulated_tcp}};
#if FOOTLIGHT_WITH_libmodbus
  kinds.push_back({"pseudo_terminal", pseudo_terminal_rtu});
  kinds.push_back({"loopback", loopback_tcp});
#endif
  return kinds;
}

INSTANTIATE_TEST_SUITE_P(EveryTransport, ModbusPortContract, ::testing::ValuesIn(modbus_kinds()),
                         [](const auto& kind) { return kind.param.name; });

}  // namespace
}  // namespace footlight::contracts
