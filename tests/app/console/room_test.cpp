// SPDX-License-Identifier: Apache-2.0
#include "app/console/room.hpp"

#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/temporary_folder.hpp"

namespace footlight::app {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class Letters final : public Mailer {
 public:
  void send(PersonId to, const Letter& letter) override { got[to].push_back(*letter); }
  void send_state(PersonId to, const Letter& letter) override { got[to].push_back(*letter); }
  void close(PersonId who, std::uint16_t code, std::string_view /*why*/) override { closed[who] = code; }

  std::map<PersonId, std::vector<std::string>> got;
  std::map<PersonId, std::uint16_t> closed;
};

class RoomTest : public ::testing::Test {
 protected:
  RoomTest() {
    rules_.needs_token = true;
    rules_.token = std::string(64, 'a');
  }
  /// Somebody with this role who has said hello.
  PersonId comes(const std::string& name, Role role) {
    std::string token = rules_.token;
    if (role != Role::admin) token = pairing_.redeem(pairing_.make(role, clock_.now()), clock_.now())->token;
    const PersonId id = room_.enter({"127.0.0.1"});
    room_.heard(id, R"({"hello": {"name": ")" + name + R"(", "token": ")" + token + "\"}}");
    EXPECT_TRUE(room_.welcome(id));
    letters_.got.clear();
    return id;
  }
  void order(PersonId who, const std::string& line) { room_.heard(who, R"({"order": ")" + line + R"(", "id": 5})"); }
  std::vector<std::string> orders() {
    std::vector<std::string> lines;
    for (const SaidOrder& said : orders_.take(1000)) lines.push_back(said.who + ": " + said.line);
    return lines;
  }
  std::vector<std::string> heard(PersonId who) { return std::exchange(letters_.got[who], {}); }

  test::TemporaryFolder folder_;
  Letters letters_;
  OrderBox orders_;
  Pairing pairing_;
  ConsoleRules rules_;
  ManualClock clock_;
  std::unique_ptr<AuditLog> audit_ = AuditLog::open(folder_ / "console.log").value();
  Room room_{letters_, orders_, audit_.get(), pairing_, rules_, clock_, {"0.1", "run1", "abc", 1}};
};

TEST_F(RoomTest, WhoComesIsToldWhatThereIs) {
  room_.state(R"({"state":{}})", "1");
  room_.told({RunEvent::Kind::alarm, "bus left is unplugged"});
  const PersonId id = room_.enter({"127.0.0.1"});
  EXPECT_THAT(heard(id), IsEmpty()) << "nothing before hello";
  room_.heard(id, R"({"hello": {"name": "Ana", "token": ")" + rules_.token + "\"}}");
  EXPECT_THAT(
      heard(id),
      ElementsAre(R"({"welcome":{"you":1,"role":"admin","version":"0.1","plan":"abc","epoch":1,"run":"run1"}})",
                  R"({"state":{}})", R"({"seat":null})", HasSubstr(R"({"log":[{"alarm":"bus left is unplugged","n":1)"),
                  HasSubstr(R"("text":"bus left is unplugged")"),
                  R"({"people":[{"id":1,"name":"Ana","role":"admin"}]})"));
}

TEST_F(RoomTest, NothingIsHeardBeforeHelloAndHelloComesInTime) {
  const PersonId eager = room_.enter({"127.0.0.1"});
  room_.heard(eager, R"({"order": "go"})");
  EXPECT_EQ(letters_.closed[eager], Room::kNotUnderstood);
  const PersonId silent = room_.enter({"127.0.0.1"});
  clock_.advance(milliseconds(5000));
  room_.tick();
  EXPECT_FALSE(letters_.closed.contains(silent));
  clock_.advance(milliseconds(1));
  room_.tick();
  EXPECT_EQ(letters_.closed[silent], Room::kNotUnderstood);
  EXPECT_THAT(orders(), IsEmpty());
}

TEST_F(RoomTest, ATokenThatIsNotGoodEndsIt) {
  for (const std::string& token : {std::string(), std::string(64, 'b'), std::string(63, 'a')}) {
    const PersonId id = room_.enter({"10.0.0.9"});
    room_.heard(id, R"({"hello": {"name": "Eve", "token": ")" + token + "\"}}");
    EXPECT_EQ(letters_.closed[id], Room::kToken);
    EXPECT_FALSE(room_.welcome(id));
    EXPECT_THAT(heard(id), IsEmpty());
  }
}

