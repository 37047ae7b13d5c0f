// SPDX-License-Identifier: Apache-2.0
#include "sim/markers/sdo_server.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "can_frame.hpp"

namespace footlight::sim {
namespace {

/// Node 5 with ten channels and serial number 0xCAFE0102.
struct SdoServerTest : ::testing::Test {
  SdoServerTest() { model.power_on(kStart); }
  drivers::CanFrame ask(std::initializer_list<int> bytes) {
    const auto request = frame(0x605, bytes);
    const auto answer = server.answer(std::span(request.data).first<8>(), kStart);
    return answer.value_or(drivers::CanFrame{});
  }
  NodeModel model{10, true};
  CanopenObjects::Counters counters;
  CanopenObjects objects{5, 0xCAFE0102, model, counters};
  SdoServer server{5, objects};
};

TEST_F(SdoServerTest, UpToFourBytesAreReadInOneAnswer) {
  EXPECT_EQ(ask({0x40, 0x18, 0x10, 4, 0, 0, 0, 0}), frame(0x585, {0x43, 0x18, 0x10, 4, 0x02, 0x01, 0xFE, 0xCA}));
  EXPECT_EQ(ask({0x40, 0x17, 0x10, 0, 0, 0, 0, 0}), frame(0x585, {0x4B, 0x17, 0x10, 0, 0xE8, 0x03, 0, 0}));
  EXPECT_EQ(ask({0x40, 0x03, 0x21, 0, 0, 0, 0, 0}), frame(0x585, {0x4F, 0x03, 0x21, 0, 10, 0, 0, 0}));
}

TEST_F(SdoServerTest, ALongTextComesInSegmentsOfSeven) {
  EXPECT_EQ(ask({0x40, 0x08, 0x10, 0, 0, 0, 0, 0}), frame(0x585, {0x41, 0x08, 0x10, 0, 16, 0, 0, 0}));
  EXPECT_EQ(ask({0x60, 0, 0, 0, 0, 0, 0, 0}), frame(0x585, {0x00, 'F', 'o', 'o', 't', 'l', 'i', 'g'}));
  EXPECT_EQ(ask({0x70, 0, 0, 0, 0, 0, 0, 0}), frame(0x585, {0x10, 'h', 't', ' ', 'm', 'a', 'r', 'k'}));
  EXPECT_EQ(ask({0x60, 0, 0, 0, 0, 0, 0, 0}), frame(0x585, {0x0B, 'e', 'r', 0, 0, 0, 0, 0})) << "five bytes are unused";
  EXPECT_EQ(ask({0x70, 0, 0, 0, 0, 0, 0, 0}), frame(0x585, {0x80, 0x08, 0x10, 0, 0x01, 0x00, 0x04, 0x05}))
      << "it is over";
}

TEST_F(SdoServerTest, ARepeatedToggleBitIsAnAbort) {
  ask({0x40, 0x08, 0x10, 0, 0, 0, 0, 0});
  ask({0x60, 0, 0, 0, 0, 0, 0, 0});
  EXPECT_EQ(ask({0x60, 0, 0, 0, 0, 0, 0, 0}), frame(0x585, {0x80, 0x08, 0x10, 0, 0x00, 0x00, 0x03, 0x05}));
}

TEST_F(SdoServerTest, WritesExpeditedAndInSegments) {
  EXPECT_EQ(ask({0x23, 0x00, 0x21, 7, 0x30, 0x20, 0x10, 0}), frame(0x585, {0x60, 0x00, 0x21, 7, 0, 0, 0, 0}));
  EXPECT_EQ(model.look(7).colour, (Colour{0x10, 0x20, 0x30}));
  EXPECT_EQ(ask({0x2B, 0x01, 0x21, 7, 2, 200, 0, 0}), frame(0x585, {0x60, 0x01, 0x21, 7, 0, 0, 0, 0}));
  EXPECT_EQ(model.look(7).brightness, 200);
  EXPECT_EQ(ask({0x21, 0x00, 0x21, 8, 4, 0, 0, 0}), frame(0x585, {0x60, 0x00, 0x21, 8, 0, 0, 0, 0}));
  EXPECT_EQ(ask({0x07, 3, 2, 1, 0, 0, 0, 0}), frame(0x585, {0x20, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(model.look(8).colour, (Colour{1, 2, 3}));
}

TEST_F(SdoServerTest, EveryRefusalHasItsAbortCode) {
  const auto code = [&](std::initializer_list<int> bytes) {
    const auto answer = ask(bytes);
    EXPECT_EQ(answer.data[0], 0x80);
    return answer.data[4] | (answer.data[5] << 8) | (answer.data[6] << 16) | (answer.data[7] << 24);
  };
  EXPECT_EQ(code({0x40, 0x02, 0x10, 0, 0, 0, 0, 0}), 0x06020000) << "no such object";
  EXPECT_EQ(code({0x40, 0x18, 0x10, 5, 0, 0, 0, 0}), 0x06090011) << "no such part";
  EXPECT_EQ(code({0x40, 0x00, 0x62, 11, 0, 0, 0, 0}), 0x06090011) << "an eleventh channel of ten";
  EXPECT_EQ(code({0x23, 0x18, 0x10, 4, 1, 0, 0, 0}), 0x06010002) << "read-only";
  EXPECT_EQ(code({0x2F, 0x00, 0x21, 7, 1, 0, 0, 0}), 0x06070010) << "one byte into four";
  EXPECT_EQ(code({0x2B, 0x01, 0x21, 7, 5, 200, 0, 0}), 0x06090030) << "no such effect";
  EXPECT_EQ(code({0x2F, 0x04, 0x21, 0, 2, 0, 0, 0}), 0x06090030) << "identify is on or off";
  EXPECT_EQ(code({0xC2, 0x00, 0x21, 7, 0, 0, 0, 0}), 0x05040001) << "block transfer";
  EXPECT_EQ(code({0x60, 0, 0, 0, 0, 0, 0, 0}), 0x05040001) << "nothing is under way";
}

TEST_F(SdoServerTest, AnAbortOfTheOtherSideEndsTheTransferSilently) {
  ask({0x40, 0x08, 0x10, 0, 0, 0, 0, 0});
  EXPECT_EQ(ask({0x80, 0x08, 0x10, 0, 0, 0, 4, 5}), drivers::CanFrame{});
  EXPECT_EQ(ask({0x60, 0, 0, 0, 0, 0, 0, 0}).data[0], 0x80);
}

TEST_F(SdoServerTest, IdentifyAndALookArePerformed) {
  EXPECT_EQ(ask({0x2F, 0x04, 0x21, 0, 1, 0, 0, 0}).data[0], 0x60);
  EXPECT_TRUE(model.identifying(kStart));
  EXPECT_EQ(ask({0x2F, 0x00, 0x62, 3, 9, 0, 0, 0}).data[0], 0x60);
  EXPECT_EQ(model.shown(2), 255) << "pending";
  model.take_staged(1, kStart);
  EXPECT_EQ(model.shown(2), 9);
}

TEST_F(SdoServerTest, AnyBytesAreAnsweredOrIgnoredAndLeaveItWorking) {
  EXPECT_TRUE(rc::check([&](const std::vector<std::array<std::uint8_t, 8>>& requests) {
    for (const auto& request : requests) static_cast<void>(server.answer(request, kStart));
    RC_ASSERT(ask({0x40, 0x17, 0x10, 0, 0, 0, 0, 0}) == frame(0x585, {0x4B, 0x17, 0x10, 0, 0xE8, 0x03, 0, 0}));
  }));
}

}  // namespace
}  // namespace footlight::sim
