// SPDX-License-Identifier: Apache-2.0
#include "app/remote/osc_surface.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include "tests/app/remote/listener.hpp"
#include "tests/support/small_show.hpp"
#include "tests/support/temporary_folder.hpp"

namespace footlight::app {
namespace {

using Does = config::RemoteButton::Does;
using Outcome = controller::Outcome;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A UDP socket of this machine.
class Peer {
 public:
  Peer() : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::bind(socket_.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    socklen_t size = sizeof address;
    EXPECT_EQ(::getsockname(socket_.get(), reinterpret_cast<sockaddr*>(&address), &size), 0);
    port_ = ntohs(address.sin_port);
  }
  [[nodiscard]] std::uint16_t port() const { return port_; }
  void send(std::uint16_t port, const std::vector<std::byte>& bytes) const {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(port);
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    (void)::sendto(socket_.get(), bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&to), sizeof to);
  }
  /// What has come; loopback delivers at once.
  [[nodiscard]] std::vector<OscMessage> take() const {
    std::vector<OscMessage> all;
    std::array<std::byte, 4096> buffer{};
    while (true) {
      const ssize_t size = ::recv(socket_.get(), buffer.data(), buffer.size(), MSG_DONTWAIT);
      if (size < 0) return all;
      const auto read = read_osc(std::span(buffer.data(), static_cast<std::size_t>(size)));
      EXPECT_TRUE(read);
      if (read) all.insert(all.end(), read->begin(), read->end());
    }
  }

 private:
  FileDescriptor socket_;
  std::uint16_t port_ = 0;
};

class OscSurfaceTest : public ::testing::Test {
 protected:
  OscSurfaceTest() : small_(tests::random_show(6, 6, 4, 3, 2, 1)), desk_(small_.show, small_.plan) {
    if (!FOOTLIGHT_WITH_liblo) return;
    settings_.listen = {"127.0.0.1", free_port()};
    settings_.from = {"127.0.0.1"};
    remote_.buttons = {{"left", Does::hold, "", "", {}}, {"GO", Does::go, "", "", {}}};
    remote_.gates = {{0, {std::nullopt, milliseconds(2500)}}};
    interlocks_.emplace(std::vector<std::string>{"trap"}, remote_, clock_.now());
    panel_.emplace(remote_, *interlocks_);
    desk_.add(ears_);
    view_.show.standby = 0;
  }
  void SetUp() override {
    if (!FOOTLIGHT_WITH_liblo) GTEST_SKIP() << "built without liblo";
  }
  static std::uint16_t free_port() { return Peer().port(); }
  void open() {
    auto opened = OscSurface::open(settings_, small_.show, small_.plan, desk_, *interlocks_, *panel_, clock_, true);
    ASSERT_TRUE(opened) << opened.error().message;
    surface_ = std::move(opened).value();
    desk_.add(*surface_);
  }
  std::vector<controller::Command> look(double after_s = 0.02) {
    clock_.advance(seconds(after_s));
    wishes_ = desk_.look(view_);
    return wishes_.commands;
  }
  void send(const OscMessage& message) { peer_.send(settings_.listen.port, osc_bytes(message)); }

