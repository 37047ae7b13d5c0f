// SPDX-License-Identifier: Apache-2.0
#include "app/remote/osc_calls.hpp"

#include <gtest/gtest.h>

namespace footlight::app {
namespace {

using Kind = RemoteCall::Kind;
using Asked = OscAsked::Kind;

TEST(OscCalls, TheCommonVerbsAreCalls) {
  for (const auto& [address, call] :
       std::vector<std::pair<std::string, RemoteCall>>{{"/go", {Kind::go}},
                                                       {"/stop", {Kind::hold}},
                                                       {"/pause", {Kind::hold}},
                                                       {"/resume", {Kind::resume}},
                                                       {"/panic", {Kind::hold}},
                                                       {"/standby", {Kind::order, "standby"}},
                                                       {"/cue/12.5/start", {Kind::start_cue, "12.5"}},
                                                       {"/cue/2/load", {Kind::load_cue, "2"}}}) {
    const OscAsked asked = asked_by({address});
    EXPECT_EQ(asked.kind, Asked::call) << address;
    EXPECT_EQ(asked.call, call) << address;
  }
  EXPECT_EQ(asked_by({"/footlight/order", {"tempo 80"}}).call, (RemoteCall{Kind::order, "tempo 80"}));
}

TEST(OscCalls, AButtonOfAControlSurfaceThatComesUpIsNoSecondGo) {
  EXPECT_EQ(asked_by({"/go", {1.0}}).kind, Asked::call);
  EXPECT_EQ(asked_by({"/go", {0.0}}).kind, Asked::nothing);
  EXPECT_EQ(asked_by({"/go", {std::int32_t{0}}}).kind, Asked::nothing);
}

TEST(OscCalls, ButtonsAndGatesHaveANameAndALevel) {
  EXPECT_EQ(asked_by({"/footlight/gate", {"lift level", std::int32_t{1}}}).input, (OscInput{true, "lift level", true}));
  EXPECT_EQ(asked_by({"/footlight/button", {"left", 0.0}}).input, (OscInput{false, "left", false}));
  EXPECT_EQ(asked_by({"/footlight/gate", {"lift level"}}).why, "a name, and 1 or 0");
}

TEST(OscCalls, WhatIsWrongIsToldWithWhatWouldBeRight) {
  EXPECT_EQ(asked_by({"/cue/twelve/start"}).why, "\"twelve\" is not a cue number");
  EXPECT_EQ(asked_by({"/cue/12/stop"}).why, "/cue/12/start or /cue/12/load");
  EXPECT_EQ(asked_by({"/cue/12"}).why, "/cue/12/start or /cue/12/load");
  EXPECT_EQ(asked_by({"/connect"}).why, "one string");
  EXPECT_EQ(asked_by({"/gogogo"}).why,
            "no such address (/go, /stop, /pause, /resume, /panic, /standby, /cue/{number}/start, /cue/{number}/load, "
            "/footlight/order)");
}

}  // namespace
}  // namespace footlight::app
