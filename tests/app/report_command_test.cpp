// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/starter_show.hpp"

namespace footlight {
namespace {

using nlohmann::json;
using test::footlight;
using test::Ran;
using ::testing::EndsWith;
using ::testing::HasSubstr;

class ReportCommand : public test::StarterShow {};

TEST_F(ReportCommand, IsOnePageThatNeedsNothingElse) {
  replace("title: \"Twelve\"", "title: \"Twelve <&> people\"");
  const Ran ran = footlight({"report", show_, "-o", folder_ / "r.html"});
  ASSERT_EQ(ran.status, 0) << ran.err;
  const std::string page = folder_.read("r.html");
  EXPECT_THAT(page, HasSubstr("<title>Twelve &lt;&amp;&gt; people</title>"));
  for (const char* heading : {"Key formations", "How well the floor draws the film", "Clearance", "Ways",
                              "How calmly the crowd moves", "Buses", "When a marker fails", "Warnings"}) {
    EXPECT_THAT(page, HasSubstr(std::string("<h2>") + heading + "</h2>"));
  }
  const std::regex outside("(src|href)=\"(?!data:)|@import|url\\(|<script");
  EXPECT_FALSE(std::regex_search(page, outside)) << "no network";
  const Ran again = footlight({"report", show_, "-o", folder_ / "again.html"});
  EXPECT_EQ(folder_.read("again.html"), page) << "the same plan gives the same bytes";
}

TEST_F(ReportCommand, ItsFiguresAreThoseOfOtherCommands) {
  ASSERT_EQ(footlight({"plan", show_, "-q"}).status, 0);
  const Ran ran = footlight({"report", show_, "--json"});
  ASSERT_EQ(ran.status, 0) << ran.err;
  const json report = json::parse(ran.out);
  const json measured = json::parse(footlight({"measure", show_, "--json"}).out);
  EXPECT_EQ(report["title"], "Twelve");
  EXPECT_EQ(report["files"], json::array());
  EXPECT_EQ(report["performers"].size(), 12U);
  EXPECT_EQ(report["all"]["min_clearance_m"], measured["min_clearance_m"]);
  EXPECT_EQ(report["all"]["theta_dev"], nullptr) << "cells have no picture";
  EXPECT_EQ(report["sections"][1]["name"], "ring");
  double walked = 0;
  for (const json& way : report["ways"]["walked_m"]) walked += way.get<double>();
  EXPECT_NEAR(walked, measured["total_distance_m"].get<double>(), 1e-6);
  const auto& least = report["clearance"]["least_m"];
  EXPECT_NEAR(*std::min_element(least.begin(), least.end()), report["all"]["min_clearance_m"].get<double>(), 1e-9);
  for (const char* list : {"I_d_bits", "I_v_bits", "sigma_min_dis_m", "sigma_curr_eft_m"}) {
    EXPECT_EQ(report["crowd"][list].size(), report["crowd"]["time_s"].size()) << list;
  }
  EXPECT_EQ(report["buses_missing"], nullptr);
  ASSERT_FALSE(report["buses"].empty());
  EXPECT_GT(report["buses"][0]["load"], 0);
  EXPECT_EQ(report["dark"], json::parse(footlight({"dark", show_, "--json"}).out));
  EXPECT_EQ(footlight({"report", show_}).err, "error: say what to write: -o FILE.html, or --json\n");
}

TEST_F(ReportCommand, SaysWhatIsWrongAndLeavesNothing) {
  const Ran ran = footlight({"report", show_, "-o", folder_ / "nowhere/r.html"});
  EXPECT_EQ(ran.status, 2);
  EXPECT_EQ(ran.err, "error: cannot write '" + (folder_ / "nowhere/r.html") + "': No such file or directory\n");
  const Ran full = test::run_program(
      {"sh", "-c", "ulimit -f 4; exec \"$0\" \"$@\"", FOOTLIGHT_PROGRAM, "report", show_, "-o", folder_ / "s/r.html"});
  EXPECT_EQ(full.status, 2);
  EXPECT_THAT(full.err, EndsWith("cannot write '" + (folder_ / "s/r.html") + "': File too large\n"));
  EXPECT_EQ(files(), as_made_);
}

}  // namespace
}  // namespace footlight
