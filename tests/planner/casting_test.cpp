// SPDX-License-Identifier: Apache-2.0
//
// Who stands where by name, by group and by region.
#include "planner/casting.hpp"

#include <algorithm>
#include <map>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"
#include "planner/manual_work.hpp"
#include "planner/plan_show.hpp"
#include "planner/validate.hpp"
#include "tests/planner/small_show.hpp"

namespace footlight::planner {
namespace {

std::vector<CellIndex> some_cells(const Grid& grid, std::size_t people, Rng& rng) {
  std::vector<CellIndex> cells;
  for (int i = 0; i < grid.size(); ++i) cells.push_back(CellIndex::of(i));
  for (std::size_t i = 0; i < people; ++i) std::swap(cells[i], cells[i + rng.below(cells.size() - i)]);
  cells.resize(people);
  return cells;
}

/// The first so many people are in the first group, and so on; who is left is in none.
void group_people(Show& show, const std::vector<std::size_t>& sizes) {
  std::size_t next = 0;
  for (std::size_t g = 0; g < sizes.size(); ++g) {
    show.groups.push_back({"g" + std::to_string(g + 1), {}, true});
    for (std::size_t n = 0; n < sizes[g]; ++n) show.performers[next++].group = GroupIndex::of(g);
  }
}

CellsSource list_of(std::vector<CellIndex> cells) { return {"list.csv", std::move(cells), false, {}}; }

/// The same list with a column of groups: people's groups in some order.
CellsSource grouped_list(const Show& show, std::vector<CellIndex> cells, Rng& rng) {
  CellsSource source = list_of(std::move(cells));
  for (const Performer& performer : show.performers) source.groups.push_back(performer.group);
  for (std::size_t i = 0; i + 1 < source.groups.size(); ++i) {
    std::swap(source.groups[i], source.groups[i + rng.below(source.groups.size() - i)]);
  }
  return source;
}

Planned planned_of(const Show& show) {
  auto planned = plan_show(show, std::vector<std::optional<Film>>(show.sections.size()));
  if (!planned) {
    ADD_FAILURE() << planned.error().message;
    return {};
  }
  return std::move(planned).value();
}

/// What a formation of a list asks for and the plan does not keep.
std::vector<std::string> broken(const Show& show, const Plan& plan) {
  std::vector<std::string> out;
  for (const Formation& formation : plan.formations) {
    const Section& section = show.sections[formation.section.at()];
    const auto& list = std::get<CellsSource>(section.from);
    std::map<CellIndex, std::size_t> place;
    for (std::size_t i = 0; i < list.cells.size(); ++i) place[list.cells[i]] = i;
    for (std::size_t p = 0; p < formation.cells.size(); ++p) {
      const auto at = place.find(formation.cells[p]);
      if (at == place.end()) {
        out.push_back(formation.id + ": a cell that is not listed");
      } else if (list.assigned && at->second != p) {
        out.push_back(formation.id + ": somebody else's cell");
      } else if (!list.groups.empty() && list.groups[at->second] != show.performers[p].group) {
        out.push_back(formation.id + ": another group's cell");
      }
    }
    for (const Override& hand : section.overrides) {
      for (const Override::Pin& pin : hand.pin) {
        if (formation.cells[pin.performer.at()] != pin.cell) out.push_back(formation.id + ": not where pinned");
      }
    }
  }
  return out;
}

TEST(Casting, EveryFormationHasThePeopleThatItAsksForWhateverTheOthersAsk) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    const std::size_t people = 1 + rng.below(40);
    Show show = test::show_with(static_cast<int>(people), static_cast<GridKind>(rng.below(3)), 10, 8);
    std::vector<std::size_t> sizes;
    for (std::size_t left = people, g = 0; g < 4 && left > 0; ++g) {
      sizes.push_back(1 + rng.below(left));
      left -= sizes.back();
    }
    group_people(show, sizes);
    for (Group& group : show.groups) group.exchange = rng.below(3) != 0;
    const std::size_t sections = 1 + rng.below(6);
    for (std::size_t s = 0; s < sections; ++s) {
      CellsSource source = list_of(some_cells(show.stage.grid, people, rng));
      const std::uint64_t what = rng.below(5);
      if (what == 0) source = grouped_list(show, source.cells, rng);
      if (what == 1) source.assigned = true;
      Section section =
          test::section_of("list", source, 1 + 200.0 * static_cast<double>(s), 0, 4, 30 + static_cast<int>(s));
      if (what == 2) {
        Override hand;
        hand.number = 1;
        for (std::size_t p = 0; p < people; p += 1 + rng.below(9)) {
          hand.pin.push_back({PerformerIndex::of(p), source.cells[p], {"show.yaml", 40, 1}});
        }
        section.overrides.push_back(hand);
      }
      show.sections.push_back(section);
    }
    const auto planned = plan_show(show, std::vector<std::optional<Film>>(sections));
    RC_ASSERT(planned.has_value());
    const auto wrong = broken(show, planned->plan);
    if (!wrong.empty()) RC_FAIL(wrong.front());
  }));
}

