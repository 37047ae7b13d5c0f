// SPDX-License-Identifier: Apache-2.0
#include "app/remote/osc_door.hpp"

#include <filesystem>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace footlight::app {
namespace {

const std::string kToken = "0123456789abcdefghijkl";
const config::NetworkPlace kDesk{"10.0.0.4", 9001};

TEST(OscDoor, HearsTheAddressesOnTheListAlone) {
  const OscDoor door({"10.0.0.4", "::1"}, kToken);
  EXPECT_TRUE(door.knows("10.0.0.4"));
  EXPECT_FALSE(door.knows("10.0.0.40"));
  EXPECT_FALSE(door.knows("127.0.0.1"));
}

TEST(OscDoor, WantsTheTokenOnceAndForgetsAClientAfterAMinuteOfSilence) {
  OscDoor door({"10.0.0.4"}, kToken);
  OscMessage go{"/go"};
  EXPECT_FALSE(door.lets_in(kDesk, go, instant_at(1)));
  EXPECT_FALSE(door.connect(kDesk, "0123456789abcdefghijkm", instant_at(1)));
  EXPECT_FALSE(door.connect(kDesk, "", instant_at(1)));
  EXPECT_FALSE(door.lets_in(kDesk, go, instant_at(1)));
  EXPECT_TRUE(door.connect(kDesk, kToken, instant_at(2)));
  EXPECT_TRUE(door.lets_in(kDesk, go, instant_at(60)));
  EXPECT_TRUE(door.lets_in(kDesk, go, instant_at(119))) << "it has been heard since";
  EXPECT_FALSE(door.lets_in({"10.0.0.4", 9002}, go, instant_at(119))) << "another program there";
  EXPECT_FALSE(door.lets_in(kDesk, go, instant_at(180)));
  EXPECT_FALSE(door.lets_in(kDesk, go, instant_at(180.1)));
}

TEST(OscDoor, TakesTheTokenOffAMessageThatCarriesIt) {
  OscDoor door({"10.0.0.4"}, kToken);
  OscMessage order{"/footlight/order", {"hold", kToken}};
  EXPECT_TRUE(door.lets_in(kDesk, order, instant_at(1)));
  EXPECT_EQ(order, (OscMessage{"/footlight/order", {"hold"}}));
  EXPECT_FALSE(door.lets_in(kDesk, order, instant_at(1))) << "it does not open the door for others";
}

TEST(OscDoor, KeepsNoMoreClientsThanItMay) {
  OscDoor door({"10.0.0.4"}, kToken);
  for (std::uint16_t port = 1; port <= 200; ++port) {
    EXPECT_TRUE(door.connect({"10.0.0.4", port}, kToken, instant_at(port / 100.0)));
  }
  OscMessage go{"/go"};
  EXPECT_TRUE(door.lets_in({"10.0.0.4", 200}, go, instant_at(2)));
  EXPECT_FALSE(door.lets_in({"10.0.0.4", 1}, go, instant_at(2))) << "the oldest went";
}

TEST(OscDoor, IsOpenWithoutATokenWhichOnlyLoopbackMay) {
  OscDoor door({"127.0.0.1"}, "");
  OscMessage go{"/go"};
  EXPECT_TRUE(door.lets_in({"127.0.0.1", 5}, go, instant_at(1)));
  EXPECT_TRUE(door.connect({"127.0.0.1", 5}, "whatever", instant_at(1)));
}

TEST(OscToken, IsReadFromAFileThatNobodyElseReads) {
  const test::TemporaryFolder folder;
  const std::string file = folder / "osc.token";
  const auto make = [&](const std::string& text, std::filesystem::perms perms) {
    folder.write("osc.token", text);
    std::filesystem::permissions(file, perms);
  };
  const auto owner = std::filesystem::perms::owner_read | std::filesystem::perms::owner_write;
  make(kToken + "\n", owner);
  EXPECT_EQ(read_osc_token(file).value(), kToken);
  make(kToken, owner | std::filesystem::perms::group_read);
  EXPECT_EQ(read_osc_token(file).error().message, "token file \"" + file + "\": others may read it (chmod 600)");
  make("short\n", owner);
  const std::string make_one = "((umask 077; head -c 24 /dev/urandom | base64 > FILE) makes one)";
  EXPECT_EQ(read_osc_token(file).error().message,
            "token file \"" + file + "\": a token has 22 to 256 characters " + make_one);
  make(std::string(300, 'x'), owner);
  EXPECT_EQ(read_osc_token(file).error().message,
            "token file \"" + file + "\": a token has 22 to 256 characters " + make_one);
  EXPECT_EQ(read_osc_token(folder / "none").error().message,
            "token file \"" + (folder / "none") + "\": No such file or directory " + make_one);
}

}  // namespace
}  // namespace footlight::app
