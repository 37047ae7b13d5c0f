// SPDX-License-Identifier: Apache-2.0
#include "planner/stations.hpp"

#include <algorithm>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "planner/plan_show.hpp"
#include "tests/planner/small_show.hpp"

namespace footlight::planner {
namespace {

TEST(Stations, FilmsThatArePlannedTogetherTellAStageOfTheirOwnFromTheCallingThread) {
  Show show = test::three_sections(40);
  show.sections[0] = test::section_of("early", test::video(), 1, 40, 0, 11);
  show.sections[1] = test::section_of("late", test::video(), 60, 40, 0, 12);
  test::Films films = test::three_films();
  films[0] = films[1];
  std::vector<std::pair<std::string, double>> told;
  const auto caller = std::this_thread::get_id();
  Progress progress;
  progress.report = [&](std::string_view stage, double share) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    told.emplace_back(stage, share);
  };
  ASSERT_TRUE(plan_show(show, films, progress));
  ASSERT_FALSE(told.empty());
  EXPECT_EQ(told.front(), std::pair(std::string("joint"), 0.0));
  std::vector<double> shares;
  for (const auto& [stage, share] : told) {
    if (stage != "joint") break;
    shares.push_back(share);
  }
  EXPECT_EQ(shares.back(), 1);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  const auto again = [&](const auto& one) { return one.first == "joint"; };
  EXPECT_EQ(std::count_if(told.begin(), told.end(), again), static_cast<std::ptrdiff_t>(shares.size()));
}

TEST(Stations, ASingleFilmTellsHowFarItIsFromNothingToAll) {
  Show show = test::three_sections(40);
  show.sections = {test::section_of("film", test::video(), 1, 40, 0, 11)};
  std::vector<double> shares;
  Progress progress;
  progress.report = [&](std::string_view stage, double share) {
    if (stage == "joint") shares.push_back(share);
  };
  ASSERT_TRUE(plan_show(show, {test::three_films()[1]}, progress));
  ASSERT_GT(shares.size(), 2U);
  EXPECT_EQ(shares.front(), 0);
  EXPECT_EQ(shares.back(), 1);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
}

}  // namespace
}  // namespace footlight::planner