TEST(Casting, TheChangeIsMadeWhereThereIsMostTime) {
  // Names at both ends; four counts, then eighty-four, then four.
  Show show = test::show_with(12, GridKind::square, 30, 8);
  Rng rng(3);
  std::vector<CellIndex> left = test::cells_in(show.stage.grid, "A1:C4");
  std::vector<CellIndex> mirrored(left.rbegin(), left.rend());
  const double starts[] = {1, 9, 97, 105};
  for (int s = 0; s < 4; ++s) {
    CellsSource source = list_of(test::cells_in(show.stage.grid, s < 2 ? "A1:C4" : "AA1:AC4"));
    if (s == 3) std::reverse(source.cells.begin(), source.cells.end());
    source.assigned = s == 0 || s == 3;
    show.sections.push_back(test::section_of("list", source, starts[s], 0, 4, 30 + s));
  }
  const Plan plan = planned_of(show).plan;
  EXPECT_EQ(broken(show, plan), std::vector<std::string>());
  EXPECT_EQ(plan.formations[0].cells, plan.formations[1].cells);
  EXPECT_EQ(plan.formations[2].cells, plan.formations[3].cells);
  EXPECT_TRUE(plan.valid) << "a dense block is turned around on the way";
}

TEST(Casting, BeforeTheFirstAndAfterTheLastNameAnybodyTakesAnyPlace) {
  Show show = test::show_with(20, GridKind::square, 40, 8);
  for (int s = 0; s < 3; ++s) {
    const char* const where[] = {"A1:E4", "K1:O4", "U1:Y4"};
    CellsSource source = list_of(test::cells_in(show.stage.grid, where[s]));
    if (s == 1) std::reverse(source.cells.begin(), source.cells.end());
    source.assigned = s == 1;
    show.sections.push_back(test::section_of("list", source, 1 + 40.0 * s, 0, 4, 30 + s));
  }
  const Plan plan = planned_of(show).plan;
  EXPECT_EQ(broken(show, plan), std::vector<std::string>());
  EXPECT_TRUE(plan.valid);
  for (const TransitionFacts& facts : plan.transitions) EXPECT_NEAR(facts.longest_walk_m, 10, 1e-9);
}

TEST(Casting, AGroupThatDoesNotExchangeKeepsItsWays) {
  // Two groups in stripes move aside by one column: freely everybody would shift, but the stripes are people's own.
  Show show = test::show_with(24, GridKind::square, 20, 8);
  group_people(show, {12, 12});
  Rng rng(1);
  for (int s = 0; s < 2; ++s) {
    CellsSource source = list_of({});
    for (int column = 0; column < 6; ++column) {
      for (int row = 0; row < 4; ++row) {
        source.cells.push_back(show.stage.grid.index({2 * column + s, row}));
        source.groups.push_back(GroupIndex::of(column % 2));
      }
    }
    show.sections.push_back(test::section_of("list", source, 1 + 40.0 * s, 0, 4, 30 + s));
  }
  const Plan plan = planned_of(show).plan;
  EXPECT_EQ(broken(show, plan), std::vector<std::string>());
  EXPECT_TRUE(plan.valid);
  // An image-like list without groups after it: only people of one group may take each other's places there.
  Show alone = show;
  for (Group& group : alone.groups) group.exchange = false;
  alone.sections.push_back(test::section_of("list", list_of(test::cells_in(show.stage.grid, "C3:H6")), 81, 0, 4, 32));
  const Plan after = planned_of(alone).plan;
  EXPECT_EQ(broken(alone, after), std::vector<std::string>());
}

