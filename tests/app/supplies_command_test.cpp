// SPDX-License-Identifier: Apache-2.0
//
// Power supplies and CAN interfaces as a user meets them, through the built program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/program.hpp"
#include "tests/support/starter_show.hpp"
#include "tests/support/temporary_folder.hpp"

namespace footlight {
namespace {

using nlohmann::json;
using test::footlight;
using test::Ran;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class SuppliedShow : public test::StarterShow {
 protected:
  void with_rig(const std::string& supply, const std::string& bus = "{name: can-a, url: \"sim://can\", supply: P1}") {
    replace("# rig: rig.yaml", "rig: rig.yaml");
    folder_.write("s/rig.yaml", "rig: 1\nbuses: [" + bus + "]\nsupplies: [{name: P1, " + supply +
                                    "}]\nlamps: {lamp: 300 mA, node: 20 mA}\nfloor: {buses: can-a}\n");
  }
};

TEST_F(SuppliedShow, CheckAndDryrunTellTheLoadOfEverySupply) {
  with_rig("limit: 1000 A");
  const Ran checked = footlight({"check", show_});
  EXPECT_EQ(checked.status, 0) << checked.err;
  EXPECT_THAT(checked.out, HasSubstr("supply P1: at most "));
  EXPECT_THAT(checked.out, HasSubstr(" A of 1000 A ("));
  const json supplies = json::parse(footlight({"dryrun", show_, "--json"}).out)["supplies"];
  ASSERT_EQ(supplies.size(), 1U);
  EXPECT_EQ(supplies[0]["name"], "P1");
  EXPECT_GT(supplies[0]["peak_a"], 0.3);
  EXPECT_LT(supplies[0]["mean_a"], supplies[0]["peak_a"]);
}

TEST_F(SuppliedShow, AnOverloadIsRefusedWithItsPlaceInTheRig) {
  with_rig("limit: 100 mA");
  const Ran ran = footlight({"check", show_});
  EXPECT_EQ(ran.status, 3);
  EXPECT_THAT(ran.err, HasSubstr("rig.yaml:3:12: error: supplies[0]: the supply \"P1\" has to give "));
}

TEST_F(SuppliedShow, AnInterfaceThatIsNotThereStopsCheckDevicesAndRun) {
  with_rig("limit: 1000 A", "{name: can-a, url: \"can://can77\", supply: P1}");
  EXPECT_EQ(footlight({"check", show_}).status, 0) << "the show itself is right";
  for (const std::vector<std::string>& words : {std::vector<std::string>{"check", show_, "--devices"},
                                                {"run", show_, "--go", "--state", folder_ / "state"},
                                                {"devices", "scan", "can-a", "--show", show_}}) {
    const Ran ran = footlight(words);
    EXPECT_EQ(ran.status, 4) << words[0];
    EXPECT_THAT(ran.err, HasSubstr("bus \"can-a\": CAN interface \"can77\": ")) << words[0];
    EXPECT_THAT(ran.err, HasSubstr("ip link")) << words[0];
  }
}

TEST_F(SuppliedShow, ABusOfOutputModulesPlaysTheShow) {
  with_rig("limit: 1000 A", "{name: can-a, url: \"sim://can\", profile: cia401-32do, supply: P1}");
  const Ran ran = footlight({"dryrun", show_, "--json"});
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_EQ(json::parse(ran.out)["wrong_final"], 0);
}

}  // namespace
}  // namespace footlight
