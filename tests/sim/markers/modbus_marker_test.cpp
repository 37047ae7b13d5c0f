// SPDX-License-Identifier: Apache-2.0
#include "sim/markers/modbus_marker.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "sim/markers/check_sums.hpp"

namespace footlight::sim {
namespace {

using Octets = std::vector<std::uint8_t>;

Octets sealed(Octets frame) {
  const std::uint16_t check = crc16_modbus(frame);
  frame.push_back(static_cast<std::uint8_t>(check & 0xFFU));
  frame.push_back(static_cast<std::uint8_t>(check >> 8U));
  return frame;
}

/// Node 7 with three channels, switched on. The frames in hexadecimal were made by another program from the document.
struct ModbusMarkerTest : ::testing::Test {
  explicit ModbusMarkerTest(ModbusProfile profile = footlight_profile()) : marker(7, std::move(profile), model) {
    model.power_on(kStart);
    marker.power_on();
  }
  Octets hear(const Octets& frame) { return marker.receive_rtu(frame, now); }
  Octets ask(Octets frame) { return hear(sealed(std::move(frame))); }
  static Octets refusal(int function, int code) {
    return sealed({7, static_cast<std::uint8_t>(function | 0x80), static_cast<std::uint8_t>(code)});
  }
  Instant now = kStart;
  NodeModel model{3, true};
  ModbusMarker marker;

