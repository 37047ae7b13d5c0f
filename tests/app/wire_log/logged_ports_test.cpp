// SPDX-License-Identifier: Apache-2.0
#include "app/wire_log/logged_ports.hpp"

#include <gtest/gtest.h>

#include "app/simulated_buses.hpp"
#include "core/clock.hpp"
#include "sim/simulated_rig.hpp"
#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct Recorded {
  std::size_t bus;
  Heading heading;
  Bytes packet;
  friend bool operator==(const Recorded&, const Recorded&) = default;
};

class Recording final : public WireLog {
 public:
  void record(std::size_t bus, Heading heading, std::span<const std::uint8_t> packet) noexcept override {
    all.push_back({bus, heading, {packet.begin(), packet.end()}});
  }
  std::vector<Recorded> all;
};

class LoggedPortsTest : public ::testing::Test {
 protected:
  template <class Port>
  Port& before(BusKind kind) {
    grid_ = Grid::make(GridKind::square, 4, 1, 1).value();
    simulated_ = std::make_unique<sim::SimulatedRig>(tests::lamps_everywhere(*grid_, {kind}, 115'200, 4), sim::Faults{},
                                                     1, clock_, nullptr);
    drivers::PortReference port;
    if constexpr (std::is_same_v<Port, drivers::CanPort>) {
      port = &simulated_->can(BusIndex(0));
    } else if constexpr (std::is_same_v<Port, drivers::ByteStream>) {
      port = &simulated_->serial(BusIndex(0));
    } else {
      port = &simulated_->modbus(BusIndex(0));
    }
    return *std::get<Port*>(logged_.before(3, kind, port));
  }
  void run_for(Duration duration) { simulated_->advance_to(clock_.now() + duration); }

  ManualClock clock_;
  std::optional<Grid> grid_;
  std::unique_ptr<sim::SimulatedRig> simulated_;
  Recording log_;
  LoggedPorts logged_{log_};
};

TEST_F(LoggedPortsTest, CanFramesHaveTheHeaderOfSocketCan) {
  auto& port = before<drivers::CanPort>(BusKind::can);
  ASSERT_EQ(port.send({.id = 0x080, .length = 1, .data = {9}}), drivers::SendStatus::accepted);
  ASSERT_EQ(log_.all.size(), 1U);
  EXPECT_EQ(log_.all[0], (Recorded{3, Heading::sent, {0, 0, 0, 0x80, 1, 0, 0, 0, 9}}));
  const Duration sync = port.wire_time({.id = 0x080, .length = 1, .data = {9}});
  EXPECT_EQ(logged_.carried(0), sync);
  ASSERT_EQ(port.send({.id = 0x000, .length = 2, .data = {1, 0}}), drivers::SendStatus::accepted);
  ASSERT_EQ(port.send({.id = 0x080, .length = 1, .data = {10}}), drivers::SendStatus::accepted);
  run_for(milliseconds(20));
  drivers::CanFrame frame;
  ASSERT_TRUE(port.receive(frame)) << "the status after the SYNC";
  ASSERT_EQ(log_.all.size(), 4U);
  EXPECT_EQ(logged_.carried(0), 2 * sync + port.wire_time({.id = 0, .length = 2, .data = {}}) + port.wire_time(frame));
  EXPECT_EQ(log_.all[3].heading, Heading::received);
  EXPECT_EQ(Bytes(log_.all[3].packet.begin(), log_.all[3].packet.begin() + 9), (Bytes{0, 0, 1, 0x81, 8, 0, 0, 0, 10}));
}

TEST_F(LoggedPortsTest, SerialBytesHaveTheHeaderOfAnRtac) {
  auto& port = before<drivers::ByteStream>(BusKind::serial);
  ASSERT_EQ(port.write(Bytes{0, 7, 0}), drivers::SendStatus::accepted);
  EXPECT_EQ(log_.all.at(0), (Recorded{3, Heading::sent, {0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 7, 0}}));
  Bytes buffer(10);
  EXPECT_EQ(port.read(buffer), 0U);
  EXPECT_EQ(log_.all.size(), 1U) << "nothing is no packet";
  EXPECT_EQ(logged_.carried(0), port.wire_time(3));
}

TEST_F(LoggedPortsTest, RtuRequestsAndRepliesAreTheFramesOfTheLine) {
  auto& port = before<drivers::ModbusPort>(BusKind::modbus_rtu);
  ASSERT_EQ(port.submit({1, 3, 0x43, 1, {}}), drivers::SendStatus::accepted);
  EXPECT_FALSE(port.poll());
  run_for(milliseconds(50));
  ASSERT_TRUE(port.poll());
  const Bytes tag{0, 12, 0, 8, 'm', 'b', 'r', 't', 'u', 0, 0, 0, 0, 0, 0, 0};
  Bytes query = tag;
  query.insert(query.end(), {1, 3, 0, 0x43, 0, 1, 0x75, 0xDE});
  Bytes reply = tag;
  reply.insert(reply.end(), {1, 3, 2, 0, 1, 0x79, 0x84});
  EXPECT_EQ(log_.all, (std::vector<Recorded>{{3, Heading::sent, query}, {3, Heading::received, reply}}));
}

TEST_F(LoggedPortsTest, AnExceptionIsLoggedAndATimeoutIsNot) {
  auto& port = before<drivers::ModbusPort>(BusKind::modbus_rtu);
  ASSERT_EQ(port.submit({1, 3, 0x100, 1, {}}), drivers::SendStatus::accepted);
  run_for(milliseconds(50));
  ASSERT_TRUE(port.poll());
  ASSERT_EQ(log_.all.size(), 2U);
  EXPECT_EQ(Bytes(log_.all[1].packet.begin() + 16, log_.all[1].packet.end() - 2), (Bytes{1, 0x83, 2}));
  ASSERT_EQ(port.submit({9, 3, 0x43, 1, {}}), drivers::SendStatus::accepted) << "a unit that nobody is";
  run_for(milliseconds(200));
  ASSERT_TRUE(port.poll());
  EXPECT_EQ(log_.all.size(), 3U);
}

TEST_F(LoggedPortsTest, TcpRequestsAndRepliesLieInOneConnectionInOrder) {
  auto& port = before<drivers::ModbusPort>(BusKind::modbus_tcp);
  for (int i = 0; i < 2; ++i) {
    ASSERT_EQ(port.submit({1, 3, 0x43, 1, {}}), drivers::SendStatus::accepted);
    run_for(milliseconds(50));
    ASSERT_TRUE(port.poll());
  }
  ASSERT_EQ(log_.all.size(), 4U);
  const auto number = [&](std::size_t packet, std::size_t at) {
    const Bytes& bytes = log_.all[packet].packet;
    return (std::uint32_t{bytes[at]} << 24U) | (std::uint32_t{bytes[at + 1]} << 16U) |
           (std::uint32_t{bytes[at + 2]} << 8U) | bytes[at + 3];
  };
  constexpr std::size_t kSequence = 24;
  constexpr std::size_t kAcknowledged = 28;
  EXPECT_EQ(number(0, kSequence), 1U);
  EXPECT_EQ(number(1, kAcknowledged), 13U) << "the 12 bytes of the request";
  EXPECT_EQ(number(2, kSequence), 13U);
  EXPECT_EQ(number(2, kAcknowledged), 12U) << "the 11 bytes of the reply";
  EXPECT_EQ(Bytes(log_.all[3].packet.begin() + 40, log_.all[3].packet.end()), (Bytes{0, 2, 0, 0, 0, 5, 1, 3, 2, 0, 1}));
}

}  // namespace
}  // namespace footlight::app
