// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/paper/stamp.hpp"
#include "app/plan_diff.hpp"
#include "tests/support/small_show.hpp"
#include "tests/support/starter_show.hpp"

namespace footlight {
namespace {

using app::diff_of;
using app::FormationDiff;
using test::footlight;
using test::Ran;
using ::testing::HasSubstr;
using Names = std::vector<std::string>;

/// A plan whose formations know everybody's cells.
Plan formed(std::size_t people) {
  tests::SmallShow cast = tests::random_show(20, 12, people, 2, 3, 9);
  for (Formation& formation : cast.plan.formations) {
    for (const auto& track : cast.plan.tracks) {
      formation.cells.push_back(cast.plan.stage.grid.nearest(position_at(cast.plan.stage.grid, track, formation.time)));
    }
  }
  return cast.plan;
}

TEST(PlanDiff, OfEqualPlansIsEmpty) {
  const Plan plan = formed(6);
  const auto diff = diff_of(plan, plan);
  EXPECT_EQ(diff.same, 6U);
  EXPECT_TRUE(diff.changed.empty());
  EXPECT_TRUE(diff.formations.empty());
  EXPECT_THAT(diff_text(diff), HasSubstr("no formation has changed"));
}

TEST(PlanDiff, TellsWhoStandsElsewhereAndWhoCameAndLeft) {
  const Plan before = formed(6);
  Plan now = before;
  std::swap(now.tracks[1][2].cell, now.tracks[4][2].cell);
  std::swap(now.formations[2].cells[1], now.formations[2].cells[4]);
  now.performers[5] = "new";
  now.formations[3].id = "other";
  const auto diff = diff_of(before, now);
  EXPECT_EQ(diff.changed, (Names{"2", "5"}));
  EXPECT_EQ(diff.same, 3U);
  EXPECT_EQ(diff.joined, Names{"new"});
  EXPECT_EQ(diff.left, Names{"6"});
  ASSERT_EQ(diff.formations.size(), 3U);
  EXPECT_EQ(diff.formations[0].id, before.formations[2].id);
  ASSERT_EQ(diff.formations[0].displaced.size(), 2U);
  EXPECT_EQ(diff.formations[0].displaced[0].who, PerformerIndex(1));
  EXPECT_EQ(diff.formations[0].displaced[0].now, diff.formations[0].displaced[1].before);
  EXPECT_NE(diff.formations[1].kind, diff.formations[2].kind) << "one new, one gone";
  const auto json = nlohmann::json::parse(diff_json(diff));
  EXPECT_EQ(json["changed"], nlohmann::json({"2", "5"}));
  EXPECT_EQ(json["formations"][0]["displaced"], 2);
  EXPECT_EQ(json["old"]["plan"], app::Stamp(before).plan);
  EXPECT_EQ(json["new"]["plan"], app::Stamp(now).plan);
}

class DiffCommand : public test::StarterShow {};

TEST_F(DiffCommand, DrawsAndTells) {
  ASSERT_EQ(footlight({"plan", show_, "-o", folder_ / "old.plan", "-q"}).status, 0);
  std::string ring = folder_.read("s/ring.csv");
  const std::size_t at = ring.find("\n12,8,5");
  ASSERT_NE(at, std::string::npos);
  folder_.write("s/ring.csv", ring.replace(at, 7, "\n12,9,5"));
  ASSERT_EQ(footlight({"plan", show_, "-o", folder_ / "new.plan", "-q"}).status, 0);
  const Ran ran = footlight({"diff", folder_ / "old.plan", folder_ / "new.plan", "-o", folder_ / "d.pdf"});
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("1 people have other marks, 11 the same: 12\n"));
  EXPECT_THAT(ran.out, HasSubstr("ring/1: 1 stand elsewhere, by 1.0 m at most\n"));
  const Ran text = test::run_program({"pdftotext", folder_ / "d.pdf", folder_ / "d.txt"});
  EXPECT_EQ(text.status, 0);
  EXPECT_THAT(folder_.read("d.txt"), HasSubstr("ring/1"));
}

TEST_F(DiffCommand, SaysWhatIsWrong) {
  const Ran none = footlight({"diff", folder_ / "a.plan", folder_ / "b.plan"});
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, HasSubstr("a.plan': No such file or directory\n"));
  const Ran name = footlight({"diff", "a", "b", "-o", "x.png"});
  EXPECT_EQ(name.status, 2);
  EXPECT_EQ(name.err, "error: 'x.png': changes are drawn into a file that ends with .pdf\n");
}

}  // namespace
}  // namespace footlight