TEST_F(RoomTest, WhatIsNotUnderstoodEndsIt) {
  const PersonId id = comes("Ana", Role::admin);
  room_.heard(id, "{");
  EXPECT_EQ(letters_.closed[id], Room::kNotUnderstood);
}

TEST_F(RoomTest, WhoViewsChangesNothing) {
  const PersonId id = comes("Vic", Role::view);
  for (const char* message : {R"({"order": "go"})", R"({"order": "hold"})", R"({"seat": "take"})",
                              R"({"acknowledge": 1})", R"({"pair": "view"})", R"({"order": "quit"})"}) {
    room_.heard(id, message);
    const auto letters = heard(id);
    ASSERT_EQ(letters.size(), 1U) << message;
    EXPECT_THAT(letters[0], HasSubstr(R"("refused":true)")) << message;
  }
  EXPECT_THAT(orders(), IsEmpty());
}

TEST_F(RoomTest, OnlyTheSeatGivesOrdersButEveryOperatorMayHold) {
  const PersonId ana = comes("Ana", Role::operate);
  const PersonId ben = comes("Ben", Role::operate);
  order(ana, "go");
  EXPECT_THAT(heard(ben), ElementsAre(R"({"seat":{"holder":1,"name":"Ana"}})",
                                      HasSubstr(R"({"note":"Ana has the operator's seat")")))
      << "an empty seat is taken by who gives an order";
  order(ben, "go");
  EXPECT_THAT(heard(ben), ElementsAre(HasSubstr("somebody else has the seat: take it first")));
  order(ben, "hold");
  order(ben, "hold end");
  EXPECT_THAT(orders(), ElementsAre("Ben: hold", "Ben: hold end", "Ana: go")) << "a HOLD goes before";
}

TEST_F(RoomTest, TakingTheSeatOverIsSeenByAll) {
  const PersonId ana = comes("Ana", Role::operate);
  const PersonId ben = comes("Ben", Role::operate);
  const PersonId vic = comes("Vic", Role::view);
  room_.heard(ana, R"({"seat": "take"})");
  heard(vic);
  room_.heard(ben, R"({"seat": "take"})");
  EXPECT_THAT(heard(vic), ElementsAre(R"({"seat":{"holder":2,"name":"Ben"}})",
                                      HasSubstr(R"({"note":"Ben has the operator's seat, which Ana had")")));
  order(ana, "go");
  EXPECT_THAT(orders(), IsEmpty());
  room_.heard(ana, R"({"seat": "leave"})");
  EXPECT_THAT(heard(vic), IsEmpty()) << "it is not hers";
  room_.leave(ben);
  EXPECT_THAT(heard(vic), ElementsAre(R"({"seat":null})", Not(HasSubstr("Ben"))));
}

TEST_F(RoomTest, OnlyAnAdminEndsTheRunOrMakesCodes) {
  const PersonId ana = comes("Ana", Role::operate);
  order(ana, "quit");
  order(ana, "  QUIT  ");
  room_.heard(ana, R"({"pair": "view"})");
  EXPECT_THAT(heard(ana), ElementsAre(HasSubstr("only an admin ends the run"), HasSubstr("only an admin ends the run"),
                                      HasSubstr("only an admin makes codes")));
  const PersonId root = comes("Root", Role::admin);
  order(root, "quit");
  EXPECT_THAT(orders(), ElementsAre("Root: quit"));
  room_.heard(root, R"({"pair": "operate"})");
  const auto code = nlohmann::json::parse(heard(root).back())["code"];
  EXPECT_EQ(code["role"], "operate");
  EXPECT_EQ(code["seconds"], 120);
  const auto paired = room_.pair("10.0.0.5", code["code"].get<std::string>());
  ASSERT_TRUE(paired);
  EXPECT_EQ(paired->role, Role::operate);
}

TEST_F(RoomTest, AnAnswerGoesToAllAndItsIdToWhoAsked) {
  const PersonId ana = comes("Ana", Role::operate);
  const PersonId vic = comes("Vic", Role::view);
  order(ana, "go");
  const auto said = orders_.take(1);
  ASSERT_EQ(said.size(), 1U);
  heard(ana);
  heard(vic);
  RunEvent event{RunEvent::Kind::answer, "the cue runs"};
  event.order = "go";
  event.refused = true;
  event.who = {controller::GoSource::page, said[0].who, said[0].tag};
  room_.told(event);
  EXPECT_THAT(heard(ana),
              ElementsAre(HasSubstr(
                  R"({"answer":{"order":"go","who":"Ana","refused":true,"text":"the cue runs","id":5},"n":2)")));
  EXPECT_THAT(
      heard(vic),
      ElementsAre(HasSubstr(R"({"answer":{"order":"go","who":"Ana","refused":true,"text":"the cue runs"},"n":2)")));
}

TEST_F(RoomTest, AFloodOfOrdersLosesOrdersAndNeverAHold) {
  const PersonId ana = comes("Ana", Role::operate);
  const PersonId ben = comes("Ben", Role::operate);
  for (int i = 0; i < 60; ++i) order(ana, "go");
  order(ben, "hold");
  const auto said = orders();
  EXPECT_EQ(said.size(), 41U) << "forty at once";
  EXPECT_EQ(said.front(), "Ben: hold");
  heard(ana);
  room_.tick();
  EXPECT_THAT(heard(ana), ElementsAre(R"({"lost":20})"));
  clock_.advance(milliseconds(1000));
  for (int i = 0; i < 60; ++i) order(ana, "go");
  EXPECT_EQ(orders().size(), 20U) << "then twenty a second";
}

TEST_F(RoomTest, OrdersOfManyThatWaitAreBoundedAndAHoldStillHasAPlace) {
  std::vector<PersonId> people;
  for (int i = 0; i < 4; ++i) people.push_back(comes("Op" + std::to_string(i), Role::operate));
  for (const PersonId who : people) {
    room_.heard(who, R"({"seat": "take"})");
    for (int i = 0; i < 40; ++i) order(who, "tempo 90");
  }
  for (int i = 0; i < 40; ++i) order(people[0], "hold");
  const auto said = orders();
  EXPECT_EQ(said.size(), OrderBox::kMostOrders + OrderBox::kMostHolds);
  EXPECT_EQ(said[0], "Op0: hold");
}

TEST_F(RoomTest, AFloodOfMessagesEndsTheConnection) {
  const PersonId vic = comes("Vic", Role::view);
  for (int i = 0; i < 199; ++i) room_.heard(vic, R"({"ping": 1})");
  EXPECT_FALSE(letters_.closed.contains(vic));
  room_.heard(vic, R"({"ping": 1})");
  EXPECT_EQ(letters_.closed[vic], Room::kFlood);
}

TEST_F(RoomTest, AlarmsStayUntilSomebodyAcknowledgesThem) {
  const PersonId ana = comes("Ana", Role::operate);
  room_.told({RunEvent::Kind::alarm, "node n3 silent"});
  heard(ana);
  room_.heard(ana, R"({"acknowledge": 1})");
  const auto letters = heard(ana);
  ASSERT_EQ(letters.size(), 1U);
  EXPECT_EQ(nlohmann::json::parse(letters[0])["alarms"][0]["acknowledged_by"], "Ana");
  room_.heard(ana, R"({"acknowledge": 9})");
  EXPECT_THAT(heard(ana), ElementsAre(HasSubstr("there is no such alarm")));
}

TEST_F(RoomTest, TheAuditLogHasWhoWhatCueAndPlanWithControlCharactersEscaped) {
  room_.state(R"({"state":{}})", "12.5");
  const PersonId ana = comes("Ana", Role::operate);
  order(ana, "go");
  RunEvent event{RunEvent::Kind::answer, "a\x1b[2Jb\nc\x7f"};
  event.order = "go";
  event.who = {controller::GoSource::page, "Ana", orders_.take(1).at(0).tag};
  room_.told(event);
  room_.refused("10.0.0.9", "GET /x", "421 no\r\nHost");
  audit_.reset();
  const std::string text = folder_.read("console.log");
  EXPECT_THAT(text, HasSubstr(R"("who":"Ana","from":"127.0.0.1","role":"operate","what":"order go","result":"said",)"
                              R"("cue":"12.5","plan":"abc"})"));
  EXPECT_THAT(text, HasSubstr(R"("what":"order go","result":"a\u001b[2Jb\nc\u007f")"));
  EXPECT_THAT(text, HasSubstr(R"("from":"10.0.0.9","role":"","what":"GET /x","result":"refused: 421 no\r\nHost")"));
  for (const char c : text) EXPECT_TRUE(c == '\n' || (c >= ' ' && c <= '~')) << static_cast<int>(c);
}

}  // namespace
}  // namespace footlight::app
