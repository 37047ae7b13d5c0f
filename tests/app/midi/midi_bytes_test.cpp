// SPDX-License-Identifier: Apache-2.0
#include "app/midi/midi_bytes.hpp"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/rng.hpp"

namespace footlight::app {
namespace {

using Bytes = std::vector<std::uint8_t>;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<Bytes> messages_of(MidiBytes& stream, const Bytes& bytes) {
  std::vector<Bytes> messages;
  for (const std::uint8_t byte : bytes) {
    const auto message = stream.take(byte);
    if (!message.empty()) messages.emplace_back(message.begin(), message.end());
  }
  return messages;
}

TEST(MidiBytes, RunningStatusIsWrittenOut) {
  MidiBytes stream;
  EXPECT_THAT(messages_of(stream, {0x90, 60, 100, 60, 0, 0xC1, 7, 8}),
              ElementsAre(Bytes{0x90, 60, 100}, Bytes{0x90, 60, 0}, Bytes{0xC1, 7}, Bytes{0xC1, 8}));
}

TEST(MidiBytes, SystemCommonHasItsOwnLengthsAndEndsRunningStatus) {
  MidiBytes stream;
  EXPECT_THAT(messages_of(stream, {0xF1, 0x23, 0x24, 0xF2, 1, 2, 3, 0xF6, 0xF3, 5, 0xF5, 9}),
              ElementsAre(Bytes{0xF1, 0x23}, Bytes{0xF2, 1, 2}, Bytes{0xF6}, Bytes{0xF3, 5}));
  EXPECT_EQ(stream.lost(), 0U);
}

TEST(MidiBytes, ExclusiveMayComeInPiecesWithTheClockInBetween) {
  MidiBytes stream;
  EXPECT_THAT(messages_of(stream, {0xF0, 0x7F, 0x7F}), IsEmpty());
  EXPECT_THAT(messages_of(stream, {0xF8, 0x02, 0x01}), ElementsAre(Bytes{0xF8}));
  EXPECT_THAT(messages_of(stream, {0x01, 0xF7}), ElementsAre(Bytes{0xF0, 0x7F, 0x7F, 0x02, 0x01, 0x01, 0xF7}));
}

TEST(MidiBytes, WhatIsCutOffByAnotherStatusIsLostAndTheOtherIsHeard) {
  MidiBytes stream;
  EXPECT_THAT(messages_of(stream, {0xF0, 1, 2, 0x90, 60, 1, 0x90, 61, 0xB0, 1, 2}),
              ElementsAre(Bytes{0x90, 60, 1}, Bytes{0xB0, 1, 2}));
  EXPECT_EQ(stream.lost(), 2U);
}

TEST(MidiBytes, ExclusiveThatNeverEndsCostsNothingButItself) {
  MidiBytes stream;
  Bytes bytes{0xF0};
  bytes.resize(100'000, 0x11);
  bytes.push_back(0xF7);
  EXPECT_THAT(messages_of(stream, bytes), IsEmpty());
  EXPECT_EQ(stream.lost(), 1U);
  EXPECT_THAT(messages_of(stream, {0xF0, 5, 0xF7}), ElementsAre(Bytes{0xF0, 5, 0xF7}));
}

TEST(MidiBytes, TheLongestExclusiveIsWhole) {
  for (const std::size_t size : {kLongestMidiMessage, kLongestMidiMessage + 1}) {
    MidiBytes stream;
    Bytes bytes(size, 0x11);
    bytes.front() = 0xF0;
    bytes.back() = 0xF7;
    EXPECT_EQ(messages_of(stream, bytes).size(), size == kLongestMidiMessage ? 1U : 0U) << size;
    EXPECT_EQ(stream.lost(), size == kLongestMidiMessage ? 0U : 1U) << size;
  }
}

TEST(MidiBytes, WhateverComesEveryMessageIsWellFormed) {
  Rng rng(4);
  MidiBytes stream;
  for (int i = 0; i < 300'000; ++i) {
    const auto message = stream.take(static_cast<std::uint8_t>(rng.below(256)));
    if (message.empty()) continue;
    ASSERT_GE(message[0], 0x80);
    const bool exclusive = message[0] == 0xF0;
    for (std::size_t b = 1; b < message.size() - (exclusive ? 1 : 0); ++b) ASSERT_LT(message[b], 0x80);
    ASSERT_TRUE(!exclusive || message.back() == 0xF7);
  }
}

}  // namespace
}  // namespace footlight::app
