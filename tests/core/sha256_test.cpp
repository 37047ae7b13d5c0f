// SPDX-License-Identifier: Apache-2.0
#include "core/sha256.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace footlight {
namespace {

std::string sum_of(std::string_view text) {
  Sha256 sum;
  sum.bytes({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  return sum.hex();
}

TEST(Sha256, AgreesWithTheExamplesOfTheStandard) {
  EXPECT_EQ(sum_of(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sum_of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Sha256, TextsThatJoinToTheSameLettersDiffer) {
  EXPECT_NE(Sha256().text("ab").text("c").hex(), Sha256().text("a").text("bc").hex());
}

TEST(Sha256, BothZerosAreOneNumber) {
  EXPECT_EQ(Sha256().real(0.0).hex(), Sha256().real(-0.0).hex());
  EXPECT_NE(Sha256().real(0.0).hex(), Sha256().real(std::numeric_limits<double>::denorm_min()).hex());
}

}  // namespace
}  // namespace footlight
