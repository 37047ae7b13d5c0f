// SPDX-License-Identifier: Apache-2.0
#include "planner/by_hand.hpp"

#include <algorithm>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planner/manual_work.hpp"
#include "planner/plan_show.hpp"
#include "planner/validate.hpp"
#include "tests/planner/small_show.hpp"

namespace footlight::planner {
namespace {

/// A disc that wanders over the floor for 60 counts.
Show wandering_show(int people = 60) {
  Show show = test::show_with(people);
  show.sections.push_back(test::section_of("wander", test::video(), 1, 60, 0, 31));
  return show;
}
Film wandering_film() {
  return tests::film_of(41, [](int f) { return tests::disc(80, 60, 20 + f, 30, 14); });
}

SectionKey at_count(double count) { return {count, 0, {"show.yaml", 33, 14}}; }
SectionKey at_film(double film_s) { return {std::nullopt, film_s, {"show.yaml", 33, 24}}; }

std::vector<CellIndex> sorted(std::vector<CellIndex> cells) {
  std::sort(cells.begin(), cells.end());
  return cells;
}

const Formation* formation_at(const Plan& plan, double count) {
  for (const Formation& formation : plan.formations) {
    if (std::abs(formation.count - count) < 1e-6) return &formation;
  }
  return nullptr;
}

TEST(Keys, AreExactFormationsAndOthersAreNot) {
  for (const PlannerModel model : {PlannerModel::flat, PlannerModel::hierarchical, PlannerModel::joint}) {
    Show show = wandering_show();
    show.sections[0].planner.model = model;
    show.sections[0].keys = {at_count(31), at_film(0.4)};
    Film film = wandering_film();
    film.fps = 25;
    const auto planned = plan_show(show, {film});
    ASSERT_TRUE(planned) << planned.error().message;
    EXPECT_TRUE(planned->plan.valid) << testing::PrintToString(planned->refusal);
    const Formation* by_count = formation_at(planned->plan, 31);
    const Formation* by_film = formation_at(planned->plan, 16);
    ASSERT_NE(by_count, nullptr);
    ASSERT_NE(by_film, nullptr);
    EXPECT_EQ(by_count->frame, 20);
    EXPECT_EQ(by_film->frame, 10);
    std::vector<std::string> keys;
    for (const Formation& formation : planned->plan.formations) {
      if (formation.key) keys.push_back(formation.id);
    }
    EXPECT_EQ(keys.size(), 3U) << testing::PrintToString(keys);
    EXPECT_EQ(planned->plan.formations.front().key, true);
    EXPECT_EQ(planned->plan.formations.back().key, false);
    EXPECT_EQ(planned->plan.formations.size() == 4, model == PlannerModel::flat);
    // Exact: the drawing of its own frame, as an image of it alone would be.
    Show alone = wandering_show();
    alone.sections[0].keys = {at_count(31)};
    alone.sections[0].planner.model = PlannerModel::hierarchical;
    const auto other = plan_show(alone, {film});
    EXPECT_EQ(sorted(by_count->cells), sorted(formation_at(other->plan, 31)->cells));
  }
}

TEST(Keys, AreReachedThoughThePicturesBetweenLeadElsewhere) {
  // A picture that jumps away and back: whoever followed it could not be in time for the key.
  Show show = test::show_with(20, GridKind::square, 60, 12);
  show.sections.push_back(test::section_of("jump", test::video(), 1, 24, 0, 31));
  show.sections[0].sampling.interval = milliseconds(2000);
  const Film film = tests::film_of(25, [](int f) { return tests::disc(240, 48, f > 4 && f < 16 ? 200 : 30, 24, 10); });
  const auto free = plan_show(show, {film});
  ASSERT_TRUE(free);
  show.sections[0].keys = {at_count(18)};
  const auto planned = plan_show(show, {film});
  ASSERT_TRUE(planned) << planned.error().message;
  EXPECT_TRUE(planned->plan.valid) << testing::PrintToString(planned->refusal);
  const Formation* key = formation_at(planned->plan, 18);
  ASSERT_NE(key, nullptr);
  EXPECT_EQ(key->in_picture, 20);
}

TEST(Keys, ThatCannotBeReachedAreRefusedByName) {
  Show show = test::show_with(20, GridKind::square, 60, 12);
  show.sections.push_back(test::section_of("jump", test::video(), 1, 24, 0, 31));
  const Film film = tests::film_of(25, [](int f) { return tests::disc(240, 48, f > 4 && f < 16 ? 200 : 30, 24, 10); });
  show.sections[0].keys = {at_count(12), at_count(18)};
  const auto planned = plan_show(show, {film});
  ASSERT_TRUE(planned) << planned.error().message;
  EXPECT_FALSE(planned->plan.valid);
  ASSERT_EQ(planned->refusal.size(), 1U);
  EXPECT_THAT(planned->refusal[0], testing::StartsWith("show.yaml:31:5: error: sections[0]: the key formation jump/"));
  EXPECT_THAT(planned->refusal[0], testing::HasSubstr(" cannot be reached in time: performer "));
  EXPECT_THAT(planned->refusal[0], testing::HasSubstr("another key, a longer section, or less changed by hand)"));
}

TEST(Keys, OutsideOfTheVideoAreAnInputError) {
  Show show = wandering_show();
  Film film = wandering_film();
  film.fps = 25;
  show.sections[0].keys = {at_film(1.64)};
  const auto late = plan_show(show, {film});
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error(), input_error("show.yaml:33:24: error: sections[0].keys: 1.64 s is outside of the frames that "
                                      "are shown (they are 0 s to 1.6 s of its file)"));
  show.sections[0].keys = {at_count(61.5)};
  const auto beyond = plan_show(show, {film});
  ASSERT_FALSE(beyond);
  EXPECT_EQ(beyond.error(), input_error("show.yaml:33:14: error: sections[0].keys: count 61.5 is outside of the video "
                                        "(it runs from count 1 to count 61)"));
}

class Overrides : public testing::Test {
 protected:
  Overrides() : film_(wandering_film()), show_(wandering_show()) {
    show_.stage.reserve = test::cells_in(show_.stage.grid, "A1:A20");
    show_.performers = test::show_with(66).performers;
    show_.sections[0].from = ImageSource{"disc.png", {}};
    show_.sections[0].duration_counts = 0;
    film_->frames.resize(1);
    film_->frames[0] = tests::disc(80, 60, 40, 30, 12);
    // A scale at which the picture has room for about fifty people.
    std::get<ImageSource>(show_.sections[0].from).picture.fit = Fit::contain;
    asked_.count = 1;
    asked_.position = {"show.yaml", 34, 9};
  }
  [[nodiscard]] CellIndex cell(const char* name) const { return show_.stage.grid.index(*parse_cell(name)); }
  static Position at(int column) { return {"show.yaml", 34, column}; }
  Planned planned() {
    show_.sections[0].overrides = {asked_};
    auto result = plan_show(show_, {film_});
    EXPECT_TRUE(result) << (result ? "" : result.error().message);
    return result ? *result : Planned();
  }
  std::string error() {
    show_.sections[0].overrides = {asked_};
    const auto result = plan_show(show_, {film_});
    EXPECT_FALSE(result);
    return result ? "" : result.error().message;
  }
  std::vector<CellIndex> before() {
    show_.sections[0].overrides.clear();
    return sorted(plan_show(show_, {film_})->plan.formations.at(0).cells);
  }
  /// Cells that are free and cells in the picture, in order.
  void look() {
    cells_ = before();
    for (int i = 0; i < show_.stage.grid.size(); ++i) {
      const CellIndex one = CellIndex::of(i);
      if (std::binary_search(show_.stage.reserve.begin(), show_.stage.reserve.end(), one)) continue;
      (std::binary_search(cells_.begin(), cells_.end(), one) ? taken_ : free_).push_back(one);
    }
    ASSERT_GT(taken_.size(), 10U);
    ASSERT_LT(taken_.size(), 66U);
  }

