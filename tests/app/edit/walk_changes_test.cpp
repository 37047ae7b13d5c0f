// SPDX-License-Identifier: Apache-2.0
#include "app/edit/walk_changes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/edit/same_place.hpp"
#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

using testing::ElementsAre;

/// Three sections [0, 4], [8, 12], [16, 20] s; a transition between each two mark instants.
Plan plan_of_three() {
  Plan plan = tests::random_show(6, 6, 4, 3, 2, 1).plan;
  plan.performers = {"1", "2", "10", "9"};
  const auto& track = plan.tracks[0];
  plan.transitions.clear();
  for (std::size_t m = 0; m + 1 < track.size(); ++m) {
    TransitionFacts& one = plan.transitions.emplace_back();
    one.start = track[m].time;
    one.end = track[m + 1].time;
  }
  return plan;
}

TEST(WalkChanges, APlanHasNoneAgainstItself) {
  const WalkChanges changes = walk_changes(plan_of_three(), plan_of_three());
  EXPECT_THAT(changes.people, ElementsAre());
  EXPECT_EQ(changes.text(), "0 transitions, 0 people");
}

TEST(WalkChanges, WhoChangesPlacesInOneFormationWalksOtherwiseBeforeAndAfterIt) {
  const Plan before = plan_of_three();
  Plan now = before;
  std::swap(now.tracks[2][4].cell, now.tracks[3][4].cell);
  const WalkChanges changes = walk_changes(before, now);
  EXPECT_THAT(changes.people, ElementsAre("9", "10"));
  EXPECT_EQ(changes.text(), "2 transitions, 2 people");
}

TEST(WalkChanges, AnotherPersonOnAWayChangesNoWalk) {
  const Plan before = plan_of_three();
  Plan now = before;
  now.performers[1] = "zoe";
  const WalkChanges changes = walk_changes(before, now);
  EXPECT_THAT(changes.people, ElementsAre("zoe"));
  EXPECT_THAT(changes.left, ElementsAre("2"));
  EXPECT_EQ(changes.text(), "0 transitions, 1 person");
}

TEST(WalkChanges, EverythingLaterChangesEverybody) {
  const Plan before = plan_of_three();
  Plan now = before;
  for (auto& track : now.tracks) {
    for (Mark& mark : track) mark.time += seconds(1);
  }
  for (TransitionFacts& one : now.transitions) {
    one.start += seconds(1);
    one.end += seconds(1);
  }
  EXPECT_EQ(walk_changes(before, now).people.size(), 4U);
  EXPECT_EQ(walk_changes(before, now).transitions, now.transitions.size());
}

/// The same show with a first section of one second more.
struct Places {
  Plan before = plan_of_three();
  Plan now = before;
  std::vector<controller::CuePlay> plays_before;
  std::vector<controller::CuePlay> plays;
  Places() {
    Show show;
    show.cues = {tests::cue_of("1", 0), tests::cue_of("2", 1), tests::cue_of("3", 2)};
    show.sections.resize(3);
    plays_before = controller::cue_plays(show, before);
    for (std::size_t s = 0; s < 3; ++s) {
      now.sections[s].end += seconds(1);
      if (s > 0) now.sections[s].start += seconds(1);
    }
    for (auto& track : now.tracks) {
      for (std::size_t m = 3; m < track.size(); ++m) track[m].time += seconds(1);
    }
    plays = controller::cue_plays(show, now);
  }
  [[nodiscard]] Instant of(double position_s, int active, int standby) const {
    return same_place(before, plays_before, now, plays, controller::Stands(now), instant_at(position_s), active,
                      standby);
  }
};

TEST(SamePlace, IsTheSameStandbyCueOrAsFarIntoTheSameSection) {
  const Places places;
  ASSERT_EQ(places.plays[0].to, instant_at(5));
  EXPECT_EQ(places.of(0, -1, 0), instant_at(0));
  EXPECT_EQ(places.of(4, -1, 1), instant_at(5)) << "the end of a set that lasts longer now";
  EXPECT_EQ(places.of(10, 1, 2), instant_at(11)) << "held two seconds into the second section";
  EXPECT_EQ(places.of(20, -1, -1), places.plays.back().to) << "the end";
}

TEST(SamePlace, ACueOrSectionThatIsGoneIsReplacedByWhatComesBefore) {
  Places places;
  places.plays.erase(places.plays.begin() + 1);
  EXPECT_EQ(places.of(4, -1, 1), places.plays[0].to);
  places.now.sections.erase(places.now.sections.begin() + 1);
  places.now.sections[1].name = "other";
  EXPECT_EQ(places.of(10, 1, 2), places.plays[0].from);
}

}  // namespace
}  // namespace footlight::app
