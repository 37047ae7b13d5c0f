// SPDX-License-Identifier: Apache-2.0
#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/starter_show.hpp"

namespace footlight {
namespace {

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
