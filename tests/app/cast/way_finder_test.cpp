// SPDX-License-Identifier: Apache-2.0
#include "app/cast/way_finder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/console/show_document.hpp"
#include "planner/validate.hpp"
#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

using ::testing::HasSubstr;
using tests::mark_at;

/// Two cues: five people stand in a row, walk upstage from 8 s to 16 s and stand again to 40 s. The tempo is 120.
std::shared_ptr<const CastPlan> five(ContinueMode mode = ContinueMode::manual) {
  const Grid grid = *Grid::make(GridKind::square, 12, 12, 1.0);
  std::vector<std::vector<Mark>> tracks;
  for (int i = 0; i < 5; ++i) {
    tracks.push_back({mark_at(0, grid, 3 + i, 1), mark_at(8, grid, 3 + i, 1), mark_at(16, grid, 3 + i, 9),
                      mark_at(40, grid, 3 + i, 9)});
  }
  Plan plan = tests::plan_of(grid, std::move(tracks));
  plan.stage.clearance_m = 0.5;
  plan.stage.max_speed_mps = 1.4;
  plan.sections.push_back({"one", kStart, instant_at(8), 1.4, {}, {}, {}});
  plan.sections.push_back({"two", instant_at(16), instant_at(40), 1.4, {}, {}, {}});
  plan.valid = true;
  Show show;
  show.title = "Five";
  show.stage = plan.stage;
  show.tempo = TempoMap(120);
  show.cues = {tests::cue_of("1", 0, mode), tests::cue_of("2", 1)};
  for (const std::string& id : plan.performers) {
    Performer one;
    one.id = id;
    one.name = "Person " + id;
    show.performers.push_back(std::move(one));
  }
  return std::make_shared<const CastPlan>(std::move(show), std::move(plan));
}

class WayFinderTest : public ::testing::Test {
 protected:
  nlohmann::json ask(int column, int row, double position_s, DeskWord::Phase phase, const char* cue,
                     std::uint32_t who = 0) {
    WayFinder::Question question;
    question.who = PerformerIndex(who);
    question.from = cast_->plan().stage.grid.index({column, row});
    question.word.phase = phase;
    question.word.cue = cue;
    question.word.rate = phase == DeskWord::Phase::runs ? 1 : 0;
    question.position = instant_at(position_s);
    return nlohmann::json::parse(finder_.answer(cast_, question))["where"];
  }
  std::shared_ptr<const CastPlan> cast_ = five();
  WayFinder finder_;
};

using Phase = DeskWord::Phase;

TEST_F(WayFinderTest, WhoIsLateIsToldTheCountAndTheSheetsWords) {
  const auto where = ask(1, 5, 10, Phase::runs, "2");
  EXPECT_EQ(where["kind"], "join");
  const auto& places = where["places"];
  ASSERT_GE(places.size(), 2U);
  EXPECT_EQ(places[0]["cell"], cast_->plan().stage.grid.index({1, 5}).value());
  EXPECT_GE(places[0]["until_s"].get<double>(), 14) << "time to read it";
  EXPECT_THAT(places[0]["way"].get<std::string>(), HasSubstr("steps"));
  EXPECT_EQ(finder_.given(), 1U);
}

TEST_F(WayFinderTest, EveryWayThatIsGivenIsOneThatTheJudgeAccepts) {
  int ways = 0;
  for (int cell = 0; cell < 144; cell += 5) {
    WayFinder fresh;
    finder_ = std::move(fresh);
    const auto where = ask(cell % 12, cell / 12, 9, Phase::runs, "2", 2);
    if (where["kind"] != "join") continue;
    ++ways;
    Plan plan = cast_->plan();
    std::vector<Mark> track;
    for (const auto& place : where["places"]) {
      for (const char* at : {"from_s", "until_s"}) {
        const Mark mark{instant_at(place[at].get<double>()), CellIndex(place["cell"].get<std::uint32_t>())};
        if (track.empty() || track.back().time < mark.time) track.push_back(mark);
      }
    }
    const Instant joins = track.back().time;
    for (const Mark& mark : plan.tracks[2]) {
      if (mark.time > joins) track.push_back(mark);
    }
    plan.tracks[2] = track;
    const planner::Verdict verdict = planner::validate(plan, track.front().time, joins);
    EXPECT_TRUE(verdict.valid()) << cell << ": " << (verdict.first.empty() ? "" : verdict.first.front().text);
  }
  EXPECT_GT(ways, 15);
}

