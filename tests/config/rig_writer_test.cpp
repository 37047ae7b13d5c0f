// SPDX-License-Identifier: Apache-2.0
#include "config/rig_writer.hpp"

#include <gtest/gtest.h>

#include "config/output_file.hpp"
#include "config/rig_file.hpp"
#include "tests/config/show_folder.hpp"

namespace footlight::config {
namespace {

class RigWriter : public testing::Test {
 protected:
  RigWriter() {
    show_.stage.grid = Grid::make(GridKind::square, 8, 6, 1).value();
    show_.stage.blocked = {CellIndex(3)};
    show_.performers.resize(2);
    show_.performers[1].wearable = "W 1";
  }
  Rig read(const std::string& name) {
    Diagnostics diagnostics;
    std::vector<std::string> files;
    Rig rig = read_rig(folder_.path(name).string(), show_, true, diagnostics, files);
    EXPECT_FALSE(diagnostics.has_errors()) << diagnostics.to_text();
    return rig;
  }
  Rig written(const Rig& rig, const std::string& name) {
    const auto text = rig_text(rig, show_, folder_.path(name));
    EXPECT_TRUE(text) << text.error().message;
    folder_.write(name, *text);
    return read(name);
  }

  ShowFolder folder_;
  Show show_;
};

void expect_same(const Rig& a, const Rig& b) {
  ASSERT_EQ(a.buses.size(), b.buses.size());
  for (std::size_t i = 0; i < a.buses.size(); ++i) {
    EXPECT_EQ(a.buses[i].name, b.buses[i].name);
    EXPECT_EQ(a.buses[i].kind, b.buses[i].kind);
    EXPECT_EQ(a.buses[i].url, b.buses[i].url);
    EXPECT_EQ(a.buses[i].bits_per_second, b.buses[i].bits_per_second);
    EXPECT_EQ(a.buses[i].supply, b.buses[i].supply);
    EXPECT_EQ(a.buses[i].profile, b.buses[i].profile);
    EXPECT_EQ(a.buses[i].line, b.buses[i].line);
    EXPECT_EQ(a.buses[i].fixture, b.buses[i].fixture);
  }
  ASSERT_EQ(a.supplies.size(), b.supplies.size());
  for (std::size_t i = 0; i < a.supplies.size(); ++i) EXPECT_EQ(a.supplies[i].limit_a, b.supplies[i].limit_a);
  EXPECT_EQ(a.currents, b.currents);
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  for (std::size_t i = 0; i < a.nodes.size(); ++i) {
    EXPECT_EQ(a.nodes[i].name, b.nodes[i].name);
    EXPECT_EQ(a.nodes[i].bus, b.nodes[i].bus);
    EXPECT_EQ(a.nodes[i].address, b.nodes[i].address);
    EXPECT_EQ(a.nodes[i].supply, b.nodes[i].supply);
    ASSERT_EQ(a.nodes[i].channels.size(), b.nodes[i].channels.size()) << a.nodes[i].name;
    for (std::size_t c = 0; c < a.nodes[i].channels.size(); ++c) {
      EXPECT_EQ(a.nodes[i].channels[c].kind, b.nodes[i].channels[c].kind);
      EXPECT_EQ(a.nodes[i].channels[c].cell, b.nodes[i].channels[c].cell);
      EXPECT_EQ(a.nodes[i].channels[c].performer, b.nodes[i].channels[c].performer);
    }
  }
}

constexpr const char* kRig =
    "# the floor of the school\n"
    "rig: 1\n"
    "buses:\n"
    "  - {name: \"left, 1\", url: \"can://can0\", supply: P1}\n"
    "  - name: r\n"
    "    url: rtu:///dev/ttyUSB0\n"
    "    profile: own.yaml\n"
    "    characters: 8N2\n"
    "    direction: gpio\n"
    "    direction_line: gpiochip0:17\n"
    "  - {name: s, url: sim://serial, bits_per_second: 57600}\n"
    "supplies:\n"
    "  - {name: P1, limit: 20 A, overload: dim}\n"
    "  - {name: P 2, limit: 500 mA, stagger: 20 ms, feeds: [{bus: s, first: 2, last: 2}]}\n"
    "lamps: {lamp: 60 mA, node: 5 mA}\n"
    "nodes:\n"
    "  - {name: \"7\", bus: r, address: 9, channels: [A1:B2, unused, H6], supply: \"P 2\"}\n"
    "  - {bus: s, address: 2, channels: [{wearable: W 1}, C3, D3, E3]}\n"
    "floor: {buses: [\"left, 1\", s], channels_per_node: 6}\n";

TEST_F(RigWriter, WhatItWritesReadsAsTheSameRig) {
  folder_.write("rig.yaml", kRig);

  folder_.write("own.yaml", read_file(FOOTLIGHT_SOURCE_DIR "/drivers/profiles/relay-16.yaml", 1 << 20).value());
  const Rig rig = read("rig.yaml");
  expect_same(written(rig, "out.yaml"), rig);
}

TEST_F(RigWriter, LampsThatHaveMovedAreWhereTheyAre) {
  folder_.write("rig.yaml", kRig);
  folder_.write("own.yaml", read_file(FOOTLIGHT_SOURCE_DIR "/drivers/profiles/relay-16.yaml", 1 << 20).value());
  Rig rig = read("rig.yaml");
  std::swap(rig.nodes[0].channels[0], rig.nodes[1].channels[2]);
  rig.nodes[2].channels[1] = {};
  expect_same(written(rig, "out.yaml"), rig);
}

TEST_F(RigWriter, AProfileBesideTheOldFileIsFoundFromAnotherFolder) {
  folder_.write("rig.yaml", kRig);
  folder_.write("own.yaml", read_file(FOOTLIGHT_SOURCE_DIR "/drivers/profiles/relay-16.yaml", 1 << 20).value());
  const Rig rig = read("rig.yaml");
  expect_same(written(rig, "there/out.yaml"), rig);
}

TEST_F(RigWriter, ARigThatWasMadeForTheStageIsWrittenWhole) {
  const Rig rig = make_simulated_rig(show_);
  expect_same(written(rig, "out.yaml"), rig);
}

TEST_F(RigWriter, RunsOfCellsOfOneRowAreRanges) {
  Node node;
  const auto cell = [&](int column, int row) {
    node.channels.push_back({Channel::Kind::cell, show_.stage.grid.index({column, row}), {}});
  };
  cell(0, 1);
  cell(1, 1);
  cell(2, 1);
  cell(4, 1);
  cell(5, 1);
  node.channels.emplace_back();
  cell(7, 1);
  cell(0, 2);
  node.channels.push_back({Channel::Kind::wearable, {}, PerformerIndex(1)});
  EXPECT_EQ(channels_text(node, show_), "A2:C2, E2, F2, unused, H2, A3, {wearable: \"W 1\"}");
}

TEST_F(RigWriter, AFileThatIsGoneIsSaid) {
  Rig rig = make_simulated_rig(show_);
  rig.file = folder_.path("gone.yaml").string();
  const auto text = rig_text(rig, show_, folder_.path("out.yaml"));
  ASSERT_FALSE(text);
  EXPECT_EQ(folder_.without_folder(text.error().message), "the file \"gone.yaml\" is missing");
}

}  // namespace
}  // namespace footlight::config
