// SPDX-License-Identifier: Apache-2.0
// SocketCAN on controllers with drivers of their own: two SJA1000 on one bus (can0, can1).
#include <gtest/gtest.h>

#include "drivers/transports/can_socket.hpp"
#include "tests/hardware/guest.hpp"

namespace footlight::hardware {
namespace {

using drivers::CanFrame;
using drivers::SendStatus;

class Sja1000 : public ::testing::Test {
 protected:
  Sja1000() {
    for (const char* name : {"can0", "can1"}) {
      run("ip link set " + std::string(name) + " down; ip link set " + name +
          " up type can bitrate 500000 restart-ms 100");
    }
  }
};

TEST_F(Sja1000, FramesOfEveryLengthGoBothWaysInOrder) {
  auto here = drivers::open_can("can0", 500'000);
  auto there = drivers::open_can("can1", 500'000);
  ASSERT_TRUE(here) << here.error().message;
  ASSERT_TRUE(there) << there.error().message;
  for (std::uint8_t length = 0; length <= 8; ++length) {
    CanFrame sent{.id = static_cast<std::uint16_t>(0x200 + length), .length = length, .data = {}};
    for (std::uint8_t i = 0; i < length; ++i) sent.data.at(i) = static_cast<std::uint8_t>(0xA0 + i);
    CanFrame heard;
    ASSERT_EQ((*here)->send(sent), SendStatus::accepted);
    ASSERT_TRUE(eventually([&] { return (*there)->receive(heard); })) << int{length};
    EXPECT_EQ(heard, sent);
    ASSERT_EQ((*there)->send(sent), SendStatus::accepted);
    ASSERT_TRUE(eventually([&] { return (*here)->receive(heard); })) << int{length};
    EXPECT_EQ(heard, sent);
  }
}

TEST_F(Sja1000, AnAdapterThatIsPulledOutIsDown) {
  auto port = drivers::open_can("can1", 500'000);
  ASSERT_TRUE(port) << port.error().message;
  const CanFrame frame{.id = 0x201, .length = 1, .data = {1}};
  ASSERT_EQ((*port)->send(frame), SendStatus::accepted);
  unplug("sja1");
  EXPECT_EQ((*port)->send(frame), SendStatus::down);
  plug(R"("driver":"kvaser_pci","canbus":"bus0","id":"sja1")");
  EXPECT_TRUE(eventually([] { return run("ip -br link").find("can1") != std::string::npos; }));
}

}  // namespace
}  // namespace footlight::hardware
