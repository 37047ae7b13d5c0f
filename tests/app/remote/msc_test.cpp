// SPDX-License-Identifier: Apache-2.0
#include "app/remote/msc.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "app/midi/midi_bytes.hpp"
#include "core/rng.hpp"

namespace footlight::app {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Kind = RemoteCall::Kind;

MscHeard hear(const Bytes& message, int device = 3) {
  config::MidiRemote settings;
  settings.device = device;
  settings.format = 0x01;
  settings.macros = {{7, "hold end"}};
  return hear_msc(message, settings);
}

TEST(Msc, GoOf12Point5ToAll) {
  // The bytes of docs/remote.md.
  const auto heard = hear({0xF0, 0x7F, 0x7F, 0x02, 0x01, 0x01, 0x31, 0x32, 0x2E, 0x35, 0xF7});
  EXPECT_EQ(heard.call, (RemoteCall{Kind::start_cue, "12.5"}));
}

TEST(Msc, GoWithoutACueIsGo) { EXPECT_EQ(hear({0xF0, 0x7F, 0x7F, 0x02, 0x01, 0x01, 0xF7}).call, RemoteCall{Kind::go}); }

TEST(Msc, ListAndPathAreLeftOutOfAccount) {
  // "Go cue 2 on cue stack 10", as a lighting desk's manual has it.
  EXPECT_EQ(hear({0xF0, 0x7F, 0x7F, 0x02, 0x01, 0x01, 0x32, 0x00, 0x31, 0x30, 0xF7}).call,
            (RemoteCall{Kind::start_cue, "2"}));
  EXPECT_EQ(hear({0xF0, 0x7F, 0x7F, 0x02, 0x01, 0x01, 0x00, 0x31, 0x30, 0xF7}).call, RemoteCall{Kind::go});
}

TEST(Msc, EveryCommandHasItsOrder) {
  const auto say = [](std::uint8_t command, const Bytes& data = {}) {
    Bytes message{0xF0, 0x7F, 0x03, 0x02, 0x7F, command};
    message.insert(message.end(), data.begin(), data.end());
    message.push_back(0xF7);
    return hear(message);
  };
  EXPECT_EQ(say(0x02).call, RemoteCall{Kind::hold});
  EXPECT_EQ(say(0x02, {0x34}).call, RemoteCall{Kind::hold}) << "whichever cue";
  EXPECT_EQ(say(0x03).call, RemoteCall{Kind::resume});
  EXPECT_EQ(say(0x05, {0x34}).call, (RemoteCall{Kind::load_cue, "4"}));
  EXPECT_EQ(say(0x05).why_not, "LOAD without a cue number");
  EXPECT_EQ(say(0x07, {7}).call, (RemoteCall{Kind::order, "hold end"}));
  EXPECT_EQ(say(0x07, {8}).why_not, "FIRE: no macro 8 (midi.macros)");
  EXPECT_EQ(say(0x07).why_not, "FIRE without the number of a macro");
  EXPECT_EQ(say(0x08).call, RemoteCall{Kind::hold});
  EXPECT_EQ(say(0x0A).call, RemoteCall{Kind::top});
  EXPECT_EQ(say(0x0B).why_not, "command 0B is not carried out (GO, STOP, RESUME, LOAD, FIRE, ALL_OFF, RESET are)");
  EXPECT_EQ(say(0x01, {0x31, 0x2E, 0x2E}).why_not, "what should be a cue number is none");
}

TEST(Msc, OtherDevicesFormatsAndMessagesAreNotForUs) {
  for (const Bytes& message : std::vector<Bytes>{{0xF0, 0x7F, 0x04, 0x02, 0x01, 0x01, 0xF7},
                                                 {0xF0, 0x7F, 0x03, 0x02, 0x10, 0x01, 0xF7},
                                                 {0xF0, 0x7F, 0x7F, 0x01, 0x01, 0x01, 0xF7},
                                                 {0xF0, 0x7E, 0x7F, 0x02, 0x01, 0x01, 0xF7},
                                                 {0xF0, 0x7F, 0x7F, 0x02, 0x01, 0x01},
                                                 {0xF0, 0xF7},
                                                 {0x90, 60, 100},
                                                 {}}) {
    EXPECT_FALSE(hear(message).call);
    EXPECT_EQ(hear(message).why_not, "");
  }
}

TEST(Msc, GarbageStartsNoCue) {
  Rng rng(12);
  int understood = 0;
  for (int i = 0; i < 200'000; ++i) {
    Bytes message(rng.below(16));
    for (std::uint8_t& byte : message) byte = static_cast<std::uint8_t>(rng.below(256));
    if (i % 2 == 0 && message.size() >= 7) {  // near the real thing
      const Bytes head{0xF0, 0x7F, 0x7F, 0x02, 0x01};
      std::copy(head.begin(), head.end(), message.begin());
      message.back() = 0xF7;
    }
    const auto heard = hear(message);
    if (!heard.call) continue;
    ++understood;
    ASSERT_TRUE(heard.call->kind != Kind::start_cue || CueNumber::parse(heard.call->text));
  }
  EXPECT_GT(understood, 100);
}

TEST(Msc, AGoInPiecesWithTheClockInBetweenIsOneGo) {
  const Bytes go{0xF0, 0x7F, 0xF8, 0x7F, 0x02, 0xF8, 0xF8, 0x01, 0x01, 0x31, 0x32, 0xF8, 0x2E, 0x35, 0xF7};
  MidiBytes stream;
  std::vector<RemoteCall> calls;
  for (const std::uint8_t byte : go) {
    const auto message = stream.take(byte);
    if (const auto heard = hear({message.begin(), message.end()}); heard.call) calls.push_back(*heard.call);
  }
  EXPECT_EQ(calls, (std::vector<RemoteCall>{{Kind::start_cue, "12.5"}}));
}

}  // namespace
}  // namespace footlight::app
