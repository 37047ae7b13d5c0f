// SPDX-License-Identifier: Apache-2.0
#include "app/surfaces/state_text.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "controller/cue_list.hpp"
#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

using Phase = controller::Rehearsal::Phase;
using ResetState = controller::Rehearsal::ResetState;
using tests::cue_of;

class StateTextTest : public ::testing::Test {
 protected:
  StateTextTest() : small_(tests::random_show(6, 6, 4, 3, 2, 1)) {
    small_.show.cues = {cue_of("1", 0), cue_of("2", 1, ContinueMode::auto_follow), cue_of("3", 2)};
    plays_ = controller::cue_plays(small_.show, small_.plan);
    view_.buses = {{"left", 6, 0}, {"right", 4, 0}};
    view_.show.at = instant_at(100);
    view_.show.standby = 0;
  }
  [[nodiscard]] std::string line() const { return StateText(small_.show, small_.plan, plays_).line(view_); }

  tests::SmallShow small_;
  std::vector<controller::CuePlay> plays_;
  DeskView view_;
};

TEST_F(StateTextTest, SaysWhatGoWillDo) {
  EXPECT_EQ(line(), "s1 1:1 count 1 | 100 % | GO for cue 1 cue 1 | all 10 nodes right");
  view_.show.standby = 1;
  view_.show.active = 0;
  view_.show.phase = Phase::runs;
  view_.show.position = instant_at(2.6);
  view_.show.ends_at = instant_at(101.4);
  view_.buses[1].unconfirmed = 2;
  EXPECT_EQ(line(), "s1 2:2 count 6 | 100 % | cue 1 cue 1 runs, GO for 2 cue 2 in 1.4 s | right 2/4 NOT RIGHT");
  view_.show.holds_at_end = true;
  view_.show.percent = view_.show.limit_percent = 118;
  EXPECT_EQ(
      line(),
      "s1 2:2 count 6 | 118 % (at most) | cue 1 cue 1 runs, GO for 2 cue 2 in 1.4 s, HOLD at the end of the set | "
      "right 2/4 NOT RIGHT");
  view_.show.phase = Phase::stands;
  EXPECT_EQ(line(), "s1 2:2 count 6 | 118 % (at most) | HOLD in cue 1 cue 1: GO goes on | right 2/4 NOT RIGHT");
}

TEST_F(StateTextTest, SaysWhatAFreezeWouldDoNow) {
  view_.show.active = 0;
  view_.show.standby = 1;
  view_.show.phase = Phase::runs;
  view_.show.position = instant_at(2.6);
  view_.show.ends_at = instant_at(101.4);
  view_.freeze = {true, 3, instant_at(3.3), 2};
  EXPECT_EQ(line(),
            "s1 2:2 count 6 | 100 % | cue 1 cue 1 runs, GO for 2 cue 2 in 1.4 s | freeze: 3 pairs may touch until "
            "count 8; HOLD at the end is better | all 10 nodes right");
  const auto json = nlohmann::json::parse(StateText(small_.show, small_.plan, plays_).json(view_))["state"]["freeze"];
  EXPECT_EQ(json, (nlohmann::json{{"pairs", 3}, {"until_count", 7.6}, {"resume_pairs", 2}}));
  view_.freeze = {true, 0, instant_at(2.6), 0};
  EXPECT_EQ(line(),
            "s1 2:2 count 6 | 100 % | cue 1 cue 1 runs, GO for 2 cue 2 in 1.4 s | freeze safe | all 10 nodes right");
  view_.show.phase = Phase::stands;
  view_.freeze.resume_pairs = 1;
  EXPECT_EQ(line(),
            "s1 2:2 count 6 | 100 % | HOLD in cue 1 cue 1: GO goes on | going on: 1 pair may touch where people have "
            "walked on | all 10 nodes right");
}

