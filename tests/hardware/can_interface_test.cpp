// SPDX-License-Identifier: Apache-2.0
// SocketCAN as the kernel gives it: controllers with drivers of their own, virtual interfaces, a serial adapter.
#include "drivers/transports/can_interface.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/can/error.h>

#include "drivers/transports/can_socket.hpp"
#include "tests/hardware/guest.hpp"
#include "tests/hardware/slcan_adapter.hpp"

namespace footlight::hardware {
namespace {

using drivers::CanFrame;
using drivers::CanPort;
using drivers::CanState;
using drivers::SendStatus;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr CanFrame kFrame{.id = 0x201, .length = 2, .data = {1, 2}};

std::unique_ptr<CanPort> open_port(const std::string& interface) {
  auto port = drivers::open_can(interface, 500'000);
  EXPECT_TRUE(port) << port.error().message;
  return std::move(port).value();
}

/// Brings the interface up anew, as if nothing had been done to it.
void bring_up(const std::string& interface, const std::string& settings) {
  run("ip link set " + interface + " down; ip link set " + interface + " txqueuelen 10; ip link set " + interface +
      " up " + settings);
}

/// The next data frame that arrives, or an empty one.
CanFrame next_frame(CanPort& port) {
  CanFrame frame;
  const auto arrived = [&] { return port.receive(frame) && frame.kind != CanFrame::Kind::error; };
  return eventually(arrived) ? frame : CanFrame{};
}

bool becomes(CanPort& port, CanState state) {
  return eventually([&] {
    CanFrame frame;
    while (port.receive(frame)) {
    }
    return port.state() == state;
  });
}

std::vector<std::string> objections_to(const std::string& interface) {
  const auto settings = drivers::read_can_interface(interface);
  EXPECT_TRUE(settings) << settings.error().message;
  std::vector<std::string> texts;
  for (const drivers::Objection& objection : drivers::objections(*settings, 500'000)) texts.push_back(objection.text);
  return texts;
}

/// Two controllers on one bus.
struct Pair {
  std::string kind;
  std::string here;
  std::string there;
  std::string settings;
};

class CanController : public ::testing::TestWithParam<Pair> {
 protected:
  CanController() {
    bring_up(GetParam().here, GetParam().settings);
    bring_up(GetParam().there, GetParam().settings);
    here_ = open_port(GetParam().here);
    there_ = open_port(GetParam().there);
  }
  std::unique_ptr<CanPort> here_;
  std::unique_ptr<CanPort> there_;
};

TEST_P(CanController, FramesOfEveryLengthGoBothWaysInOrder) {
  for (std::uint8_t length = 0; length <= 8; ++length) {
    CanFrame sent{.id = static_cast<std::uint16_t>(0x200 + length), .length = length, .data = {}};
    for (std::uint8_t i = 0; i < length; ++i) sent.data.at(i) = static_cast<std::uint8_t>(0xA0 + i);
    ASSERT_EQ(here_->send(sent), SendStatus::accepted);
    EXPECT_EQ(next_frame(*there_), sent);
    ASSERT_EQ(there_->send(sent), SendStatus::accepted);
    EXPECT_EQ(next_frame(*here_), sent);
  }
}

TEST_P(CanController, TheEchoOfEachFrameEmptiesTheQueueAndIsNotHeard) {
  for (int i = 0; i < 8; ++i) ASSERT_EQ(here_->send(kFrame), SendStatus::accepted);
  CanFrame frame;
  EXPECT_TRUE(eventually([&] {
    EXPECT_FALSE(here_->receive(frame));
    return here_->queued() == 0;
  }));
  EXPECT_EQ(here_->state(), CanState::active);
}

TEST_P(CanController, AThousandFramesArriveOnceAndInOrderThroughAQueueOfTen) {
  constexpr int kFrames = 1000;
  int sent = 0;
  int heard = 0;
  CanFrame frame;
  EXPECT_TRUE(eventually([&] {
    while (sent < kFrames && here_->queued() < 8) {
      CanFrame next{.id = 0x202, .length = 2, .data = {}};
      next.data[0] = static_cast<std::uint8_t>(sent & 0xFF);
      next.data[1] = static_cast<std::uint8_t>(sent >> 8);
      if (here_->send(next) != SendStatus::accepted) break;
      ++sent;
    }
    EXPECT_FALSE(here_->receive(frame));
    while (there_->receive(frame)) {
      EXPECT_EQ(frame.data[0] | (frame.data[1] << 8), heard);
      ++heard;
    }
    return heard >= kFrames;
  }));
  EXPECT_EQ(heard, kFrames);
}

TEST_P(CanController, AnInterfaceThatIsTakenDownIsDownAndComesBack) {
  run("ip link set " + GetParam().here + " down");
  EXPECT_EQ(here_->send(kFrame), SendStatus::down);
  EXPECT_EQ(here_->state(), CanState::down);
  EXPECT_EQ(here_->queued(), 0U);
  run("ip link set " + GetParam().here + " up");
  ASSERT_TRUE(becomes(*here_, CanState::active));
  ASSERT_EQ(here_->send(kFrame), SendStatus::accepted);
  EXPECT_EQ(next_frame(*there_), kFrame);
}

TEST_P(CanController, TheEndOfAnInterfaceIsHeardWithoutSending) {
  run("ip link set " + GetParam().here + " down");
  EXPECT_TRUE(becomes(*here_, CanState::down));
}

TEST_P(CanController, ThePreflightSeesTheKernelsSettingsAndItsCommandsMendThem) {
  const std::string& name = GetParam().here;
  EXPECT_THAT(objections_to(name), IsEmpty());
  run("ip link set " + name + " down; ip link set " + name + " txqueuelen 4 up type can bitrate 250000 restart-ms 0");
  const auto wrong = objections_to(name);
  ASSERT_EQ(wrong.size(), 3U) << ::testing::PrintToString(wrong);
  for (const std::string& objection : wrong) {
    const auto from = objection.find('(') + 1;
    run(objection.substr(from, objection.rfind(')') - from));
  }
  EXPECT_THAT(objections_to(name), IsEmpty());
  run("ip link set " + name + " down");
  EXPECT_EQ(objections_to(name).size(), 1U);
}

TEST_P(CanController, FramesOfTwentyNineBitsAreNotHeard) {
  run("cansend " + GetParam().there + " 12345678#01");
  run("cansend " + GetParam().there + " 181#02");
  EXPECT_EQ(next_frame(*here_).id, 0x181);
}

INSTANTIATE_TEST_SUITE_P(Kinds, CanController,
                         ::testing::Values(Pair{"sja1000", "can0", "can1", "type can bitrate 500000 restart-ms 100"},
                                           Pair{"ctucanfd", "can2", "can3",
                                                "type can bitrate 500000 dbitrate 2000000 fd on restart-ms 100"}),
                         [](const auto& pair) { return pair.param.kind; });

TEST(CtuCanFd, FdFramesOfEveryLengthAndBothRatesArriveAsTheyWereSent) {
  for (const char* name : {"can2", "can3"}) bring_up(name, "type can bitrate 500000 dbitrate 2000000 fd on");
  const auto here = open_port("can2");
  const auto there = open_port("can3");
  for (const auto kind : {CanFrame::Kind::fd, CanFrame::Kind::fd_fast}) {
    for (const int length : {0, 5, 8, 12, 16, 20, 24, 32, 48, 64}) {
      CanFrame sent{.id = 0x123, .length = static_cast<std::uint8_t>(length), .data = {}, .kind = kind};
      for (int i = 0; i < length; ++i) sent.data.at(static_cast<std::size_t>(i)) = static_cast<std::uint8_t>(3 * i + 1);
      ASSERT_EQ(here->send(sent), SendStatus::accepted);
      EXPECT_EQ(next_frame(*there), sent) << length;
    }
  }
}

TEST(Sja1000, AnAdapterThatIsPulledOutIsDownAndComesBackUnderItsName) {
  for (const char* name : {"can0", "can1"}) bring_up(name, "type can bitrate 500000 restart-ms 100");
  const auto here = open_port("can0");
  const auto there = open_port("can1");
  ASSERT_EQ(there->send(kFrame), SendStatus::accepted);
  unplug("sja1");
  EXPECT_TRUE(becomes(*there, CanState::down));
  EXPECT_EQ(there->send(kFrame), SendStatus::down);
  EXPECT_EQ(here->send(kFrame), SendStatus::accepted) << "the other interface lives";
  plug(R"("driver":"kvaser_pci","canbus":"bus0","id":"sja1")");
  ASSERT_TRUE(eventually([] { return run("ip -brief link").find("can1") != std::string::npos; }));
  bring_up("can1", "type can bitrate 500000 restart-ms 100");
  ASSERT_TRUE(becomes(*there, CanState::active));
  ASSERT_EQ(here->send({.id = 0x203, .length = 0, .data = {}}), SendStatus::accepted);
  EXPECT_EQ(next_frame(*there).id, 0x203);
}

class VirtualCan : public ::testing::Test {
 protected:
  VirtualCan() { run("ip link add vcan0 type vcan && ip link set vcan0 up"); }
  ~VirtualCan() override { run("ip link del vcan0"); }
};

TEST_F(VirtualCan, InjectedErrorFramesAreToldAsTheKernelWouldTellThem) {
  const auto port = open_port("vcan0");
  run("cansend vcan0 20000004#0008000000000000");  // CRTL: transmit warning
  EXPECT_TRUE(becomes(*port, CanState::warning));
  run("cansend vcan0 20000004#0020000000000000");
  EXPECT_TRUE(becomes(*port, CanState::passive));
  run("cansend vcan0 20000040#0000000000000000");
  EXPECT_TRUE(becomes(*port, CanState::bus_off));
  EXPECT_EQ(port->send(kFrame), SendStatus::down);
  run("cansend vcan0 20000100#0000000000000000");
  EXPECT_TRUE(becomes(*port, CanState::active));
  EXPECT_EQ(port->send(kFrame), SendStatus::accepted);
}

TEST_F(VirtualCan, NothingIsObjectedTo) {
  run("ip link set vcan0 txqueuelen 10");
  EXPECT_THAT(objections_to("vcan0"), IsEmpty());
}

TEST_F(VirtualCan, ErrorFramesAreHandedOnWithTheirDetail) {
  const auto port = open_port("vcan0");
  run("cansend vcan0 20000020#0000000000000000");  // ACK
  CanFrame frame;
  ASSERT_TRUE(eventually([&] { return port->receive(frame); }));
  EXPECT_EQ(frame.kind, CanFrame::Kind::error);
  EXPECT_EQ(frame.id, CAN_ERR_ACK);
  EXPECT_EQ(port->state(), CanState::active);
}

TEST_F(VirtualCan, ProgramsOnTheSameMachineHearEachOther) {
  const auto here = open_port("vcan0");
  const auto there = open_port("vcan0");
  ASSERT_EQ(here->send(kFrame), SendStatus::accepted);
  EXPECT_EQ(next_frame(*there), kFrame);
  CanFrame frame;
  EXPECT_TRUE(eventually([&] {
    EXPECT_FALSE(here->receive(frame)) << "its own frames are not heard";
    return here->queued() == 0;
  }));
}

TEST(SerialCanAdapter, TellsFramesAndErrorCounters) {
  SlcanAdapter adapter;
  const auto port = open_port(adapter.interface());
  adapter.say("t1812AABB");
  EXPECT_EQ(next_frame(*port), (CanFrame{.id = 0x181, .length = 2, .data = {0xAA, 0xBB}}));
  ASSERT_EQ(port->send(kFrame), SendStatus::accepted);
  EXPECT_TRUE(eventually([&] { return ::testing::Value(adapter.read(), Contains("t20120102")); }));
  adapter.say("sw096000");
  EXPECT_TRUE(becomes(*port, CanState::warning));
  adapter.say("sp128000");
  EXPECT_TRUE(becomes(*port, CanState::passive));
}

TEST(SerialCanAdapter, BusOffIsSeenAndEndsWithTheRestart) {
  SlcanAdapter adapter;
  const auto port = open_port(adapter.interface());
  adapter.say("sb255000");
  ASSERT_TRUE(becomes(*port, CanState::bus_off));
  EXPECT_EQ(port->send(kFrame), SendStatus::down);
  EXPECT_THAT(objections_to(adapter.interface()), Contains(HasSubstr("is bus-off")));
  run("ip link set " + adapter.interface() + " down; ip link set " + adapter.interface() + " up");
  EXPECT_TRUE(becomes(*port, CanState::active));
}

TEST(SerialCanAdapter, AQueueThatNobodyEmptiesIsRefusedAtOnceAndThenStalled) {
  SlcanAdapter adapter;
  const auto port = open_port(adapter.interface());
  SendStatus status = SendStatus::accepted;
  int accepted = 0;
  for (; accepted < 10'000 && status == SendStatus::accepted; ++accepted) status = port->send(kFrame);
  EXPECT_EQ(status, SendStatus::busy);
  ASSERT_TRUE(eventually([&] {
    port->send(kFrame);
    return port->state() == CanState::stalled;
  })) << accepted;
  EXPECT_TRUE(eventually([&] {
    adapter.read();
    CanFrame frame;
    port->receive(frame);
    port->send(kFrame);
    return port->state() == CanState::active;
  }));
}

TEST(SerialCanAdapter, OneThatIsPulledOutIsDown) {
  SlcanAdapter adapter;
  const auto port = open_port(adapter.interface());
  adapter.hang_up();
  EXPECT_TRUE(becomes(*port, CanState::down));
}

}  // namespace
}  // namespace footlight::hardware
