// SPDX-License-Identifier: Apache-2.0
#include "config/plan_file.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <sqlite3.h>

#include "core/check.hpp"
#include "core/rng.hpp"
#include "tests/support/full.hpp"
#include "tests/support/temporary_folder.hpp"

namespace footlight::config {
namespace {

using test::TemporaryFolder;
using Names = std::vector<std::string>;

/// A plan of any content within its shape, all from one seed: odd texts, times before count 1, infinities.
class AnyPlan {
 public:
  explicit AnyPlan(std::uint64_t seed) : rng_(seed) {}

  Plan make(int most_people = 12) {
    Plan plan;
    plan.title = text();
    plan.version = text();
    plan.show_hash = text();
    const GridKind kinds[] = {GridKind::square, GridKind::hexagonal, GridKind::triangular};
    plan.stage.grid = *Grid::make(kinds[rng_.below(3)], 1 + number(40), 1 + number(40), 0.1 + rng_.uniform());
    cells_ = plan.stage.grid.size();
    plan.stage.blocked = some_cells();
    plan.stage.reserve = some_cells();
    plan.stage.clearance_m = real();
    plan.stage.max_speed_mps = real();
    plan.stage.lag = Duration(number(1'000'000'000));
    plan.stage.walk = rng_.below(2) == 0 ? WalkKind::straight : WalkKind::cells;
    people_ = 1 + number(most_people);
    for (int i = 0; i < people_; ++i) {
      plan.performers.push_back(text());
      plan.radius_m.push_back(real());
      plan.max_speed_mps.push_back(real());
      plan.tracks.push_back(track());
    }
    for (int i = 0; i <= number(3); ++i) plan.sections.push_back(section());
    for (int i = 0; i < number(5); ++i) plan.formations.push_back(formation(static_cast<int>(plan.sections.size())));
    for (int i = 0; i < number(5); ++i) plan.transitions.push_back(facts());
    plan.valid = number(2) == 1;
    return plan;
  }

 private:
  int number(int below) { return static_cast<int>(rng_.below(static_cast<std::uint64_t>(below))); }
  std::string text() {
    std::string out;
    for (int i = number(9); i > 0; --i) out.push_back("aZ9 '\"\\\n\0\xC3\xA9;%"[number(13)]);
    return out;
  }
  double real() {
    switch (number(6)) {
      case 0:
        return 0;
      case 1:
        return std::numeric_limits<double>::infinity();
      case 2:
        return static_cast<double>(number(1000));
      default:
        return (rng_.uniform() - 0.5) * std::pow(10.0, number(30) - 15);
    }
  }
  Instant instant() { return Instant(Duration(static_cast<std::int64_t>(rng_.next()) >> number(60))); }
  CellIndex cell() { return CellIndex::of(number(cells_)); }
  std::vector<CellIndex> some_cells() {
    std::vector<CellIndex> out;
    for (int i = 0; i < cells_; ++i) {
      if (number(7) == 0) out.push_back(CellIndex::of(i));
    }
    return out;
  }
  std::vector<Mark> track() {
    std::vector<Mark> out;
    std::int64_t time = static_cast<std::int64_t>(rng_.next()) >> 8;
    for (int i = number(10); i >= 0; --i) {
      out.push_back({Instant(Duration(time)), cell()});
      time += 1 + static_cast<std::int64_t>(rng_.next() >> (10 + static_cast<unsigned>(number(50))));
    }
    return out;
  }
  PlanSection section() {
    PlanSection out{text(), instant(), instant(), real(), {}, some_cells(), {}};
    if (number(2) == 1) {
      out.film = FilmPlacement{text(),       number(100), number(100),    real(), number(5000),
                               number(5000), number(256), number(2) == 1, {}};
      for (double& value : out.film->stage_to_frame) value = real();
    }
    for (int i = number(3); i > 0; --i) out.notes.push_back(text());
    return out;
  }
  Formation formation(int sections) {
    Formation out{text(), SectionIndex::of(number(sections)), real(), instant(), {}, {}, number(people_ + 1)};
    out.key = rng_.below(2) == 0;
    out.moved = number(9);
    out.pinned = number(9);
    if (number(2) == 1) out.frame = number(1000);
    for (int i = 0; i < people_; ++i) out.cells.push_back(cell());
    return out;
  }
  TransitionFacts facts() {
    const auto person = [&] { return PerformerIndex::of(number(people_)); };
    TransitionFacts out;
    out.start = instant();
    out.end = instant();
    out.clearance_m = real();
    out.closest_a = person();
    out.closest_b = person();
    out.closest_at = instant();
    out.longest_walk_m = real();
    out.longest_walker = person();
    out.tolerated_lag_s = real();
    return out;
  }

  Rng rng_;
  int cells_ = 1;
  int people_ = 1;
};

void execute(const std::string& file, const std::string& sql) {
  sqlite3* database = nullptr;
  FL_CHECK(sqlite3_open(file.c_str(), &database) == SQLITE_OK);
  char* error = nullptr;
  sqlite3_exec(database, sql.c_str(), nullptr, nullptr, &error);
  EXPECT_EQ(error, nullptr) << (error == nullptr ? "" : error);
  sqlite3_free(error);
  sqlite3_close(database);
}

TEST(PlanFile, LoadsWhatWasSaved) {
  const TemporaryFolder folder;
  EXPECT_TRUE(rc::check("load(save(p)) == p", [&](std::uint64_t seed) {
    const Plan plan = AnyPlan(seed).make();
    const auto saved = save_plan(plan, folder / "a.plan");
    RC_ASSERT(saved.has_value());
    const auto loaded = load_plan(folder / "a.plan");
    RC_ASSERT(loaded.has_value());
    RC_ASSERT(*loaded == plan);
  }));
}

TEST(PlanFile, TheSamePlanGivesTheSameBytes) {
  const TemporaryFolder folder;
  const Plan plan = AnyPlan(5).make();
  ASSERT_TRUE(save_plan(plan, folder / "a.plan"));
  ASSERT_TRUE(save_plan(plan, folder / "b.plan"));
  EXPECT_EQ(folder.read("a.plan"), folder.read("b.plan"));
  EXPECT_EQ(folder.names(), (Names{"a.plan", "b.plan"}));
}

/// Every harmed file is refused or gives the very same plan (the harm lies in bytes that carry nothing).
/// FOOTLIGHT_MUTATIONS=1000000 runs the whole promise (a quarter of an hour).
TEST(PlanFile, NoHarmedFileLoadsAsAnotherPlan) {
  const TemporaryFolder folder;
  const char* wanted = std::getenv("FOOTLIGHT_MUTATIONS");
  const long mutations = wanted == nullptr ? test::tries(400L, 100'000L) : std::atol(wanted);
  Rng rng(1);
  long refused = 0;
  long same = 0;
  Plan plan;
  std::string whole;
  for (long i = 0; i < mutations; ++i) {
    if (i % 1000 == 0) {
      plan = AnyPlan(rng.next()).make();
      ASSERT_TRUE(save_plan(plan, folder / "a.plan"));
      whole = folder.read("a.plan");
    }
    std::string bytes = whole;
    switch (rng.below(4)) {
      case 0:
        bytes.resize(rng.below(bytes.size()));
        break;
      case 1:
        bytes[rng.below(bytes.size())] ^= static_cast<char>(1U << rng.below(8));
        break;
      case 2:
        for (int k = 0; k < 4; ++k) bytes[rng.below(bytes.size())] = static_cast<char>(rng.below(256));
        break;
      default: {  // a stretch from elsewhere: pages and rows change places
        const std::size_t size = 1 + rng.below(64);
        bytes.replace(rng.below(bytes.size() - size), size, whole.substr(rng.below(whole.size() - size), size));
      }
    }
    const auto loaded = load_plan(folder.write("b.plan", bytes));
    if (loaded) {
      ASSERT_TRUE(*loaded == plan) << "mutation " << i;
      ++same;
    } else {
      ++refused;
    }
  }
  EXPECT_GT(refused, mutations / 4);
  EXPECT_EQ(refused + same, mutations);
}

class HarmedPlan : public ::testing::Test {
 protected:
  HarmedPlan() {
    Plan plan = AnyPlan(11).make();
    plan.transitions.resize(1);
    FL_CHECK(save_plan(plan, file_).has_value());
  }
  std::string refusal() {
    const auto plan = load_plan(file_);
    if (plan) return "a plan";
    EXPECT_EQ(plan.error().kind, ErrorKind::input);
    return plan.error().message;
  }
  /// What is said after a change with another tool.
  std::string after(const std::string& sql) {
    execute(file_, sql);
    return refusal();
  }
  std::string harmed(const std::string& what) {
    return "cannot use '" + file_ + "': it is harmed: " + what + " (plan the show again)";
  }

  TemporaryFolder folder_;
  std::string file_ = folder_ / "a.plan";
};

TEST_F(HarmedPlan, ANumberThatSomebodyEditedIsFound) {
  EXPECT_EQ(after("UPDATE stage SET clearance_m = clearance_m + 0.25, max_speed_m_s = 3"),
            harmed("its content does not match its digest"));
}

TEST_F(HarmedPlan, AValidityThatSomebodyGrantedIsFound) {
  EXPECT_EQ(after("UPDATE meta SET value = 1 - value WHERE key = 'valid'"),
            harmed("its content does not match its digest"));
}

TEST_F(HarmedPlan, AnotherVersionOfTheShowIsFound) {
  EXPECT_EQ(after("INSERT OR REPLACE INTO meta VALUES('version', 'another')"),
            harmed("its content does not match its digest"));
  EXPECT_EQ(after("INSERT INTO meta VALUES('more', '')"),
            harmed("table meta: title, show_hash, valid and digest are needed"));
}

TEST_F(HarmedPlan, ValuesOutOfRangeAreNamed) {
  EXPECT_EQ(after("UPDATE transitions SET closest_a = 4000000000"),
            harmed("table transitions: row 1 has a value of the wrong kind or out of its range"));
}

TEST_F(HarmedPlan, MissingRowsAreNamed) {
  EXPECT_EQ(after("DELETE FROM tracks WHERE performer = 0"), harmed("table tracks: its rows are not in order"));
}

TEST_F(HarmedPlan, AGridThatDoesNotExistIsNamed) {
  EXPECT_EQ(after("UPDATE stage SET columns = 1000000"), harmed("table stage: there is no such grid"));
}

TEST_F(HarmedPlan, AKindOfWalkThatDoesNotExistIsNamed) {
  EXPECT_EQ(after("UPDATE stage SET walk = 'hop'"), harmed("table stage: there is no such kind of walk"));
}

TEST_F(HarmedPlan, ViewsTriggersAndStrangeTablesAreRefusedUnread) {
  const std::string not_ours = harmed("its tables are not those of a plan");
  EXPECT_EQ(after("CREATE VIEW v AS WITH RECURSIVE r(n) AS (SELECT 1 UNION ALL SELECT n + 1 FROM r) SELECT n FROM r"),
            not_ours);
  EXPECT_EQ(after("DROP VIEW v; DROP TABLE notes; CREATE VIEW notes AS SELECT 0 AS number, 0 AS section, 'x' AS text"),
            not_ours);
}

TEST_F(HarmedPlan, AnotherVersionSaysWhichAndWhatToDo) {
  EXPECT_EQ(after("PRAGMA user_version = 7"),
            "cannot use '" + file_ + "': it has version 7, this program reads version 4 (plan the show again)");
}

TEST_F(HarmedPlan, OtherFilesAreNoPlans) {
  const std::string no_plan = "cannot use '" + file_ + "': it is no plan (footlight plan writes one)";
  EXPECT_EQ(after("PRAGMA application_id = 0"), no_plan);
  folder_.write("a.plan", "footlight: 1\n");
  EXPECT_EQ(refusal(), no_plan);
  folder_.write("a.plan", "");
  EXPECT_EQ(refusal(), no_plan);
  std::filesystem::remove(file_);
  EXPECT_EQ(refusal(), "cannot read '" + file_ + "': No such file or directory");
}

TEST(PlanFile, AFailureLeavesTheOlderFile) {
  const TemporaryFolder folder;
  ASSERT_TRUE(save_plan(AnyPlan(1).make(), folder / "a.plan"));
  const std::string before = folder.read("a.plan");
  Plan unsound = AnyPlan(2).make();
  unsound.stage.clearance_m = std::nan("");
  const auto saved = save_plan(unsound, folder / "a.plan");
  ASSERT_FALSE(saved);
  EXPECT_EQ(saved.error().kind, ErrorKind::internal);
  EXPECT_EQ(folder.read("a.plan"), before);
  EXPECT_EQ(folder.names(), Names{"a.plan"});
}

TEST(HashFiles, CoversNamesContentsAndOrder) {
  const TemporaryFolder folder;
  const std::string a = folder.write("a", "1");
  const std::string b = folder.write("b", "2");
  const auto hash = [](std::vector<std::string> files) { return *hash_files(files); };
  const std::string before = hash({a, b});
  EXPECT_EQ(before.size(), 64U);
  EXPECT_NE(hash({b, a}), before);
  folder.write("b", "3");
  EXPECT_NE(hash({a, b}), before);
  folder.write("a", "12");
  folder.write("b", "");
  EXPECT_NE(hash({a, b}), before);
}

TEST(HashFiles, AFolderMayMoveAsAWhole) {
  const TemporaryFolder one;
  const TemporaryFolder two;
  const std::vector<std::string> here{one.write("show.yaml", "1"), one.write("v.mp4", "2")};
  const std::vector<std::string> there{two.write("show.yaml", "1"), two.write("v.mp4", "2")};
  EXPECT_EQ(*hash_files(here), *hash_files(there));
}

TEST(HashFiles, NamesTheFileThatCannotBeRead) {
  const std::vector<std::string> files{"/nowhere/show.yaml"};
  EXPECT_EQ(hash_files(files).error(), input_error("cannot read '/nowhere/show.yaml': No such file or directory"));
}

}  // namespace
}  // namespace footlight::config
