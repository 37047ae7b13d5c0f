// SPDX-License-Identifier: Apache-2.0
#include "app/console/client_message.hpp"

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/rng.hpp"
#include "tests/support/mutated.hpp"

namespace footlight::app {
namespace {

std::string wrong(std::string_view text) {
  const auto message = client_message_from(text);
  return message ? "understood" : message.error().message;
}

TEST(ClientMessage, EachKindIsUnderstood) {
  const auto hello = client_message_from(R"({"hello": {"name": "Åsa", "token": "t"}})");
  ASSERT_TRUE(hello);
  EXPECT_EQ(std::get<Hello>(*hello).name, "Åsa");
  EXPECT_EQ(std::get<Hello>(*hello).token, "t");
  const auto order = client_message_from(R"({"order": "jump cue 12", "id": 7, "new": [1]})");
  ASSERT_TRUE(order);
  EXPECT_EQ(std::get<OrderSaid>(*order).line, "jump cue 12");
  EXPECT_EQ(std::get<OrderSaid>(*order).id, 7U);
  EXPECT_FALSE(std::get<OrderSaid>(*client_message_from(R"({"order": ""})")).id);
  EXPECT_TRUE(std::get<SeatWish>(*client_message_from(R"({"seat": "take"})")).take);
  EXPECT_FALSE(std::get<SeatWish>(*client_message_from(R"({"seat": "leave"})")).take);
  EXPECT_EQ(std::get<Acknowledge>(*client_message_from(R"({"acknowledge": 12})")).alarm, 12U);
  EXPECT_EQ(std::get<PairWish>(*client_message_from(R"({"pair": "operate"})")).role, Role::operate);
  EXPECT_EQ(std::get<Ping>(*client_message_from(R"({"ping": 9007199254740992})")).number, std::uint64_t{1} << 53);
}

TEST(ClientMessage, WhatIsWrongIsSaid) {
  const std::string no_json = "a JSON object in UTF-8, of at most 4096 bytes";
  const std::string name = "hello: a name of 1 to 40 characters that are shown";
  const std::string id = "order: id is a whole number from 0 to 2^53";
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", no_json},
      {"go", no_json},
      {"[]", no_json},
      {"\"order\"", no_json},
      {R"({"order": "go")", no_json},
      {R"({"order": "go"} x)", no_json},
      {"{\"order\": \"\xff\"}", no_json},
      {R"({"order": "\ud800"})", no_json},
      {R"({"hello": {"name": [[[[1]]]]}})", no_json},
      {std::string(5000, ' ') + "{}", no_json},
      {"{}", "one of hello, order, seat, acknowledge, pair, ping"},
      {R"({"Order": "go"})", "one of hello, order, seat, acknowledge, pair, ping"},
      {R"({"order": "go", "ping": 1})", "one message at a time"},
      {R"({"order": 1})", "order: text, as \"go\""},
      {R"({"order": null})", "order: text, as \"go\""},
      {R"({"order": "go\nquit"})", "order: at most 256 bytes, and no control characters"},
      {R"({"order": "\u0000"})", "order: at most 256 bytes, and no control characters"},
      {R"({"order": ")" + std::string(257, 'a') + "\"}", "order: at most 256 bytes, and no control characters"},
      {R"({"order": "go", "id": -1})", id},
      {R"({"order": "go", "id": 1.5})", id},
      {R"({"order": "go", "id": "7"})", id},
      {R"({"order": "go", "id": 9007199254740993})", id},
      {R"({"hello": "me"})", R"(hello: {"name": "...", "token": "..."})"},
      {R"({"hello": {}})", name},
      {R"({"hello": {"name": ""}})", name},
      {R"({"hello": {"name": "a\u001b[2J"}})", name},
      {R"({"hello": {"name": "a\u202eb"}})", name},
      {R"({"hello": {"name": "a\u0085b"}})", name},
      {R"({"hello": {"name": ")" + std::string(41, 'a') + "\"}}", name},
      {R"({"hello": {"name": "a", "token": 1}})", "hello: the token is text"},
      {R"({"seat": true})", "seat: \"take\" or \"leave\""},
      {R"({"pair": "admin"})", "pair: \"view\" or \"operate\""},
      {R"({"pair": 1})", "pair: \"view\" or \"operate\""},
      {R"({"ping": "x"})", "ping: a whole number from 0 to 2^53"},
      {R"({"acknowledge": -3})", "acknowledge: a whole number from 0 to 2^53"},
  };
  for (const auto& [text, message] : cases) EXPECT_EQ(wrong(text), message) << text;
}

TEST(ClientMessage, AHoldIsKnownHoweverItIsWritten) {
  for (const char* order : {"hold", "HOLD", "  Hold", "hold end", "hold freeze"}) EXPECT_TRUE(is_hold(order)) << order;
  for (const char* order : {"", "go", "holding", "run on", "go hold"}) EXPECT_FALSE(is_hold(order)) << order;
}

TEST(ClientMessage, CodesMayBeTypedInGroups) {
  EXPECT_EQ(*code_from(R"({"code": "1234 5678"})"), "12345678");
  EXPECT_EQ(*code_from(R"({"code": "1234-5678"})"), "12345678");
  for (const char* body : {"", "{}", R"({"code": 12345678})", "[]", R"({"code": null})"}) {
    EXPECT_FALSE(code_from(body)) << body;
  }
}

TEST(ClientMessage, NoMutationDoesHarm) {
  const std::vector<std::string> seeds{R"({"hello": {"name": "stage manager", "token": "0123456789abcdef"}})",
                                       R"({"order": "jump cue 12", "id": 7})",
                                       R"({"seat": "take"})",
                                       R"({"acknowledge": 12})",
                                       R"({"pair": "view"})",
                                       R"({"ping": 17})"};
  std::uint64_t understood = 0;
  for (std::uint64_t seed = 0; seed < 60'000; ++seed) {
    const std::string text = test::mutated(seeds[seed % seeds.size()], Rng(seed), "\"{}[]:,\\u0e9-\x00\xff");
    const auto message = client_message_from(text);
    if (!message) continue;
    ++understood;
    const auto* order = std::get_if<OrderSaid>(&*message);
    if (order == nullptr) continue;
    EXPECT_LE(order->line.size(), kLongestOrder);
    EXPECT_EQ(order->line.find_first_of(std::string("\n\r\0\x1b", 4)), std::string::npos) << seed;
  }
  EXPECT_GT(understood, 1000U) << "the mutations are too wild to find anything";
}

}  // namespace
}  // namespace footlight::app
