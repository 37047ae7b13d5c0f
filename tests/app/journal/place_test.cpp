// SPDX-License-Identifier: Apache-2.0
#include "app/journal/place.hpp"

#include <gtest/gtest.h>

namespace footlight::app {
namespace {

std::vector<controller::CuePlay> two_cues() {
  std::vector<controller::CuePlay> plays(2);
  plays[0].cue.number = *CueNumber::parse("1");
  plays[0].from = kStart;
  plays[0].to = instant_at(4);
  plays[1].cue.number = *CueNumber::parse("2");
  plays[1].from = instant_at(4);
  plays[1].to = instant_at(12);
  return plays;
}

/// Cue 2 was at 6 s when the machine's clock said 100 s; seen 102 s.
Place running() {
  Place place;
  place.where.position = instant_at(6);
  place.where.cue = 1;
  place.where.waits = false;
  place.where.runs_since = instant_at(100);
  place.at = seconds(102);
  return place;
}

TEST(Place, AShowThatStoodStandsHoweverLongAgo) {
  Place place;
  place.where.position = instant_at(4);
  place.at = seconds(100);
  for (const double later_s : {0.1, 3600.0}) {
    const TakeUp up = take_up(place, seconds(100 + later_s), AfterDeath::go_on, two_cues());
    EXPECT_EQ(up.show.where.position, instant_at(4));
    EXPECT_FALSE(up.show.where.runs_since);
    EXPECT_FALSE(up.show.where.cue);
  }
  EXPECT_EQ(take_up(place, seconds(100.5), AfterDeath::go_on, two_cues()).told,
            "cut off 0.50 s ago, while the show stood at 4.000 s: it stands there");
}

TEST(Place, WhileTheMarkersStillGuideARunningShowGoesOnInTime) {
  const TakeUp up = take_up(running(), seconds(104.5), AfterDeath::go_on, two_cues());
  EXPECT_EQ(up.show.where.position, instant_at(6));
  EXPECT_EQ(up.show.where.runs_since, instant_at(100)) << "as if nothing had happened";
  EXPECT_EQ(up.told, "cut off 2.50 s ago, in the middle of a cue: the show goes on in time");
}

TEST(Place, LaterItStandsWhereItWasSeenLast) {
  const TakeUp up = take_up(running(), seconds(104.501), AfterDeath::go_on, two_cues());
  EXPECT_EQ(up.show.where.position, instant_at(8)) << "two seconds later than at 100 s";
  EXPECT_FALSE(up.show.where.runs_since);
  EXPECT_FALSE(up.show.where.waits);
  EXPECT_EQ(up.show.where.cue, 1U);
  EXPECT_EQ(up.told,
            "cut off 2.50 s ago, in the middle of a cue: it stands at 8.000 s, in cue 2, for the markers have lost "
            "guidance since; see where people are before GO");
}

TEST(Place, TheTempoCountsAndNobodyIsTakenBeyondTheCue) {
  Place place = running();
  place.where.percent = 50;
  EXPECT_EQ(take_up(place, seconds(200), AfterDeath::go_on, two_cues()).show.where.position, instant_at(7));
  place.at = seconds(150);
  EXPECT_EQ(take_up(place, seconds(200), AfterDeath::go_on, two_cues()).show.where.position, instant_at(12));
}

TEST(Place, WhoWantsItStandsAtOnce) {
  const TakeUp up = take_up(running(), seconds(102.1), AfterDeath::stand, two_cues());
  EXPECT_EQ(up.show.where.position, instant_at(8));
  EXPECT_FALSE(up.show.where.runs_since);
  EXPECT_EQ(
      up.told,
      "cut off 0.10 s ago, in the middle of a cue: it stands at 8.000 s, in cue 2; see where people are before GO");
}

TEST(Place, ACueThatHadNotBegunIsStandbyAgain) {
  Place place;
  place.where.position = instant_at(4);
  place.where.cue = 1;
  place.where.runs_since = instant_at(103);  // after its count-in
  place.at = seconds(101);
  const TakeUp stands = take_up(place, seconds(110), AfterDeath::go_on, two_cues());
  EXPECT_FALSE(stands.show.where.cue);
  EXPECT_EQ(stands.show.where.position, instant_at(4));
  EXPECT_TRUE(take_up(place, seconds(102), AfterDeath::go_on, two_cues()).show.where.runs_since)
      << "it goes on counting in";
}

TEST(Place, WhatTheOperatorHasSaidOfTheSourceOfTimeStaysSaid) {
  for (const controller::Chase::Word word : {controller::Chase::Word{true, true}, {true, false}, {false, true}}) {
    Place stood;
    stood.where.position = instant_at(4);
    stood.time = word;
    EXPECT_EQ(take_up(stood, seconds(10), AfterDeath::go_on, two_cues()).show.time, word);
    Place ran = running();
    ran.time = word;
    EXPECT_EQ(take_up(ran, seconds(103), AfterDeath::go_on, two_cues()).show.time, word) << "it goes on in time";
  }
}

TEST(Place, WhereSomebodyHasToSeeWherePeopleAreTheSourceOfTimeBeginsNothing) {
  EXPECT_FALSE(take_up(running(), seconds(200), AfterDeath::go_on, two_cues()).show.time.armed) << "too late";
  EXPECT_FALSE(take_up(running(), seconds(102.1), AfterDeath::stand, two_cues()).show.time.armed);
  Place counted_in = running();
  counted_in.where.waits = true;
  counted_in.where.runs_since = instant_at(103);
  EXPECT_FALSE(take_up(counted_in, seconds(110), AfterDeath::go_on, two_cues()).show.time.armed);
  Place in_reset;
  in_reset.in_reset = true;
  EXPECT_FALSE(take_up(in_reset, seconds(0.1), AfterDeath::go_on, two_cues()).show.time.armed);
  EXPECT_TRUE(take_up(in_reset, seconds(0.1), AfterDeath::go_on, two_cues()).show.time.on);
}

TEST(Place, HasWhatTheDeskKnowsBesideTheShow) {
  DeskView view;
  view.show.time.armed = false;
  view.show.time.on = false;
  view.emergency_hold = true;
  view.readiness.outlives = "armed";
  const Place place = place_of(view, {});
  EXPECT_EQ(place.time, (controller::Chase::Word{false, false}));
  EXPECT_TRUE(place.emergency_hold);
  EXPECT_EQ(place.readiness, "armed");
}

TEST(Place, OfAResetMoveTheEndIsLitAndSaid) {
  Place place;
  place.where.position = instant_at(4);
  place.in_reset = true;
  place.at = seconds(100);
  EXPECT_EQ(take_up(place, seconds(101), AfterDeath::go_on, two_cues()).told,
            "cut off in a reset move, 1.00 s ago: its end is lit, at 4.000 s; see that people are there before GO");
}

TEST(Place, AnotherClockSeesTheSameInstant) {
  const TakenUp up = by_clock({running().where, {true, false}}, instant_at(1), seconds(103));
  EXPECT_EQ(up.where.runs_since, instant_at(-2));
  EXPECT_EQ(up.where.position, instant_at(6));
  EXPECT_FALSE(up.time.armed);
}

}  // namespace
}  // namespace footlight::app
