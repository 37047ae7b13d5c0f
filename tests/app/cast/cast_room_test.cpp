// SPDX-License-Identifier: Apache-2.0
#include "app/cast/cast_room.hpp"

#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/rng.hpp"

namespace footlight::app {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class Letters final : public Mailer {
 public:
  void send(PersonId to, const Letter& letter) override { got[to].push_back(*letter); }
  void send_state(PersonId to, const Letter& letter) override { got[to].push_back(*letter); }
  void close(PersonId who, std::uint16_t code, std::string_view) override { closed[who] = code; }

  std::map<PersonId, std::vector<std::string>> got;
  std::map<PersonId, std::uint16_t> closed;
};

class CastRoomTest : public ::testing::Test {
 protected:
  PersonId comes() {
    const PersonId id = room_.enter();
    room_.heard(id, R"({"hello":{"token":"secret"}})");
    return id;
  }
  Letters letters_;
  ManualClock clock_;
  std::vector<PhoneQuestion> asked_;
  std::size_t room_for_ = 100;
  CastRoom room_{letters_, "secret", clock_, [this](PersonId, const PhoneQuestion& question) {
                   if (asked_.size() >= room_for_) return false;
                   asked_.push_back(question);
                   return true;
                 }};
};

TEST_F(CastRoomTest, APhoneThatKnowsTheTokenIsToldTheNewestStateAlone) {
  room_.state(std::make_shared<const std::string>("old"));
  room_.state(std::make_shared<const std::string>("new"));
  EXPECT_THAT(letters_.got[comes()], ElementsAre("new"));
}

TEST_F(CastRoomTest, WithoutTheTokenNothingIsTold) {
  room_.state(std::make_shared<const std::string>("state"));
  const PersonId wrong = room_.enter();
  room_.heard(wrong, R"({"hello":{"token":"secreT"}})");
  EXPECT_EQ(letters_.closed[wrong], Room::kToken);
  const PersonId early = room_.enter();
  room_.heard(early, R"({"part":{"who":0,"language":"en"}})");
  EXPECT_EQ(letters_.closed[early], Room::kNotUnderstood);
  room_.state(std::make_shared<const std::string>("more"));
  EXPECT_THAT(letters_.got, IsEmpty());
  EXPECT_THAT(asked_, IsEmpty());
}

TEST_F(CastRoomTest, WhoSaysNothingIsSentAway) {
  const PersonId silent = room_.enter();
  const PersonId here = comes();
  clock_.advance(CastRoom::kHelloWithin + milliseconds(1));
  room_.tick();
  EXPECT_EQ(letters_.closed.count(silent), 1U);
  EXPECT_EQ(letters_.closed.count(here), 0U);
}

TEST_F(CastRoomTest, NoMessageIsAnOrder) {
  for (const char* text :
       {R"({"order":"go"})", R"({"seat":"take"})", R"({"acknowledge":1})", R"({"pair":"operate"})", "go", "[]", "{}",
        R"({"ping":"1"})", R"({"part":{"who":-1,"language":"en"}})", R"({"part":{"who":0,"language":"xx"}})",
        R"({"where":{"who":0,"language":"en"}})", R"({"ping":1,"part":{}})", R"({"hello":{"token":"secret"}})",
        R"({"part":{"who":{"a":{"b":{"c":1}}}}})", "\xff"}) {
    const PersonId id = comes();
    room_.heard(id, text);
    EXPECT_EQ(letters_.closed[id], Room::kNotUnderstood) << text;
  }
  EXPECT_THAT(asked_, IsEmpty());
}

TEST_F(CastRoomTest, AnAnswerToAPingHasTheClockOfAll) {
  const PersonId id = comes();
  clock_.advance(milliseconds(1500));
  room_.heard(id, R"({"ping":17.5})");
  EXPECT_THAT(letters_.got[id].back(), HasSubstr(R"("pong":17.5)"));
  EXPECT_THAT(letters_.got[id].back(), HasSubstr(R"("now_ms":)"));
}

TEST_F(CastRoomTest, APhoneAsksSoOftenAndNoMoreAndTheOthersAsMuchAsBefore) {
  const PersonId one = comes();
  for (int i = 0; i < 20; ++i) room_.heard(one, R"({"where":{"who":3,"cell":5,"language":"zh"}})");
  EXPECT_EQ(asked_.size(), static_cast<std::size_t>(CastRoom::kQuestionsAtOnce));
  EXPECT_EQ(letters_.got[one].back(), R"({"busy":2})");
  EXPECT_EQ(letters_.closed.count(one), 0U) << "it loses questions, not the page";
  const PersonId other = comes();
  room_.heard(other, R"({"where":{"who":4,"cell":5,"language":"en"}})");
  EXPECT_EQ(asked_.back().who, PerformerIndex(4));
  clock_.advance(milliseconds(2001));
  room_.heard(one, R"({"part":{"who":3,"language":"zh"}})");
  EXPECT_EQ(asked_.back().about, PhoneQuestion::About::part);
}

TEST_F(CastRoomTest, WhatIsTooMuchForAllIsToldAsThat) {
  room_for_ = 0;
  const PersonId id = comes();
  room_.heard(id, R"({"part":{"who":3,"language":"en"}})");
  EXPECT_THAT(letters_.got[id], ElementsAre(R"({"busy":2})"));
}

TEST_F(CastRoomTest, AFloodEndsTheConnection) {
  const PersonId id = comes();
  for (int i = 0; i < 100; ++i) room_.heard(id, R"({"ping":1})");
  EXPECT_EQ(letters_.closed[id], Room::kFlood);
}

TEST_F(CastRoomTest, NoMutationOfAMessageDoesHarm) {
  const std::string good = R"({"where":{"who":3,"cell":5,"language":"zh"}})";
  Rng rng(5);
  for (int i = 0; i < 20'000; ++i) {
    std::string text = good;
    for (std::uint64_t k = 0; k <= rng.below(4); ++k) text[rng.below(text.size())] = static_cast<char>(rng.below(256));
    (void)phone_message_from(text.substr(0, rng.below(text.size() + 1)));
  }
  EXPECT_TRUE(phone_message_from(good));
  EXPECT_FALSE(phone_message_from(good + std::string(512, ' ')));
}

}  // namespace
}  // namespace footlight::app
