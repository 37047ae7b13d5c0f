// SPDX-License-Identifier: Apache-2.0
#include "drivers/devices/footlight_serial/serial_frame.hpp"

#include <numeric>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"
#include "drivers/devices/footlight_serial/cobs.hpp"

namespace footlight::drivers::footlight_serial {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes counting(std::size_t from, std::size_t count) {
  Bytes bytes(count);
  for (std::size_t i = 0; i < count; ++i) bytes[i] = static_cast<std::uint8_t>(from + i);
  return bytes;
}

Bytes joined(std::initializer_list<Bytes> parts) {
  Bytes all;
  for (const Bytes& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

TEST(Cobs, GivesTheKnownAnswers) {
  EXPECT_EQ(cobs_encode(Bytes{}), (Bytes{1}));
  EXPECT_EQ(cobs_encode(Bytes{0}), (Bytes{1, 1}));
  EXPECT_EQ(cobs_encode(Bytes{0, 0}), (Bytes{1, 1, 1}));
  EXPECT_EQ(cobs_encode(Bytes{0x11, 0x22, 0x00, 0x33}), (Bytes{3, 0x11, 0x22, 2, 0x33}));
  EXPECT_EQ(cobs_encode(Bytes{0x11, 0, 0, 0}), (Bytes{2, 0x11, 1, 1, 1}));
}

TEST(Cobs, ARunOf254BytesTakesNoZeroWithIt) {
  const Bytes run = counting(1, 254);  // 0x01 .. 0xFE
  EXPECT_EQ(cobs_encode(run), joined({{0xFF}, run}));
  EXPECT_EQ(cobs_encode(joined({{0}, run})), joined({{1, 0xFF}, run}));
  EXPECT_EQ(cobs_encode(joined({run, {0xFF}})), joined({{0xFF}, run, {2, 0xFF}}));
  EXPECT_EQ(cobs_encode(joined({run, {0}})), joined({{0xFF}, run, {1, 1}}));
}

TEST(Cobs, DecodesWhatItEncodesAndLeavesNoZero) {
  EXPECT_TRUE(rc::check([](const Bytes& bytes, std::uint8_t zeros) {
    Bytes input = bytes;
    input.insert(input.end(), zeros, 0);
    input.insert(input.end(), bytes.begin(), bytes.end());
    const Bytes encoded = cobs_encode(input);
    RC_ASSERT(std::find(encoded.begin(), encoded.end(), std::uint8_t{0}) == encoded.end());
    RC_ASSERT(encoded.size() <= input.size() + input.size() / 254 + 1);
    RC_ASSERT(cobs_decode(encoded) == input);
  }));
}

TEST(Cobs, RoundTripsAroundTheLongestRun) {
  for (std::size_t count = 250; count < 262; ++count) {
    const Bytes input(count, 0x55);
    EXPECT_EQ(cobs_decode(cobs_encode(input)), input) << count;
  }
}

TEST(Cobs, RefusesWhatNoEncoderMakes) {
  EXPECT_EQ(cobs_decode(Bytes{}), std::nullopt);
  EXPECT_EQ(cobs_decode(Bytes{3, 0x11}), std::nullopt);
  EXPECT_EQ(cobs_decode(Bytes{2, 0x00}), std::nullopt);
  EXPECT_EQ(cobs_decode(Bytes{0}), std::nullopt);
}

std::vector<Frame> receive(FrameReceiver& receiver, const Bytes& bytes) {
  std::vector<Frame> frames;
  for (const std::uint8_t byte : bytes) {
    if (auto frame = receiver.take(byte)) frames.push_back(*std::move(frame));
  }
  return frames;
}

Frame answer(std::uint8_t address, Bytes body) {
  return {Direction::from_node, Command::status, address, 0xA3, 17, std::move(body)};
}

TEST(FrameReceiver, TakesFramesWithOneDelimiterBetweenThem) {
  Bytes bytes = encode(answer(1, counting(0, 8)));
  bytes.pop_back();
  const Bytes second = encode(answer(2, {}));
  FrameReceiver receiver;
  const auto frames = receive(receiver, joined({bytes, second}));
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0], answer(1, counting(0, 8)));
  EXPECT_EQ(frames[1], answer(2, {}));
  EXPECT_EQ(receiver.dropped(), 0U);
}

TEST(FrameReceiver, IgnoresEmptyFrames) {
  FrameReceiver receiver;
  EXPECT_EQ(receive(receiver, joined({{0, 0, 0, 0}, encode(answer(1, {}))})).size(), 1U);
  EXPECT_EQ(receiver.dropped(), 0U);
}

TEST(FrameReceiver, IsInStepAfterTheNextDelimiterWhateverItHeard) {
  Rng rng(1);
  const Bytes frame = encode(answer(9, counting(0, 40)));
  for (int round = 0; round < 2'000; ++round) {
    FrameReceiver receiver;
    Bytes garbage(rng.below(300));
    for (auto& byte : garbage) byte = static_cast<std::uint8_t>(rng.below(256));
    receive(receiver, garbage);
    const auto frames = receive(receiver, frame);
    ASSERT_EQ(frames.size(), 1U) << round;
    ASSERT_EQ(frames[0], answer(9, counting(0, 40)));
  }
}

TEST(FrameReceiver, TakesTheLongestFrameAndDropsALongerOne) {
  FrameReceiver receiver;
  EXPECT_EQ(receive(receiver, encode(answer(9, Bytes(kLongestBody, 1)))).size(), 1U);
  const Bytes endless(1'000'000, 0x41);
  EXPECT_TRUE(receive(receiver, endless).empty());
  EXPECT_TRUE(receive(receiver, {0}).empty());
  EXPECT_EQ(receiver.dropped(), 1U);
  EXPECT_EQ(receive(receiver, encode(answer(9, {}))).size(), 1U);
}

TEST(FrameReceiver, NoFlippedBitPasses) {
  const Bytes good = encode(answer(7, counting(1, 8)));
  for (std::size_t bit = 8; bit < 8 * (good.size() - 1); ++bit) {
    Bytes bad = good;
    bad[bit / 8] = static_cast<std::uint8_t>(bad[bit / 8] ^ (1U << (bit % 8)));
    FrameReceiver receiver;
    EXPECT_TRUE(receive(receiver, bad).empty()) << "bit " << bit;
  }
}

TEST(FrameReceiver, DropsWrongVersionsAndCommandsOfRightCheckSum) {
  FrameReceiver receiver;
  Frame strange = answer(7, {});
  strange.direction = static_cast<Direction>(0x82);
  EXPECT_TRUE(receive(receiver, encode(strange)).empty());
  strange = answer(7, {});
  strange.command = static_cast<Command>(15);
  EXPECT_TRUE(receive(receiver, encode(strange)).empty());
  EXPECT_EQ(receiver.dropped(), 2U);
}

TEST(SerialFrame, LengthIsKnownBeforeTheContent) {
  for (std::size_t body = 0; body <= kLongestBody; ++body) {
    EXPECT_EQ(encode(answer(7, Bytes(body, 0))).size(), frame_length(body));
    EXPECT_EQ(encode(answer(7, Bytes(body, 1))).size(), frame_length(body));
  }
}

TEST(SerialFrame, AnswersOfTheWrongLengthAreNone) {
  EXPECT_FALSE(decode_status(answer(7, counting(0, 7))));
  EXPECT_FALSE(decode_status(answer(7, counting(0, 9))));
  EXPECT_TRUE(decode_status(answer(7, counting(0, 8))));
  Frame receipt = answer(7, counting(0, 2));
  EXPECT_FALSE(decode_receipt(receipt)) << "a status is no receipt";
  receipt.command = Command::preload;
  EXPECT_TRUE(decode_receipt(receipt));
  receipt.direction = Direction::from_controller;
  EXPECT_FALSE(decode_receipt(receipt)) << "our own echo is no receipt";
}

}  // namespace
}  // namespace footlight::drivers::footlight_serial
