// SPDX-License-Identifier: Apache-2.0
#include "app/cast/cast_server.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/cast/follower.hpp"
#include "app/console/room.hpp"
#include "tests/app/console/raw_client.hpp"
#include "tests/support/mutated.hpp"
#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using tests::RawClient;

class CastServerTest : public ::testing::Test {
 protected:
  void open(CastServer::Settings settings = {}) {
    settings.token = token_;
    auto server = CastServer::open(std::move(settings), nullptr, clock_);
    ASSERT_TRUE(server) << server.error().message;
    server_ = std::move(server).value();
    tests::SmallShow small = tests::random_show(12, 8, 6, 2, 2, 1);
    server_->take_plan(std::make_shared<const CastPlan>(small.show, small.plan), true);
  }
  [[nodiscard]] RawClient client() const { return RawClient(server_->port()); }
  [[nodiscard]] std::string answer(const std::string& request) const {
    RawClient one = client();
    one.send(request);
    return one.response();
  }
  [[nodiscard]] std::string bearer() const { return "Authorization: Bearer " + token_ + "\r\n"; }
  [[nodiscard]] std::string post(const std::string& body, const std::string& headers = kHeaders) const {
    const std::string host = client().host();
    return answer("POST /api/pair HTTP/1.1\r\nHost: " + host + "\r\nOrigin: http://" + host +
                  "\r\nContent-Length: " + std::to_string(body.size()) + "\r\n" + headers + "\r\n" + body);
  }
  [[nodiscard]] std::unique_ptr<RawClient> phone() const {
    auto one = std::make_unique<RawClient>(server_->port());
    EXPECT_TRUE(one->open());
    one->say(R"({"hello":{"token":")" + token_ + "\"}}");
    EXPECT_THAT(one->heard("state"), HasSubstr("\"heard\":"));
    return one;
  }
  static constexpr const char* kHeaders = "Content-Type: application/json\r\nX-Footlight: 1\r\n";
  const std::string token_ = std::string(64, 'a');
  SteadyClock clock_;
  std::unique_ptr<CastServer> server_;
};

TEST_F(CastServerTest, ThePageHasEveryHeaderThatGuardsIt) {
  open();
  for (const char* target : {"/", "/cast.js", "/cast.css"}) {
    EXPECT_THAT(answer(client().get(target)),
                AllOf(StartsWith("HTTP/1.1 200 OK\r\n"), HasSubstr("Content-Security-Policy: default-src 'self'; "),
                      HasSubstr("frame-ancestors 'none'"), HasSubstr("X-Content-Type-Options: nosniff\r\n"),
                      HasSubstr("Referrer-Policy: no-referrer\r\n"), Not(HasSubstr("Set-Cookie")),
                      Not(HasSubstr("Access-Control"))))
        << target;
  }
}

TEST_F(CastServerTest, NamesAreForThoseAloneWhoKnowTheCode) {
  open();
  EXPECT_THAT(answer(client().get("/api/show")), StartsWith("HTTP/1.1 401 "))
      << "also on this machine: a proxy may be in between";
  EXPECT_THAT(answer(client().get("/api/show?token=" + token_)), StartsWith("HTTP/1.1 404 "));
  const std::string shown = answer(client().get("/api/show", bearer()));
  EXPECT_THAT(shown, AllOf(StartsWith("HTTP/1.1 200 "), HasSubstr("\"performers\"")));
  const std::string etag = shown.substr(shown.find("ETag: ") + 6, 66);
  EXPECT_THAT(answer(client().get("/api/show", bearer() + "If-None-Match: " + etag + "\r\n")),
              StartsWith("HTTP/1.1 304 "));
  RawClient stranger = client();
  ASSERT_TRUE(stranger.open());
  stranger.say(R"({"hello":{"token":"b"}})");
  EXPECT_EQ(stranger.farewell(), Room::kToken);
}

TEST_F(CastServerTest, TheCodeIsTypedOnceAndGivesTheToken) {
  open();
  const std::string code = join_code(token_);
  EXPECT_EQ(code.size(), 10U);
  EXPECT_THAT(post(R"({"code":")" + code.substr(0, 5) + " - " + code.substr(5) + "\"}"), HasSubstr(token_));
  EXPECT_EQ(code_as_meant("oO-iL k"), "0011K");
  EXPECT_THAT(post(R"({"code":"0000000000"})"),
              AllOf(StartsWith("HTTP/1.1 403 "), HasSubstr("this is not the code of this cast")));
  EXPECT_THAT(post(R"({"code":1})"), StartsWith("HTTP/1.1 400 "));
  EXPECT_THAT(post("{}", "X-Footlight: 1\r\n"), StartsWith("HTTP/1.1 415 "));
  EXPECT_THAT(post("{}", "Content-Type: application/json\r\n"), StartsWith("HTTP/1.1 400 "));
}

TEST_F(CastServerTest, WhoGuessesCodesIsSlowedDown) {
  open();
  std::string last;
  for (int i = 0; i < 400 && last.find(" 429 ") == std::string::npos; ++i) last = post(R"({"code":"0000000000"})");
  EXPECT_THAT(last, StartsWith("HTTP/1.1 429 "));
  EXPECT_THAT(answer(client().get("/api/show", bearer())), StartsWith("HTTP/1.1 200 ")) << "who is in stays in";
}

