// SPDX-License-Identifier: Apache-2.0
#include "drivers/transports/can_socket.hpp"

#include <array>
#include <cerrno>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <sys/socket.h>

namespace footlight::drivers {
namespace {

constexpr CanFrame kFrame{.id = 1, .length = 0, .data = {}};

/// Keeps frame boundaries as a CAN socket does, on machines whose kernel has no CAN.
class CanSocketTest : public ::testing::Test {
 protected:
  CanSocketTest() {
    std::array<int, 2> pair{-1, -1};
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK, 0, pair.data()), 0);
    far_ = FileDescriptor(pair[1]);
    port_ = std::make_unique<CanSocket>(FileDescriptor(pair[0]), "nosuchcan", 500'000, clock_);
  }
  void arrive(canid_t id, std::uint8_t length) {
    struct can_frame raw {};
    raw.can_id = id;
    raw.can_dlc = length;
    raw.data[0] = 0x42;
    EXPECT_EQ(::write(far_.get(), &raw, sizeof raw), static_cast<ssize_t>(sizeof raw));
  }

  void arrive_error(canid_t classes, std::initializer_list<std::uint8_t> detail = {}) {
    struct can_frame raw {};
    raw.can_id = CAN_ERR_FLAG | classes;
    raw.can_dlc = CAN_ERR_DLC;
    std::copy(detail.begin(), detail.end(), raw.data);
    EXPECT_EQ(::write(far_.get(), &raw, sizeof raw), static_cast<ssize_t>(sizeof raw));
    CanFrame told;
    EXPECT_TRUE(port_->receive(told));
    EXPECT_EQ(told.kind, CanFrame::Kind::error);
    EXPECT_EQ(told.id, classes);
  }

