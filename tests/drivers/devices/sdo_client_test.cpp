// SPDX-License-Identifier: Apache-2.0
#include "drivers/devices/canopen/sdo_client.hpp"

#include <array>
#include <string>

#include <gtest/gtest.h>
#include <rapidcheck.h>

namespace footlight::drivers::canopen {
namespace {

using State = SdoClient::State;
using Bytes = std::vector<std::uint8_t>;

CanFrame frame(std::uint16_t id, std::initializer_list<std::uint8_t> data) {
  CanFrame made{id, static_cast<std::uint8_t>(data.size()), {}};
  std::copy(data.begin(), data.end(), made.data.begin());
  return made;
}
CanFrame answer(std::initializer_list<std::uint8_t> data) { return frame(0x585, data); }

TEST(SdoClient, ReadsFourBytesInOneAnswer) {
  SdoClient client;
  EXPECT_EQ(client.read(5, {0x1018, 4}), frame(0x605, {0x40, 0x18, 0x10, 4, 0, 0, 0, 0}));
  EXPECT_EQ(client.take(answer({0x43, 0x18, 0x10, 4, 1, 2, 3, 4})), std::nullopt);
  EXPECT_EQ(client.state(), State::done);
  EXPECT_EQ(client.data(), (Bytes{1, 2, 3, 4}));
}

TEST(SdoClient, ReadsATextInSegments) {
  SdoClient client;
  client.read(5, {0x1008, 0});
  EXPECT_EQ(client.take(answer({0x41, 0x08, 0x10, 0, 9, 0, 0, 0})), frame(0x605, {0x60, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(client.take(answer({0x00, 'F', 'o', 'o', 't', 'l', 'i', 'g'})), frame(0x605, {0x70, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(client.take(answer({0x1B, 'h', 't', 0, 0, 0, 0, 0})), std::nullopt);
  EXPECT_EQ(client.state(), State::done);
  EXPECT_EQ(std::string(client.data().begin(), client.data().end()), "Footlight");
}

TEST(SdoClient, WritesExpedited) {
  SdoClient client;
  EXPECT_EQ(client.write(5, {0x2104, 0}, Bytes{1}), frame(0x605, {0x2F, 0x04, 0x21, 0, 1, 0, 0, 0}));
  EXPECT_EQ(client.write(5, {0x1017, 0}, Bytes{1, 2}), frame(0x605, {0x2B, 0x17, 0x10, 0, 1, 2, 0, 0}));
  EXPECT_EQ(client.take(answer({0x60, 0x04, 0x21, 0, 0, 0, 0, 0})), std::nullopt);
  EXPECT_EQ(client.state(), State::waiting) << "that was the answer to the write before";
  client.take(answer({0x60, 0x17, 0x10, 0, 0, 0, 0, 0}));
  EXPECT_EQ(client.state(), State::done);
}

TEST(SdoClient, WritesLongDataInSegments) {
  SdoClient client;
  EXPECT_EQ(client.write(5, {0x2000, 0}, Bytes{1, 2, 3, 4, 5, 6, 7, 8, 9}),
            frame(0x605, {0x21, 0x00, 0x20, 0, 9, 0, 0, 0}));
  EXPECT_EQ(client.take(answer({0x60, 0x00, 0x20, 0, 0, 0, 0, 0})), frame(0x605, {0x00, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(client.take(answer({0x20, 0, 0, 0, 0, 0, 0, 0})), frame(0x605, {0x1B, 8, 9, 0, 0, 0, 0, 0}));
  EXPECT_EQ(client.take(answer({0x30, 0, 0, 0, 0, 0, 0, 0})), std::nullopt);
  EXPECT_EQ(client.state(), State::done);
}

TEST(SdoClient, AnAbortOfTheNodeIsKeptWithItsCode) {
  SdoClient client;
  client.read(5, {0x1018, 4});
  client.take(answer({0x80, 0x18, 0x10, 4, 0x11, 0x00, 0x09, 0x06}));
  EXPECT_EQ(client.state(), State::aborted);
  EXPECT_EQ(client.abort_code(), 0x06090011U);
}

TEST(SdoClient, ARepeatedSegmentIsAborted) {
  SdoClient client;
  client.read(5, {0x1008, 0});
  client.take(answer({0x41, 0x08, 0x10, 0, 20, 0, 0, 0}));
  client.take(answer({0x00, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(client.take(answer({0x00, 1, 2, 3, 4, 5, 6, 7})),
            frame(0x605, {0x80, 0x08, 0x10, 0, 0x00, 0x00, 0x03, 0x05}));
  EXPECT_EQ(client.state(), State::aborted);
}

TEST(SdoClient, ANodeThatSendsWithoutEndIsCutOff) {
  SdoClient client;
  client.read(5, {0x1008, 0});
  client.take(answer({0x41, 0x08, 0x10, 0, 20, 0, 0, 0}));
  int segments = 0;
  for (std::uint8_t toggle = 0; client.state() == State::waiting; toggle ^= 0x10) {
    client.take(answer({toggle, 1, 2, 3, 4, 5, 6, 7}));
    ++segments;
  }
  EXPECT_EQ(segments, 1024 / 7 + 1);
  EXPECT_EQ(client.abort_code(), 0x05040005U);
}

TEST(SdoClient, FramesOfOthersChangeNothing) {
  SdoClient client;
  client.read(5, {0x1018, 4});
  EXPECT_EQ(client.take(frame(0x586, {0x43, 0x18, 0x10, 4, 1, 2, 3, 4})), std::nullopt);
  EXPECT_EQ(client.take(frame(0x585, {0x43, 0x18, 0x10, 4, 1, 2, 3})), std::nullopt);
  EXPECT_EQ(client.take(answer({0x43, 0x18, 0x10, 3, 1, 2, 3, 4})), std::nullopt) << "of another object";
  CanFrame error = answer({0x43, 0x18, 0x10, 4, 1, 2, 3, 4});
  error.kind = CanFrame::Kind::error;
  EXPECT_EQ(client.take(error), std::nullopt);
  EXPECT_EQ(client.state(), State::waiting);
}

TEST(SdoClient, AnySequenceOfAnswersLeavesItUsable) {
  EXPECT_TRUE(rc::check([](const std::vector<std::array<std::uint8_t, 8>>& answers) {
    SdoClient client;
    client.read(5, {0x1008, 0});
    for (const auto& bytes : answers) {
      CanFrame heard{0x585, 8, {}};
      std::copy(bytes.begin(), bytes.end(), heard.data.begin());
      client.take(heard);
    }
    client.read(5, {0x1018, 4});
    client.take(answer({0x43, 0x18, 0x10, 4, 1, 2, 3, 4}));
    RC_ASSERT(client.state() == State::done);
  }));
}

}  // namespace
}  // namespace footlight::drivers::canopen
