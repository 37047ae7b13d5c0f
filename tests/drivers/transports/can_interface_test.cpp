// SPDX-License-Identifier: Apache-2.0
#include "drivers/transports/can_interface.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace footlight::drivers {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

CanInterface good() {
  CanInterface interface;
  interface.name = "can0";
  interface.up = true;
  interface.queue_length = 10;
  interface.controller = CanInterface::Controller{};
  interface.controller->bits_per_second = 500'000;
  interface.controller->restart_ms = 100;
  return interface;
}

std::vector<std::string> texts(const CanInterface& interface, bool that_stop = false) {
  std::vector<std::string> out;
  for (const Objection& objection : objections(interface, 500'000)) {
    if (objection.stops || !that_stop) out.push_back(objection.text);
  }
  return out;
}

TEST(CanObjections, NoneAgainstAnInterfaceAsItShouldBe) { EXPECT_THAT(objections(good(), 500'000), IsEmpty()); }

TEST(CanObjections, NoneAgainstAVirtualOneThatIsUp) {
  CanInterface interface = good();
  interface.controller.reset();
  EXPECT_THAT(objections(interface, 500'000), IsEmpty());
}

TEST(CanObjections, EverythingWrongIsToldAtOnceWithWhatMendsIt) {
  CanInterface interface = good();
  interface.up = false;
  interface.queue_length = 3;
  interface.controller->bits_per_second = 250'000;
  interface.controller->restart_ms = 0;
  interface.controller->state = CanState::bus_off;
  interface.controller->echoes = false;
  EXPECT_THAT(
      texts(interface),
      ElementsAre(
          "CAN interface \"can0\": its queue holds 3 frames, less than a node's preload needs (ip link set can0 "
          "txqueuelen 10)",
          "CAN interface \"can0\": is down (ip link set can0 up type can bitrate 500000 restart-ms 100)",
          "CAN interface \"can0\": runs at 250000 bit/s, and the rig says 500000 (ip link set can0 down; ip link set "
          "can0 up type can bitrate 500000 restart-ms 100)",
          "CAN interface \"can0\": stays silent after bus-off (ip link set can0 down; ip link set can0 up type can "
          "bitrate 500000 restart-ms 100)",
          "CAN interface \"can0\": is bus-off (ip link set can0 type can restart)",
          "CAN interface \"can0\": its driver does not tell when a frame has left, so a dead wire is seen by silent "
          "nodes alone (an adapter whose interface `ip link` shows with ECHO)"));
}

TEST(CanObjections, AShowIsStoppedWhereNothingCanBeSentOrUnderstood) {
  CanInterface interface = good();
  interface.queue_length = 3;
  interface.controller->restart_ms = 1000;
  interface.controller->echoes = false;
  interface.controller->state = CanState::bus_off;
  EXPECT_THAT(texts(interface, true), IsEmpty()) << "it will come back by itself";
  interface.controller->restart_ms = 0;
  EXPECT_THAT(texts(interface, true),
              ElementsAre("CAN interface \"can0\": is bus-off (ip link set can0 type can restart)"));
  interface = good();
  interface.up = false;
  interface.controller->bits_per_second = 125'000;
  EXPECT_EQ(texts(interface, true).size(), 2U);
}

TEST(CanObjections, ALongRestartAndErrorCountersAreTold) {
  CanInterface interface = good();
  interface.controller->restart_ms = 1000;
  interface.controller->state = CanState::passive;
  interface.controller->transmit_errors = 128;
  EXPECT_THAT(
      texts(interface),
      ElementsAre(
          "CAN interface \"can0\": waits 1000 ms after bus-off (ip link set can0 down; ip link set can0 up type "
          "can bitrate 500000 restart-ms 100)",
          "CAN interface \"can0\": counts 128 transmit errors, 0 receive errors (both ends terminated by 120 "
          "Ohm, every node powered and at 500000 bit/s)"));
}

TEST(CanInterfaceSettings, OneThatIsNotThereOrNotCanIsRefused) {
  const auto none = read_can_interface("can77");
  const auto loopback = read_can_interface("lo");
  ASSERT_FALSE(none);
  ASSERT_FALSE(loopback);
#if FOOTLIGHT_WITH_libnl
  EXPECT_EQ(none.error().kind, ErrorKind::device);
  EXPECT_EQ(
      none.error().message,
      "CAN interface \"can77\": not found (plug the adapter in and load its driver; `ip link show type can` lists "
      "what there is)");
  EXPECT_EQ(loopback.error().message,
            "CAN interface \"lo\": is not a CAN interface (one that `ip link show type can` lists)");
#else
  EXPECT_EQ(none.error().kind, ErrorKind::refused) << "what cannot be seen stops nothing";
  EXPECT_EQ(none.error().message,
            "CAN interface \"can77\": its settings are not known: this program was built without libnl-route (install "
            "libnl-route-3-dev and build again)");
#endif
}

}  // namespace
}  // namespace footlight::drivers
