// SPDX-License-Identifier: Apache-2.0
#include "planner/stand_in.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"
#include "planner/plan_show.hpp"
#include "planner/validate.hpp"
#include "tests/planner/small_show.hpp"

namespace footlight::planner {
namespace {

using Films = std::vector<std::optional<Film>>;
using ::testing::HasSubstr;

/// Some 20 people in the pictures, the others in the wings of 32 cells.
Show two_sections(int people) {
  Show show = test::show_with(people, GridKind::square, 24, 16);
  show.stage.reserve = test::cells_in(show.stage.grid, "A1:B16");
  Section first = test::section_of("first", ImageSource{"a.png", {}}, 1, 0, 4, 11);
  Section film = test::section_of("film", test::video(), 45, 40, 0, 12);
  film.sampling.interval = milliseconds(3000);
  std::get<ImageSource>(first.from).picture.fit = Fit::contain;
  std::get<VideoSource>(film.from).picture.fit = Fit::contain;
  show.sections = {first, film};
  return show;
}
Films two_films() {
  const Mask start = tests::disc(80, 60, 30, 30, 8);
  return {tests::film_of(1, [&](int) { return start; }),
          tests::film_of(30, [](int f) { return tests::disc(80, 60, 25 + f, 30, f < 15 ? 9 : 7); })};
}

/// Somebody who is in the reserve in every formation, and somebody who never is.
std::optional<std::size_t> who(const Show& show, const Plan& plan, bool waits) {
  for (std::size_t p = 0; p < plan.tracks.size(); ++p) {
    const auto in_reserve = [&](const Mark& mark) {
      return std::binary_search(show.stage.reserve.begin(), show.stage.reserve.end(), mark.cell);
    };
    const auto& track = plan.tracks[p];
    if (waits ? std::all_of(track.begin(), track.end(), in_reserve)
              : std::none_of(track.begin(), track.end(), in_reserve)) {
      return p;
    }
  }
  return std::nullopt;
}

std::optional<std::size_t> place_of(const Plan& plan, const std::string& id) {
  const auto at = std::find(plan.performers.begin(), plan.performers.end(), id);
  if (at == plan.performers.end()) return std::nullopt;
  return static_cast<std::size_t>(at - plan.performers.begin());
}

/// People of a plan whose tracks are not those of the other one.
std::vector<std::string> changed(const Plan& before, const Plan& after) {
  std::vector<std::string> out;
  for (std::size_t p = 0; p < before.performers.size(); ++p) {
    const auto now = place_of(after, before.performers[p]);
    if (now && after.tracks[*now] != before.tracks[p]) out.push_back(before.performers[p]);
  }
  return out;
}

TEST(StandIns, SomebodyOfTheReserveWalksTheWayAndNobodyElseChanges) {
  Show show = two_sections(36);
  const auto all = plan_show(show, two_films());
  ASSERT_TRUE(all) << all.error().message;
  ASSERT_TRUE(all->plan.valid);
  const auto absent = who(show, all->plan, false);
  const auto waits = who(show, all->plan, true);
  ASSERT_TRUE(absent && waits);
  show.performers[*absent].absent = true;
  const auto without = plan_show(show, two_films());
  ASSERT_TRUE(without) << without.error().message;
  EXPECT_TRUE(without->plan.valid);
  EXPECT_TRUE(validate(without->plan).valid());
  EXPECT_EQ(without->plan.performers.size(), 35U);
  EXPECT_FALSE(place_of(without->plan, show.performers[*absent].id));
  const std::string taker = show.performers[*waits].id;
  EXPECT_EQ(changed(all->plan, without->plan), (std::vector<std::string>{taker}));
  EXPECT_EQ(without->plan.tracks[*place_of(without->plan, taker)], all->plan.tracks[*absent]);
  EXPECT_EQ(without->plan.sections[0].notes.size(), all->plan.sections[0].notes.size() + 1);
  EXPECT_THAT(without->plan.sections[0].notes,
              testing::Contains("performer " + show.performers[*absent].id + " is absent: performer " + taker +
                                " takes the way; 1 of 36 people changes, " +
                                std::to_string(all->plan.tracks[*absent].size()) + " marks"));
  // The pictures are as full as before.
  for (std::size_t k = 0; k < all->plan.formations.size(); ++k) {
    EXPECT_EQ(without->plan.formations[k].in_picture, all->plan.formations[k].in_picture);
    EXPECT_EQ(without->plan.formations[k].cells.size(), 35U);
  }
}

TEST(StandIns, AnUnderstudyTakesTheWholeWayAndNobodyElseChanges) {
  Show show = two_sections(36);
  const auto all = plan_show(show, two_films());
  ASSERT_TRUE(all && all->plan.valid);
  const auto absent = who(show, all->plan, false);
  ASSERT_TRUE(absent);
  show.understudies = {{"zoe", "Zoe", {}, 0.1, 9}};
  show.performers[*absent].absent = true;
  show.performers[*absent].cover = "zoe";
  const auto covered = plan_show(show, two_films());
  ASSERT_TRUE(covered && covered->plan.valid);
  Plan expected = all->plan;
  expected.performers[*absent] = "zoe";
  expected.radius_m[*absent] = 0.1;
  expected.max_speed_mps[*absent] = 9;
  expected.sections[0].notes.push_back("performer " + show.performers[*absent].id +
                                       " is absent: zoe covers the whole way; nobody else changes");
  EXPECT_EQ(covered->plan.tracks, expected.tracks);
  EXPECT_EQ(covered->plan.performers, expected.performers);
  EXPECT_EQ(covered->plan.max_speed_mps, expected.max_speed_mps);
  EXPECT_EQ(covered->plan.formations, expected.formations);
  EXPECT_THAT(covered->plan.sections[0].notes, testing::Contains(expected.sections[0].notes.back()));
  show.understudies[0].max_speed_mps = 0.01;
  const auto slow = plan_show(show, two_films());
  ASSERT_TRUE(slow);
  EXPECT_FALSE(slow->plan.valid) << "she cannot walk it";
  EXPECT_THAT(slow->refusal, testing::Contains(HasSubstr("zoe")));
}

TEST(StandIns, NobodyStandsInForWhoNeverLeavesTheReserve) {
  Show show = two_sections(36);
  const auto all = plan_show(show, two_films());
  ASSERT_TRUE(all);
  const auto waits = who(show, all->plan, true);
  ASSERT_TRUE(waits);
  show.performers[*waits].absent = true;
  const auto without = plan_show(show, two_films());
  ASSERT_TRUE(without);
  EXPECT_TRUE(without->plan.valid);
  EXPECT_EQ(changed(all->plan, without->plan), std::vector<std::string>{});
  EXPECT_THAT(without->plan.sections[0].notes,
              testing::Contains("performer " + show.performers[*waits].id +
                                " is absent: nobody has to stand in, since the way never leaves the reserve"));
}

TEST(StandIns, WithoutAReserveThePlaceStaysEmpty) {
  Show show = two_sections(40);
  show.stage.reserve.clear();
  std::get<ImageSource>(show.sections[0].from).picture.fit = Fit::area;
  std::get<VideoSource>(show.sections[1].from).picture.fit = Fit::area;
  const auto all = plan_show(show, two_films());
  ASSERT_TRUE(all) << all.error().message;
  show.performers[4].absent = true;
  const auto without = plan_show(show, two_films());
  ASSERT_TRUE(without);
  EXPECT_TRUE(without->plan.valid);
  EXPECT_EQ(changed(all->plan, without->plan), std::vector<std::string>{});
  EXPECT_EQ(without->plan.formations[0].in_picture, all->plan.formations[0].in_picture - 1);
  EXPECT_THAT(without->plan.sections[0].notes,
              testing::Contains(HasSubstr("performer 5 is absent: the place stays empty, since nobody who is")));
}

TEST(StandIns, NoMoreTracksChangeThanPeopleAreAbsentAndReplanningAgreesWithPlanningAfresh) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    Show show = two_sections(20 + static_cast<int>(rng.below(16)));
    if (rng.below(3) == 0) show.performers[3].radius_m = 0.3;
    if (rng.below(3) == 0) show.performers[5].max_speed_mps = 0.7;
    Stages stages;
    const Reuse reuse{&stages, {"a", "film"}};
    const auto all = plan_show(show, two_films(), {}, reuse);
    RC_ASSERT(all.has_value());
    std::size_t absent = 0;
    for (std::size_t n = 1 + rng.below(4); n > 0; --n) {
      bool& away = show.performers[rng.below(show.performers.size())].absent;
      absent += away ? 0 : 1;
      away = true;
    }
    const auto again = plan_show(show, Films(2), {}, reuse);
    const auto afresh = plan_show(show, two_films());
    RC_ASSERT(again.has_value() && afresh.has_value());
    RC_ASSERT(again->plan == afresh->plan);
    RC_ASSERT(again->refusal == afresh->refusal);
    // Who comes changes neither formations nor walks.
    RC_ASSERT(again->formations.anew + again->pairings.anew + again->walks.anew == 0U);
    RC_ASSERT(again->plan.performers.size() == show.performers.size() - absent);
    RC_ASSERT(changed(all->plan, again->plan).size() <= absent);
    RC_ASSERT(again->plan.valid == validate(again->plan).valid());
    RC_ASSERT(again->plan.valid || !all->plan.valid);
  }));
}

