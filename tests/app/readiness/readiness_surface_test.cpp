// SPDX-License-Identifier: Apache-2.0
#include "app/readiness/readiness_surface.hpp"

#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

using Stage = Readiness::Stage;
using State = Readiness::State;
using Phase = controller::Rehearsal::Phase;
using ResetState = controller::Rehearsal::ResetState;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr NodeBoard::View kFine{0, NodeBoard::kRight | NodeBoard::kSameChecks};
constexpr NodeBoard::View kSilent{0, NodeBoard::kSilent};

class Ears final : public Surface {
 public:
  void look(const DeskView& view, RunDesk& /*desk*/) override { seen = view; }
  void told(const RunEvent& event) override { heard.push_back(event.text); }
  [[nodiscard]] bool listens() const override { return true; }
  DeskView seen;
  std::vector<std::string> heard;
};

/// Three nodes on one bus.
class ReadinessSurfaceTest : public ::testing::Test {
 protected:
  ReadinessSurfaceTest() : small_(tests::random_show(6, 6, 4, 3, 2, 1)), desk_(small_.show, small_.plan), board_(3) {
    rig_ = tests::lamps_everywhere(small_.show.stage.grid, {BusKind::serial}, 115'200, 12);
    for (std::size_t n = 0; n < 3; ++n) board_.put(n, kFine);
    desk_.add(ears_);
    view_.roll_called = true;
  }
  void open(Scope scope, bool arms = false) {
    readiness_.emplace(scope);
    for (const Stage stage : {Stage::show, Stage::plan, Stage::buses, Stage::probes, Stage::time}) {
      readiness_->tell(stage, State::success, "told");
    }
    health_.emplace(rig_, board_, desk_, nullptr);
    desk_.add(*health_);
    surface_.emplace(*readiness_, rig_, board_, *health_, desk_, arms);
    desk_.add(*surface_);
  }
  DeskWishes look() {
    DeskWishes wishes = desk_.look(view_);
    view_.show.barred = wishes.bars;
    return wishes;
  }
  std::vector<std::string> say(const std::string& order) {
    ears_.heard.clear();
    desk_.say(order, {controller::GoSource::lines, "lines"});
    return std::exchange(ears_.heard, {});
  }

  tests::SmallShow small_;
  Rig rig_;
  RunDesk desk_;
  NodeBoard board_;
  Ears ears_;
  std::optional<Readiness> readiness_;
  std::optional<BusHealth> health_;
  std::optional<ReadinessSurface> surface_;
  DeskView view_;
};

TEST_F(ReadinessSurfaceTest, GoIsBarredFromTheFirstLookUntilItIsArmed) {
  open(Scope::live);
  view_.roll_called = false;
  EXPECT_EQ(look().bars, controller::kNotReady);
  EXPECT_THAT(say("arm"), ElementsAre("arm: roll-call WAITING: nodes are asked; plan-on-nodes OFF; looks OFF"));
  view_.roll_called = true;
  EXPECT_EQ(look().bars, controller::kNotReady);
  (void)look();
  EXPECT_THAT(ears_.seen.against, ElementsAre("nobody has said arm"));
  EXPECT_THAT(say("arm"), ElementsAre("GO is armed"));
  EXPECT_EQ(look().bars, 0U);
  EXPECT_TRUE(ears_.seen.readiness.armed);
  EXPECT_EQ(ears_.seen.readiness.scope, "live");
  ASSERT_EQ(ears_.seen.readiness.stages.size(), Readiness::kStages);
}

TEST_F(ReadinessSurfaceTest, SilentNodesAreNamedAndOverridden) {
  open(Scope::live);
  board_.put(1, kSilent);
  (void)look();
  (void)look();
  const std::string silent = "12 of 36 markers silent: " + rig_.nodes[1].name;
  EXPECT_THAT(ears_.seen.against, ElementsAre("roll-call: " + silent));
  EXPECT_THAT(say("override roll-call"), ElementsAre("roll-call is overridden by lines: " + silent));
  EXPECT_THAT(say("arm"), ElementsAre("GO is armed"));
}

TEST_F(ReadinessSurfaceTest, NodesThatCannotBeReadBackAreAWarning) {
  open(Scope::live);
  board_.put(2, {NodeBoard::kNothingYet, NodeBoard::kUnverified | NodeBoard::kNoChecks});
  (void)look();
  const auto stages = readiness_->report();
  EXPECT_EQ(stages[3].state, State::success);
  EXPECT_EQ(stages[4].state, State::warning);
  EXPECT_EQ(
      stages[4].text,
      "2 nodes confirm by sequence and check sum what this plan shows, 1 cannot be read back; 2 keep this plan and "
      "patch; 1 keep none");
}

TEST_F(ReadinessSurfaceTest, ANodeOfAnotherPatchLocksGoAndIsNamed) {
  open(Scope::live);
  board_.put(0, {0, NodeBoard::kRight | NodeBoard::kOtherPatch});
  board_.put(2, {0, NodeBoard::kRight | NodeBoard::kNoPatch});
  (void)look();
  const std::string wrong = "the patch of another rig or node is on: " + rig_.nodes[0].name +
                            " (is it the node that the rig means? `footlight devices patch --write` when it is); no "
                            "patch is on: " +
                            rig_.nodes[2].name +
                            " (`footlight devices patch --write` when its lamps are where the rig says)";
  EXPECT_THAT(say("arm"), ElementsAre("arm: plan-on-nodes ERROR: " + wrong));
  EXPECT_EQ(look().bars, controller::kNotReady);
  EXPECT_THAT(say("override plan-on-nodes"), ElementsAre("plan-on-nodes is overridden by lines: " + wrong));
  EXPECT_THAT(say("arm"), ElementsAre("GO is armed"));
  board_.put(0, kFine);
  board_.put(1, {0, NodeBoard::kRight | NodeBoard::kOtherPlan});
  board_.put(2, kFine);
  (void)look();
  EXPECT_EQ(readiness_->report()[4].text,
            "another plan is on: " + rig_.nodes[1].name + " (does another controller tell it?)");
}

TEST_F(ReadinessSurfaceTest, GoWaitsUntilEveryNodeHasToldWhatItKeeps) {
  open(Scope::live);
  board_.put(1, {0, NodeBoard::kRight});
  (void)look();
  EXPECT_THAT(say("arm"), ElementsAre("arm: plan-on-nodes WAITING: 3 nodes confirm by sequence and check sum what this "
                                      "plan shows; 2 keep this plan and patch; 1 are asked for theirs"));
  board_.put(1, kFine);
  (void)look();
  EXPECT_THAT(say("arm"), ElementsAre("GO is armed"));
  board_.put(1, {0, NodeBoard::kRight});
  (void)look();
  EXPECT_EQ(readiness_->report()[4].state, State::success) << "a node that has restarted later stops nothing";
}

TEST_F(ReadinessSurfaceTest, StagesSayWhatIsNotReadyWhileAWireIsDownAndComeBack) {
  open(Scope::rehearsal);
  view_.buses = {{"bus1", 3, 0}};
  (void)look();
  view_.now = instant_at(1);
  view_.buses[0].trouble = "unplugged";
  for (std::size_t n = 0; n < 3; ++n) board_.put(n, kSilent);
  (void)look();
  auto stages = readiness_->report();
  EXPECT_EQ(stages[2].state, State::error);
  EXPECT_EQ(stages[2].text, "bus1 is down: unplugged");
  EXPECT_EQ(stages[3].state, State::error);
  EXPECT_THAT(stages[3].text, ::testing::StartsWith("36 of 36 markers silent: "));
  EXPECT_EQ(stages[4].state, State::warning);
  EXPECT_EQ(stages[4].text, "0 nodes confirm by sequence and check sum what this plan shows, 3 do not");
  EXPECT_EQ(stages[6].state, State::warning);
  view_.buses[0].trouble.clear();
  for (std::size_t n = 0; n < 3; ++n) board_.put(n, kFine);
  for (const double at_s : {2.0, 3.0}) {
    view_.now = instant_at(at_s);
    (void)look();
  }
  stages = readiness_->report();
  EXPECT_EQ(stages[2].text, "1 open");
  for (const std::size_t stage : {2U, 3U, 4U, 6U}) EXPECT_EQ(stages[stage].state, State::success) << stage;
}

TEST_F(ReadinessSurfaceTest, ANodeThatAnswersAndDoesNotShowWhatItShouldIsNoProof) {
  open(Scope::rehearsal);
  (void)look();
  board_.put(1, {0, NodeBoard::kSameChecks});
  for (const double at_s : {1.0, 3.4, 3.6}) {
    view_.now = instant_at(at_s);
    (void)look();
    EXPECT_EQ(readiness_->report()[4].state, at_s < 3.5 ? State::success : State::warning) << at_s;
  }
  EXPECT_EQ(readiness_->report()[3].state, State::success);
}

TEST_F(ReadinessSurfaceTest, WhereNobodyIsAtTheDeskItArmsItself) {
  open(Scope::live, true);
  EXPECT_EQ(look().bars, 0U);
}

TEST_F(ReadinessSurfaceTest, ASpareIsFollowedWhileTheShowGoesOn) {
  open(Scope::rehearsal);
  (void)look();
  EXPECT_THAT(say("swap nobody"), ElementsAre("swap: the rig has no node \"nobody\""));
  EXPECT_EQ(say("swap " + rig_.nodes[1].name).at(0),
            "swap " + rig_.nodes[1].name + ", 1 of 2: unplug it from bus bus1. The others go on.");
  (void)look();
  ASSERT_TRUE(ears_.seen.readiness.swap.has_value());
  EXPECT_EQ(ears_.seen.readiness.swap->node, rig_.nodes[1].name);
  EXPECT_EQ(ears_.seen.readiness.swap->step, "unplug");
  ears_.heard.clear();
  board_.put(1, kSilent);
  (void)look();
  EXPECT_THAT(ears_.heard, ElementsAre(::testing::HasSubstr("2 of 2: give the spare address 2")));
  board_.put(1, kFine);
  (void)look();
  EXPECT_THAT(ears_.heard, Contains(::testing::HasSubstr("the spare answers at address 2")));
  (void)look();
  EXPECT_EQ(ears_.seen.readiness.swap->step, "done") << "until somebody has read it";
  EXPECT_THAT(say("swap off"), ElementsAre(::testing::HasSubstr("the spare answers at address 2")));
  (void)look();
  EXPECT_FALSE(ears_.seen.readiness.swap.has_value());
  EXPECT_THAT(say("swap off"), ElementsAre("swap: none is under way"));
}

TEST_F(ReadinessSurfaceTest, WithNobodyOnTheStageNobodyIsLedBack) {
  open(Scope::lights_only);
  view_.show.reset = {ResetState::wanted, 7, instant_at(4), instant_at(0)};
  view_.show.phase = Phase::runs;
  EXPECT_THAT(look().commands, IsEmpty());
  view_.show.phase = Phase::stands;
  const auto commands = look().commands;
  ASSERT_EQ(commands.size(), 1U);
  EXPECT_EQ(commands[0].kind, controller::Command::Kind::placed);
  EXPECT_THAT(look().commands, IsEmpty()) << "said once";
}

TEST_F(ReadinessSurfaceTest, ARehearsalIsNotBarred) {
  open(Scope::rehearsal);
  view_.roll_called = false;
  EXPECT_EQ(look().bars, 0U);
  EXPECT_THAT(say("ready").at(0),
              ::testing::StartsWith("scope rehearsal, GO is there\n  SUCCESS  show          told\n"));
}

}  // namespace
}  // namespace footlight::app
