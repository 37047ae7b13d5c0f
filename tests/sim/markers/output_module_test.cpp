// SPDX-License-Identifier: Apache-2.0
#include "sim/markers/output_module.hpp"

#include <initializer_list>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "can_frame.hpp"

namespace footlight::sim {
namespace {

using drivers::CanFrame;
using Reaction = CanNode::Reaction;

OutputModule of_outputs(int outputs) {
  OutputModule module;
  module.outputs = outputs;
  return module;
}

/// Node 5 with sixteen outputs, as it comes from its maker, switched on.
struct OutputModuleTest : ::testing::Test {
  OutputModuleTest() { model.power_on(kStart); }
  Reaction hear(int id, std::initializer_list<int> bytes) { return node.receive(frame(id, bytes), now); }
  void start() { hear(0x000, {0x01, 5}); }
  /// @return abort code; 0: taken
  std::uint32_t write(int index, int sub, std::uint32_t value, int size) {
    const int command = size == 1 ? 0x2F : size == 2 ? 0x2B : 0x23;
    const auto byte = [&](unsigned i) { return static_cast<int>((value >> (8U * i)) & 0xFFU); };
    EXPECT_EQ(hear(0x605, {command, index & 0xFF, index >> 8, sub, byte(0), byte(1), byte(2), byte(3)}), Reaction::sdo);
    return node.sdo_answer().data[0] == 0x80 ? number() : 0;
  }
  std::uint32_t read(int index, int sub) {
    EXPECT_EQ(hear(0x605, {0x40, index & 0xFF, index >> 8, sub, 0, 0, 0, 0}), Reaction::sdo);
    return number();
  }
  [[nodiscard]] std::uint32_t number() const {
    std::uint32_t value = 0;
    for (unsigned i = 0; i < 4; ++i) value |= std::uint32_t{node.sdo_answer().data.at(4 + i)} << (8U * i);
    return value;
  }
  /// Which outputs are on, the first on the left.
  [[nodiscard]] std::string outputs() const {
    std::string text;
    for (int channel = 0; channel < 16; ++channel) text += model.shown(channel) != 0 ? '#' : '.';
    return text;
  }
  void make_synchronous() {
    EXPECT_EQ(write(0x1400, 1, 0x80000205, 4), 0U);
    EXPECT_EQ(write(0x1400, 2, 1, 1), 0U);
    EXPECT_EQ(write(0x1400, 1, 0x205, 4), 0U);
  }
  Instant now = kStart;
  NodeModel model{16, false, kDark};
  OutputModuleNode node{5, of_outputs(16), model};
};

TEST_F(OutputModuleTest, AsItComesItsOutputsActAtOnceAndItSendsNoHeartbeats) {
  EXPECT_EQ(node.boot_up(), frame(0x705, {0}));
  EXPECT_EQ(node.heartbeat().id, 0);
  hear(0x205, {0x09, 0x80});
  EXPECT_EQ(outputs(), "................") << "pre-operational";
  start();
  hear(0x205, {0x09, 0x80});
  EXPECT_EQ(outputs(), "#..#...........#");
}

TEST_F(OutputModuleTest, ASynchronousPdoWaitsForTheSync) {
  make_synchronous();
  start();
  hear(0x205, {0xFF, 0x00});
  EXPECT_EQ(outputs(), "................");
  EXPECT_EQ(hear(0x080, {}), Reaction::none);
  EXPECT_EQ(outputs(), "########........");
}

TEST_F(OutputModuleTest, ASyncWithACounterIsAnErrorForIt) {
  make_synchronous();
  start();
  hear(0x205, {0xFF, 0x00});
  EXPECT_EQ(hear(0x080, {17}), Reaction::emergency);
  EXPECT_EQ(node.emergency(), frame(0x085, {0x40, 0x82, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(outputs(), "................");
}

TEST_F(OutputModuleTest, AMappingIsRefusedInAnyOtherOrder) {
  EXPECT_EQ(write(0x1600, 0, 0, 1), 0x08000022U) << "the PDO is valid";
  EXPECT_EQ(write(0x1600, 1, 0x62000208, 4), 0x08000022U);
  EXPECT_EQ(write(0x1400, 1, 0x80000205, 4), 0U);
  EXPECT_EQ(write(0x1600, 1, 0x62000208, 4), 0x08000022U) << "its count is not 0";
  EXPECT_EQ(write(0x1600, 0, 0, 1), 0U);
  EXPECT_EQ(write(0x1600, 1, 0x62000308, 4), 0x06040041U) << "a third byte of outputs";
  EXPECT_EQ(write(0x1600, 1, 0x62000110, 4), 0x06040041U) << "sixteen bits of an object of eight";
  EXPECT_EQ(write(0x1600, 1, 0x62000208, 4), 0U);
  EXPECT_EQ(write(0x1600, 2, 0x62000108, 4), 0U);
  EXPECT_EQ(write(0x1600, 0, 3, 1), 0x06040041U) << "nothing is mapped there";
  EXPECT_EQ(write(0x1600, 0, 9, 1), 0x06040042U);
  EXPECT_EQ(write(0x1600, 0, 2, 1), 0U);
  EXPECT_EQ(write(0x1400, 1, 0x205, 4), 0U);
  EXPECT_EQ(write(0x1400, 1, 0x305, 4), 0x06090030U) << "a valid PDO keeps its identifier";
  start();
  hear(0x205, {0x01, 0x80});
  EXPECT_EQ(outputs(), ".......##.......") << "the bytes are exchanged now";
}

TEST_F(OutputModuleTest, WhatIsNotThereOrNotPossibleIsRefused) {
  EXPECT_EQ(write(0x1400, 2, 241, 1), 0x06090030U) << "a reserved type";
  EXPECT_EQ(write(0x1000, 0, 0, 4), 0x06010002U);
  EXPECT_EQ(write(0x1017, 0, 1000, 4), 0x06070010U);
  EXPECT_EQ(write(0x2100, 1, 0, 4), 0x06020000U) << "our own marker's look table";
  EXPECT_EQ(write(0x6206, 3, 0, 1), 0x06090011U);
  EXPECT_EQ(read(0x1000, 0), 0x00020191U);
  EXPECT_EQ(read(0x6200, 0) & 0xFFU, 2U);
}

TEST_F(OutputModuleTest, AShortPdoIsNotTakenAndTold) {
  start();
  EXPECT_EQ(hear(0x205, {0xFF}), Reaction::emergency);
  EXPECT_EQ(node.emergency(), frame(0x085, {0x10, 0x82, 0x11, 0, 0, 0, 0, 0}));
  EXPECT_EQ(outputs(), "................");
  EXPECT_EQ(hear(0x205, {0xFF, 0}), Reaction::emergency);
  EXPECT_EQ(node.emergency(), frame(0x085, {0, 0, 0, 0, 0, 0, 0, 0})) << "it is over";
}

TEST_F(OutputModuleTest, WithoutItsControllerOutputsGoWhereTheErrorModeSendsThem) {
  EXPECT_EQ(write(0x6206, 2, 0x0F, 1), 0U) << "of the second byte only the lower half";
  EXPECT_EQ(write(0x6207, 2, 0x05, 1), 0U);
  EXPECT_EQ(write(0x1016, 1, 0x007F03E8, 4), 0U);
  EXPECT_EQ(write(0x1017, 0, 500, 2), 0U);
  start();
  hear(0x205, {0xFF, 0xFF});
  now += milliseconds(900);
  EXPECT_EQ(node.beat(now), milliseconds(500));
  EXPECT_EQ(outputs(), "################") << "no heartbeat has come yet: it waits for none";
  hear(0x77F, {5});
  now += milliseconds(1000);
  node.beat(now);
  EXPECT_EQ(outputs(), "################");
  now += milliseconds(500);
  node.beat(now);
  EXPECT_EQ(outputs(), "........#.#.####");
  EXPECT_EQ(node.heartbeat(), frame(0x705, {127})) << "pre-operational (0x1029)";
}

TEST_F(OutputModuleTest, ResetForgetsItsConfiguration) {
  make_synchronous();
  start();
  EXPECT_EQ(hear(0x000, {0x81, 0}), Reaction::boot_up);
  EXPECT_EQ(read(0x1400, 2), 255U);
}

TEST_F(OutputModuleTest, AnyFrameIsSurvived) {
  EXPECT_TRUE(rc::check([](const std::vector<std::pair<std::uint16_t, std::vector<std::uint8_t>>>& frames) {
    NodeModel any(16, false, kDark);
    any.power_on(kStart);
    OutputModuleNode module(5, of_outputs(16), any);
    for (const auto& [id, data] : frames) {
      CanFrame one;
      one.id = static_cast<std::uint16_t>(data.size() % 2 == 0 ? 0x605 : id % 0x800U);
      one.length = static_cast<std::uint8_t>(std::min<std::size_t>(8, data.size()));
      std::copy_n(data.begin(), one.length, one.data.begin());
      module.receive(one, kStart);
      module.beat(kStart);
    }
  }));
}

}  // namespace
}  // namespace footlight::sim
