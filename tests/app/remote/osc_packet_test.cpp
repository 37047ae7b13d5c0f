// SPDX-License-Identifier: Apache-2.0
#include "app/remote/osc_packet.hpp"

#include <cstring>

#include <gtest/gtest.h>

#include "core/rng.hpp"

namespace footlight::app {
namespace {

std::vector<std::byte> bytes_of(std::string_view text) {
  std::vector<std::byte> bytes(text.size());
  std::memcpy(bytes.data(), text.data(), text.size());
  return bytes;
}

#if FOOTLIGHT_WITH_liblo

using namespace std::string_view_literals;

TEST(OscPacket, IsReadAsTheStandardWritesIt) {
  EXPECT_EQ(read_osc(bytes_of("/go\0,\0\0\0"sv)).value(), (std::vector<OscMessage>{{"/go"}}));
  EXPECT_EQ(read_osc(bytes_of("/a\0\0,isf\0\0\0\0\0\0\0\7ab\0\0\x3f\xc0\0\0"sv)).value(),
            (std::vector<OscMessage>{{"/a", {std::int32_t{7}, "ab", 1.5}}}));
  EXPECT_EQ(read_osc(bytes_of("/a\0\0,TF\0"sv)).value(),
            (std::vector<OscMessage>{{"/a", {std::int32_t{1}, std::int32_t{0}}}}));
}

TEST(OscPacket, WhatIsWrittenIsReadAgain) {
  const std::vector<OscMessage> messages{{"/reply/go", {"ok", "the cue starts"}}, {"/n", {std::int32_t{-5}, 0.25}}};
  EXPECT_EQ(read_osc(osc_bytes(messages[0])).value(), (std::vector<OscMessage>{messages[0]}));
  EXPECT_EQ(read_osc(osc_bundle(messages)).value(), messages);
}

TEST(OscPacket, WhatIsNoOscIsRefused) {
  EXPECT_EQ(read_osc({}).error().message, "no OSC message");
  EXPECT_EQ(read_osc(bytes_of("go")).error().message, "no OSC message");
  EXPECT_EQ(read_osc(bytes_of("/go")).error().message, "no OSC message");
  EXPECT_EQ(read_osc(bytes_of("/a\0\0,s\0\0"sv)).error().message, "no OSC message") << "an argument is missing";
  EXPECT_EQ(read_osc(bytes_of("/a\0\0,b\0\0\0\0\0\4abcd"sv)).error().message,
            "arguments are numbers, strings, true and false");
  EXPECT_EQ(read_osc(bytes_of("/a\0\0,b\0\0"sv)).error().message, "arguments are numbers, strings, true and false")
      << "a blob without its length";
  EXPECT_EQ(read_osc(bytes_of("#bundle\0abc"sv)).error().message, "a bundle that is cut off");
  EXPECT_EQ(read_osc(bytes_of("#bundle\0\0\0\0\0\0\0\0\1\xff\xff\xff\xff/go\0,\0\0\0"sv)).error().message,
            "a bundle that is cut off");
  const std::vector<OscMessage> many(33, OscMessage{"/go"});
  EXPECT_EQ(read_osc(osc_bundle(many)).error().message, "more than 32 messages in one datagram");
  EXPECT_EQ(read_osc(osc_bytes({"/a", std::vector<OscValue>(17, std::int32_t{1})})).error().message,
            "more than 16 arguments");
}

TEST(OscPacket, BundlesInBundlesAreBounded) {
  std::vector<std::byte> packet = osc_bytes({"/go"});
  for (int depth = 1; depth <= 6; ++depth) {
    std::vector<std::byte> outer = bytes_of("#bundle\0\0\0\0\0\0\0\0\1\0\0\0"sv);
    outer.push_back(static_cast<std::byte>(packet.size()));
    outer.insert(outer.end(), packet.begin(), packet.end());
    packet = std::move(outer);
    EXPECT_EQ(read_osc(packet).has_value(), depth <= 4) << depth;
  }
}

TEST(OscPacket, AnyBytesAreReadOrRefused) {
  Rng rng(3);
  const std::vector<std::byte> good = osc_bundle({{"/footlight/order", {"tempo 80"}}, {"/cue/2/start"}, {"/a", {1.5}}});
  int read = 0;
  for (int i = 0; i < 100'000; ++i) {
    std::vector<std::byte> bytes = good;
    if (i % 4 == 0) bytes.resize(rng.below(64));
    if (i % 4 == 1) bytes.resize(rng.below(good.size()));
    const std::size_t changes = bytes.empty() ? 0 : rng.below(6);
    for (std::size_t c = 0; c < changes; ++c) bytes[rng.below(bytes.size())] = static_cast<std::byte>(rng.below(256));
    if (i % 4 == 0) {
      for (std::byte& byte : bytes) byte = static_cast<std::byte>(rng.below(256));
    }
    read += read_osc(bytes) ? 1 : 0;
  }
  EXPECT_GT(read, 1000);
}

#else

TEST(OscPacket, AProgramWithoutLibloSaysSo) {
  EXPECT_EQ(read_osc(bytes_of("/go")).error().message,
            "OSC: this program was built without liblo (install liblo-dev and build again)");
}

#endif

}  // namespace
}  // namespace footlight::app