/// Four people: 1 is on stage all the time, 2 for half of it, 3 and 4 never.
struct ByHandTracks {
  Show show = test::show_with(4);
  std::vector<std::vector<Mark>> tracks;
  ByHandTracks() {
    show.stage.reserve = test::cells_in(show.stage.grid, "A1:A4");
    const auto cell = [&](const char* name) { return test::cells_in(show.stage.grid, name)[0]; };
    const auto at = [](int s) { return kStart + seconds(s); };
    tracks = {{{at(0), cell("F1:F1")}, {at(10), cell("P1:P1")}, {at(20), cell("F1:F1")}},
              {{at(0), cell("F2:F2")}, {at(5), cell("A2:A2")}, {at(20), cell("A2:A2")}},
              {{at(0), cell("A3:A3")}, {at(20), cell("A3:A3")}},
              {{at(0), cell("A4:A4")}, {at(20), cell("A4:A4")}}};
  }
  void away(std::initializer_list<std::size_t> who) {
    for (const std::size_t p : who) show.performers[p].absent = true;
  }
  [[nodiscard]] std::vector<std::optional<PerformerIndex>> takers(bool wide_enough = true) const {
    std::vector<std::optional<PerformerIndex>> out;
    for (const StandIn& one : stand_ins(show, tracks, wide_enough)) out.push_back(one.taker);
    return out;
  }
};
using Takers = std::vector<std::optional<PerformerIndex>>;

