// SPDX-License-Identifier: Apache-2.0
#include "sim/endpoints/rtu_framing.hpp"

#include <gtest/gtest.h>

#include "sim/markers/check_sums.hpp"

namespace footlight::sim {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes with_check_sum(Bytes bytes) {
  const std::uint16_t check = crc16_modbus(bytes);
  bytes.push_back(static_cast<std::uint8_t>(check & 0xFFU));
  bytes.push_back(static_cast<std::uint8_t>(check >> 8U));
  return bytes;
}

const Bytes kRead = with_check_sum({1, 3, 0, 0x40, 0, 6});
const Bytes kWrite = with_check_sum({1, 0x10, 0, 0, 0, 2, 4, 0, 1, 2, 3});

TEST(RtuFraming, AFrameThatComesInPiecesIsWholeWithItsLastByte) {
  RtuFraming framing;
  for (std::size_t i = 0; i < kWrite.size(); ++i) {
    EXPECT_EQ(framing.next(kStart), std::nullopt) << "after " << i << " bytes";
    framing.take(std::span(kWrite).subspan(i, 1), kStart);
  }
  EXPECT_EQ(framing.next(kStart), kWrite);
  EXPECT_EQ(framing.silence_at(), kNever);
}

TEST(RtuFraming, TwoFramesThatComeAtOnceAreTwo) {
  RtuFraming framing;
  Bytes both = kRead;
  both.insert(both.end(), kWrite.begin(), kWrite.end());
  framing.take(both, kStart);
  EXPECT_EQ(framing.next(kStart), kRead);
  EXPECT_EQ(framing.next(kStart), kWrite);
  EXPECT_EQ(framing.next(kStart), std::nullopt);
}

TEST(RtuFraming, WhatHasAWrongCheckSumOrNoKnownLengthEndsWithSilence) {
  Bytes wrong = kRead;
  wrong.back() ^= 1U;
  for (const Bytes& frame : {wrong, with_check_sum({1, 0x41, 7}), Bytes{0xFF}}) {
    RtuFraming framing;
    framing.take(frame, kStart);
    EXPECT_EQ(framing.next(kStart + RtuFraming::kSilence - Duration(1)), std::nullopt);
    EXPECT_EQ(framing.silence_at(), kStart + RtuFraming::kSilence);
    EXPECT_EQ(framing.next(kStart + RtuFraming::kSilence), frame);
  }
}

TEST(RtuFraming, AGarbledFrameDoesNotTakeTheNextOneAlongWhenSilenceIsBetween) {
  RtuFraming framing;
  Bytes cut(kRead.begin(), kRead.end() - 3);
  framing.take(cut, kStart);
  const Instant later = kStart + RtuFraming::kSilence;
  EXPECT_EQ(framing.next(later), cut);
  framing.take(kRead, later);
  EXPECT_EQ(framing.next(later), kRead);
}

TEST(RtuFraming, EndlessNoiseIsHandedOnInPiecesAsLongAsAFrame) {
  RtuFraming framing;
  framing.take(Bytes(1000, 0x55), kStart);
  const auto piece = framing.next(kStart);
  ASSERT_TRUE(piece);
  EXPECT_EQ(piece->size(), 256U);
}

}  // namespace
}  // namespace footlight::sim