TEST_F(CastServerTest, WhatIsForbiddenIsRefusedOverTheWire) {
  open();
  const std::string host = client().host();
  const std::string ok = "Host: " + host + "\r\n";
  const std::vector<std::pair<std::string, std::string>> cases{
      {"GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n", "421 "},
      {"GET / HTTP/1.1\r\n\r\n", "421 "},
      {"GET / HTTP/1.1\r\n" + ok + "Origin: http://evil.example\r\n\r\n", "403 "},
      {client().upgrade("Origin: http://evil.example\r\n"), "403 "},
      {"POST /api/show HTTP/1.1\r\n" + ok + "Origin: http://" + host + "\r\n" + kHeaders + "Content-Length: 0\r\n\r\n",
       "405 "},
      {"DELETE / HTTP/1.1\r\n" + ok + "\r\n", "405 "},
      {"GET /api/pair HTTP/1.1\r\n" + ok + "\r\n", "405 "},
      {"GET /api/plan.bin HTTP/1.1\r\n" + ok + bearer() + "\r\n", "404 "},
      {"GET /api/looks/0.bin HTTP/1.1\r\n" + ok + bearer() + "\r\n", "404 "},
      {"GET /api/way.bin HTTP/1.1\r\n" + ok + bearer() + "\r\n", "404 "},
      {"GET /app.js HTTP/1.1\r\n" + ok + "\r\n", "404 "},
      {"GET /%2e%2e/etc/passwd HTTP/1.1\r\n" + ok + "\r\n", "404 "},
      {"GET / HTTP/1.1\r\n" + ok + "X: " + std::string(16 * 1024, 'a') + "\r\n\r\n", "431 "},
      {"POST /api/pair HTTP/1.1\r\n" + ok + "Origin: http://" + host + "\r\n" + kHeaders +
           "Content-Length: 65537\r\n\r\n",
       "413 "},
      {"rubbish\r\n\r\n", "400 "},
  };
  for (const auto& [request, status] : cases) {
    RawClient one = client();
    one.send(request);
    EXPECT_THAT(one.rest(), AllOf(StartsWith("HTTP/1.1 " + status), HasSubstr("nosniff"))) << request.substr(0, 200);
    EXPECT_FALSE(one.timed_out()) << request.substr(0, 200);
  }
}

TEST_F(CastServerTest, APhoneIsToldItsPartAndWhereToGo) {
  open();
  const auto one = phone();
  one->say(R"({"part":{"who":2,"language":"en"}})");
  EXPECT_THAT(one->heard("part"), HasSubstr(R"({"part":{"who":2,"places":[{"from_s":)"));
  one->say(R"({"where":{"who":2,"cell":0,"language":"en"}})");
  EXPECT_EQ(one->heard("where"), R"({"where":{"kind":"not-heard"}})");
  one->say(R"({"part":{"who":6,"language":"en"}})");
  EXPECT_EQ(one->heard("stale"), R"({"stale":true})") << "nobody has that number";
  DeskWord word;
  word.position_s = -1;
  server_->take_word(word, clock_.now());
  EXPECT_THAT(one->heard("\"stands\""), HasSubstr("\"heard\":true"));
  one->say(R"({"where":{"who":2,"cell":4000000,"language":"en"}})");
  EXPECT_THAT(one->heard("where"), HasSubstr("no-cell"));
  server_->lost();
  EXPECT_THAT(one->heard("state"), HasSubstr("\"heard\":false"));
  server_.reset();
  EXPECT_EQ(one->farewell(), Room::kGoingAway);
}

TEST_F(CastServerTest, ThereIsRoomForSoManyPhonesAndNoMore) {
  CastServer::Settings settings;
  settings.most_phones = 3;
  open(std::move(settings));
  std::vector<std::unique_ptr<RawClient>> phones;
  for (int i = 0; i < 3; ++i) phones.push_back(phone());
  RawClient more = client();
  more.send(more.get("/"));
  EXPECT_EQ(more.rest(), "");
  EXPECT_FALSE(more.timed_out());
}

TEST_F(CastServerTest, APhoneThatReadsNothingIsDroppedAndDelaysNobody) {
  CastServer::Settings settings;
  settings.silent_for = milliseconds(1000);
  settings.heartbeat = milliseconds(1);
  open(std::move(settings));
  const auto deaf = phone();  // answers no ping
  const auto quick = phone();
  DeskWord word;
  for (int i = 0; i < 20; ++i) {
    word.position_s = i;
    server_->take_word(word, clock_.now());
    EXPECT_THAT(quick->heard("\"position_s\":" + std::to_string(i) + ".0"), HasSubstr("state"));
  }
  (void)deaf->rest();
  EXPECT_FALSE(deaf->timed_out()) << "it was cut off";
}

TEST_F(CastServerTest, NoMutationOfARequestDoesHarm) {
  open();
  Rng rng(11);
  const std::string good = client().get("/api/show", bearer());
  for (int i = 0; i < 300; ++i) {
    RawClient one = client();
    std::string request = good;
    for (std::uint64_t k = 0; k <= rng.below(5); ++k)
      request[rng.below(request.size())] = static_cast<char>(rng.below(256));
    one.send(request + "\r\n\r\n");
  }
  EXPECT_THAT(answer(good), StartsWith("HTTP/1.1 200 "));
}

TEST(DeskPlace, IsTheAddressThatARunSays) {
  EXPECT_EQ(desk_place_from("http://127.0.0.1:8440")->authority(), "127.0.0.1:8440");
  EXPECT_EQ(desk_place_from("http://[::1]:8440/")->authority(), "[::1]:8440");
  EXPECT_EQ(desk_place_from("http://desk.example")->authority(), "desk.example");
  for (const char* wrong : {"8440", "https://desk.example", "http://", "http://a:b", "http://a/b", "http://a:70000",
                            "http://u@a", "http://a b"}) {
    EXPECT_FALSE(desk_place_from(wrong)) << wrong;
  }
}

}  // namespace
}  // namespace footlight::app