TEST(StandIns, EachTakesOneWayFirstComeFirstServed) {
  ByHandTracks all;
  EXPECT_EQ(all.takers(), Takers{});
  all.away({0, 1});
  EXPECT_EQ(all.takers(), (Takers{PerformerIndex(2), PerformerIndex(3)}));
}

TEST(StandIns, WhoeverIsToldToCoverDoesSoAndNobodyElseTakesHer) {
  ByHandTracks all;
  all.away({0, 1});
  all.show.performers[1].cover = "3";
  EXPECT_EQ(all.takers(), (Takers{PerformerIndex(3), PerformerIndex(2)})) << "3 would have been the first choice for 1";
}

TEST(StandIns, WhoIsTooSlowOrTooWideDoesNotStandIn) {
  ByHandTracks all;
  all.away({0});
  all.show.performers[2].max_speed_mps = 0.9;  // the way is walked at 1 m/s
  EXPECT_EQ(all.takers(), Takers{PerformerIndex(3)});
  all.show.performers[3].radius_m = 0.4;
  EXPECT_EQ(all.takers(), Takers{PerformerIndex(3)});
  EXPECT_EQ(all.takers(false), Takers{PerformerIndex(1)});
  all.show.performers[2].max_speed_mps = 1;
  EXPECT_EQ(all.takers(false), Takers{PerformerIndex(2)});
}

TEST(StandIns, StayInTheirGroupWhereGroupsHavePlacesOfTheirOwn) {
  ByHandTracks all;
  all.away({0});
  all.show.groups = {{"left", {}, true}, {"right", {}, true}};
  all.show.performers[0].group = GroupIndex(0);
  all.show.performers[2].group = GroupIndex(1);
  EXPECT_EQ(all.takers(), Takers{PerformerIndex(2)}) << "groups are colours alone";
  all.show.groups[1].exchange = false;
  EXPECT_EQ(all.takers(), Takers{PerformerIndex(3)}) << "2's group keeps its own places, the absent one's has none";
  all.show.groups[0].exchange = false;
  EXPECT_EQ(all.takers(), Takers{std::nullopt});
  all.show.performers[1].group = GroupIndex(0);
  EXPECT_EQ(all.takers(), Takers{PerformerIndex(1)});
}

TEST(StandIns, WhoGivesUpAPlaceOfHerOwnIsToldOf) {
  ByHandTracks all;
  all.away({0, 2, 3});
  const auto found = stand_ins(all.show, all.tracks, true);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(stand_in_text(all.show, found[0]),
            "performer 1 is absent: performer 2 takes the way; 1 of 4 people changes, 3 marks; the taker's own place, "
            "5.0 s on stage instead of 20.0 s, stays empty");
  EXPECT_FALSE(found[1].taker || found[2].taker);
}

}  // namespace
}  // namespace footlight::planner
