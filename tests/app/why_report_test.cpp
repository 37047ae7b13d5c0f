// SPDX-License-Identifier: Apache-2.0
#include "app/why_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/planner/why/hurried_show.hpp"

namespace footlight::app {
namespace {

using ::testing::HasSubstr;
using tests::HurriedShow;

planner::Move move_of(const HurriedShow& made, std::uint32_t who) {
  return planner::explain_moves(made.show, made.plan, made.film, PerformerIndex(who), FormationIndex(1),
                                FormationIndex(1))
      .front();
}

WhyAnswer answer_of(const HurriedShow& made, std::uint32_t who) {
  WhyAnswer answer;
  answer.who = PerformerIndex(who);
  answer.moves = {move_of(made, who)};
  answer.one_more = planner::one_more_count(made.show, made.plan, made.film, answer.who, FormationIndex(1), {}).value();
  return answer;
}

std::vector<std::string> kinds_of(const std::vector<MoveLimit>& limits) {
  std::vector<std::string> out;
  for (const MoveLimit& limit : limits) out.push_back(limit.kind);
  return out;
}

TEST(WhyReport, PutsTheTightestLimitFirstAndWhatCannotBeMeasuredLast) {
  const HurriedShow made = tests::two_lists();
  const auto limits = limits_of(made.show, made.plan, move_of(made, 0));
  EXPECT_EQ(kinds_of(limits), (std::vector<std::string>{"pace", "neighbour", "lag", "pin"}));
  EXPECT_EQ(limits[0].text,
            "2.0 m in the 4 counts that lie between the two formations: 1.00 m/s of 1.4 m/s (the stage's limit)");
  EXPECT_NEAR(limits[0].used.value(), 1 / 1.4, 1e-9);
  EXPECT_EQ(limits[1].text, "performer 2 comes as near as 1.000 m at count 7 (at least 0.5 m)");
  EXPECT_EQ(limits[3].text, "C1 is given by the show's list of cells: nobody else can take it");
  EXPECT_FALSE(limits[3].used.has_value());
}

TEST(WhyReport, SaysWhatTheShowFileAsksForByNameGroupAndHand) {
  HurriedShow made = tests::two_lists();
  made.show.groups.push_back({"left", {}, false});
  planner::Move move = move_of(made, 0);
  move.exact = true;
  move.moved = 2;
  move.group = GroupIndex(0);
  const auto told = [&](planner::Move::Bound bound) {
    move.bound = bound;
    std::vector<std::string> out;
    for (const MoveLimit& limit : limits_of(made.show, made.plan, move)) {
      if (!limit.used) out.push_back(limit.kind + ": " + limit.text);
    }
    return out;
  };
  const std::string key = "key: the formation is exact: nobody may be elsewhere, however far it is";
  const std::string hand = "hand: 2 people are placed by hand in this formation";
  using Bound = planner::Move::Bound;
  EXPECT_EQ(told(Bound::nothing), (std::vector<std::string>{key, hand}));
  move.pinned_to = move.to;
  EXPECT_EQ(told(Bound::pin), (std::vector<std::string>{
                                  "pin: C1 is given to this performer by name: nobody else can take it", key, hand}));
  move.pinned_to = made.show.stage.grid.index({3, 0});
  EXPECT_EQ(told(Bound::pin).front(), "pin: D1 is given to this performer by name, and is not reached in time");
  EXPECT_EQ(told(Bound::group_in_list).front(), "group: C1 is a place of the group 'left' in the show's list of cells");
  EXPECT_EQ(told(Bound::region).front(),
            "group: places in its regions are kept for the group 'left', and its people for them");
  EXPECT_EQ(told(Bound::group).front(), "group: nobody else takes a place of the group 'left' (exchange: false)");
}

TEST(WhyReport, SaysWhoseLimitAndWhoseTimeItIs) {
  HurriedShow made = tests::two_lists();
  planner::Move move = move_of(made, 0);
  move.film_sets_time = true;
  move.whose_limit = planner::Move::SpeedLimit::own;
  EXPECT_THAT(
      limits_of(made.show, made.plan, move)[0].text,
      HasSubstr("in the 4 counts that the film's pace leaves: 1.00 m/s of 1.4 m/s (the performer's own limit)"));
  move.free_place = planner::Move::FreePlace{made.show.stage.grid.index({9, 0}), 9};
  const auto limits = limits_of(made.show, made.plan, move);
  EXPECT_EQ(limits[0].kind, "drawing");
  EXPECT_EQ(limits[0].text, "the nearest free place of the drawing, J1, is 9.0 m away: 12.9 counts at 1.4 m/s");
}

TEST(WhyReport, APairThatTouchesUsesAllOfItsLimit) {
  HurriedShow made = tests::two_lists();
  planner::Move move = move_of(made, 0);
  move.nearest->distance_m = 0;
  move.tolerated_lag_s = 0;
  move.lag_limited_by = PerformerIndex(1);
  WhyAnswer answer = answer_of(made, 0);
  answer.moves = {move};
  EXPECT_THAT(why_text(made.show, made.plan, answer), HasSubstr("\nlag         all  performer 2 comes too close when"));
  const auto json = nlohmann::json::parse(why_json(made.show, made.plan, answer));
  EXPECT_EQ(json["limits"][0]["kind"], "lag");
  EXPECT_TRUE(json["limits"][0]["used"].is_null());
}

TEST(WhyReport, TellsTheMoveAndWhatOneMoreCountGives) {
  const HurriedShow made = tests::two_lists();
  EXPECT_EQ(why_text(made.show, made.plan, answer_of(made, 0)),
            "performer 1 into there/1, count 5 to 9: walks from A1 to C1\n"
            "\n"
            "limit      used\n"
            "pace       71 %  2.0 m in the 4 counts that lie between the two formations: 1.00 m/s of 1.4 m/s (the "
            "stage's limit)\n"
            "neighbour  50 %  performer 2 comes as near as 1.000 m at count 7 (at least 0.5 m)\n"
            "lag        10 %  nobody comes too close when people are up to 2 s late (0.2 s asked)\n"
            "pin           -  C1 is given by the show's list of cells: nobody else can take it\n"
            "\n"
            "the walks of all 3 performers into there/1:\n"
            "                goes to  walks     speed  all walk   fastest  too fast  clearance     lag  places\n"
            "as planned           C1  2.0 m  1.00 m/s       2 m  1.00 m/s         0    1.000 m  2.00 s  3 of 3\n"
            "solved again         C1  2.0 m  1.00 m/s       2 m  1.00 m/s         0    1.000 m  2.00 s  3 of 3\n"
            "one more count       C1  2.0 m  0.80 m/s       2 m  0.80 m/s         0    1.000 m  2.00 s  3 of 3\n");
}

TEST(WhyReport, TellsTheSameToPrograms) {
  const HurriedShow made = tests::two_lists();
  const auto json = nlohmann::json::parse(why_json(made.show, made.plan, answer_of(made, 0)));
  EXPECT_EQ(json["performer"], "1");
  EXPECT_EQ(json["formation"], "there/1");
  EXPECT_EQ(json["start_count"], 5);
  EXPECT_EQ(json["nearest"]["performer"], "2");
  EXPECT_EQ(json["one_more_count"]["places"], 3);
  EXPECT_EQ(json["one_more_count"]["planned"]["speed_m_s"], 1.0);
  EXPECT_EQ(json["one_more_count"]["one_more"]["to"], "C1");
  EXPECT_EQ(json["moves"].size(), 1U);
}

TEST(WhyReport, AMoveIsToldInFullWhenItIsTheTightest) {
  const HurriedShow made = tests::jumping_film();
  const auto last = FormationIndex::of(made.plan.formations.size() - 1);
  const auto moves =
      planner::explain_moves(made.show, made.plan, made.film, PerformerIndex(0), FormationIndex(1), last);
  const std::size_t told = tightest(made.show, made.plan, moves);
  for (const planner::Move& move : moves) {
    EXPECT_LE(limits_of(made.show, made.plan, move).front().used.value(),
              limits_of(made.show, made.plan, moves[told]).front().used.value());
  }
}

}  // namespace
}  // namespace footlight::app
