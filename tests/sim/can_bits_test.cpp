// SPDX-License-Identifier: Apache-2.0
#include "sim/can_bits.hpp"

#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

namespace footlight::sim {
namespace {

using drivers::CanFrame;

/// Start of frame to the last data bit, one entry a bit, written from the standard.
std::vector<int> plain_bits(const CanFrame& frame) {
  std::vector<int> bits{0};
  for (int i = 10; i >= 0; --i) bits.push_back((frame.id >> i) & 1);
  bits.insert(bits.end(), {0, 0, 0});
  for (int i = 3; i >= 0; --i) bits.push_back((frame.length >> i) & 1);
  for (int byte = 0; byte < frame.length; ++byte) {
    for (int i = 7; i >= 0; --i) bits.push_back((frame.data[static_cast<std::size_t>(byte)] >> i) & 1);
  }
  return bits;
}

/// The shift register of ISO 11898-1, 10.4.2.6, literally.
int crc_bit_by_bit(const std::vector<int>& bits) {
  int crc = 0;
  for (const int bit : bits) {
    const int next = bit ^ ((crc >> 14) & 1);
    crc = (crc << 1) & 0x7FFF;
    if (next != 0) crc ^= 0x4599;
  }
  return crc;
}

int stuff_bit_by_bit(std::vector<int> bits, int crc) {
  for (int i = 14; i >= 0; --i) bits.push_back((crc >> i) & 1);
  int stuffed = 0;
  int last = -1;
  int run = 0;
  for (const int bit : bits) {
    run = bit == last ? run + 1 : 1;
    last = bit;
    if (run == 5) {
      ++stuffed;
      last = 1 - bit;
      run = 1;
    }
  }
  return stuffed;
}

TEST(CanBits, AFrameOfZerosAloneHasAStuffBitAfterEachFive) {
  const CanFrame nothing{0x000, 0, {}};
  // 19 bits before the data and 15 of a CRC that is 0: 34 zeros, six whole fives in them.
  EXPECT_EQ(can_crc(nothing), 0);
  EXPECT_EQ(can_stuff_bits(nothing), 6);
  EXPECT_EQ(can_frame_bits(nothing), 34 + 6 + 10);
}

TEST(CanBits, ZerosInTheDataGoOnWithTheRun) {
  const CanFrame start_all{0x000, 2, {0x01, 0x00}};
  // 0000 0000 0000 000 0010 | 0000 0001 | 0000 0000 | CRC by the shift register on paper: the run of zeros before the
  // length holds three stuff bits; the rest is compared with the register bit by bit.
  EXPECT_EQ(can_crc(start_all), crc_bit_by_bit(plain_bits(start_all)));
  EXPECT_EQ(can_stuff_bits(start_all), stuff_bit_by_bit(plain_bits(start_all), can_crc(start_all)));
}

TEST(CanBits, TheWorstFrameIsThatOfTheLiterature) {
  // Davis, Burns, Bril, Lukkien 2007: 135 bits with eight bytes, 55 with none, inter-frame space included.
  EXPECT_EQ(can_worst_frame_bits(8) + kCanInterframeBits, 135);
  EXPECT_EQ(can_worst_frame_bits(0) + kCanInterframeBits, 55);
}

TEST(CanBits, TablesAgreeWithTheRegisterBitByBitForAnyFrame) {
  EXPECT_TRUE(rc::check([] {
    CanFrame frame;
    frame.id = *rc::gen::inRange<std::uint16_t>(0, 0x800);
    frame.length = *rc::gen::inRange<std::uint8_t>(0, 9);
    const bool sparse = *rc::gen::arbitrary<bool>();
    for (auto& byte : frame.data) {
      byte = sparse ? *rc::gen::element<std::uint8_t>(0x00, 0xFF, 0x1F, 0x80) : *rc::gen::arbitrary<std::uint8_t>();
    }
    const auto bits = plain_bits(frame);
    const int crc = crc_bit_by_bit(bits);
    RC_ASSERT(can_crc(frame) == crc);
    RC_ASSERT(can_stuff_bits(frame) == stuff_bit_by_bit(bits, crc));
    RC_ASSERT(can_frame_bits(frame) <= can_worst_frame_bits(frame.length));
  }));
}

}  // namespace
}  // namespace footlight::sim
