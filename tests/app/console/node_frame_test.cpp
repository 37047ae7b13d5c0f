// SPDX-License-Identifier: Apache-2.0
#include "app/console/node_frame.hpp"

#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"

namespace footlight::app {
namespace {

std::uint32_t word(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// What a page does with a frame.
void take(const std::string& frame, std::vector<NodeBoard::View>& nodes) {
  ASSERT_GE(frame.size(), 8U);
  ASSERT_EQ(frame[0], 1);
  if ((frame[1] & 1) != 0) nodes.assign(nodes.size(), {});
  const std::uint32_t runs = word(frame, 4);
  ASSERT_EQ(frame.size(), 8 + runs * 16U);
  for (std::uint32_t r = 0; r < runs; ++r) {
    const std::size_t at = 8 + r * 16U;
    for (std::uint32_t n = 0; n < word(frame, at + 4); ++n) {
      nodes.at(word(frame, at) + n) = {word(frame, at + 8), word(frame, at + 12)};
    }
  }
}

TEST(NodeFrame, AClientThatTakesEveryFrameHasTheBoard) {
  EXPECT_TRUE(rc::check("frames applied give the board", [] {
    const auto size = *rc::gen::inRange<std::size_t>(0, 40);
    NodeBoard board(size);
    NodeNews news;
    std::vector<NodeBoard::View> page(size);
    const auto rounds = *rc::gen::inRange(1, 6);
    for (int round = 0; round < rounds; ++round) {
      for (std::size_t n = 0; n < size; ++n) {
        if (*rc::gen::inRange(0, 3) == 0) board.put(n, {*rc::gen::inRange(0U, 3U), *rc::gen::inRange(0U, 16U)});
      }
      if (const auto frame = news.frame(board)) take(*frame, page);
      for (std::size_t n = 0; n < size; ++n) RC_ASSERT(page[n] == board.at(n));
      RC_ASSERT(!news.frame(board));
    }
  }));
}

TEST(NodeFrame, TheFirstOneTellsOfAll) {
  NodeBoard board(3);
  NodeNews news;
  const auto first = news.frame(board);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->size(), 24U);
  EXPECT_EQ((*first)[1], 1);
  EXPECT_EQ(word(*first, 16), NodeBoard::kNothingYet);
  board.put(1, {7, NodeBoard::kRight});
  const auto second = news.frame(board);
  ASSERT_TRUE(second);
  EXPECT_EQ((*second)[1], 0);
  EXPECT_EQ(word(*second, 4), 1U);
  EXPECT_EQ(word(*second, 8), 1U);
  EXPECT_EQ(word(*second, 16), 7U);
}

TEST(NodeFrame, AHundredThousandMarkersOfOneMindAre24Bytes) {
  constexpr std::size_t kNodes = 100'000 / 32;
  NodeBoard board(kNodes);
  NodeNews news;
  (void)news.frame(board);
  for (std::size_t n = 0; n < kNodes; ++n) board.put(n, {1, NodeBoard::kRight});
  EXPECT_EQ(news.frame(board)->size(), 24U);
  // The worst case: every second node has confirmed the next switch.
  for (std::size_t n = 0; n < kNodes; n += 2) board.put(n, {2, NodeBoard::kRight});
  EXPECT_EQ(news.frame(board)->size(), 8 + (kNodes + 1) / 2 * 16);
}

}  // namespace
}  // namespace footlight::app
