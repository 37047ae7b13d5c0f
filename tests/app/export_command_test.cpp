// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/starter_show.hpp"

namespace footlight {
namespace {

using nlohmann::json;
using test::footlight;
using test::Ran;

class ExportCommand : public test::PlannedStarterShow {};

TEST_F(ExportCommand, SaysAsJsonWhatItWroteOfWhichPlan) {
  const Ran ran = footlight({"export", show_, "--csv", folder_ / "csv", "--drone", folder_ / "d.zip", "--json"});
  ASSERT_EQ(ran.status, 0) << ran.err;
  const json told = json::parse(ran.out);
  EXPECT_EQ(told["files"], (json{folder_ / "d.zip", folder_ / "csv/marks.csv", folder_ / "csv/formations.csv",
                                 folder_ / "csv/stage.json"}));
  for (const json& file : told["files"]) EXPECT_TRUE(std::filesystem::exists(file.get<std::string>())) << file;
  EXPECT_EQ(told["title"], "Twelve");
  EXPECT_EQ(told["valid"], true);
  const json sheets = json::parse(footlight({"sheets", show_, "-o", folder_ / "x.pdf", "--json"}).out);
  EXPECT_EQ(told["plan"], sheets["plan"]) << "paper and files can be compared";
}

TEST_F(ExportCommand, AnOutputThatCannotBeWrittenIsNamed) {
  const Ran ran = footlight({"export", show_, "--drone", folder_ / "nowhere/d.zip"});
  EXPECT_EQ(ran.status, 2);
  EXPECT_EQ(ran.err, "error: cannot write '" + (folder_ / "nowhere/d.zip") + "': No such file or directory\n");
  EXPECT_EQ(ran.out, "");
}

}  // namespace
}  // namespace footlight
