// SPDX-License-Identifier: Apache-2.0
#include "app/console/console.hpp"

#include <atomic>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/simulated_buses.hpp"
#include "tests/app/console/raw_client.hpp"
#include "tests/support/small_show.hpp"
#include "tests/support/temporary_folder.hpp"

namespace footlight::app {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;
using tests::RawClient;

TEST(ConsolePlace, IsAPortOfThisMachineOrANumericAddressAndAPort) {
  EXPECT_EQ(Console::place_from("8440")->address, "127.0.0.1");
  EXPECT_EQ(Console::place_from("8440")->port, 8440);
  EXPECT_EQ(Console::place_from("localhost:1")->address, "127.0.0.1");
  EXPECT_EQ(Console::place_from("192.168.1.5:80")->address, "192.168.1.5");
  EXPECT_EQ(Console::place_from("[::1]:8440")->address, "::1");
  for (const char* place : {"", ":", "x", "-1", "65536", "8440 ", "desk:8440", "127.0.0.1", "127.0.0.1:", "1.2.3:4",
                            "[::1]", "http://127.0.0.1:8440", "0x50"}) {
    const auto where = Console::place_from(place);
    ASSERT_FALSE(where) << place;
    EXPECT_EQ(where.error().message, "\"" + std::string(place) +
                                         "\" is no place for the console: a port, as 8440, or a numeric address of "
                                         "this machine and a port, as 192.168.1.5:8440 or [::1]:8440");
  }
}

TEST(ConsoleOfARun, HandsOverBetweenDeskAndPage) {
  const test::TemporaryFolder folder;
  tests::SmallShow small = tests::random_show(8, 6, 12, 2, 2, 7);
  small.rig = tests::lamps_everywhere(small.show.stage.grid, {BusKind::serial}, 115'200, 8);
  RunDesk desk(small.show, small.plan);
  auto opened = Console::open({}, folder.path() / "new" / "state", small.show, small.plan, small.rig, desk, true);
  ASSERT_TRUE(opened) << opened.error().message;
  Console& console = **opened;
  desk.add(console);
  EXPECT_THAT(console.address(), StartsWith("http://127.0.0.1:"));
  EXPECT_FALSE(console.needs_token());
  EXPECT_TRUE(console.listens());
  RawClient page(static_cast<std::uint16_t>(std::stoi(console.address().substr(17))));
  const auto used = with_schedule(small.show, small.plan, small.rig, [&](const SimulatedSchedule& wires) {
    DeskView view;
    view.schedule = &wires.schedule;
    view.show.standby = 0;
    view.buses = {{"bus1", 6, 0}};
    (void)desk.look(view);
    ASSERT_TRUE(page.open());
    page.say(R"({"hello":{"name":"Ana"}})");
    EXPECT_THAT(page.heard("\"state\""), HasSubstr(R"("phase":"stands")"));
    page.say(R"({"order":"tempo 80","id":4})");
    DeskWishes wishes;
    while (wishes.commands.empty()) {
      desk.wait(milliseconds(20));
      wishes = desk.look(view);
    }
    EXPECT_EQ(wishes.commands[0].percent, 80);
    EXPECT_EQ(wishes.commands[0].source, controller::GoSource::page);
    desk.answered({wishes.commands[0], controller::Outcome::done, {}});
    EXPECT_THAT(page.heard("answer"),
                HasSubstr(R"({"order":"tempo 80","who":"Ana","refused":false,"text":"done","id":4})"));
    console.plan_taken();
    (void)desk.look(view);
    EXPECT_THAT(page.heard("epoch"), HasSubstr(R"({"epoch":2,"plan":")"));
    RawClient other(static_cast<std::uint16_t>(std::stoi(console.address().substr(17))));
    other.send(other.get("/api/show"));
    EXPECT_THAT(other.response(), HasSubstr(R"({"epoch":2,)"));
    other.send(other.get("/api/looks/1.bin"));
    std::atomic<bool> answered{false};
    std::thread run([&] {
      while (!answered) {
        desk.wait(milliseconds(20));
        (void)desk.look(view);
      }
    });
    EXPECT_THAT(other.response(), HasSubstr("FLLK"));
    answered = true;
    run.join();
  });
  EXPECT_TRUE(used);
}

}  // namespace
}  // namespace footlight::app