  tests::SmallShow small_;
  ManualClock clock_;
  RunDesk desk_;
  Listener ears_;
  config::OscRemote settings_;
  config::Remote remote_;
  std::optional<Interlocks> interlocks_;
  std::optional<Panel> panel_;
  std::unique_ptr<OscSurface> surface_;
  Peer peer_;
  DeskView view_;
  DeskWishes wishes_;
};

TEST_F(OscSurfaceTest, AGoIsCarriedOutAndAnswered) {
  open();
  send({"/go"});
  const auto commands = look();
  ASSERT_EQ(commands.size(), 1U);
  EXPECT_EQ(commands[0].source, controller::GoSource::network);
  desk_.answered({commands[0], Outcome::cue_started, clock_.now()});
  EXPECT_THAT(peer_.take(), ElementsAre(OscMessage{"/reply/go", {"ok", "the cue starts"}}));
}

TEST_F(OscSurfaceTest, ARefusedGoIsAnsweredAndSeenByAll) {
  open();
  send({"/cue/1/start"});
  send({"/cue/3/start"});
  const auto commands = look();
  ASSERT_EQ(commands.size(), 1U);
  desk_.answered({commands[0], Outcome::too_soon, clock_.now()});
  EXPECT_THAT(peer_.take(),
              ElementsAre(OscMessage{"/reply/cue/3/start",
                                     {"refused", "cue 3 is not standby (1 is): load it, then people have a way there"}},
                          OscMessage{"/reply/cue/1/start", {"refused", "too soon after the last GO"}}));
  EXPECT_THAT(ears_.take(), ElementsAre(HasSubstr("/cue/3/start by osc 127.0.0.1 refused"),
                                        "go by osc 127.0.0.1 refused: too soon after the last GO"));
}

TEST_F(OscSurfaceTest, OrdersInWordsAreAnsweredAlsoWhenTheyAreNotUnderstood) {
  open();
  send({"/footlight/order", {" jmup "}});
  send({"/footlight/order", {"quit"}});
  send({"/nonsense"});
  EXPECT_THAT(look(), IsEmpty());
  EXPECT_FALSE(wishes_.ends);
  const auto replies = peer_.take();
  ASSERT_EQ(replies.size(), 3U);
  EXPECT_EQ(replies[0].values[0], OscValue("refused"));
  EXPECT_EQ(replies[1], (OscMessage{"/reply/footlight/order", {"refused", "a run is ended at its desk"}}));
  EXPECT_EQ(replies[2].values[0], OscValue("error"));
}

TEST_F(OscSurfaceTest, StrangersAreNotReadAndGetNoAnswer) {
  settings_.from = {"127.0.0.2"};
  open();
  send({"/go"});
  EXPECT_THAT(look(), IsEmpty());
  EXPECT_THAT(peer_.take(), IsEmpty());
}

TEST_F(OscSurfaceTest, WithoutTheTokenNothingIsCarriedOut) {
  const test::TemporaryFolder folder;
  folder.write("token", "0123456789abcdefghijkl");
  std::filesystem::permissions(folder.path() / "token", std::filesystem::perms::owner_read);
  settings_.token_file = folder / "token";
  open();
  send({"/go"});
  send({"/connect", {"wrong"}});
  send({"/footlight/button", {"left", std::int32_t{1}}});
  EXPECT_THAT(look(), IsEmpty());
  EXPECT_EQ(interlocks_->bars() & controller::kHoldPressed, 0U);
  const auto replies = peer_.take();
  ASSERT_EQ(replies.size(), 3U);
  for (const OscMessage& reply : replies) EXPECT_EQ(reply.values[0], OscValue("denied")) << reply.address;
  send({"/connect", {"0123456789abcdefghijkl"}});
  send({"/go"});
  EXPECT_EQ(look().size(), 1U);
  EXPECT_THAT(peer_.take(), ElementsAre(OscMessage{"/reply/connect", {"ok", ""}}));
}

TEST_F(OscSurfaceTest, AFloodLosesMessagesAndIsToldOnce) {
  open();
  std::size_t commands = 0;
  for (int round = 0; round < 10; ++round) {
    for (int i = 0; i < 100; ++i) send({"/go"});
    commands += look().size();
    EXPECT_EQ(surface_->file(), -1) << "nobody is woken for a flood";
  }
  EXPECT_EQ(commands, 10U * FloodGuard::kMost);
  (void)look(1);
  EXPECT_THAT(ears_.take(), ElementsAre("note: OSC: 840 messages were lost: more than 16 of a client in 20 ms"));
  send({"/go"});
  EXPECT_EQ(look().size(), 1U) << "afterwards everything is heard again";
  EXPECT_GE(surface_->file(), 0);
}

TEST_F(OscSurfaceTest, AFloodSwallowsNoHoldOfTheSameClient) {
  open();
  const auto kinds = [&] {
    std::vector<controller::Command::Kind> said;
    for (const controller::Command& command : look()) said.push_back(command.kind);
    return said;
  };
  using Kind = controller::Command::Kind;
  for (const OscMessage& hold : {OscMessage{"/stop"}, OscMessage{"/panic"}, OscMessage{"/footlight/order", {"HOLD"}}}) {
    for (int i = 0; i < 100; ++i) send({"/go"});
    send(hold);
    for (int i = 0; i < 100; ++i) send({"/go"});
    const auto said = kinds();
    EXPECT_EQ(std::ranges::count(said, Kind::hold), 1) << hold.address;
    EXPECT_EQ(said.back(), Kind::hold) << "the GOs before and after it were lost";
  }
  // A flood of holds says one thing.
  for (int i = 0; i < 100; ++i) send({"/stop"});
  EXPECT_THAT(kinds(), ElementsAre(Kind::hold));
  send({"/stop"});
  send({"/go"});
  send({"/stop"});
  EXPECT_THAT(kinds(), ElementsAre(Kind::hold, Kind::go, Kind::hold)) << "the last word counts";
}

TEST_F(OscSurfaceTest, AFloodSwallowsNeitherASpottersHoldNorAGatesSignOfLife) {
  open();
  send({"/footlight/gate", {"trap", std::int32_t{1}}});
  (void)look();
  for (int round = 0; round < 200; ++round) {
    for (int i = 0; i < 100; ++i) send({"/go"});
    send({"/footlight/gate", {"trap", std::int32_t{1}}});
    if (round == 100) send({"/footlight/button", {"left", std::int32_t{1}}});
    (void)look();
    interlocks_->step(clock_.now());
    EXPECT_EQ(interlocks_->gates()[0].state, GateView::State::closed) << round;
    EXPECT_EQ((interlocks_->bars() & controller::kHoldPressed) != 0, round >= 100) << round;
  }
}

TEST_F(OscSurfaceTest, OfInputsThatAreToldTooOftenTheSafeLevelCounts) {
  open();
  send({"/footlight/gate", {"trap", std::int32_t{1}}});
  (void)look();
  for (int i = 0; i < 200; ++i) {
    send({"/footlight/gate", {"trap", std::int32_t{i == 150 ? 0 : 1}}});
    send({"/footlight/button", {"left", std::int32_t{i == 150 ? 1 : 0}}});
    send({"/footlight/button", {"nobody", std::int32_t{1}}});
  }
  (void)look();
  EXPECT_EQ(interlocks_->gates()[0].state, GateView::State::open);
  EXPECT_NE(interlocks_->bars() & controller::kHoldPressed, 0U);
  send({"/footlight/gate", {"trap", std::int32_t{1}}});
  send({"/footlight/button", {"left", std::int32_t{0}}});
  (void)look();
  EXPECT_EQ(interlocks_->gates()[0].state, GateView::State::closed) << "the next time it is said";
  EXPECT_EQ(interlocks_->bars() & controller::kHoldPressed, 0U);
}

TEST_F(OscSurfaceTest, WhoHasNoTokenUsesUpNobodysBudget) {
  const test::TemporaryFolder folder;
  folder.write("token", "0123456789abcdefghijkl");
  std::filesystem::permissions(folder.path() / "token", std::filesystem::perms::owner_read);
  settings_.token_file = folder / "token";
  open();
  const Peer stranger;
  for (int i = 0; i < 100; ++i) stranger.send(settings_.listen.port, osc_bytes({"/go"}));
  for (int i = 0; i < 100; ++i) stranger.send(settings_.listen.port, osc_bytes({"/stop"}));
  send({"/go", {"0123456789abcdefghijkl"}});
  EXPECT_EQ(look().size(), 1U);
  EXPECT_EQ(stranger.take().size(), static_cast<std::size_t>(FloodGuard::kMost)) << "denied";
}

TEST_F(OscSurfaceTest, GarbageIsAnsweredAndCountsInTheFlood) {
  open();
  for (int i = 0; i < 40; ++i) peer_.send(settings_.listen.port, std::vector<std::byte>(7, std::byte{0xFF}));
  EXPECT_THAT(look(), IsEmpty());
  const auto replies = peer_.take();
  EXPECT_EQ(replies.size(), static_cast<std::size_t>(FloodGuard::kMost));
  EXPECT_EQ(replies[0], (OscMessage{"/reply", {"error", "no OSC message"}}));
}

TEST_F(OscSurfaceTest, SpottersHoldAndGatesAreToldByName) {
  open();
  send({"/footlight/gate", {"trap", std::int32_t{1}}});
  send({"/footlight/button", {"left", std::int32_t{1}}});
  send({"/footlight/button", {"right", std::int32_t{1}}});
  (void)look();
  EXPECT_EQ(interlocks_->bars(), controller::kHoldPressed);
  EXPECT_THAT(peer_.take(),
              ElementsAre(OscMessage{"/reply/footlight/button", {"error", "no button \"right\" is told by OSC"}}));
}

TEST_F(OscSurfaceTest, AGoButtonByOscCountsWhenItGoesDown) {
  open();
  for (int i = 0; i < 3; ++i) send({"/footlight/button", {"GO", std::int32_t{1}}});
  EXPECT_EQ(look().size(), 1U);
  send({"/footlight/button", {"GO", std::int32_t{0}}});
  send({"/footlight/button", {"GO", std::int32_t{1}}});
  EXPECT_EQ(look().size(), 1U);
}

TEST_F(OscSurfaceTest, TheStateIsToldAtItsRateAndAlarmsAtOnce) {
  settings_.state = {{"127.0.0.1", peer_.port()}};
  settings_.rate_hz = 5;
  view_.show.position = instant_at(12.5);
  view_.show.standby = 2;
  open();
  for (int i = 0; i < 50; ++i) (void)look();
  const auto messages = peer_.take();
  std::size_t told = 0;
  for (const OscMessage& message : messages) told += message.address == "/footlight/position" ? 1 : 0;
  EXPECT_EQ(told, 5U);
  EXPECT_THAT(messages, ::testing::Contains(OscMessage{"/footlight/standby", {"3"}}));
  EXPECT_THAT(messages, ::testing::Contains(OscMessage{"/footlight/position", {12.5}}));
  desk_.tell({RunEvent::Kind::alarm, "trap: open"});
  EXPECT_THAT(peer_.take(), ElementsAre(OscMessage{"/footlight/alarm", {"trap: open"}}));
}

TEST_F(OscSurfaceTest, APortThatIsTakenIsRefusedWithItsName) {
  settings_.listen.port = peer_.port();
  const auto opened = OscSurface::open(settings_, small_.show, small_.plan, desk_, *interlocks_, *panel_, clock_, true);
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().kind, ErrorKind::device);
  EXPECT_EQ(opened.error().message, "OSC: UDP port " + std::to_string(peer_.port()) +
                                        " of 127.0.0.1: Address already in use (a port that nobody uses, an address of "
                                        "this machine)");
}

}  // namespace
}  // namespace footlight::app