  ManualClock clock_;
  FileDescriptor far_;
  std::unique_ptr<CanSocket> port_;
};

TEST_F(CanSocketTest, SendsTheKernelsFrames) {
  ASSERT_EQ(port_->send({.id = 0x207, .length = 3, .data = {1, 2, 3}}), SendStatus::accepted);
  struct can_frame raw {};
  ASSERT_EQ(::read(far_.get(), &raw, sizeof raw), static_cast<ssize_t>(sizeof raw));
  EXPECT_EQ(raw.can_id, 0x207U);
  EXPECT_EQ(raw.can_dlc, 3);
  EXPECT_EQ(raw.data[2], 3);
  EXPECT_EQ(raw.data[3], 0);
}

TEST_F(CanSocketTest, HearsDataFramesOfElevenBitsAlone) {
  arrive(0x187 | CAN_EFF_FLAG, 1);
  arrive(0x187 | CAN_RTR_FLAG, 0);
  arrive(0x187, 1);
  CanFrame frame;
  ASSERT_TRUE(port_->receive(frame));
  EXPECT_EQ(frame, (CanFrame{.id = 0x187, .length = 1, .data = {0x42}}));
  EXPECT_FALSE(port_->receive(frame));
}

TEST_F(CanSocketTest, FdFramesOfEveryLengthKeepTheirKind) {
  for (const auto kind : {CanFrame::Kind::fd, CanFrame::Kind::fd_fast}) {
    for (const int length : {0, 8, 12, 16, 20, 24, 32, 48, 64}) {
      CanFrame frame{.id = 0x123, .length = static_cast<std::uint8_t>(length), .data = {}, .kind = kind};
      for (int i = 0; i < length; ++i) frame.data.at(static_cast<std::size_t>(i)) = static_cast<std::uint8_t>(i + 1);
      ASSERT_EQ(port_->send(frame), SendStatus::accepted);
      struct canfd_frame raw {};
      ASSERT_EQ(::read(far_.get(), &raw, sizeof raw), static_cast<ssize_t>(CANFD_MTU));
      EXPECT_EQ((raw.flags & CANFD_BRS) != 0, kind == CanFrame::Kind::fd_fast);
      ASSERT_EQ(::write(far_.get(), &raw, CANFD_MTU), static_cast<ssize_t>(CANFD_MTU));
      CanFrame heard;
      ASSERT_TRUE(port_->receive(heard));
      EXPECT_EQ(heard, frame) << length;
    }
  }
}

TEST_F(CanSocketTest, BusOffIsToldAndNothingIsSentUntilTheInterfaceHasRestarted) {
  arrive_error(CAN_ERR_BUSOFF);
  EXPECT_EQ(port_->state(), CanState::bus_off);
  EXPECT_EQ(port_->trouble(),
            "CAN interface \"nosuchcan\": bus-off: silent until it is restarted (wiring and bit rate; restart-ms 100 "
            "restarts it)");
  EXPECT_EQ(port_->send(kFrame), SendStatus::down);
  arrive_error(CAN_ERR_RESTARTED);
  EXPECT_EQ(port_->state(), CanState::active);
  EXPECT_EQ(port_->trouble(), "");
  EXPECT_EQ(port_->send(kFrame), SendStatus::accepted);
}

TEST_F(CanSocketTest, AfterBusOffOfUnknownEndItTriesAgain) {
  arrive_error(CAN_ERR_BUSOFF);
  clock_.advance(milliseconds(999));
  EXPECT_EQ(port_->send(kFrame), SendStatus::down);
  clock_.advance(milliseconds(1));
  EXPECT_EQ(port_->send(kFrame), SendStatus::accepted);
  EXPECT_EQ(port_->state(), CanState::bus_off) << "taken by the kernel is not on the wire";
  arrive(0x181, 8);
  CanFrame frame;
  ASSERT_TRUE(port_->receive(frame));
  EXPECT_EQ(port_->state(), CanState::active) << "what is heard proves that we are on the bus";
}

TEST_F(CanSocketTest, ErrorCountersAreToldByTheirLevels) {
  arrive_error(CAN_ERR_CRTL, {0, CAN_ERR_CRTL_TX_WARNING});
  EXPECT_EQ(port_->state(), CanState::warning);
  arrive_error(CAN_ERR_CRTL, {0, CAN_ERR_CRTL_TX_PASSIVE});
  EXPECT_EQ(port_->state(), CanState::passive);
  arrive_error(CAN_ERR_CRTL, {0, CAN_ERR_CRTL_RX_OVERFLOW});
  EXPECT_EQ(port_->trouble(), "") << "it still sends";
  EXPECT_EQ(port_->state(), CanState::passive) << "an overflow says nothing of the counters";
  EXPECT_EQ(port_->send(kFrame), SendStatus::accepted);
  arrive_error(CAN_ERR_CRTL, {0, CAN_ERR_CRTL_ACTIVE});
  EXPECT_EQ(port_->state(), CanState::active);
}

TEST_F(CanSocketTest, AFullQueueIsBusyAndAfter70MillisecondsStalled) {
  SendStatus status = SendStatus::accepted;
  for (int i = 0; i < 100'000 && status == SendStatus::accepted; ++i) {
    status = port_->send({.id = 0x207, .length = 8, .data = {}});
  }
  EXPECT_EQ(status, SendStatus::busy);
  EXPECT_GT(port_->queued(), 0U);
  EXPECT_EQ(port_->state(), CanState::active);
  clock_.advance(milliseconds(70) + microseconds(200));
  EXPECT_EQ(port_->state(), CanState::stalled);
  EXPECT_THAT(port_->trouble(), ::testing::HasSubstr("frames wait and none leaves: nobody acknowledges"));
}

TEST_F(CanSocketTest, AClosedWireIsDownAndLooksForItsInterfaceAgain) {
  ASSERT_EQ(port_->send(kFrame), SendStatus::accepted);
  far_ = FileDescriptor(-1);
  EXPECT_EQ(port_->send(kFrame), SendStatus::down);
  EXPECT_EQ(port_->state(), CanState::down);
  EXPECT_EQ(port_->trouble(), "CAN interface \"nosuchcan\": taken down, or its adapter is unplugged");
  EXPECT_EQ(port_->queued(), 0U) << "what waited is lost";
  clock_.advance(milliseconds(100));
  CanFrame frame;
  EXPECT_FALSE(port_->receive(frame)) << "there is no interface of that name";
  EXPECT_EQ(port_->state(), CanState::down);
}

TEST(CanWireTime, AFrameOfEightBytesIs135BitsAtWorst) {
  const ManualClock clock;
  CanSocket port(FileDescriptor(-1), "can0", 500'000, clock);
  EXPECT_EQ(worst_can_bits(8), 135);
  EXPECT_EQ(worst_can_bits(0), 55);
  EXPECT_EQ(port.wire_time({.id = 1, .length = 8, .data = {}}), microseconds(270));
}

TEST(CanInterface, OneThatIsNotThereIsRefusedWithWhatWouldHelp) {
  const FileDescriptor probe(::socket(PF_CAN, SOCK_RAW, CAN_RAW));
  const bool kernel_has_can = probe.get() >= 0;
  const auto port = open_can("can77", 500'000);
  ASSERT_FALSE(port);
  EXPECT_EQ(port.error().kind, ErrorKind::device);
  if (kernel_has_can) {
    EXPECT_EQ(port.error().message,
              "CAN interface \"can77\": not found: No such device (ip link set can77 up type can bitrate 500000 "
              "restart-ms 100)");
  } else {
    EXPECT_EQ(port.error().message,
              "CAN interface \"can77\": no socket: Address family not supported by protocol (a kernel with CAN: "
              "modprobe can can_raw)");
  }
}

}  // namespace
}  // namespace footlight::drivers
