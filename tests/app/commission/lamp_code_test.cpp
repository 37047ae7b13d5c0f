// SPDX-License-Identifier: Apache-2.0
#include "app/commission/lamp_code.hpp"

#include <bit>
#include <set>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "app/commission/lamps.hpp"

namespace footlight::app {
namespace {

using Outcome = LampCode::Outcome;

std::vector<double> contrasts_of(const LampCode& code, std::size_t lamp, double size = 1) {
  std::vector<double> out;
  for (int b = 0; b < code.bits(); ++b) out.push_back(code.bit(lamp, b) ? size : -size);
  return out;
}

TEST(LampCode, ItsCheckIsTheCatalogueCrc) {
  // CRC-8/AUTOSAR without its inversions: "123456789" gives 0xDF with start and final xor 0xFF.
  std::uint8_t crc = 0xFF;
  for (const char c : std::string("123456789")) crc = crc8_bits(static_cast<unsigned char>(c), 8, crc);
  EXPECT_EQ(crc ^ 0xFF, 0xDF);
}

TEST(LampCode, EveryLampIsReadFromItsWord) {
  EXPECT_TRUE(rc::check([] {
    const auto lamps = *rc::gen::inRange<std::size_t>(1, 20'000);
    const LampCode code(lamps, static_cast<std::uint8_t>(*rc::gen::inRange(0, 256)));
    const auto lamp = *rc::gen::inRange<std::size_t>(0, lamps);
    const auto read = code.read(contrasts_of(code, lamp));
    RC_ASSERT(read.outcome == Outcome::exact);
    RC_ASSERT(read.lamp == lamp);
  }));
}

TEST(LampCode, WordsDifferInFourBitsAtLeast) {
  for (const std::size_t lamps : {2U, 3U, 12U, 1000U, 1024U, 4023U}) {
    const LampCode code(lamps, 0x5A);
    std::vector<std::uint32_t> words;
    for (std::size_t i = 0; i < lamps; ++i) words.push_back(code.word(i));
    int least = 32;
    for (std::size_t i = 0; i < lamps; ++i) {
      for (std::size_t j = i + 1; j < lamps; ++j) least = std::min(least, std::popcount(words[i] ^ words[j]));
    }
    EXPECT_GE(least, 4) << lamps;
  }
}

TEST(LampCode, AboutHalfOfTheLampsShineInEveryBitOfTheNumber) {
  for (const std::size_t lamps : {33U, 900U, 1025U, 4023U}) {
    const LampCode code(lamps, 0);
    for (int b = 0; b < code.bits() - LampCode::kCheckBits; ++b) {
      std::size_t lit = 0;
      for (std::size_t i = 0; i < lamps; ++i) lit += code.bit(i, b) ? 1 : 0;
      const double share = static_cast<double>(lit) / static_cast<double>(lamps);
      EXPECT_GT(share, 0.3) << lamps << " lamps, bit " << b;
      EXPECT_LT(share, 0.7) << lamps << " lamps, bit " << b;
    }
  }
}

TEST(LampCode, OneWeakBitIsPutRight) {
  EXPECT_TRUE(rc::check([] {
    const auto lamps = *rc::gen::inRange<std::size_t>(2, 15'000);
    const LampCode code(lamps, 7);
    const auto lamp = *rc::gen::inRange<std::size_t>(0, lamps);
    auto contrasts = contrasts_of(code, lamp);
    double& bit = contrasts[*rc::gen::inRange<std::size_t>(0, contrasts.size())];
    bit *= -0.2;
    const auto read = code.read(contrasts);
    RC_ASSERT(read.outcome == Outcome::corrected);
    RC_ASSERT(read.lamp == lamp);
  }));
}

TEST(LampCode, StrongBitsThatAreWrongAreNotBelieved) {
  EXPECT_TRUE(rc::check([] {
    const auto lamps = *rc::gen::inRange<std::size_t>(2, 15'000);
    const LampCode code(lamps, 7);
    const auto lamp = *rc::gen::inRange<std::size_t>(0, lamps);
    auto contrasts = contrasts_of(code, lamp);
    const auto wrong = *rc::gen::unique<std::vector<std::size_t>>(*rc::gen::inRange<std::size_t>(1, 4),
                                                                  rc::gen::inRange<std::size_t>(0, contrasts.size()));
    for (const std::size_t bit : wrong) contrasts[bit] *= -1;
    RC_ASSERT(code.read(contrasts).outcome == Outcome::wrong);
  }));
}

TEST(LampCode, WordsOfAnotherRigAreNotRead) {
  const LampCode ours(500, 0x12);
  const LampCode theirs(500, 0x13);
  for (std::size_t lamp = 0; lamp < 500; ++lamp) {
    EXPECT_EQ(ours.read(contrasts_of(theirs, lamp)).outcome, Outcome::wrong);
  }
}

}  // namespace
}  // namespace footlight::app