TEST_F(WayFinderTest, NobodyIsSentPastTheEndOfACueThatWaitsForGo) {
  const auto where = ask(11, 11, 4, Phase::runs, "1");  // 12 m in 4 s
  EXPECT_EQ(where["kind"], "wait");
  EXPECT_EQ(where["ask_s"], 8) << "when the show stands";
  cast_ = five(ContinueMode::auto_follow);
  EXPECT_EQ(ask(11, 11, 4, Phase::runs, "1")["kind"], "join") << "where it goes on by itself she joins later";
}

TEST_F(WayFinderTest, ALoopEndsWhatCanBePromised) {
  DeskWord word;
  word.phase = Phase::runs;
  word.cue = "2";
  word.loop = DeskWord::Loop{16, 20};
  EXPECT_EQ(stops_at(*cast_, word, instant_at(17)), instant_at(20));
  word.loop.reset();
  EXPECT_EQ(stops_at(*cast_, word, instant_at(17)), instant_at(40));
  word.holds_at_end = true;
  EXPECT_EQ(stops_at(*cast_, word, instant_at(10)), instant_at(16));
}

TEST_F(WayFinderTest, WhileTheShowStandsSheGoesAtOnceAroundThoseWhoStand) {
  const auto where = ask(3, 5, 8, Phase::stands, "", 4);
  EXPECT_EQ(where["kind"], "join");
  EXPECT_EQ(where["at_once"], true);
  EXPECT_EQ(where["places"].back()["cell"], cast_->plan().stage.grid.index({7, 1}).value());
  EXPECT_EQ(finder_.given(), 0U);
}

TEST_F(WayFinderTest, AFreezeInTheMiddleOfAWalkAndAResetAreWaitedFor) {
  EXPECT_EQ(ask(1, 5, 12, Phase::stands, "2")["kind"], "held");
  EXPECT_EQ(ask(1, 5, 12, Phase::resets, "")["kind"], "reset");
}

TEST_F(WayFinderTest, WhoIsRightIsToldSo) { EXPECT_EQ(ask(3, 1, 2, Phase::runs, "1")["kind"], "here"); }

TEST(CastPlan, WhatAConsoleTellsOfAPlanIsReadBack) {
  const auto cast = five();
  const std::string bytes = plan_bytes(cast->plan(), 7);
  const auto tracks = tracks_from(bytes, 5, 144);
  ASSERT_TRUE(tracks) << tracks.error().message;
  EXPECT_EQ(*tracks, cast->plan().tracks);
  EXPECT_EQ(tracks_from(bytes, 6, 144).error().message, "the desk's plan is of 5 people, this show of 6");
  EXPECT_EQ(tracks_from(bytes.substr(0, bytes.size() - 1), 5, 144).error().message,
            "the desk's plan is not as long as it says");
  EXPECT_EQ(tracks_from(bytes, 5, 20).error().message, "the desk's plan has cells that are not on this stage");
  EXPECT_EQ(tracks_from("FLP", 5, 144).error().message, "the desk's plan is of another version of Footlight");
  Rng rng(1);
  for (int i = 0; i < 20'000; ++i) {
    std::string wrong = bytes;
    wrong[rng.below(wrong.size())] = static_cast<char>(rng.below(256));
    const auto read = tracks_from(wrong, 5, 144);
    EXPECT_TRUE(!read || read->size() == 5U);
  }
}

TEST(CastPlan, PhonesGetNamesAndNoLamps) {
  const auto json = nlohmann::json::parse(five()->show_json());
  EXPECT_EQ(json["performers"][1]["name"], "Person 2");
  EXPECT_EQ(json["cues"].size(), 2U);
  EXPECT_FALSE(json.contains("rig"));
  const auto part = nlohmann::json::parse(five()->part_json(PerformerIndex(1), Language::chinese));
  EXPECT_EQ(part["who"], 1);
  EXPECT_EQ(part["places"].size(), 2U);
  EXPECT_EQ(part["places"][0]["until_s"], 8);
}

}  // namespace
}  // namespace footlight::app