  std::optional<Film> film_;
  Show show_;
  Override asked_;
  std::vector<CellIndex> cells_;
  std::vector<CellIndex> taken_;
  std::vector<CellIndex> free_;
};

TEST_F(Overrides, MoveTakesSomebodyElsewhereAndNobodyElse) {
  look();
  // A row moves up by one: cells that are left are taken in the same moment.
  asked_.move = {{taken_[0], taken_[1], at(1)}, {taken_[1], free_[0], at(2)}};
  const Planned result = planned();
  std::vector<CellIndex> expected = cells_;
  std::replace(expected.begin(), expected.end(), taken_[0], free_[0]);
  EXPECT_EQ(sorted(result.plan.formations.at(0).cells), sorted(expected));
  EXPECT_EQ(result.plan.formations[0].moved, 2);
  EXPECT_TRUE(result.plan.formations[0].key);
  const ManualWork work = manual_work(result.plan);
  EXPECT_DOUBLE_EQ(work.formations_share(), 2.0 / 66);
  EXPECT_EQ(work.transitions_share(), 0);
}

TEST_F(Overrides, AddAndRemoveExchangeWithTheReserve) {
  look();
  const int in_picture = [&] {
    show_.sections[0].overrides.clear();
    return plan_show(show_, {film_})->plan.formations.at(0).in_picture;
  }();
  asked_.remove = {{taken_[3], at(1)}, {taken_[4], at(2)}, {taken_[5], at(3)}};
  asked_.add = {{free_[0], at(4)}};
  const Planned result = planned();
  const std::vector<CellIndex> cells = sorted(result.plan.formations.at(0).cells);
  for (const CellIndex gone : {taken_[3], taken_[4], taken_[5]}) {
    EXPECT_FALSE(std::binary_search(cells.begin(), cells.end(), gone));
  }
  EXPECT_TRUE(std::binary_search(cells.begin(), cells.end(), free_[0]));
  EXPECT_EQ(result.plan.formations[0].moved, 3);
  EXPECT_EQ(result.plan.formations[0].in_picture, in_picture - 2);
  EXPECT_TRUE(result.plan.valid);
}

TEST_F(Overrides, WhatCannotBeDoneIsAnErrorAtItsPlace) {
  look();
  const auto name = [&](CellIndex one) { return show_.stage.grid.name(one); };
  const std::string head = "show.yaml:34:7: error: sections[0].overrides[0]: ";
  const Override plain = asked_;
  asked_.move = {{free_[0], free_[1], at(7)}};
  EXPECT_EQ(error(), head + "nobody stands on " + name(free_[0]) +
                         " at count 1 (footlight export --csv lists who stands where)");
  asked_ = plain;
  asked_.move = {{taken_[0], taken_[1], at(7)}};
  EXPECT_EQ(error(), head + "the cell " + name(taken_[1]) + " is taken at count 1 (move or remove who is there)");
  asked_ = plain;
  asked_.remove = {{cell("A1"), at(7)}};
  EXPECT_EQ(error(), head + "A1 is in the reserve (who is removed goes there)");
  asked_ = plain;
  asked_.add = {{cell("A1"), at(7)}};
  EXPECT_EQ(error(), head + "A1 is in the reserve (add cells of the picture)");
  asked_ = plain;
  asked_.pin = {{PerformerIndex(4), free_[0], at(7)}};
  EXPECT_EQ(error(), head + "nobody stands on " + name(free_[0]) +
                         " at count 1, so that 5 cannot (move somebody there in the same override)");
  asked_ = plain;
  asked_.pin = {{PerformerIndex(4), taken_[0], at(1)}, {PerformerIndex(4), taken_[1], at(7)}};
  EXPECT_EQ(error(), head + "performer 5 is pinned to " + name(taken_[0]) + " at count 1 already (once will do)");
  asked_.pin = {{PerformerIndex(4), taken_[0], at(1)}, {PerformerIndex(5), taken_[0], at(7)}};
  EXPECT_EQ(error(),
            head + "performer 5 is pinned to " + name(taken_[0]) + " at count 1 already (a cell holds one person)");
}

TEST_F(Overrides, TheReserveIsNeitherEmptiedNorOverfilled) {
  look();
  const std::string head = "show.yaml:34:7: error: sections[0].overrides[0]: ";
  for (std::size_t n = 0; n <= 66 - taken_.size(); ++n) asked_.add.push_back({free_[n], at(7)});
  EXPECT_EQ(error(), head + "nobody waits in the reserve at count 1 to take " +
                         show_.stage.grid.name(asked_.add.back().cell) + " (remove somebody in the same override)");
  asked_.add.clear();
  const std::size_t room = 20 - (66 - taken_.size());
  for (std::size_t n = 0; n <= room; ++n) asked_.remove.push_back({taken_[n], at(7)});
  EXPECT_EQ(error(), head + "the reserve has no cell left for who leaves " +
                         show_.stage.grid.name(asked_.remove.back().cell) +
                         " at count 1 (add as many cells as are removed, or make the reserve larger)");
}

TEST_F(Overrides, AFormationThatIsNotThereIsNamedWithTheNearestOnes) {
  asked_.count = 3;
  EXPECT_EQ(error(),
            "show.yaml:34:9: error: sections[0].overrides[0]: the section has no formation at count 3 (the "
            "nearest is at count 1)");
  asked_.count = std::nullopt;
  asked_.number = 2;
  EXPECT_EQ(error(), "show.yaml:34:9: error: sections[0].overrides[0]: the section has 1 formations (1 to 1)");
  show_.sections[0] = test::section_of("wander", test::video(), 1, 60, 0, 31);
  film_ = wandering_film();
  asked_.count = 2;
  const std::string text = error();
  EXPECT_THAT(text, testing::StartsWith("show.yaml:34:9: error: sections[0].overrides[0]: the section has no formation "
                                        "at count 2 (the nearest is at count 1, then count "));
  EXPECT_THAT(text, testing::EndsWith("; keys: [count 2] makes one)"));
}

TEST_F(Overrides, AreExactUnderEveryModel) {
  for (const PlannerModel model : {PlannerModel::flat, PlannerModel::hierarchical, PlannerModel::joint}) {
    Show show = wandering_show();
    const Film film = wandering_film();
    show.sections[0].planner.model = model;
    show.sections[0].sampling.interval = milliseconds(4000);
    const auto before_hand = plan_show(show, {film});
    ASSERT_TRUE(before_hand);
    const Formation formation = before_hand->plan.formations.at(2);
    const std::vector<CellIndex> drawn = sorted(formation.cells);
    CellIndex free;
    while (std::binary_search(drawn.begin(), drawn.end(), free)) free = CellIndex(free.value() + 1);
    // Near the picture, so that it can be walked.
    for (const CellIndex near : show.stage.grid.within(show.stage.grid.centre(drawn[0]), 1.5)) {
      if (!std::binary_search(drawn.begin(), drawn.end(), near)) free = near;
    }
    Override asked;
    asked.number = 3;
    asked.move = {{drawn[0], free, at(7)}};
    show.sections[0].overrides = {asked};
    const auto result = plan_show(show, {film});
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_TRUE(result->plan.valid) << testing::PrintToString(result->refusal);
    const std::vector<CellIndex> after = sorted(result->plan.formations.at(2).cells);
    EXPECT_TRUE(std::binary_search(after.begin(), after.end(), free));
    EXPECT_FALSE(std::binary_search(after.begin(), after.end(), drawn[0]));
  }
}

TEST(ByHand, WhoIsPinnedFartherAwayThanSheCanWalkIsToldOf) {
  Show show = test::three_sections();
  show.sections[1].planner.model = PlannerModel::hierarchical;
  const auto before = plan_show(show, test::three_films());
  ASSERT_TRUE(before);
  const auto& formations = before->plan.formations;
  const auto second =
      std::find_if(formations.begin(), formations.end(), [](const Formation& one) { return one.id == "film/2"; });
  ASSERT_NE(second, formations.end());
  // At one end of the picture, and three seconds later at the other.
  const auto first = second - 1;
  const auto more_left = [&](CellIndex a, CellIndex b) {
    return show.stage.grid.centre(a).x < show.stage.grid.centre(b).x;
  };
  const PerformerIndex who(6);
  Override early;
  early.count = first->count;
  early.pin = {{who, *std::min_element(first->cells.begin(), first->cells.end(), more_left), {}}};
  Override hand;
  hand.count = second->count;
  const CellIndex right = *std::max_element(second->cells.begin(), second->cells.end(), more_left);
  hand.pin = {{who, right, {}}};
  show.sections[1].overrides = {early, hand};
  const auto planned = plan_show(show, test::three_films());
  ASSERT_TRUE(planned) << planned.error().message;
  ASSERT_TRUE(planned->plan.valid);
  const Formation& late = planned->plan.formations[static_cast<std::size_t>(second - formations.begin())];
  const Grid& grid = show.stage.grid;
  const CellIndex there = late.cells[who.at()];
  ASSERT_NE(there, right);
  const std::string note = "performer " + show.performers[who.at()].id + " is pinned to " + grid.name(right) +
                           " at count " + std::to_string(static_cast<int>(late.count)) + " and has come as far as " +
                           grid.name(there) + " by then, since nobody walks faster than 1.4 m/s";
  EXPECT_EQ(std::count(planned->plan.sections[1].notes.begin(), planned->plan.sections[1].notes.end(), note), 1)
      << testing::PrintToString(planned->plan.sections[1].notes);
}

}  // namespace
}  // namespace footlight::planner
