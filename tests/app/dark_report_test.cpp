// SPDX-License-Identifier: Apache-2.0
#include "app/dark_report.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

using controller::DarkUnit;

std::vector<DarkUnit> units() {
  DarkUnit supply{DarkUnit::Kind::supply, "left", 2, 9, 2, {}};
  supply.worst.push_back({PerformerIndex(0), CellIndex(5), instant_at(2), PerformerIndex(1), 0.25, instant_at(3.5)});
  return {supply, {DarkUnit::Kind::node, "n1", 1, 4, 0, {}}, {DarkUnit::Kind::node, "n2", 1, 5, 0, {}}};
}

TEST(DarkReport, NamesTheWorstUnitsAndTheWorstCueOfEach) {
  const auto small = tests::random_show(4, 4, 3, 1, 3, 1);
  EXPECT_EQ(dark_text(small.show, small.plan, units()),
            "0 of 2 nodes have cues that become unsafe when dark\n"
            "1 of 1 supply have cues that become unsafe when dark\n"
            "\n"
            "dark    kind  nodes  not shown  unsafe\n"
            "left  supply      2          9       2\n"
            "\n"
            "left: cue 1: performer 1 is not shown B2 at count 5; 2 comes as near as 0.250 m at count 8\n");
}

TEST(DarkReport, SaysWhenNothingBecomesUnsafe) {
  const auto small = tests::random_show(4, 4, 3, 1, 3, 1);
  EXPECT_EQ(dark_text(small.show, small.plan, {{DarkUnit::Kind::node, "n1", 1, 4, 0, {}}}),
            "0 of 1 node have cues that become unsafe when dark\n");
}

TEST(DarkReport, TellsProgramsTheSame) {
  const auto small = tests::random_show(4, 4, 3, 1, 3, 1);
  const auto json = nlohmann::json::parse(dark_json(small.show, small.plan, units()));
  EXPECT_EQ(json["nodes"], 2);
  EXPECT_EQ(json["nodes_unsafe"], 0);
  EXPECT_EQ(json["supplies_unsafe"], 1);
  EXPECT_EQ(json["units"][0]["name"], "left");
  EXPECT_EQ(json["units"][0]["worst"][0]["cue"], "1");
  EXPECT_EQ(json["units"][0]["worst"][0]["not_shown"], "B2");
  EXPECT_EQ(json["units"][0]["worst"][0]["distance_m"], 0.25);
}

}  // namespace
}  // namespace footlight::app