  const Octets preload{0x07, 0x10, 0x00, 0x00, 0x00, 0x03, 0x06, 0xAB, 0x05, 0x01, 0x00, 0x03, 0x00, 0x3B, 0x91};
  const Octets latch{0x00, 0x10, 0x00, 0x20, 0x00, 0x03, 0x06, 0xAB, 0x05, 0xF1, 0x5F, 0x0E, 0xA0, 0x36, 0x46};
};

TEST_F(ModbusMarkerTest, PreloadLatchAndStatusAreTheBytesOfTheDocument) {
  EXPECT_EQ(hear(preload), (Octets{0x07, 0x10, 0x00, 0x00, 0x00, 0x03, 0x80, 0x6E}));
  EXPECT_EQ(model.shown(0), 255);
  EXPECT_TRUE(hear(latch).empty()) << "nobody answers a broadcast";
  EXPECT_EQ(model.shown(0), 1);
  EXPECT_EQ(model.shown(2), 3);
  EXPECT_EQ(
      hear({0x07, 0x03, 0x00, 0x40, 0x00, 0x06, 0xC4, 0x7A}),
      (Octets{0x07, 0x03, 0x0C, 0x05, 0x00, 0xCB, 0xCF, 0x00, 0x01, 0x00, 0x01, 0x00, 0x00, 0x00, 0x00, 0x51, 0x52}));
}

TEST_F(ModbusMarkerTest, APartOfTheStatusMayBeRead) {
  now += milliseconds(3'999);
  EXPECT_EQ(ask({7, 3, 0, 0x43, 0, 2}), sealed({7, 3, 4, 0, 1, 0, 3}));  // boots, uptime
}

TEST_F(ModbusMarkerTest, ALatchNeedsItsPlanItsSequenceAndBothGuards) {
  hear(preload);
  EXPECT_EQ(ask({7, 0x10, 0, 0x20, 0, 3, 6, 0xAB, 0x05, 0xF1, 0x5F, 0x0E, 0xA1}), refusal(0x10, 3));
  EXPECT_EQ(ask({7, 0x10, 0, 0x20, 0, 3, 6, 0xAB, 0x05, 0xF1, 0x5E, 0x0E, 0xA0}), refusal(0x10, 3));
  ask({0, 0x10, 0, 0x20, 0, 3, 6, 0xAC, 0x05, 0xF6, 0x5F, 0x09, 0xA0});
  ask({0, 0x10, 0, 0x20, 0, 3, 6, 0xAB, 0x04, 0xF1, 0x5E, 0x0E, 0xA1});
  EXPECT_EQ(model.shown(0), 255);
  EXPECT_EQ(ask({7, 0x10, 0, 0x20, 0, 3, 6, 0xAB, 0x05, 0xF1, 0x5F, 0x0E, 0xA0}), sealed({7, 0x10, 0, 0x20, 0, 3}));
  EXPECT_EQ(model.shown(0), 1);
}

TEST_F(ModbusMarkerTest, ExceptionsSayWhatIsWrong) {
  EXPECT_EQ(ask({7, 0x04, 0, 0x40, 0, 1}), refusal(0x04, 1));
  EXPECT_EQ(ask({7, 0x03, 0, 0x3F, 0, 1}), refusal(0x03, 2));
  EXPECT_EQ(ask({7, 0x03, 0, 0x40, 0, 7}), refusal(0x03, 2));
  EXPECT_EQ(ask({7, 0x03, 0, 0x40, 0, 0}), refusal(0x03, 3));
  EXPECT_EQ(ask({7, 0x03, 0, 0x40, 0, 126}), refusal(0x03, 3));
  EXPECT_EQ(ask({7, 0x10, 0, 0x00, 0, 4, 8, 0xAB, 5, 1, 2, 3, 0, 0, 0}), refusal(0x10, 3)) << "looks for five channels";
  EXPECT_EQ(ask({7, 0x10, 0, 0x00, 0, 2, 4, 0xAB, 0, 1, 2}), refusal(0x10, 3)) << "sequence 0";
  EXPECT_EQ(ask({7, 0x10, 0, 0x00, 0, 2, 4, 0xAB, 241, 1, 2}), refusal(0x10, 3)) << "sequence 241";
  EXPECT_EQ(ask({7, 0x10, 0, 0x01, 0, 1, 2, 1, 2}), refusal(0x10, 2)) << "looks without their sequence";
  EXPECT_EQ(ask({7, 0x10, 0, 0x00, 0, 2, 3, 0xAB, 5, 1}), refusal(0x10, 3)) << "byte count";
  EXPECT_EQ(ask({7, 0x06, 0, 0x20, 0xAB, 5}), refusal(0x06, 3)) << "a latch is three registers";
  EXPECT_EQ(ask({7, 0x06, 1, 0x00, 0, 0}), refusal(0x06, 2));
  EXPECT_EQ(ask({7, 0x10, 0, 0x50, 0, 4, 8, 0, 255, 1, 2, 3, 4, 0, 0}), refusal(0x10, 3)) << "NO-GUIDANCE stays";
  EXPECT_EQ(model.pending_sequence(), 0);
}

TEST_F(ModbusMarkerTest, FramesOfOthersAndWrongCheckSumsAreNotAnswered) {
  EXPECT_TRUE(ask({8, 3, 0, 0x40, 0, 6}).empty());
  Octets broken = preload;
  broken[8] ^= 1;
  EXPECT_TRUE(hear(broken).empty());
  EXPECT_TRUE(hear({7, 3}).empty());
  EXPECT_EQ(ask({7, 3, 0, 0x45, 0, 1}), sealed({7, 3, 2, 0, 2})) << "both are counted";
}

TEST_F(ModbusMarkerTest, LookTableAndHeartbeatAreBroadcast) {
  ask({0, 0x10, 0, 0x50, 0, 4, 8, 0, 9, 10, 20, 30, 40, 0, 2});
  EXPECT_EQ(model.look(9), (Look{{10, 20, 30}, Effect::pulse, 40}));
  hear(preload);
  hear(latch);
  now += milliseconds(1500);
  ask({0, 0x10, 0, 0x30, 0, 2, 4, 0, 0, 5, 0xDC});
  EXPECT_EQ(model.state(), NodeState::showing);
}

TEST_F(ModbusMarkerTest, TcpCarriesTheSamePdu) {
  EXPECT_EQ(marker.receive_tcp(Octets{0x12, 0x34, 0, 0, 0, 6, 7, 3, 0, 0x43, 0, 1}, now),
            (Octets{0x12, 0x34, 0, 0, 0, 5, 7, 3, 2, 0, 1}));
  EXPECT_TRUE(marker.receive_tcp(Octets{0x12, 0x34, 0, 0, 0, 7, 7, 3, 0, 0x43, 0, 1}, now).empty()) << "length";
  EXPECT_TRUE(marker.receive_tcp(Octets{0x12, 0x34, 0, 1, 0, 6, 7, 3, 0, 0x43, 0, 1}, now).empty()) << "protocol";
  EXPECT_TRUE(marker.receive_tcp(Octets{0x12, 0x34, 0, 0, 0, 6, 8, 3, 0, 0x43, 0, 1}, now).empty()) << "unit";
}

/// A foreign device: one look a register, no sequences, a latch of one register.
struct ForeignModbusMarkerTest : ModbusMarkerTest {
  static ModbusProfile foreign() {
    ModbusProfile profile;
    profile.look_register = 0x100;
    profile.looks_per_register = 1;
    profile.has_preload_sequence = false;
    profile.latch_register = 0x200;
    return profile;
  }
  ForeignModbusMarkerTest() : ModbusMarkerTest(foreign()) {}
};

TEST_F(ForeignModbusMarkerTest, LooksGatherUntilTheLatch) {
  EXPECT_EQ(ask({7, 0x06, 0x01, 0x02, 0, 9}), sealed({7, 0x06, 0x01, 0x02, 0, 9}));
  EXPECT_EQ(ask({7, 0x10, 0x01, 0x00, 0, 2, 4, 0, 4, 0, 5}), sealed({7, 0x10, 0x01, 0x00, 0, 2}));
  EXPECT_EQ(model.shown(2), 255);
  EXPECT_TRUE(ask({0, 0x06, 0x02, 0x00, 0, 77}).empty());
  EXPECT_EQ(model.shown(0), 4);
  EXPECT_EQ(model.shown(1), 5);
  EXPECT_EQ(model.shown(2), 9);
  EXPECT_EQ(ask({7, 0x03, 0x00, 0x40, 0, 1}), refusal(0x03, 2)) << "nothing can be read back";
  EXPECT_EQ(ask({7, 0x06, 0x01, 0x03, 0, 9}), refusal(0x06, 2)) << "there is no fourth channel";
}

TEST(ModbusMarker, WithoutALatchRegisterLooksActAtOnce) {
  ModbusProfile profile = ForeignModbusMarkerTest::foreign();
  profile.latch_register.reset();
  NodeModel model(3, false);
  model.power_on(kStart);
  ModbusMarker marker(7, profile, model);
  marker.receive_rtu(sealed({7, 0x06, 0x01, 0x01, 0, 9}), kStart);
  EXPECT_EQ(model.shown(1), 9);
  EXPECT_EQ(model.shown(0), 255);
}

TEST(ModbusMarkerProperty, NoBytesBreakItAndEveryAnswerIsSealed) {
  EXPECT_TRUE(rc::check([] {
    NodeModel model(*rc::gen::inRange(1, 33), true);
    model.power_on(kStart);
    ModbusProfile profile = footlight_profile();
    profile.has_preload_sequence = *rc::gen::arbitrary<bool>();
    profile.looks_per_register = *rc::gen::inRange(1, 3);
    ModbusMarker marker(7, profile, model);
    const auto count = *rc::gen::inRange(0, 20);
    for (int i = 0; i < count; ++i) {
      Octets frame = *rc::gen::arbitrary<Octets>();
      const Instant now = kStart + milliseconds(i * 300);
      if (*rc::gen::arbitrary<bool>()) {
        Octets head{*rc::gen::element<std::uint8_t>(0, 7),
                    *rc::gen::element<std::uint8_t>(3, 6, 16, 99),
                    0,
                    *rc::gen::element<std::uint8_t>(0x00, 0x10, 0x20, 0x30, 0x40, 0x50),
                    0,
                    *rc::gen::inRange<std::uint8_t>(0, 20)};
        if (head[1] == 16) {
          head.push_back(static_cast<std::uint8_t>(2 * head[5]));
          frame.resize(2U * head[5]);
        }
        head.insert(head.end(), frame.begin(), frame.end());
        frame = sealed(head);
      }
      const Octets answer = marker.receive_rtu(frame, now);
      if (!answer.empty()) {
        RC_ASSERT(sealed(Octets(answer.begin(), answer.end() - 2)) == answer);
        RC_ASSERT(answer[0] == 7);
      }
      marker.receive_tcp(frame, now);
    }
  }));
}

TEST_F(ModbusMarkerTest, SaysWhoItIs) {
  ModbusMarker other(7, footlight_profile(), model, 0x12345678);
  EXPECT_EQ(other.receive_rtu(sealed({7, 3, 0, 0x60, 0, 2}), now), sealed({7, 3, 4, 0x12, 0x34, 0x56, 0x78}));
  EXPECT_EQ(other.receive_rtu(sealed({7, 3, 0, 0x62, 0, 2}), now), sealed({7, 3, 4, 'f', 'o', 'o', 't'}));
}

TEST_F(ModbusMarkerTest, TellsItsHealth) {
  model.health = {87, 23'456, -4};
  EXPECT_EQ(ask({7, 3, 0, 0x48, 0, 3}), sealed({7, 3, 6, 0, 87, 0x5B, 0xA0, 0xFF, 0xD8}));  // -40 tenths
}

TEST_F(ModbusMarkerTest, ShowsWhichOneItIs) {
  EXPECT_EQ(ask({7, 6, 0, 0x6A, 0, 1}), sealed({7, 6, 0, 0x6A, 0, 1}));
  EXPECT_TRUE(model.identifying(now));
  EXPECT_EQ(ask({7, 6, 0, 0x6A, 0, 0}), sealed({7, 6, 0, 0x6A, 0, 0}));
  EXPECT_FALSE(model.identifying(now));
}

TEST_F(ModbusMarkerTest, TakesANewAddressUnderItsOwnUniqueId) {
  ModbusMarker other(7, footlight_profile(), model, 0x12345678);
  const auto write = [&](int unit, int id_low, int guard) {
    return other.receive_rtu(sealed({static_cast<std::uint8_t>(unit), 0x10, 0, 0x6C, 0, 4, 8, 0x12, 0x34, 0x56,
                                     static_cast<std::uint8_t>(id_low), 0, 9, 0x5A, static_cast<std::uint8_t>(guard)}),
                             now);
  };
  EXPECT_EQ(write(7, 0x79, 0x5A ^ 9), refusal(0x10, 3)) << "another device is meant";
  EXPECT_EQ(write(7, 0x78, 0), refusal(0x10, 3)) << "wrong guard";
  EXPECT_EQ(other.address(), 7);
  EXPECT_TRUE(write(0, 0x78, 0x5A ^ 9).empty());
  EXPECT_EQ(other.address(), 9);
  EXPECT_TRUE(other.receive_rtu(sealed({7, 3, 0, 0x40, 0, 1}), now).empty()) << "it is not there any more";
  EXPECT_FALSE(other.receive_rtu(sealed({9, 3, 0, 0x40, 0, 1}), now).empty());
}

ModbusProfile relay_profile() {
  ModbusProfile profile;
  profile.name = "relay";
  profile.coils = true;
  profile.look_register = 2;
  profile.has_preload_sequence = false;
  profile.readable_looks = true;
  profile.has_broadcast = false;
  profile.address_register = 0x4000;
  profile.restarts_for_address = true;
  return profile;
}

struct RelayTest : ModbusMarkerTest {
  RelayTest() : ModbusMarkerTest(relay_profile()) {
    model.take_staged(0, now);
    model.stage(0, std::vector<LookIndex>{0, 0, 0});
    model.take_staged(0, now);
  }
};

TEST_F(RelayTest, CoilsAreWrittenTogetherOrOneByOneAndReadBack) {
  EXPECT_EQ(ask({7, 0x0F, 0, 2, 0, 3, 1, 0b101}), sealed({7, 0x0F, 0, 2, 0, 3}));
  EXPECT_EQ(model.shown(0), 1);
  EXPECT_EQ(model.shown(1), 0);
  EXPECT_EQ(model.shown(2), 1);
  EXPECT_EQ(ask({7, 5, 0, 3, 0xFF, 0}), sealed({7, 5, 0, 3, 0xFF, 0}));
  EXPECT_EQ(ask({7, 1, 0, 2, 0, 3}), sealed({7, 1, 1, 0b111}));
  EXPECT_EQ(ask({7, 1, 0, 3, 0, 2}), sealed({7, 1, 1, 0b11}));
}

TEST_F(RelayTest, RefusesWhatItDoesNotHave) {
  EXPECT_EQ(ask({7, 0x0F, 0, 2, 0, 4, 1, 1}), refusal(0x0F, 2));
  EXPECT_EQ(ask({7, 0x0F, 0, 1, 0, 1, 1, 1}), refusal(0x0F, 2));
  EXPECT_EQ(ask({7, 0x0F, 0, 2, 0, 3, 2, 1, 0}), refusal(0x0F, 3));
  EXPECT_EQ(ask({7, 5, 0, 2, 0, 1}), refusal(5, 3));
  EXPECT_EQ(ask({7, 1, 0, 4, 0, 2}), refusal(1, 2));
  EXPECT_EQ(ask({7, 3, 0, 2, 0, 1}), refusal(3, 2)) << "coils are no registers";
  EXPECT_TRUE(ask({0, 5, 0, 2, 0xFF, 0}).empty());
  EXPECT_EQ(model.shown(0), 0) << "it knows no broadcast";
}

TEST_F(RelayTest, ANewAddressCountsAfterPowerOn) {
  EXPECT_EQ(ask({7, 6, 0x40, 0, 0, 12}), sealed({7, 6, 0x40, 0, 0, 12}));
  EXPECT_EQ(ask({7, 3, 0x40, 0, 0, 1}), sealed({7, 3, 2, 0, 12}));
  EXPECT_EQ(marker.address(), 7);
  marker.power_on();
  EXPECT_EQ(marker.address(), 12);
  EXPECT_TRUE(ask({7, 1, 0, 2, 0, 1}).empty());
  EXPECT_EQ(ask({12, 6, 0x40, 0, 0, 0}), sealed({12, 0x86, 3})) << "0 is nobody's address";
}

struct StateLampTest : ModbusMarkerTest {
  static ModbusProfile profile() {
    ModbusProfile profile;
    profile.has_preload_sequence = false;
    profile.look_register = 10;
    profile.looks_per_register = 1;
    profile.readable_looks = true;
    profile.states = StateTable{
        100, 4, 2, 0, 1, {}, {{1, Effect::steady}, {2, Effect::blink}}, {{0, {0, 255, 0}}, {1, {255, 0, 0}}}, {}};
    return profile;
  }
  StateLampTest() : ModbusMarkerTest(profile()) {}
};

TEST_F(StateLampTest, ItsStatesAreFilledOnceAndThenSwitched) {
  EXPECT_EQ(ask({7, 0x10, 0, 104, 0, 2, 4, 0, 2, 0, 1}), sealed({7, 0x10, 0, 104, 0, 2}));
  EXPECT_EQ(model.look(2).effect, Effect::blink);
  EXPECT_EQ(model.look(2).colour, (Colour{255, 0, 0}));
  EXPECT_EQ(ask({7, 6, 0, 101, 0, 5}), refusal(6, 3)) << "no such colour";
  EXPECT_EQ(ask({7, 6, 0, 11, 0, 2}), sealed({7, 6, 0, 11, 0, 2}));
  EXPECT_EQ(model.shown(1), 2);
  EXPECT_EQ(ask({7, 3, 0, 11, 0, 1}), sealed({7, 3, 2, 0, 2}));
  EXPECT_EQ(ask({7, 6, 0, 11, 0, 3}), refusal(6, 3)) << "no such state";
}

TEST_F(ModbusMarkerTest, AFencedControllerIsRefusedByException7) {
  ask({0, 0x10, 0, 0x32, 0, 3, 6, 0, 0, 0, 9, 0, 0x11});
  EXPECT_EQ(hear(preload), refusal(0x10, 7));
  EXPECT_EQ(ask({7, 0x10, 0, 0x32, 0, 3, 6, 0, 0, 0, 8, 0, 0xAB}), refusal(0x10, 7)) << "an older epoch";
  EXPECT_EQ(model.pending_sequence(), 0);
  ask({0, 0x10, 0, 0x32, 0, 3, 6, 0, 0, 0, 10, 0, 0xAB});
  EXPECT_NE(hear(preload), refusal(0x10, 7));
  hear(latch);
  EXPECT_EQ(model.shown(0), 1);
  EXPECT_EQ(ask({7, 0x10, 0, 0x32, 0, 2, 4, 0, 0, 0, 8}), refusal(0x10, 3)) << "half a LEAD";
}

}  // namespace
}  // namespace footlight::sim
