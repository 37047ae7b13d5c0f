// SPDX-License-Identifier: Apache-2.0
#include "config/transport_map.hpp"

#include <gtest/gtest.h>

#include "tests/config/show_folder.hpp"

namespace footlight::config {
namespace {

class TransportMap : public testing::Test {
 protected:
  TransportMap() {
    for (const auto& [name, kind] : {std::pair{"left", BusKind::serial}, std::pair{"right", BusKind::modbus_tcp}}) {
      Bus& bus = rig_.buses.emplace_back();
      bus.name = name;
      bus.kind = kind;
      bus.url = "as before";
    }
  }
  std::string wrong(const std::string& text) {
    folder_.write("map.yaml", text);
    const auto taken = take_transports(folder_.path("map.yaml"), rig_);
    return taken ? "" : folder_.without_folder(taken.error().to_text());
  }

  ShowFolder folder_;
  Rig rig_;
};

TEST_F(TransportMap, GivesTheBusesThatItNamesTheirPlaces) {
  EXPECT_EQ(wrong("transports: 1\nbuses:\n  - {name: right, url: \"tcp://127.0.0.1:1502\"}\n"), "");
  EXPECT_EQ(rig_.buses[0].url, "as before");
  EXPECT_EQ(rig_.buses[1].url, "tcp://127.0.0.1:1502");
}

TEST_F(TransportMap, WhatIsWrittenIsReadAgainWhateverTheNames) {
  rig_.buses[0].name = "a \"b\" \\ : {c}";
  folder_.write("map.yaml", transport_map_text({{rig_.buses[0].name, "serial:///tmp/a b"}}, "made for a test"));
  ASSERT_TRUE(take_transports(folder_.path("map.yaml"), rig_));
  EXPECT_EQ(rig_.buses[0].url, "serial:///tmp/a b");
}

TEST_F(TransportMap, TellsAllThatIsWrongAtItsPlace) {
  EXPECT_EQ(wrong("transports: 1\nbuses:\n"
                  "  - {name: lefft, url: \"serial:///dev/ttyS0\"}\n"
                  "  - {name: left, url: \"rtu:///dev/ttyS0\"}\n"
                  "  - {name: left, url: \"serial:///dev/ttyS0\"}\n"
                  "  - {name: right, url: \"sim://tcp\"}\n"
                  "  - {name: right}\n"),
            "map.yaml:3:12: error: buses[0].name: the rig has no bus \"lefft\" (did you mean \"left\"?)\n"
            "map.yaml:4:23: error: buses[1].url: \"rtu:///dev/ttyS0\" is not the URL of a serial bus "
            "(serial:///dev/serial/by-id/...)\n"
            "map.yaml:5:12: error: buses[2].name: the bus \"left\" is named twice (one place for each bus)\n"
            "map.yaml:6:24: error: buses[3].url: \"sim://tcp\" has no wire (tcp://host:502)\n"
            "map.yaml:7:5: error: buses[4].url: the key is missing (as in the rig, but not simulated)\n"
            "map.yaml:7:12: error: buses[4].name: the bus \"right\" is named twice (one place for each bus)\n");
}

TEST_F(TransportMap, AFileThatIsNotThereIsNamed) {
  const auto taken = take_transports(folder_.path("nowhere.yaml"), rig_);
  ASSERT_FALSE(taken);
  EXPECT_NE(taken.error().to_text().find("nowhere.yaml: error: "), std::string::npos) << taken.error().to_text();
}

}  // namespace
}  // namespace footlight::config
