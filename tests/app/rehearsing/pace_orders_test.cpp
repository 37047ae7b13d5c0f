// SPDX-License-Identifier: Apache-2.0
#include "app/rehearsing/pace_orders.hpp"

#include <gtest/gtest.h>

#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

using Kind = controller::Command::Kind;
using Phase = controller::Rehearsal::Phase;
using ResetState = controller::Rehearsal::ResetState;

struct Ear final : Surface {
  void look(const DeskView& view, RunDesk& /*desk*/) override { seen = view; }
  void told(const RunEvent& event) override { heard.push_back((event.refused ? "refused: " : "") + event.text); }
  [[nodiscard]] bool listens() const override { return true; }
  DeskView seen;
  std::vector<std::string> heard;
};

class PaceOrdersTest : public ::testing::Test {
 protected:
  PaceOrdersTest() : small_(tests::random_show(6, 6, 4, 3, 2, 1)), pace_(small_.show, clock_) {
    small_.show.cues = {tests::cue_of("1", 0), tests::cue_of("2", 1), tests::cue_of("3", 2)};
    small_.show.cues[1].notes = "trap closed?";
    desk_.emplace(small_.show, small_.plan);
    pace_.add_to(*desk_);
    desk_->add(ear_);
    view_.show.standby = 0;
    look();
  }
  std::vector<controller::Command> look() { return desk_->look(view_).commands; }
  std::vector<controller::Command> say(const std::string& order) {
    desk_->say(order, {});
    return look();
  }
  tests::SmallShow small_;
  ManualClock clock_;
  std::optional<RunDesk> desk_;
  PaceOrders pace_;
  Ear ear_;
  DeskView view_;
};

TEST_F(PaceOrdersTest, ATappedTempoIsAShareOfTheWrittenOne) {
  EXPECT_TRUE(say("tap").empty());
  clock_.advance(milliseconds(600));
  EXPECT_TRUE(say("tap").empty());
  EXPECT_EQ(ear_.heard.back(), "tap 2");
  clock_.advance(milliseconds(600));
  const auto commands = say("tap");
  ASSERT_EQ(commands.size(), 1U);
  EXPECT_EQ(commands[0].kind, Kind::tempo);
  EXPECT_EQ(commands[0].percent, 83);
  EXPECT_EQ(ear_.heard.back(), "tap 3: 100 counts a minute, 83 % of the written tempo");
}

TEST_F(PaceOrdersTest, StandbyAsksForTheWayToThatCue) {
  auto commands = say("standby 2");
  ASSERT_EQ(commands.size(), 1U);
  EXPECT_EQ(commands[0].kind, Kind::jump);
  EXPECT_EQ(commands[0].position, desk_->orders().plays()[1].from);
  EXPECT_EQ(ear_.heard.back(), "standby cue 2 cue 2: trap closed?");
  // From there, one further.
  view_.show.reset = {ResetState::ready, 1, {}, commands[0].position};
  (void)look();
  commands = say("standby down");
  ASSERT_EQ(commands.size(), 1U);
  EXPECT_EQ(commands[0].position, desk_->orders().plays()[2].from);
  view_.show.reset = {};
  (void)look();
  EXPECT_TRUE(say("standby up").empty());
  EXPECT_EQ(ear_.heard.back(), "refused: standby: this is the first cue");
  EXPECT_TRUE(say("standby 7").empty());
  EXPECT_EQ(ear_.heard.back(), "refused: standby: no cue \"7\" (a number, up or down is wanted)");
  view_.show.phase = Phase::runs;
  (void)look();
  EXPECT_TRUE(say("standby 3").empty());
  EXPECT_EQ(ear_.heard.back(), "refused: standby: the show runs (\"jump cue 12\" stops it at the end of the set)");
}

TEST_F(PaceOrdersTest, TheNotesOfTheStandbyCueAreShownWhileTheShowWaits) {
  view_.show.standby = 1;
  (void)look();
  EXPECT_EQ(ear_.seen.standby_notes, "trap closed?");
  view_.show.phase = Phase::runs;
  view_.show.active = 0;
  (void)look();
  EXPECT_EQ(ear_.seen.standby_notes, "");
}

}  // namespace
}  // namespace footlight::app
