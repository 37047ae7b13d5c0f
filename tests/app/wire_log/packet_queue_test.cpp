// SPDX-License-Identifier: Apache-2.0
#include <sstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/wire_log/wire_recorder.hpp"
#include "tests/support/temporary_folder.hpp"

namespace footlight::app {
namespace {

using Bytes = std::vector<std::uint8_t>;

TEST(PacketQueue, GivesPacketsInTheirOrderAroundItsEnd) {
  PacketQueue queue(64);
  PacketQueue::Packet packet;
  for (std::uint8_t i = 0; i < 50; ++i) {
    ASSERT_TRUE(queue.push(kStart + Duration(i), Heading::received, Bytes(i % 20, i)));
    ASSERT_TRUE(queue.pop(packet));
    EXPECT_EQ(packet.at, kStart + Duration(i));
    EXPECT_EQ(packet.heading, Heading::received);
    EXPECT_EQ(packet.bytes, Bytes(i % 20, i));
  }
  EXPECT_FALSE(queue.pop(packet));
}

TEST(PacketQueue, WhatDoesNotFitIsRefusedAsAWhole) {
  PacketQueue queue(64);
  EXPECT_FALSE(queue.push(kStart, Heading::sent, Bytes(60)));
  EXPECT_TRUE(queue.push(kStart, Heading::sent, Bytes(51, 7)));
  EXPECT_FALSE(queue.push(kStart, Heading::sent, Bytes{}));
  PacketQueue::Packet packet;
  ASSERT_TRUE(queue.pop(packet));
  EXPECT_EQ(packet.bytes, Bytes(51, 7));
  EXPECT_TRUE(queue.push(kStart, Heading::sent, Bytes{})) << "there is room again";
}

TEST(PacketQueue, TwoThreadsLoseAndInventNothing) {
  PacketQueue queue(1024);
  constexpr int kPackets = 20'000;
  std::thread writer([&] {
    for (int i = 0; i < kPackets;) {
      const Bytes bytes(static_cast<std::size_t>(i % 100), static_cast<std::uint8_t>(i));
      if (queue.push(kStart + Duration(i), Heading::sent, bytes)) ++i;
    }
  });
  PacketQueue::Packet packet;
  for (int i = 0; i < kPackets;) {
    if (!queue.pop(packet)) continue;
    ASSERT_EQ(packet.at, kStart + Duration(i));
    ASSERT_EQ(packet.bytes, Bytes(static_cast<std::size_t>(i % 100), static_cast<std::uint8_t>(i)));
    ++i;
  }
  writer.join();
}

Rig rig_of_one_bus() {
  Rig rig;
  rig.buses.push_back({"left", BusKind::can, "can://can0", 500'000, std::nullopt, {}});
  return rig;
}

TEST(WireRecorder, AFullQueueCostsPacketsAndNothingElse) {
  const ManualClock clock;
  std::ostringstream file;
  auto recorder = WireRecorder::open(rig_of_one_bus(), {{}, &file}, clock);
  ASSERT_TRUE(recorder);
  for (int i = 0; i < 100; ++i) (*recorder)->record(0, Heading::sent, Bytes(100'000));
  (*recorder)->close();
  EXPECT_GT((*recorder)->dropped(), 0U);
  EXPECT_GT(file.str().size(), 200'000U);
}

TEST(WireRecorder, KeepsElevenPiecesAndGoesOnCounting) {
  const test::TemporaryFolder folder;
  const ManualClock clock;
  for (int i = 0; i < 14; ++i) {
    ASSERT_TRUE(WireRecorder::open(rig_of_one_bus(), {folder.path() / "wires", nullptr}, clock));
  }
  folder.write("wires/notes.txt", "mine");
  const auto pieces = ring_pieces(folder.path() / "wires");
  ASSERT_EQ(pieces.size(), WireRecorder::kPieces);
  EXPECT_EQ(pieces.front().filename(), "wires-000004.pcapng");
  EXPECT_EQ(pieces.back().filename(), "wires-000014.pcapng");
}

TEST(WireRecorder, AFolderThatCannotBeMadeIsNamed) {
  const test::TemporaryFolder folder;
  folder.write("file", "");
  const ManualClock clock;
  const auto refused = WireRecorder::open(rig_of_one_bus(), {folder.path() / "file" / "wires", nullptr}, clock);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, ::testing::StartsWith("cannot write the wire logs in '" +
                                                             (folder.path() / "file" / "wires").string() + "': "));
}

}  // namespace
}  // namespace footlight::app
