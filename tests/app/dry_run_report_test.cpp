// SPDX-License-Identifier: Apache-2.0
#include "app/dry_run_report.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace footlight::app {
namespace {

DryRunReport report() {
  DryRunReport out;
  out.duration_s = 156;
  out.right_share = 0.9995;
  out.deliveries = 23220;
  out.retries = 12;
  out.wrong_final = 2;
  BusReport bus;
  bus.name = "can-1";
  bus.kind = "can";
  bus.utilisation = 0.25;
  bus.deliveries = 1100;
  out.buses = {bus};
  CueReport right;
  right.number = "1";
  CueReport wrong;
  wrong.number = "2.5";
  wrong.name = "Bow";
  wrong.end_s = 156;
  wrong.wrong = 2;
  wrong.first = {{"can-1-5", 4, 255, 2}, {"can-1-5", 5, 255, 0}};
  out.cues = {right, wrong};
  return out;
}

TEST(DryRunReport, JsonHasTheFiguresThatProgramsRead) {
  const auto json = nlohmann::json::parse(dry_run_json(report()));
  EXPECT_EQ(json["wrong_final"], 2);
  EXPECT_EQ(json["right_share"], 0.9995);
  EXPECT_EQ(json["deliveries"], 23220);
  EXPECT_EQ(json["retries"], 12);
  EXPECT_EQ(json["duration_s"], 156.0);
  ASSERT_EQ(json["buses"].size(), 1U);
  EXPECT_EQ(json["buses"][0]["name"], "can-1");
  EXPECT_EQ(json["buses"][0]["kind"], "can");
  EXPECT_EQ(json["buses"][0]["utilisation"], 0.25);
  EXPECT_EQ(json["buses"][0]["deliveries"], 1100);
}

TEST(DryRunReport, SaysWhatIsAssumedOfBusesWhoseDevicesProveNothing) {
  DryRunReport with_foreign = report();
  EXPECT_EQ(dry_run_text(with_foreign).find("unverified"), std::string::npos);
  with_foreign.buses[0].assumes = "what is acknowledged is shown";
  EXPECT_NE(dry_run_text(with_foreign).find("  unverified on can-1: what is acknowledged is shown\n"),
            std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(dry_run_json(with_foreign))["buses"][0]["assumes"], "what is acknowledged is shown");
}

TEST(DryRunReport, AFailureNamesCueAndMarkers) {
  EXPECT_EQ(dry_run_failure(report()),
            "cue 2.5 \"Bow\": 2 markers wrong at its end (156.000 s): can-1-5 channel 4 shows look 255 instead of 2; "
            "can-1-5 channel 5 shows look 255 instead of 0.");
}

TEST(DryRunReport, AFailureSaysThatThereAreMoreMarkersThanItNames) {
  DryRunReport many = report();
  many.cues[1].wrong = 3;
  EXPECT_EQ(dry_run_failure(many),
            "cue 2.5 \"Bow\": 3 markers wrong at its end (156.000 s): can-1-5 channel 4 shows look 255 instead of 2; "
            "can-1-5 channel 5 shows look 255 instead of 0, ...");
}

}  // namespace
}  // namespace footlight::app