TEST(Casting, PinnedPeopleStandOnTheirCellsAndAreCounted) {
  Show show = test::show_with(12);
  CellsSource source = list_of(test::cells_in(show.stage.grid, "A1:D3"));
  show.sections.push_back(test::section_of("block", source, 1, 0, 4, 31));
  source.cells = test::cells_in(show.stage.grid, "G1:J3");
  show.sections.push_back(test::section_of("aside", source, 33, 0, 4, 32));
  Override hand;
  hand.number = 1;
  hand.pin = {{PerformerIndex(10), *std::optional(show.stage.grid.index({8, 1})), {"show.yaml", 33, 20}}};
  show.sections[1].overrides = {hand};
  const Plan plan = planned_of(show).plan;
  EXPECT_EQ(broken(show, plan), std::vector<std::string>());
  EXPECT_EQ(plan.formations[1].pinned, 1);
  EXPECT_DOUBLE_EQ(manual_work(plan).transitions_share(), 1.0 / 12);
  EXPECT_TRUE(plan.valid);
}

TEST(Casting, WidePeopleKeepTheirDistanceAndTheOthersNeedNot) {
  Show show = test::show_with(30, GridKind::square, 24, 12);
  show.performers[4].radius_m = show.performers[11].radius_m = 0.4;
  show.sections.push_back(test::section_of("block", list_of(test::cells_in(show.stage.grid, "A1:F5")), 1, 0, 4, 31));
  show.sections.push_back(test::section_of("line", list_of(test::cells_in(show.stage.grid, "K4:T6")), 45, 0, 4, 32));
  const Planned planned = planned_of(show);
  EXPECT_TRUE(planned.plan.valid) << testing::PrintToString(planned.refusal);
  EXPECT_TRUE(validate(planned.plan).valid());
  // The two keep 0.8 m, more than walks on squares keep by themselves; some pair of the others does not.
  double least_m = 10;
  for (const TransitionFacts& facts : planned.plan.transitions) least_m = std::min(least_m, facts.clearance_m);
  EXPECT_LT(least_m, 0.8);
}

class Regions : public testing::Test {
 protected:
  Regions() : show_(test::show_with(60, GridKind::square, 30, 20)) {
    group_people(show_, {20, 20});
    show_.stage.reserve = test::cells_in(show_.stage.grid, "A1:B20");
    show_.sections.push_back(test::section_of("film", test::video(), 1, 60, 0, 31));
    add(0, "C1:J20");
    add(1, "U1:AD20");
  }
  void add(int group, const char* range) {
    footlight::Region region;
    region.group = GroupIndex::of(group);
    region.cells = test::cells_in(show_.stage.grid, range);
    std::sort(region.cells.begin(), region.cells.end());
    region.position = {"show.yaml", 35, 9};
    show_.sections[0].regions.push_back(region);
  }
  [[nodiscard]] bool in(int region, CellIndex cell) const {
    const auto& cells = show_.sections[0].regions[static_cast<std::size_t>(region)].cells;
    return std::binary_search(cells.begin(), cells.end(), cell);
  }
  [[nodiscard]] bool waits(CellIndex cell) const {
    return std::binary_search(show_.stage.reserve.begin(), show_.stage.reserve.end(), cell);
  }
  /// A wide bar that grows in height, so that all regions have places.
  static Film film() {
    return tests::film_of(31, [](int f) {
      return tests::mask_where(150, 100,
                               [f](int x, int y) { return x > 12 && x < 148 && std::abs(y - 50) < 5 + f / 4; });
    });
  }
  Show show_;
};

TEST_F(Regions, EachGroupStandsInItsPartOfThePicture) {
  for (const PlannerModel model : {PlannerModel::flat, PlannerModel::hierarchical, PlannerModel::joint}) {
    show_.sections[0].planner.model = model;
    const auto planned = plan_show(show_, {film()});
    ASSERT_TRUE(planned) << planned.error().message;
    EXPECT_TRUE(planned->plan.valid) << testing::PrintToString(planned->refusal);
    // The first formation is exact: nobody is on the way.
    const Formation& first = planned->plan.formations.front();
    int inside[2] = {0, 0};
    for (std::size_t p = 0; p < first.cells.size(); ++p) {
      const auto group = show_.performers[p].group;
      for (int region = 0; region < 2; ++region) {
        if (!in(region, first.cells[p])) continue;
        EXPECT_EQ(group, GroupIndex::of(region)) << "performer " << p + 1;
        ++inside[region];
      }
    }
    EXPECT_GT(inside[0], 3);
    EXPECT_GT(inside[1], 3);
    const bool told = std::count(planned->plan.sections[0].notes.begin(), planned->plan.sections[0].notes.end(),
                                 "planned as `model: hierarchical`: groups are bound to regions") == 1;
    EXPECT_EQ(told, model == PlannerModel::joint);
  }
}