TEST_F(StateTextTest, SaysWhyTheTempoIsHeldBack) {
  const std::vector<controller::TempoLimit> limits{
      {200, ""}, {118, "performer 8 walks at 3.39 of 4 m/s at count 17"}, {200, ""}};
  view_.limits = &limits;
  view_.show.standby = 1;
  view_.show.limit_percent = 118;
  const auto json = nlohmann::json::parse(StateText(small_.show, small_.plan, plays_).json(view_))["state"];
  EXPECT_EQ(json["most_percent"], 118);
  EXPECT_EQ(json["most_because"], "performer 8 walks at 3.39 of 4 m/s at count 17");
}

TEST_F(StateTextTest, SaysWhatAResetMoveWaitsFor) {
  view_.show.reset = {ResetState::ready, 1, instant_at(4), instant_at(0)};
  view_.show.position = instant_at(4);
  EXPECT_EQ(line(),
            "s1 3:1 count 9 | 100 % | GO lights the reset move: are people where they should be? | all 10 nodes right");
  view_.show.position = instant_at(3);
  EXPECT_EQ(
      line(),
      "s1 2:3 count 7 | 100 % | GO: people walk on to the end of the set, then the reset move | all 10 nodes right");
  view_.show.reset.state = ResetState::impossible;
  EXPECT_EQ(
      line(),
      "s1 2:3 count 7 | 100 % | NO RESET MOVE: send people by word of mouth, then \"placed\" | all 10 nodes right");
}

TEST_F(StateTextTest, TellsWhatAFreezeOfAResetMoveWouldDo) {
  view_.show.phase = Phase::resets;
  view_.show.position = instant_at(3);
  view_.freeze = {true, 1, kNever, 2};
  EXPECT_EQ(line(), "s1 2:3 count 7 | 100 % | reset move | freeze: 1 pair may touch | all 10 nodes right");
  view_.freeze.pairs = 0;
  EXPECT_EQ(line(), "s1 2:3 count 7 | 100 % | reset move | freeze safe | all 10 nodes right");
  view_.show.phase = Phase::reset_held;
  EXPECT_EQ(
      line(),
      "s1 2:3 count 7 | 100 % | HOLD in the reset move: GO goes on | going on: 2 pairs may touch where people have "
      "walked on | all 10 nodes right");
}

TEST_F(StateTextTest, TheJsonHasEveryFigure) {
  view_.show.phase = Phase::runs;
  view_.show.active = 1;
  view_.show.standby = 2;
  view_.show.position = instant_at(8.25);
  view_.show.ends_at = instant_at(103.75);
  view_.show.target.rate = 0.8;
  view_.show.loops = true;
  view_.show.loop = {instant_at(8), instant_at(12)};
  const auto json = nlohmann::json::parse(StateText(small_.show, small_.plan, plays_).json(view_))["state"];
  EXPECT_EQ(json["phase"], "runs");
  EXPECT_EQ(json["position_s"], 8.25);
  EXPECT_EQ(json["section"], "s2");
  EXPECT_EQ(json["measure"], "5:1");
  EXPECT_EQ(json["count"], 17.5);
  EXPECT_EQ(json["cue"], "2");
  EXPECT_EQ(json["standby"], "3");
  EXPECT_EQ(json["ends_in_s"], 3.75);
  EXPECT_EQ(json["goes_in_s"], nullptr);
  EXPECT_EQ(json["loop"]["to_s"], 12);
  EXPECT_EQ(json["reset"]["state"], "none");
  EXPECT_EQ(json["rate"], 0.8);
  EXPECT_EQ(json["buses"][0]["name"], "left");
}

TEST_F(StateTextTest, TheJsonSaysHowFarAResetMoveIsAndWhetherItGoesOn) {
  view_.show.phase = Phase::resets;
  view_.show.position = instant_at(8);
  view_.show.target.show_time = milliseconds(1500);
  const StateText text(small_.show, small_.plan, plays_);
  auto json = nlohmann::json::parse(text.json(view_))["state"];
  EXPECT_EQ(json["reset"]["at_s"], 1.5);
  EXPECT_EQ(json["rate"], 1);
  view_.show.phase = Phase::reset_held;
  json = nlohmann::json::parse(text.json(view_))["state"];
  EXPECT_EQ(json["reset"]["at_s"], 1.5);
  EXPECT_EQ(json["rate"], 0);
}

}  // namespace
}  // namespace footlight::app
