// SPDX-License-Identifier: Apache-2.0
#include "core/patch.hpp"

#include <gtest/gtest.h>

namespace footlight {
namespace {

Node node_of(int address, std::vector<Channel> channels) {
  return {"left-1", BusIndex(0), address, std::move(channels), {}};
}

Channel lamp(std::size_t cell) { return {Channel::Kind::cell, CellIndex::of(cell), {}}; }
Channel worn(std::size_t performer) { return {Channel::Kind::wearable, {}, PerformerIndex::of(performer)}; }

TEST(PatchCheck, IsThatOfTheAddressAndOfEveryChannelAndNothingElse) {
  const Node node = node_of(3, {lamp(5), lamp(6), worn(2), {}});
  const std::uint32_t check = patch_check(node);
  EXPECT_NE(check, 0U);
  Node renamed = node;
  renamed.name = "front";
  renamed.supply = "psu-1";
  renamed.bus = BusIndex(4);
  EXPECT_EQ(patch_check(renamed), check) << "what a node is called changes no lamp";
  EXPECT_NE(patch_check(node_of(4, node.channels)), check);
  EXPECT_NE(patch_check(node_of(3, {lamp(6), lamp(5), worn(2), {}})), check) << "exchanged";
  EXPECT_NE(patch_check(node_of(3, {lamp(5), lamp(6), worn(3), {}})), check);
  EXPECT_NE(patch_check(node_of(3, {lamp(5), lamp(6), lamp(2), {}})), check);
  EXPECT_NE(patch_check(node_of(3, {lamp(5), lamp(6), worn(2)})), check) << "a channel less";
}

TEST(PatchCheck, IsAsDocumented) {
  // python3: hashlib.sha256(struct.pack("<9q", 3, 1, 5, 1, 6, 2, 2, 0, 0)).hexdigest()[:8]
  EXPECT_EQ(patch_check(node_of(3, {lamp(5), lamp(6), worn(2), {}})), 0xE60A9088U);
}

}  // namespace
}  // namespace footlight
