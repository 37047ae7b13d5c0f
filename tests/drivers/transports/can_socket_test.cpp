// SPDX-License-Identifier: Apache-2.0
#include "drivers/transports/can_socket.hpp"

#include <array>
#include <cerrno>

#include <gtest/gtest.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <sys/socket.h>

namespace footlight::drivers {
namespace {

/// Keeps frame boundaries as a CAN socket does, on machines whose kernel has no CAN.
class CanSocketTest : public ::testing::Test {
 protected:
  CanSocketTest() {
    std::array<int, 2> pair{-1, -1};
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK, 0, pair.data()), 0);
    far_ = FileDescriptor(pair[1]);
    port_ = std::make_unique<CanSocket>(FileDescriptor(pair[0]), 500'000);
  }
  void arrive(canid_t id, std::uint8_t length) {
    struct can_frame raw {};
    raw.can_id = id;
    raw.can_dlc = length;
    raw.data[0] = 0x42;
    EXPECT_EQ(::write(far_.get(), &raw, sizeof raw), static_cast<ssize_t>(sizeof raw));
  }

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

TEST_F(CanSocketTest, BusOffIsDownUntilTheInterfaceHasRestarted) {
  arrive(CAN_ERR_FLAG | CAN_ERR_BUSOFF, 8);
  CanFrame frame;
  EXPECT_FALSE(port_->receive(frame));
  EXPECT_EQ(port_->send({.id = 1, .length = 0, .data = {}}), SendStatus::down);
  arrive(CAN_ERR_FLAG | CAN_ERR_RESTARTED, 8);
  EXPECT_FALSE(port_->receive(frame));
  EXPECT_EQ(port_->send({.id = 1, .length = 0, .data = {}}), SendStatus::accepted);
}

TEST_F(CanSocketTest, AFullQueueIsBusyAndAClosedWireIsDown) {
  SendStatus status = SendStatus::accepted;
  for (int i = 0; i < 100'000 && status == SendStatus::accepted; ++i) {
    status = port_->send({.id = 0x207, .length = 8, .data = {}});
  }
  EXPECT_EQ(status, SendStatus::busy);
  EXPECT_GT(port_->queued(), 0U);
}

TEST(CanWireTime, AFrameOfEightBytesIs135BitsAtWorst) {
  CanSocket port(FileDescriptor(-1), 500'000);
  EXPECT_EQ(worst_can_bits(8), 135);
  EXPECT_EQ(worst_can_bits(0), 55);
  EXPECT_EQ(port.wire_time({.id = 1, .length = 8, .data = {}}), microseconds(270));
  EXPECT_EQ(port.queued(), 0U);
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
