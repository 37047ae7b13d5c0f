// SPDX-License-Identifier: Apache-2.0
#include "app/cast/show_now.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/rng.hpp"

namespace footlight::app {
namespace {

using ::testing::HasSubstr;
using Phase = DeskWord::Phase;

DeskWord runs(double position_s, double rate = 1) {
  DeskWord word;
  word.phase = Phase::runs;
  word.position_s = position_s;
  word.rate = rate;
  word.cue = "2";
  return word;
}

TEST(DeskWord, IsReadFromWhatAConsoleSays) {
  const DeskMessage message = desk_message_from(
      R"({"state":{"phase":"resets","position_s":3.5,"rate":0.8,"cue":null,"standby":"2","tempo_percent":80,)"
      R"("goes_in_s":1.5,"holds_at_end":true,"loop":{"from_s":1,"to_s":9},"reset":{"state":"ready","from_s":3.5,"to_s":0,"at_s":0}}})");
  ASSERT_TRUE(message.state);
  EXPECT_EQ(message.state->phase, Phase::resets);
  EXPECT_EQ(message.state->rate, 0.8);
  EXPECT_EQ(message.state->standby, "2");
  EXPECT_EQ(message.state->goes_in_s, 1.5);
  EXPECT_TRUE(message.state->holds_at_end);
  EXPECT_EQ(message.state->loop->to_s, 9);
  EXPECT_TRUE(message.state->way);
  EXPECT_EQ(message.state->way_between->from_s, 3.5);
  EXPECT_EQ(desk_message_from(R"({"welcome":{"plan":"abc","run":"r"}})").welcome->plan, "abc");
  EXPECT_EQ(desk_message_from(R"({"epoch":2,"plan":"def"})").plan, "def");
}

TEST(DeskWord, WhatIsNotUnderstoodIsNothing) {
  for (const char* text : {"", "null", "[]", "{\"state\":1}", R"({"state":{"phase":"dances","position_s":1}})",
                           R"({"state":{"phase":"runs","position_s":"1"}})",
                           R"({"state":{"phase":"runs","position_s":1e300}})", "\xff\xfe"}) {
    EXPECT_FALSE(desk_message_from(text).state) << text;
  }
  Rng rng(3);
  const std::string good = R"({"state":{"phase":"runs","position_s":1,"reset":{"at_s":2}}})";
  for (int i = 0; i < 20'000; ++i) {
    std::string text = good;
    text[rng.below(text.size())] = static_cast<char>(rng.below(256));
    (void)desk_message_from(text);
  }
}

TEST(ShowNow, PhonesAreToldOnlyWhatTheyDoNotShowByThemselves) {
  ShowNow now;
  EXPECT_TRUE(now.take(runs(10), instant_at(100)));
  for (int i = 1; i < 50; ++i) EXPECT_FALSE(now.take(runs(10 + 0.1 * i), instant_at(100 + 0.1 * i + 0.02))) << i;
  EXPECT_NEAR(now.position_s(instant_at(105)), 15, 1e-9);
  EXPECT_TRUE(now.take(runs(20), instant_at(105))) << "a jump";
  EXPECT_TRUE(now.take(runs(20.1, 0.5), instant_at(105.1))) << "slower";
  DeskWord hold = runs(20.15, 0);
  hold.phase = Phase::stands;
  EXPECT_TRUE(now.take(hold, instant_at(105.2)));
  EXPECT_FALSE(now.take(hold, instant_at(109)));
  EXPECT_NEAR(now.position_s(instant_at(200)), 20.15, 1e-9);
}

TEST(ShowNow, ACountInThatGoesDownByItselfIsToldOnce) {
  ShowNow now;
  DeskWord word = runs(3, 0);
  word.phase = Phase::counts_in;
  word.goes_in_s = 2;
  EXPECT_TRUE(now.take(word, instant_at(50)));
  word.goes_in_s = 1.5;
  EXPECT_FALSE(now.take(word, instant_at(50.5)));
  const auto json = nlohmann::json::parse(now.json(instant_at(50.5), std::nullopt))["state"];
  EXPECT_EQ(json["goes_at_ms"], 52'000);
  EXPECT_EQ(json["now_ms"], 50'500);
  EXPECT_EQ(json["phase"], "counts-in");
  word.goes_in_s = 1.9;
  EXPECT_TRUE(now.take(word, instant_at(50.6))) << "it begins anew";
}

TEST(ShowNow, ADeskThatIsNotHeardIsToldOnceAndAgainWhenItIsBack) {
  ShowNow now;
  EXPECT_FALSE(now.heard());
  EXPECT_FALSE(now.lost());
  (void)now.take(runs(1), instant_at(0));
  EXPECT_TRUE(now.lost());
  EXPECT_FALSE(now.lost());
  EXPECT_THAT(now.json(instant_at(1), 4.0), HasSubstr(R"("heard":false)"));
  EXPECT_TRUE(now.take(runs(1.1), instant_at(0.1))) << "also when it says what was to be expected";
}

TEST(ShowNow, AnotherPlanAndAResetMoveHaveNumbers) {
  ShowNow now;
  const auto state = [&] { return nlohmann::json::parse(now.json(instant_at(0), std::nullopt))["state"]; };
  (void)now.take(runs(1), instant_at(0));
  const int epoch = state()["epoch"];
  now.take_plan(false);
  EXPECT_EQ(state()["epoch"], epoch + 1);
  EXPECT_EQ(state()["same_plan"], false);
  EXPECT_TRUE(state()["way"].is_null());
  EXPECT_TRUE(now.take_way(true));
  EXPECT_EQ(state()["way"]["n"], 1);
  EXPECT_TRUE(now.take_way(false));
  EXPECT_FALSE(now.take_way(false));
  EXPECT_TRUE(state()["way"].is_null());
}

}  // namespace
}  // namespace footlight::app