TEST_F(Regions, DivideAFormationAsTheShowFileSays) {
  const Grid& grid = show_.stage.grid;
  const std::vector<CellIndex> cells = test::cells_in(grid, "I1:V2");  // two columns of each region, 20 cells beside
  RegionTask task{&show_, &show_.sections[0].regions, &cells, std::vector<char>(cells.size(), 0), {8, 2, 18}};
  const auto whose = divide_by_regions(task);
  std::map<std::uint32_t, int> count;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    ++count[whose[i]];
    // Too few places of its own: the nearest beside them.
    EXPECT_TRUE(whose[i] != 0 || grid.cell(cells[i]).column <= 11);
    // Too many: the others take what the group leaves.
    EXPECT_TRUE(!in(1, cells[i]) || whose[i] != 0);
    EXPECT_TRUE(!in(0, cells[i]) || whose[i] == 0);
  }
  EXPECT_EQ(count, (std::map<std::uint32_t, int>{{0, 8}, {1, 2}, {2, 18}}));
}

TEST_F(Regions, ContradictAListThatSaysWhoStandsWhere) {
  CellsSource list{"bow.csv", test::cells_in(show_.stage.grid, "C1:L6"), true, {}};
  show_.sections[0].from = list;
  show_.sections[0].duration_counts = 0;
  auto planned = plan_show(show_, {std::nullopt});
  ASSERT_FALSE(planned);
  EXPECT_EQ(
      planned.error(),
      input_error("show.yaml:35:9: error: sections[0].regions: 'bow.csv' says who stands where already (leave out "
                  "the regions or its column of names or groups)"));
}

TEST(Casting, APinThatContradictsAListIsAnErrorAtItsPlace) {
  Show show = test::show_with(4);
  group_people(show, {2, 1});
  CellsSource list = list_of(test::cells_in(show.stage.grid, "A1:D1"));
  list.groups = {GroupIndex(0), GroupIndex(0), GroupIndex(1), std::nullopt};
  show.sections.push_back(test::section_of("bow", list, 1, 0, 4, 31));
  const auto pin = [&](std::uint32_t who, int column) {
    Override hand;
    hand.number = 1;
    hand.pin = {{PerformerIndex(who), show.stage.grid.index({column, 0}), {"show.yaml", 33, 20}}};
    show.sections[0].overrides = {hand};
    const auto planned = plan_show(show, {std::nullopt});
    return planned ? std::string() : planned.error().message;
  };
  const std::string head = "show.yaml:33:20: error: sections[0].overrides[0]: 'list.csv' gives ";
  const std::string tail = " (pin somebody whose place it is, or change the list)";
  EXPECT_EQ(pin(0, 2), head + "C1 to the group 'g2', and performer 1 is in 'g1'" + tail);
  EXPECT_EQ(pin(3, 2), head + "C1 to the group 'g2', and performer 4 is in no group" + tail);
  EXPECT_EQ(pin(2, 3), head + "D1 to who is in no group, and performer 3 is in 'g2'" + tail);
  EXPECT_EQ(pin(2, 2), "");
  list.groups.clear();
  list.assigned = true;
  show.sections[0].from = list;
  EXPECT_EQ(pin(0, 2), head + "C1 to performer 3, and performer 1 is not" + tail);
  EXPECT_EQ(pin(2, 2), "");
}

TEST(ExchangeKinds, GoByTheLargerOfWhatWasAndWhatWillBe) {
  // Performer 0 is named in the second formation, performer 1 in the fourth, groups {0, 1, 2}, {3, 4} in the third.
  Casting casting;
  casting.bindings.resize(5);
  casting.bindings[1].person = {0, 9, 9, 9, 9};
  casting.bindings[2].person = {5, 5, 5, 6, 6};
  casting.bindings[3].person = {9, 1, 9, 9, 9};
  const auto kinds = exchange_kinds(casting, 5, 5);
  const auto same = [&](std::size_t interval, std::size_t a, std::size_t b) {
    return kinds[interval].empty() || kinds[interval][a] == kinds[interval][b];
  };
  EXPECT_TRUE(kinds[0].empty()) << "nobody has a past";
  EXPECT_TRUE(kinds[3].empty()) << "nobody has a future";
  EXPECT_FALSE(same(1, 0, 1));
  EXPECT_FALSE(same(1, 0, 3)) << "who is named must reach a place of her group";
  EXPECT_TRUE(same(1, 3, 4));
  EXPECT_FALSE(same(2, 1, 2)) << "who will be named must not give her place away";
  EXPECT_TRUE(same(2, 3, 4));
  EXPECT_TRUE(same(2, 0, 2));
}

}  // namespace
}  // namespace footlight::planner
