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

TEST(Readiness, SilenceIsToldInMarkersAndNodes) {
  EXPECT_EQ(silence_text(12, 3290, {"left-3", "left-4"}), "12 of 3,290 markers silent: left-3, left-4");
  std::vector<std::string> many;
  for (int n = 1; n <= 11; ++n) many.push_back("n" + std::to_string(n));
  EXPECT_EQ(silence_text(352, 1'000'000, many),
            "352 of 1,000,000 markers silent: n1, n2, n3, n4, n5, n6, n7, n8 and 3 more nodes");
}

}  // namespace
}  // namespace footlight::app
