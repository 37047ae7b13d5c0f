// SPDX-License-Identifier: Apache-2.0
#include "app/readiness/readiness.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace footlight::app {
namespace {

using Stage = Readiness::Stage;
using State = Readiness::State;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

void tell_all(Readiness& readiness, State state) {
  for (std::size_t s = 0; s < Readiness::kStages; ++s) readiness.tell(static_cast<Stage>(s), state, "told");
}

std::vector<std::string> states(const Readiness& readiness) {
  std::vector<std::string> out;
  for (const Readiness::Report& stage : readiness.report()) out.emplace_back(to_text(stage.state));
  return out;
}

TEST(Readiness, TheFirstStageThatNobodyHasToldOfIsNext) {
  Readiness readiness(Scope::live);
  EXPECT_THAT(states(readiness), ElementsAre("NEXT", "OFF", "OFF", "OFF", "OFF", "OFF", "OFF", "OFF"));
  readiness.tell(Stage::show, State::success, "valid");
  readiness.tell(Stage::plan, State::warning, "old");
  readiness.tell(Stage::time, State::skipped, "the show's own clock");
  EXPECT_THAT(states(readiness), ElementsAre("SUCCESS", "WARNING", "NEXT", "OFF", "OFF", "OFF", "OFF", "SKIPPED"));
  readiness.tell(Stage::buses, State::waiting, "");
  EXPECT_THAT(states(readiness), ElementsAre("SUCCESS", "WARNING", "WAITING", "OFF", "OFF", "OFF", "OFF", "SKIPPED"));
}

TEST(Readiness, ALiveRunRefusesGoUntilEverythingIsDoneAndSomebodyHasArmedIt) {
  Readiness readiness(Scope::live);
  EXPECT_TRUE(readiness.refuses_go());
  tell_all(readiness, State::success);
  EXPECT_TRUE(readiness.refuses_go());
  EXPECT_THAT(readiness.against(), ElementsAre("nobody has said arm"));
  readiness.tell(Stage::roll_call, State::waiting, "nodes are asked");
  readiness.tell(Stage::probes, State::off, "");
  EXPECT_EQ(readiness.arm().error().message, "arm: roll-call WAITING: nodes are asked; probes OFF");
  tell_all(readiness, State::success);
  EXPECT_EQ(readiness.arm().value(), "GO is armed");
  EXPECT_FALSE(readiness.refuses_go());
  EXPECT_THAT(readiness.against(), IsEmpty());
  EXPECT_TRUE(readiness.disarm());
  EXPECT_TRUE(readiness.refuses_go());
}

TEST(Readiness, OnceArmedNothingOfItStopsAShow) {
  Readiness readiness(Scope::live);
  tell_all(readiness, State::success);
  ASSERT_TRUE(readiness.arm());
  readiness.tell(Stage::roll_call, State::error, "3 of 96 markers silent: a");
  EXPECT_FALSE(readiness.refuses_go());
}

TEST(Readiness, AnErrorIsOverriddenByNameUntilItIsAnotherOne) {
  Readiness readiness(Scope::live);
  tell_all(readiness, State::success);
  readiness.tell(Stage::roll_call, State::error, "12 of 3,290 markers silent: a");
  EXPECT_THAT(readiness.against(), ElementsAre("roll-call: 12 of 3,290 markers silent: a"));
  EXPECT_EQ(readiness.override_stage("roll-call", "keyboard").value(),
            "roll-call is overridden by keyboard: 12 of 3,290 markers silent: a");
  EXPECT_EQ(states(readiness)[3], "WARNING");
  readiness.tell(Stage::roll_call, State::error, "12 of 3,290 markers silent: a");
  EXPECT_EQ(states(readiness)[3], "WARNING") << "the same again";
  readiness.tell(Stage::roll_call, State::error, "16 of 3,290 markers silent: a, b");
  EXPECT_EQ(states(readiness)[3], "ERROR");
  EXPECT_FALSE(readiness.arm());
  ASSERT_TRUE(readiness.override_stage("roll-call", "keyboard"));
  EXPECT_TRUE(readiness.arm());
}

TEST(Readiness, OnlyErrorsOfStagesThatThereAreAreOverridden) {
  Readiness readiness(Scope::live);
  EXPECT_EQ(readiness.override_stage("roll", "lines").error().message,
            "override: no stage \"roll\" (there are show, plan, buses, roll-call, plan-on-nodes, probes, looks, time)");
  EXPECT_EQ(readiness.override_stage("probes", "lines").error().message, "override: probes is OFF, no ERROR");
}

TEST(Readiness, TwoDevicesAtOneAddressLockGoInEveryScope) {
  for (const Scope scope : {Scope::rehearsal, Scope::live, Scope::lights_only}) {
    Readiness readiness(scope);
    tell_all(readiness, State::success);
    readiness.tell(Stage::roll_call, State::error, "two devices at address 3", true);
    readiness.tell(Stage::roll_call, State::success, "12 nodes answer");
    EXPECT_TRUE(readiness.refuses_go());
    EXPECT_THAT(readiness.against(), ElementsAre("roll-call: two devices at address 3"));
    EXPECT_EQ(readiness.override_stage("roll-call", "lines").error().message,
              "override: roll-call: two devices at address 3: nobody answers for that");
    EXPECT_FALSE(readiness.arm());
  }
}

TEST(Readiness, ARehearsalHasItsGoFromTheBeginning) {
  Readiness readiness(Scope::rehearsal);
  EXPECT_FALSE(readiness.refuses_go());
  readiness.tell(Stage::roll_call, State::error, "3 of 96 markers silent: a");
  EXPECT_FALSE(readiness.refuses_go());
  EXPECT_EQ(readiness.disarm().error().message, "disarm: only a run with --scope live is armed");
}

TEST(Readiness, WithoutAScopeNothingIsLit) {
  Readiness readiness(Scope::none);
  tell_all(readiness, State::success);
  EXPECT_TRUE(readiness.refuses_go());
  EXPECT_FALSE(readiness.arm());
}

// ---- a run that is taken up

Readiness again(const Readiness& before, Scope scope = Scope::live) {
  Readiness after(scope);
  after.take_up(before.outlives());
  return after;
}

TEST(Readiness, WhoStoodArmedStandsArmedInTheRunThatTakesItUp) {
  Readiness before(Scope::live);
  tell_all(before, State::success);
  EXPECT_TRUE(again(before).refuses_go()) << "nobody has said arm";
  ASSERT_TRUE(before.arm());
  EXPECT_FALSE(again(before).refuses_go());
  before.tell(Stage::roll_call, State::error, "3 of 96 markers silent: a");
  EXPECT_FALSE(again(before).refuses_go()) << "nothing of it stops a show";
  ASSERT_TRUE(before.disarm());
  EXPECT_TRUE(again(before).refuses_go());
}

TEST(Readiness, WhatWasSaidOfTheProbeLampsStaysSaidInTheRunThatTakesItUp) {
  Readiness before(Scope::live);
  tell_all(before, State::success);
  before.tell(Stage::probes, State::error, "A1 does not shine");
  Readiness after = again(before);
  EXPECT_THAT(states(after), ElementsAre("NEXT", "OFF", "OFF", "OFF", "OFF", "ERROR", "OFF", "OFF"));
  tell_all(after, State::success);
  after = again(before);
  for (const Stage stage :
       {Stage::show, Stage::plan, Stage::buses, Stage::roll_call, Stage::plan_on_nodes, Stage::looks, Stage::time}) {
    after.tell(stage, State::success, "told");
  }
  EXPECT_EQ(after.arm().error().message, "arm: probes ERROR: A1 does not shine");
  ASSERT_TRUE(after.override_stage("probes", "lines"));
  EXPECT_EQ(states(again(after))[5], "WARNING") << "and so does the override";
  EXPECT_TRUE(again(again(after)).report()[5].overridden);
}

TEST(Readiness, AnOverrideIsTakenUpWithTheErrorThatItWasOf) {
  Readiness before(Scope::live);
  tell_all(before, State::success);
  before.tell(Stage::roll_call, State::error, "12 of 96 markers silent: a");
  ASSERT_TRUE(before.override_stage("roll-call", "lines"));
  Readiness after = again(before);
  after.tell(Stage::roll_call, State::waiting, "nodes are asked");
  EXPECT_EQ(states(after)[3], "WAITING");
  after.tell(Stage::roll_call, State::error, "12 of 96 markers silent: a");
  EXPECT_EQ(states(after)[3], "WARNING");
  after.tell(Stage::roll_call, State::error, "16 of 96 markers silent: a, b");
  EXPECT_EQ(states(after)[3], "ERROR");
}

TEST(Readiness, ALockIsTakenUpInEveryScope) {
  for (const Scope scope : {Scope::rehearsal, Scope::live, Scope::lights_only}) {
    Readiness before(scope);
    tell_all(before, State::success);
    before.tell(Stage::roll_call, State::error, "two devices at address 3", true);
    Readiness after = again(before, scope);
    tell_all(after, State::success);
    EXPECT_TRUE(after.refuses_go());
    EXPECT_FALSE(after.arm());
    EXPECT_EQ(after.override_stage("roll-call", "lines").error().message,
              "override: roll-call: two devices at address 3: nobody answers for that");
  }
}

TEST(Readiness, WhatIsNoWordOfARunInThisScopeLeavesALiveRunUnarmed) {
  Readiness rehearsal(Scope::rehearsal);
  tell_all(rehearsal, State::success);
  for (const std::string& text :
       {std::string(), std::string("{"), std::string("[]"), std::string(R"({"scope":"live"})"),
        std::string(R"({"scope":"live","stages":[{"stage":99,"state":3}],"armed":true})"),
        std::string(R"({"scope":"live","stages":[{"stage":5,"state":-1}],"armed":true})"),
        std::string(R"({"scope":"live","armed":"true"})"), rehearsal.outlives()}) {
    Readiness after(Scope::live);
    after.take_up(text);
    EXPECT_TRUE(after.refuses_go()) << text;
    EXPECT_EQ(states(after)[5], "ERROR") << text;
    EXPECT_EQ(after.report()[5].text, "nobody has looked since the run was cut off");
  }
}

TEST(Readiness, WhatOutlivesTheProgramIsShort) {
  Readiness before(Scope::live);
  for (std::size_t s = 0; s < Readiness::kStages; ++s) {
    before.tell(static_cast<Stage>(s), State::error, std::string(5000, 'x'));
    ASSERT_TRUE(before.override_stage(to_text(static_cast<Stage>(s)), std::string(5000, 'y')));
  }
  ASSERT_TRUE(before.arm());
  EXPECT_LE(before.outlives().size(), Readiness::kLongestOutlives);
  EXPECT_FALSE(again(before).refuses_go());
}

TEST(Readiness, SilenceIsToldInMarkersAndNodes) {
  EXPECT_EQ(silence_text(12, 3290, {"left-3", "left-4"}), "12 of 3,290 markers silent: left-3, left-4");
  std::vector<std::string> many;
  for (int n = 1; n <= 11; ++n) many.push_back("n" + std::to_string(n));
  EXPECT_EQ(silence_text(352, 1'000'000, many),
            "352 of 1,000,000 markers silent: n1, n2, n3, n4, n5, n6, n7, n8 and 3 more nodes");
}

}  // namespace
}  // namespace footlight::app
